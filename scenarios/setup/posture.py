"""What of a walk follows from more than a robot's size: its CoM height, how wide it stands, how deep treads are.

Another robot carries its CoM on the same walk as high as leaves its knees bent as much where they are straightest.
Equal legs alone do not say it. Where the CoM is beside the hips, how much of the mass is in the legs, how long the
soles are and how far apart the hips, all of that moves the hips over the feet, and with them how straight a leg gets
that is left behind. So both robots stand as they would (see `surefoot.scenarios.setup.stances`), and are compared.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from surefoot.errors import ParameterError
from surefoot.models.facts import RobotFacts, similar_com_height, similar_step_width, similar_tread
from surefoot.scenarios.errors import Key
from surefoot.scenarios.file.schema import Scenario


def nearer_landings(gait: Mapping[str, Any], told: bool) -> float:
    """How much nearer than its step width the feet of a walk land; infinite where they may land anywhere [m].

    Args:
        gait: keys of the group ``gait`` that are given.
        told: whether the walk hears while it goes on where to go.
    """
    velocity = gait.get("velocity")
    commands = velocity if isinstance(velocity, list | tuple) else ()
    sideways = any(isinstance(one, Mapping) and (one.get("v_y") or one.get("yaw_rate")) for one in commands)
    if told or sideways or any(gait.get(name) for name in ("turn", "footsteps", "waypoints")):
        return math.inf
    aside = gait.get("lateral_step", 0.0)
    return abs(aside) if isinstance(aside, int | float) else math.inf


Rule = Callable[[float, RobotFacts, RobotFacts], float]
"""Gives the value of a key for another robot, from the value for one, facts of that one, and facts of the other."""


def rules(nearer: float) -> dict[Key, Rule]:
    """Keys that follow from more than a robot's size, where feet land that much nearer (see `nearer_landings`) [m]."""
    return {
        ("gait", "com_height"): similar_com_height,
        ("gait", "step_width"): partial(similar_step_width, nearer=nearer),
        ("terrain", "tread"): similar_tread,
    }


POSTURE = ("com_height", "step_width")
"""Those of them that every walk has."""

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
    from scipy.optimize import brentq

    from surefoot.scenarios.setup.stance import body_of
    from surefoot.scenarios.setup.stances import least_bend
    from surefoot.scenarios.setup.walk import resolve

    of, walk = resolve(before), resolve(after)
    body, leg, height = body_of(walk.robot), walk.robot.leg_length, walk.gait.com_height

    def bend(tried: float) -> float:
        """With the CoM at a height; none where the legs do not reach."""
        gait = after.gait.model_copy(update={"com_height": tried})
        try:
            return least_bend(replace(walk, keys=after.model_copy(update={"gait": gait})), body) or 0.0
        except ParameterError:
            return 0.0

    wanted = least_bend(of, body_of(of.robot))
    if wanted is None:
        return height
    low, high = (height + leg * way for way in _WAYS)
    try:
        found = brentq(lambda tried: bend(tried) - wanted, low, high, xtol=0.5 * 10.0**-_DECIMALS)
    except ValueError:  # nowhere between them
        return height
    return round(float(found), _DECIMALS)
