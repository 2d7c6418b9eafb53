"""What every group of scenario keys is made of, and the keys wbc.* of the whole-body controller."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import Field as DataclassField
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    create_model,
)
from pydantic_core import PydanticCustomError, core_schema

from surefoot.errors import ParameterError
from surefoot.wbc.parameters import WbcParameters

Finite = Annotated[float, Field(allow_inf_nan=False)]


class Group(BaseModel):
    """A group of keys: immutable, strictly typed, closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, validate_default=True)


def as_tuple(value: Any) -> Any:
    """A list as the tuple that an immutable group holds; anything else as it is."""
    return tuple(value) if isinstance(value, list) else value


class OneOf:
    """One of the names that a registry has when a value is checked: other packages may bring more of them.

    Args:
        default: one that is always there; it is accepted without a look at the others.
        names: gives them all; asked at each check of another name, so that nothing is imported before.
    """

    def __init__(self, default: str, names: Callable[[], Iterable[str]]) -> None:
        self._default, self._names = default, names

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Check as a literal would, with its message."""
        return core_schema.no_info_after_validator_function(self._check, core_schema.str_schema(strict=True))

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Describe as a literal would."""
        return {"enum": list(self._names()), "type": "string"}

    def _check(self, value: str) -> str:
        if value == self._default or value in (known := list(self._names())):
            return value
        names = [repr(name) for name in known]
        expected = " or ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
        expected = expected or "one that an installed package brings, and none does"
        raise PydanticCustomError("literal_error", "{expected}", {"expected": expected})


def _tasks() -> Iterable[str]:
    from surefoot.wbc.tasks import TASKS

    return TASKS


def _group(name: str, parameters: Any, doc: str, more: dict[str, Any] | None = None) -> type[Group]:
    """A group with a key for every field of a dataclass, each null by default: the controller's own value."""
    keys = {entry.name: _key(entry, getattr(parameters, entry.name)) for entry in fields(parameters)}
    return create_model(name, __base__=Group, __doc__=doc, **keys, **(more or {}))


def _key(entry: "DataclassField[Any]", value: Any) -> Any:
    if is_dataclass(value):
        inner = _group(f"Wbc{entry.name.title()}", value, f"wbc.{entry.name}, null: the controller's own.")
        return inner | None, Field(default=None, description=f"{entry.name}, null: the controller's own")
    doc, unit = entry.metadata["doc"], entry.metadata.get("unit")
    shown = list(value) if isinstance(value, tuple) else value
    described = f"{doc}, null: {shown}" + (f" [{unit}]" if unit else "")
    return _annotation(value) | None, Field(default=None, description=described)


def _annotation(value: Any) -> Any:
    """Type of a key whose default is this value; its range is the controller's to know."""
    if isinstance(value, tuple):
        return Annotated[tuple[(Finite,) * len(value)], BeforeValidator(as_tuple)]  # type: ignore[misc]
    return int if isinstance(value, int) else str if isinstance(value, str) else Finite


_TASKS = Annotated[tuple[Annotated[str, OneOf("", _tasks)], ...], BeforeValidator(as_tuple)]

if TYPE_CHECKING:

    class ControllerSettings(Group):
        """The whole-body controller."""

        tasks: tuple[str, ...]

else:
    ControllerSettings = _group(
        "ControllerSettings",
        WbcParameters(),
        "The whole-body controller.",
        {"tasks": (_TASKS, Field(default=(), description="tasks of other packages in its QP, by name"))},
    )


def controller_parameters(settings: "ControllerSettings | None") -> WbcParameters:
    """The controller's parameters with what a scenario changes of them.

    Args:
        settings: the group ``wbc``; None for none.

    Raises:
        ParameterError: a number is out of its range, or a solver unknown.
    """
    changed: WbcParameters = _changed(WbcParameters(), settings)
    return changed


def controller_faults(settings: "ControllerSettings | None") -> list[ParameterError]:
    """List what `controller_parameters` would refuse: the fault of every key, each looked at alone.

    Args:
        settings: the group ``wbc``; None for none.
    """
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
    given = {entry.name: getattr(settings, entry.name) for entry in fields(parameters)}
    changed = {
        name: _changed(getattr(parameters, name), value) if isinstance(value, BaseModel) else value
        for name, value in given.items()
        if value is not None
    }
    return replace(parameters, **changed)
