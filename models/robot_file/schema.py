"""The keys of a robot file, and errors that say where in it the fault stands."""

import fnmatch
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from surefoot.models.robot_file.document import ROBOT_FILE, text_of
from surefoot.models.types import RobotError, nearest

Positive = Annotated[float, Field(gt=0.0, le=1e9, allow_inf_nan=False)]
Length = Annotated[float, Field(gt=0.0, le=1e3, allow_inf_nan=False)]
Finite = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Scale = Annotated[float, Field(ge=0.01, le=100.0, allow_inf_nan=False)]
Patterns = dict[str, Positive]
_SHOWN = 60
"""Characters of a wrong value that are shown."""

DEEPEST = 10
"""Groups inside each other."""


class _Group(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class Feet(_Group):
    """The links that carry the soles."""

    left: str = Field(description="link that carries the left sole")
    right: str = Field(description="link that carries the right sole")


class Sole(_Group):
    """The contact rectangle of both feet, where the shapes of the feet do not say it."""

    length: Length = Field(description="forward [m]")
    width: Length = Field(description="sideways [m]")
    centre: tuple[Finite, Finite, Finite] = Field(
        description="of the bottom face in the frame of the left foot's link [m]; the right one mirrors y"
    )


class RobotFile(_Group):
    """A robot, as its owner describes it: `name`, `model` and `feet`; all else follows from the model unless given.

    A file of a robot that is known by name, in another size, has `name`, `model` and `scale` alone.
    Patterns are names of joints with `*` for anything; where several match, the last one counts.
    """

    name: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=100, description="of the robot")
    model: str = Field(
        description="URDF or MJCF: a path from here, package://NAME/..., or the name of a robot to scale"
    )
    feet: Feet | None = Field(default=None, description="links that carry the soles")
    forward: Literal["x", "-x", "y", "-y"] | None = Field(
        default=None, description="axis of the base that points ahead"
    )
    torso: str | None = Field(default=None, description="link whose uprightness is controlled")
    imu: str | None = Field(default=None, description="link or site of the IMU that says how the robot moves")
    lock: list[str] | dict[str, Finite] | None = Field(
        default=None, description="joints that are frozen, and where [rad]"
    )
    sole: Sole | None = Field(default=None, description="contact rectangle of the feet")
    srdf: str | None = Field(default=None, description="file with named postures and rotors")
    posture: str | dict[str, Finite] | None = Field(default=None, description="state of the SRDF, or angles [rad]")
    armature: Patterns = Field(default={}, description="rotor inertia at the joint [kg m^2]")
    torque_limit: Patterns = Field(default={}, description="[N m]")
    velocity_limit: Patterns = Field(default={}, description="[rad/s]")
    com_height: Length | None = Field(default=None, description="of the CoM above the soles in walking [m]")
    keep_apart: list[tuple[str, str]] | None = Field(default=None, description="pairs of links that shall not meet")
    inertia: Literal["refuse", "repair"] = Field(default="refuse", description="what to do with unphysical inertias")
    scale: Scale = Field(default=1.0, description="size of the similar robot over this one")
    licence: str | None = Field(default=None, description="of the model")
    source: str | None = Field(default=None, description="where the model is from")

    def soles(self) -> Feet:
        """The feet of a file that has to have them.

        Raises:
            RobotError: it has none.
        """
        if self.feet is None:
            raise RobotError(
                ("feet",), f"robot file of '{self.name}' lacks feet", "give feet: {left: LINK, right: LINK}"
            )
        return self.feet


