"""The robots by name: those of this package and those that other packages bring.

Another package needs one file, with a function from options to a description, and one entry point:

    [project.entry-points."surefoot.robots"]
    my-robot = "my_package.robot:MY_ROBOT"    # MY_ROBOT = Robot("my-robot", describe)
"""

from functools import partial
from pathlib import Path

from surefoot.models.names import ROBOTS, SHIPPED, is_file
from surefoot.models.types import (
    Explanation,
    Robot,
    RobotDescription,
    RobotError,
    RobotOptions,
    UnknownRobotError,
    nearest,
)
from surefoot.parts.guard import taken_for


def _explained(path: Path, options: RobotOptions) -> Explanation:
    """The robot of a file, which is read by what no other robot needs."""
    from surefoot.models.robot_file.build import explain

    return explain(path, options, describe)


def _of_file(path: Path, options: RobotOptions) -> RobotDescription:
    return _explained(path, options).description


def robot_of(file: Path) -> Robot:
    """The robot of a file under the name of that file."""
    return Robot(file.stem, partial(_of_file, file))


def robot_names() -> tuple[str, ...]:
    """Names that `describe` accepts."""
    return tuple(ROBOTS)


def describe(name: str, options: RobotOptions) -> RobotDescription:
    """The robot of that name or robot file, built with these options.

    Raises:
        UnknownRobotError: no robot has that name.
        PluginError: the package that brings it cannot be used, or fails to build it.
        RobotError: an option is out of range, or the description contradicts itself.
    """
    if is_file(name):
        return _of_file(Path(name), options)
    try:
        robot = ROBOTS[name]
    except KeyError:
        raise UnknownRobotError(f"there is no robot '{name}': {nearest(name, robot_names())}") from None
    description: RobotDescription = ROBOTS.guard(name).making.function(robot.build, taken_for(RobotDescription))(
        options
    )
    if description.name != name:
        raise RobotError(("name",), f"robot '{name}' describes itself as '{description.name}'", "use one name for both")
    return description


def explain(name: str) -> Explanation:
    """A robot by name or robot file, with what of its description was derived and what else is to be known.

    Raises:
        UnknownRobotError: no robot has that name.
            PluginError: the package that brings it cannot be used, or fails to build it.
            RobotError: the description contradicts itself.
    """
    if is_file(name) or name in SHIPPED:
        return _explained(SHIPPED.get(name, Path(name)), RobotOptions())
    return Explanation(describe(name, RobotOptions()))
