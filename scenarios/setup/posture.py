"""What of a walk follows from more than a robot's size: its CoM height, how wide it stands, how deep treads are."""

import math
from collections.abc import Callable

from surefoot.scenarios.errors import Key
from surefoot.scenarios.setup.robot import RobotFacts


def com_height(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """CoM height at which the legs are bent as much: the hips at the same share of the leg's length [m].

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
    """
    return after.size.length / before.size.length * (value - before.com_above_hip) + after.com_above_hip


def for_longer_steps(height: float, step: float, longer: float, robot: RobotFacts) -> float:
    """CoM height for steps longer than those for which one was given [m].

    What a leg lacks of being straight, with the hips midway over the step, grows as the step: the nearer to straight,
    and the longer the step, the faster knees turn.

    Args:
        height: that was given [m].
        step: that it was given for [m].
        longer: that is taken [m].
        robot: facts of it.
    """
    bent = robot.leg_length - math.hypot(height - robot.com_above_hip, 0.5 * step)
    span = robot.leg_length - bent * longer / step
    if not (longer > step > 0.0 < bent and span > 0.5 * longer):
        return height
    return robot.com_above_hip + math.sqrt(span**2 - 0.25 * longer**2)


def step_width(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """Step width for another robot: scaled, and wider by what its hips, shanks or soles are wider than scaled ones [m].

    So no foot lands nearer to the other one than in the scenario as it was written; arguments as of `com_height`.
    """
    length = after.size.length / before.size.length
    wider = (
        getattr(after, name) - length * getattr(before, name) for name in ("hip_width", "shank_spacing", "foot_width")
    )
    return float(length * value + max(0.0, *wider))


def tread(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """Depth of a tread for another robot: scaled, and deeper by what its soles are longer than scaled ones [m].

    So no sole lands nearer to an edge; arguments as of `com_height`.
    """
    length = after.size.length / before.size.length
    return length * value + max(0.0, after.foot_length - length * before.foot_length)


RULES: dict[Key, Callable[[float, RobotFacts, RobotFacts], float]] = {
    ("gait", "com_height"): com_height,
    ("gait", "step_width"): step_width,
    ("terrain", "tread"): tread,
}
"""Keys that follow from more of a robot than its size."""

POSTURE = ("com_height", "step_width")
"""Those of them that every walk has."""
