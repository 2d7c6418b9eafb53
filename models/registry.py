"""The robots by name."""

from surefoot.models import humanoid100
from surefoot.models.options import nearest
from surefoot.models.types import RobotDescription, RobotOptions

_ROBOTS = {"humanoid100": humanoid100.describe}


class UnknownRobotError(LookupError):
    """No robot has that name."""


def robot_names() -> tuple[str, ...]:
    """Names that `describe` accepts."""
    return tuple(_ROBOTS)


def describe(name: str, options: RobotOptions) -> RobotDescription:
    """The robot of that name, built with these options.

    Raises:
        UnknownRobotError: no robot has that name.
        RobotError: an option is out of range.
    """
    builder = _ROBOTS.get(name)
    if builder is None:
        raise UnknownRobotError(f"there is no robot '{name}': {nearest(name, robot_names())}")
    return builder(options)
