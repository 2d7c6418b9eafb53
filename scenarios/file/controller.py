"""The keys ``wbc.*``: every number of the whole-body controller, made of the dataclasses that own it."""

from dataclasses import Field as DataclassField
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, BeforeValidator, Field, create_model

from surefoot.scenarios.file.group import Finite, Group, OneOf, as_tuple
from surefoot.scenarios.file.plugged import tasks
from surefoot.wbc.parameters import WbcParameters


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


_TASKS = Annotated[tuple[Annotated[str, OneOf("", tasks)], ...], BeforeValidator(as_tuple)]

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
