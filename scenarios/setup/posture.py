"""What of a walk follows from more than a robot's size: its CoM height, how wide it stands, how deep treads are."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from surefoot.scenarios.errors import Key
from surefoot.scenarios.setup.robot import RobotFacts

CLEAR = 0.04
"""Lateral room between the shanks, or the soles, of a reference robot that walks straight ahead [m]."""


def com_height(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """CoM height at which the legs are bent as much: the hips at the same share of the leg's length [m].

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
    """
    return after.size.length / before.size.length * (value - before.com_above_hip) + after.com_above_hip


def step_width(value: float, before: RobotFacts, after: RobotFacts, nearer: float = math.inf) -> float:
    """Step width for another robot: scaled, and wider by what its shanks or soles need to stay clear of each other [m].

    Feet that may land anywhere keep all the room between them that they have in the scenario as it was written. Those
    that come by a known way nearer than the width keep `CLEAR` of it: a wider step is not a similar one, its CoM sways
    further, and the moment about the vertical that the stance sole has to hold while a leg swings grows with it.

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
        nearer: how much nearer than that feet land in the walk as it was written; infinite where nobody knows [m].
    """
    length = after.size.length / before.size.length
    wider = 0.0
    for name in ("shank_spacing", "foot_width"):
        own, other = getattr(before, name), getattr(after, name)
        spare = max(0.0, value - nearer - own - CLEAR * before.size.length)
        wider = max(wider, other - length * (own + spare))
    return length * value + wider


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


def tread(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """Depth of a tread for another robot: scaled, and deeper by what its soles are longer than scaled ones [m].

    So no sole lands nearer to an edge; arguments as of `com_height`.
    """
    length = after.size.length / before.size.length
    return length * value + max(0.0, after.foot_length - length * before.foot_length)


Rule = Callable[[float, RobotFacts, RobotFacts], float]
"""Gives the value of a key for another robot, from the value for one, facts of that one, and facts of the other."""


def rules(nearer: float) -> dict[Key, Rule]:
    """Keys that follow from more of a robot than its size.

    Args:
        nearer: how much nearer than its step width the feet of the walk land (see `nearer_landings`) [m].
    """
    return {
        ("gait", "com_height"): com_height,
        ("gait", "step_width"): partial(step_width, nearer=nearer),
        ("terrain", "tread"): tread,
    }


POSTURE = ("com_height", "step_width")
"""Those of them that every walk has."""