def read(path: Path) -> RobotFile:
    """Read a robot file.

    Raises:
        RobotError: it cannot be read, or a key is unknown, missing or wrong; says the line.
    """
    text = text_of(path, ROBOT_FILE)
    try:
        node = _Composer(text).get_single_node()
        values, lines = yaml.SafeLoader("").construct_document(node) if node else None, _lines(node)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{path}:{mark.line + 1}" if mark else str(path)
        raise RobotError((), f"{place}: no YAML, {getattr(error, 'problem', None) or error}", "mend it") from None
    except (ValueError, TypeError, AttributeError) as error:  # dates and the like that are none
        raise RobotError((), f"{path}: no YAML, {error}", "give words and numbers") from None
    if values is None:
        raise RobotError((), f"{path}: is empty", "write one with: surefoot robot new MODEL --out FILE")
    if not isinstance(values, dict):
        raise RobotError((), f"{path}: no robot file", "give name, model and feet, a line each")
    try:
        return RobotFile.model_validate(values)
    except ValidationError as error:
        first = min(error.errors(), key=lambda fault: fault["type"] != "extra_forbidden")  # whose name may be misspelt
        raise _refusal(path, first, lines) from None


class _Composer(yaml.SafeLoader):
    """Composes nodes, and stops at what is deep or would have to be expanded."""

    depth = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self.depth += 1
        event = self.peek_event()  # type: ignore[no-untyped-call]
        if self.depth > DEEPEST:
            raise yaml.composer.ComposerError(None, None, f"nested deeper than {DEEPEST} levels", event.start_mark)
        if getattr(event, "value", None) == "<<":
            raise yaml.composer.ComposerError(None, None, "'<<' merges no groups here", event.start_mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


def _lines(node: yaml.Node | None, key: tuple[str, ...] = ()) -> dict[tuple[str, ...], int]:
    """Line of each key, counted from one."""
    found: dict[tuple[str, ...], int] = {}
    if isinstance(node, yaml.MappingNode):
        for name, value in node.value:
            found[(*key, str(name.value))] = name.start_mark.line + 1
            found |= _lines(value, (*key, str(name.value)))
    return found


def _refusal(path: Path, fault: Any, lines: Mapping[tuple[str, ...], int]) -> RobotError:
    """The first fault that pydantic found, in a sentence."""
    key = tuple(str(part) for part in fault["loc"])
    known = next((key[:size] for size in range(len(key), 0, -1) if key[:size] in lines), ())
    place = f"{path}:{lines[known]}" if known else str(path)
    dotted = ".".join(known or key[:1])
    if fault["type"] == "extra_forbidden":
        groups: dict[tuple[str, ...], type[BaseModel]] = {("feet",): Feet, ("sole",): Sole}
        group = groups.get(key[:-1], RobotFile)
        return RobotError(key, f"{place}: unknown key '{'.'.join(key)}'", nearest(key[-1], tuple(group.model_fields)))
    if fault["type"] == "missing":
        return RobotError(key, f"{place}: lacks {'.'.join(key)}", f"give {_example(key)}")
    rule = fault["msg"][0].lower() + fault["msg"][1:]
    given = fault["input"]
    shown = f"{given:.9g}" if isinstance(given, float) else repr(given)
    return RobotError(key, f"{place}: {dotted} is {shown if len(shown) <= _SHOWN else f'{shown[:_SHOWN]}...'}", rule)


def _example(key: tuple[str, ...]) -> str:
    examples = {"name": "name: my-robot", "model": "model: my_robot.urdf", "feet": "feet: {left: LINK, right: LINK}"}
    return examples.get(key[0] if len(key) == 1 else "", f"{'.'.join(key)}")


def matched(patterns: Mapping[str, float], names: Iterable[str], key: str, robot: str) -> dict[str, float]:
    """Value of each joint that a pattern of the file means.

    Raises:
        RobotError: a pattern means none.
    """
    names = tuple(names)
    found: dict[str, float] = {}
    for pattern, value in patterns.items():
        meant = fnmatch.filter(names, pattern)
        if not meant:
            what = f"{key} of {robot} has the pattern '{pattern}', which matches no joint"
            raise RobotError((key, pattern), what, nearest(pattern, names))
        found |= dict.fromkeys(meant, value)
    return found
