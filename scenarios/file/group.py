"""Groups of scenario keys, and keys that are made from parameters' fields."""

import math
from collections.abc import Container, Iterator, Mapping
from dataclasses import Field as DataclassField
from dataclasses import fields, is_dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model

from surefoot.planner.parameters import PlannerParameters, RecoveryParameters
from surefoot.scenarios.documented import doc_of
from surefoot.scenarios.file.names import OneOf
from surefoot.scenarios.file.units import Unit
from surefoot.similarity import REFERENCE_SIZE, Similarity, sized_unit
from surefoot.tunable import Range
from surefoot.wbc.parameters import WbcParameters

T = TypeVar("T")


class Group(BaseModel):
    """A group of keys: immutable, strictly typed, closed to unknown keys."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, validate_default=True, allow_inf_nan=False, defer_build=True
    )

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Keep the documentation that the JSON Schema shows, also where the interpreter drops it."""
        cls.__doc__ = doc_of(cls) or None


def key(default: Any, description: str) -> Any:
    """A key with its default, and what it is in a few words."""
    return Field(default=default, description=description)


class Unfelt:
    """The mark of a key of `Scenario`, of a group or a list, that as a whole has no effect on kinds of walker.

    Attributes:
        by: these kinds, as `Scenario.walker` names them.
    """

    def __init__(self, *by: str) -> None:
        self.by = by


def groups_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """The groups that an annotation names, however deep in it."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from groups_in(part)


def as_tuple(value: Any) -> Any:
    """A list as the tuple that an immutable group holds; anything else as it is."""
    return tuple(value) if isinstance(value, list) else value


Many = Annotated[tuple[T, ...], BeforeValidator(as_tuple)]
"""Any number of one kind."""


def _whole(value: Any) -> Any:
    return int(value) if isinstance(value, float) and value.is_integer() else value


WHOLE = BeforeValidator(_whole)
"""Takes 5.0 for 5, as JSON Schema does."""


def _group(
    name: str,
    parameters: Any,
    doc: str,
    more: Mapping[str, Any] = MappingProxyType({}),
    only: Container[str] = (),
) -> type[Group]:
    """A group with a key for each number of a dataclass, or for those named; null is the value that it has."""
    keys = keys_of(parameters, only)
    made: type[Group] = create_model(name, __base__=Group, __doc__=doc, __module__=__name__, **keys, **more)
    globals()[name] = made  # where pickle looks for it
    return made


def keys_of(parameters: Any, only: Container[str] = ()) -> dict[str, Any]:
    """The keys of a group by name: one for each number of a dataclass, or for those named."""
    values = {entry: getattr(parameters, entry.name) for entry in fields(parameters)}
    chosen = {entry: value for entry, value in values.items() if not isinstance(value, Similarity)}
    if only:
        chosen = {entry: value for entry, value in values.items() if entry.name in only}
    return {entry.name: _key(entry, value, "the profile's own" if only else None) for entry, value in chosen.items()}


def _key(entry: "DataclassField[Any]", value: Any, null: str | None) -> Any:
    """A key for a field, null by default; its range is the field's.

    Args:
        entry: the field.
        value: its value.
        null: name of what null stands for; None for this value.
    """
    if is_dataclass(value):
        inner = _group(f"Wbc{entry.name.title()}", value, f"wbc.{entry.name}, null: the controller's own.")
        return inner | None, key(None, f"{entry.name}, null: the controller's own")
    doc, unit = entry.metadata["doc"], entry.metadata.get("unit")
    names = entry.metadata.get("names")
    kind = Literal[names] if names else _kind(value, entry.metadata["range"])
    if isinstance(value, tuple):
        shown = list(value) if len(value) <= _SHOWN else "the planner's own"
        return kind | None, key(None, f"{doc}, null: {shown} [{unit}]")
    sized = sized_unit(entry)
    described = f"{doc}, null: {null or value}" + ("" if sized or not unit else f" [{unit}]")
    return (Annotated[kind, Unit(sized)] if sized else kind) | None, key(None, described)


_SHOWN = 3
"""Numbers that the description of a key tells of its default."""

_MOST = 1e9
"""The greatest number that a key takes where its field sets no end."""


def _kind(value: Any, within: Range) -> Any:
    """Type of a key whose default is this value, with its range."""
    if isinstance(value, tuple):
        return Annotated[tuple[tuple(_kind(part, within) for part in value)], BeforeValidator(as_tuple)]  # type: ignore[misc]
    least: dict[str, Any] = {} if within.least == -math.inf else {"gt" if within.positive else "ge": within.least}
    ends = Field(**least, le=min(within.most, _MOST))
    return Annotated[int, ends, WHOLE] if isinstance(value, int) else Annotated[float, ends]


if TYPE_CHECKING:

    class ControllerSettings(Group):
        """The whole-body controller."""

        friction: float | None
        tasks: tuple[str, ...]

else:
    ControllerSettings = _group(
        "ControllerSettings",
        WbcParameters(),
        "The whole-body controller.",
        {
            "friction": (
                Annotated[float, Field(ge=0.05, le=10)] | None,
                key(
                    None,
                    "friction coefficient that it counts on, whatever the ground has, null: "
                    "terrain.friction + errors.friction [-]",
                ),
            ),
            "tasks": (
                Many[Annotated[str, OneOf("wbc", "tasks")]],
                key((), "tasks of other packages in its QP, by name"),
            ),
        },
    )


if TYPE_CHECKING:

    class RecoverySettings(Group):
        """Numbers of the planner's recovery from pushes, null: the planner's own."""

else:
    RecoverySettings = _group(
        "RecoverySettings",
        RecoveryParameters(),
        "Numbers of the planner's recovery from pushes, null: the planner's own.",
    )


LAW_NUMBERS = ("jerk_limit", "jerk_rate_limit", "jerk_weight", "terminal_weight", "step_weight")
"""Numbers of the planner's law of motion that a scenario may change, each a key of its group ``planner``."""

if TYPE_CHECKING:

    class LawSettings(Group):
        """Numbers of the law of motion."""

else:
    LawSettings = _group("LawSettings", PlannerParameters(), "Numbers of the law of motion.", only=LAW_NUMBERS)


def recovery_parameters(settings: "RecoverySettings | None", usual: RecoveryParameters) -> RecoveryParameters:
    """Numbers of a planner's recovery, with what a scenario's group ``planner.recovery``, if any, changes of them."""
    changed: RecoveryParameters = _changed(usual, settings)
    return changed


def controller_parameters(settings: "ControllerSettings | None", size: Similarity = REFERENCE_SIZE) -> WbcParameters:
    """The controller's parameters for a robot of a size, with what a scenario's group ``wbc``, if any, changes of them.

    Raises:
        ParameterError: a number is out of its range, or a solver unknown.
    """
    changed: WbcParameters = _changed(size.scaled(WbcParameters()), settings)
    return changed


def _changed(parameters: Any, settings: Any) -> Any:
    """A dataclass with those of its fields that are not null in a group."""
    if settings is None:
        return parameters
    given = {entry.name: getattr(settings, entry.name, None) for entry in fields(parameters)}
    changed = {
        name: _changed(getattr(parameters, name), value) if isinstance(value, BaseModel) else value
        for name, value in given.items()
        if value is not None
    }
    return replace(parameters, **changed)
