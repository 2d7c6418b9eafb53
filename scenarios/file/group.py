"""Groups of scenario keys, and keys that are made from parameters' fields."""

import re
from collections.abc import Iterator
from dataclasses import Field as DataclassField
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model

from surefoot.errors import ParameterError
from surefoot.planner.parameters import RecoveryParameters
from surefoot.scenarios.documented import doc_of
from surefoot.scenarios.file.names import OneOf
from surefoot.scenarios.file.units import Unit
from surefoot.similarity import REFERENCE_SIZE, Similarity
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


def _group(name: str, parameters: Any, doc: str, more: dict[str, Any] | None = None) -> type[Group]:
    """A group with a key for every field of a dataclass, each null by default: the controller's own value."""
    values = {entry: getattr(parameters, entry.name) for entry in fields(parameters)}
    keys = {entry.name: _key(entry, value) for entry, value in values.items() if not isinstance(value, Similarity)}
    made: type[Group] = create_model(name, __base__=Group, __doc__=doc, __module__=__name__, **keys, **(more or {}))
    globals()[name] = made  # where pickle looks for it
    return made


def _key(entry: "DataclassField[Any]", value: Any) -> Any:
    if is_dataclass(value):
        inner = _group(f"Wbc{entry.name.title()}", value, f"wbc.{entry.name}, null: the controller's own.")
        return inner | None, key(None, f"{entry.name}, null: the controller's own")
    if "doc" not in entry.metadata:
        return _planner_key(entry, value)
    doc, unit = entry.metadata["doc"], entry.metadata.get("unit")
    shown = list(value) if isinstance(value, tuple) else value
    kind = _annotation(value)
    annotation = Annotated[kind, Unit(unit)] if unit and not isinstance(value, tuple) else kind
    described = f"{doc}, null: {shown}" + (f" [{unit}]" if isinstance(value, tuple) else "")
    return annotation | None, key(None, described)


def _planner_key(entry: "DataclassField[Any]", value: Any) -> Any:
    """One of the planner's, whose meaning is in the docstring of its dataclass and is positive."""
    doc, unit = _RECOVERY[entry.name]
    if isinstance(value, tuple):
        return _annotation(value) | None, key(None, f"{doc}, null: the planner's own [{unit}]")
    least = (
        Annotated[int, Field(ge=1, le=1000), WHOLE] if isinstance(value, int) else Annotated[float, Field(gt=0, le=1e9)]
    )
    annotation = Annotated[least, Unit(unit)] if "unit" in entry.metadata else least
    described = f"{doc}, null: {value}" + (f" [{unit}]" if "unit" not in entry.metadata else "")
    return annotation | None, key(None, described)


_RECOVERY = {
    name: (doc, unit) for name, doc, unit in re.findall(r"(?m)^ +(\w+): (.*) \[(.*)\]\.$", doc_of(RecoveryParameters))
}
"""Meaning and unit of each number of the planner's recovery."""


def _annotation(value: Any) -> Any:
    """Type of a key whose default is this value; its range is the controller's to know."""
    if isinstance(value, tuple):
        return Annotated[tuple[(float,) * len(value)], BeforeValidator(as_tuple)]  # type: ignore[misc]
    return Annotated[int, WHOLE] if isinstance(value, int) else str if isinstance(value, str) else float


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


def controller_faults(settings: "ControllerSettings | None") -> list[ParameterError]:
    """List what `controller_parameters` would refuse of a group: the fault of every key, each looked at alone."""
    faults = []
    for alone in () if settings is None else _one_by_one(settings):
        try:
            controller_parameters(alone)
        except ParameterError as fault:
            faults.append(fault)
    return faults


def _one_by_one(settings: Any) -> Iterator[Any]:
    """Copies of a group, with one key each that is not null."""
    for name, value in settings:
        parts = _one_by_one(value) if isinstance(value, BaseModel) else () if value is None else (value,)
        for part in parts:
            yield type(settings).model_construct(**{name: part})


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
