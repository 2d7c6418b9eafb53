"""Robot descriptions: one MJCF text per robot, read by MuJoCo and by Pinocchio."""

from typing import TYPE_CHECKING

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.models.names import ROBOTS
    from surefoot.models.registry import describe, explain, robot_names
    from surefoot.models.types import (
        JointRoles,
        Robot,
        RobotDescription,
        RobotError,
        RobotOptions,
        UnknownRobotError,
    )

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

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            "names": ("ROBOTS",),
            "registry": ("describe", "explain", "robot_names"),
            "types": ("JointRoles", "Robot", "RobotDescription", "RobotError", "RobotOptions", "UnknownRobotError"),
        },
    )
