"""The robots by name: those of this package and those that other packages bring.

Another package needs one file, with a function from options to a description, and one entry point:

    [project.entry-points."surefoot.robots"]
    my-robot = "my_package.robot:MY_ROBOT"    # MY_ROBOT = Robot("my-robot", describe)
"""

from surefoot.models.humanoid100 import HUMANOID100
from surefoot.models.types import Robot, RobotDescription, RobotError, RobotOptions, nearest
from surefoot.plugins import Registry

ROBOTS = Registry("surefoot.robots", Robot, {HUMANOID100.name: HUMANOID100})
"""Every robot that `robot: NAME` of a scenario can mean."""


class UnknownRobotError(LookupError):
    """No robot has that name."""


def robot_names() -> tuple[str, ...]:
    """Names that `describe` accepts."""
    return tuple(ROBOTS)


def describe(name: str, options: RobotOptions) -> RobotDescription:
    """The robot of that name, built with these options.

    Raises:
        UnknownRobotError: no robot has that name.
        PluginError: the package that brings it cannot be used.
        RobotError: an option is out of range, or the description contradicts itself.
    """
    try:
        robot = ROBOTS[name]
    except KeyError:
        raise UnknownRobotError(f"there is no robot '{name}': {nearest(name, robot_names())}") from None
    description = robot.build(options)
    if description.name != name:
        raise RobotError(("name",), f"robot '{name}' describes itself as '{description.name}'", "use one name for both")
    return description
