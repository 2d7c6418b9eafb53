"""How high another robot carries its CoM on the same walk: its knees are bent as much where they are straightest.

Equal legs alone do not say it. Where the CoM is beside the hips, how much of the mass is in the legs, how long the
soles are and how far apart the hips, all of that moves the hips over the feet, and with them how straight a leg gets
that is left behind. So both robots stand as they would (see `surefoot.scenarios.setup.stances`), and are compared.
"""

from dataclasses import replace

from scipy.optimize import brentq

from surefoot.errors import ParameterError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.stance import Body, body_of
from surefoot.scenarios.setup.stances import least_bend
from surefoot.scenarios.setup.walk import Walk, resolve

_WAYS = (-0.06, 0.03)
"""How far lower and higher it is sought, of the leg's length [-]."""

_DECIMALS = 4
"""Of a height [m]."""


def bent_alike(before: Scenario, after: Scenario) -> float:
    """CoM height with which the straightest knee is bent as that of another robot on its walk [m].

    Args:
        before: the walk of the other one.
        after: the same walk of the one in question, at about that height.

    Returns:
        The height; as it is where no stance is known beforehand, or none near it makes them alike.

    Raises:
        ParameterError: the other one cannot stand so.
    """
    of, walk = resolve(before), resolve(after)
    body, leg, height = body_of(walk.robot), walk.robot.leg_length, walk.gait.com_height
    wanted = least_bend(of, body_of(of.robot))
    if wanted is None:
        return height
    low, high = (height + leg * way for way in _WAYS)
    try:
        found = brentq(lambda tried: _bend(walk, body, tried) - wanted, low, high, xtol=0.5 * 10.0**-_DECIMALS)
    except ValueError:  # nowhere between them
        return height
    return round(float(found), _DECIMALS)


def _bend(walk: Walk, body: Body, height: float) -> float:
    """Bend with the CoM at a height; none where the legs do not reach."""
    standing = walk.standing_height + height - walk.gait.com_height
    try:
        bend = least_bend(replace(walk, gait=replace(walk.gait, com_height=height), standing_height=standing), body)
    except ParameterError:
        return 0.0
    return bend or 0.0
