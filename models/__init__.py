"""Robot descriptions: one MJCF text per robot, read by MuJoCo and by Pinocchio."""

from surefoot.models.registry import ROBOTS, UnknownRobotError, describe, explain, robot_names
from surefoot.models.types import JointRoles, Robot, RobotDescription, RobotError, RobotOptions

__all__ = [
    "ROBOTS",
    "JointRoles",
    "Robot",
    "RobotDescription",
    "RobotError",
    "RobotOptions",
    "UnknownRobotError",
    "describe",
    "explain",
    "robot_names",
]
