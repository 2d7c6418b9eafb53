"""What of a walk follows from more than a robot's size: its CoM height, how wide it stands, how deep treads are."""

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
