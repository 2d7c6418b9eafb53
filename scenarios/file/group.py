"""What groups of scenario keys are made of, names of other packages, and keys that are made from parameters' fields."""

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
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
from surefoot.planner.parameters import RecoveryParameters
from surefoot.plugins import PluginError, Registry
from surefoot.scenarios.errors import Key, Problem, dotted
from surefoot.scenarios.file.units import Unit
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.parameters import WbcParameters

Finite = Annotated[float, Field(allow_inf_nan=False)]


class Group(BaseModel):
    """A group of keys: immutable, strictly typed, closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, validate_default=True)


def as_tuple(value: Any) -> Any:
    """A list as the tuple that an immutable group holds; anything else as it is."""
    return tuple(value) if isinstance(value, list) else value


def _whole(value: Any) -> Any:
    return int(value) if isinstance(value, float) and value.is_integer() else value


WHOLE = BeforeValidator(_whole)
"""Takes 5.0 for 5, as JSON Schema does."""


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
        """Describe as a literal would; what a broken package has registered is not among the names."""
        names = self._names()
        return {"enum": loadable(names) if isinstance(names, Registry) else list(names), "type": "string"}

    def _check(self, value: str) -> str:
        if value == self._default or value in (known := list(self._names())):
            return value
        names = [repr(name) for name in known]
        expected = " or ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
        expected = expected or "one that an installed package brings, and none does"
        raise PydanticCustomError("literal_error", "{expected}", {"expected": expected})


def loadable(registry: Registry[Any]) -> list[str]:
    """Names of a registry but for what a broken package has registered."""
    found = []
    for name in registry:
        with suppress(PluginError):
            _ = registry[name]
            found.append(name)
    return found


def terrain_kinds() -> Registry[Any]:
    """Of ``terrain.kind``."""
    from surefoot.scenarios.setup.terrain import KINDS

    return KINDS


def profiles() -> Registry[Any]:
    """Of ``planner.profile``."""
    from surefoot.planner.laws.profiles import PROFILES

    return PROFILES


def estimators() -> Registry[Any]:
    """Of ``sensing.source``."""
    from surefoot.scenarios.run.sensing import ESTIMATORS

    return ESTIMATORS


def tasks() -> Registry[Any]:
    """Of each element of ``wbc.tasks``."""
    from surefoot.wbc.tasks import TASKS

    return TASKS


def robots() -> Registry[Any]:
    """Of ``robot``."""
    from surefoot.models.registry import ROBOTS

    return ROBOTS


DEFAULTS = {"terrain": "flat", "planner": "default", "sensing": "truth", "robot": "humanoid100"}
"""Names that are always there, by the group of the key."""

_REGISTRIES: dict[Key, Callable[[], Registry[Any]]] = {
    ("robot",): robots,
    ("terrain", "kind"): terrain_kinds,
    ("planner", "profile"): profiles,
    ("sensing", "source"): estimators,
    ("wbc", "tasks"): tasks,
}


def unusable(keys: Any) -> list[Problem]:
    """List names whose package cannot be used, or has taken a name of surefoot's own for something else.

    Args:
        keys: plain values of a scenario; what is of another type, or unknown, is for the schema to say.
    """
    return [Problem(key, f"{dotted(key)} {refusal.what}", refusal.right) for key, refusal in _refusals(keys)]


def unknown(keys: Any) -> list[Problem]:
    """List names that no installed package brings; no package is loaded.

    Args:
        keys: plain values of a scenario.
    """
    return [
        Problem(key, f"{dotted(key)} '{name}' is not known here", "install the package that brings it")
        for key, name, registry in _named(keys)
        if name != DEFAULTS.get(str(key[0])) and name not in registry()
    ]


def _refusals(keys: Any) -> Iterator[tuple[Key, PluginError]]:
    for key, name, registry in _named(keys):
        found = registry()
        try:
            found[name]
        except KeyError:
            continue
        except PluginError as refusal:
            yield key, refusal
        else:
            clash = found.clashes().get(name)
            if clash is not None:
                yield key, clash


def _named(keys: Any) -> Iterator[tuple[Key, str, Callable[[], Registry[Any]]]]:
    """Every name that is written, with its place; a robot file is no name."""
    from surefoot.models.registry import is_file

    for key, registry in _REGISTRIES.items():
        value = keys
        for part in key:
            value = value.get(part) if isinstance(value, dict) else None
        if isinstance(value, str) and not (key == ("robot",) and is_file(value)):
            yield key, value, registry
        for index, name in enumerate(value if isinstance(value, list) else ()):
            if isinstance(name, str):
                yield (*key, index), name, registry


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
        return inner | None, Field(default=None, description=f"{entry.name}, null: the controller's own")
    if "doc" not in entry.metadata:
        return _planner_key(entry, value)
    doc, unit = entry.metadata["doc"], entry.metadata.get("unit")
    shown = list(value) if isinstance(value, tuple) else value
    key = _annotation(value)
    annotation = Annotated[key, Unit(unit)] if unit and not isinstance(value, tuple) else key
    described = f"{doc}, null: {shown}" + (f" [{unit}]" if isinstance(value, tuple) else "")
    return annotation | None, Field(default=None, description=described)


def _planner_key(entry: "DataclassField[Any]", value: Any) -> Any:
    """One of the planner's, which is told in the docstring of its dataclass and is positive."""
    doc, unit = _RECOVERY[entry.name]
    if isinstance(value, tuple):
        return _annotation(value) | None, Field(default=None, description=f"{doc}, null: the planner's own [{unit}]")
    least = (
        Annotated[int, Field(ge=1, le=1000), WHOLE]
        if isinstance(value, int)
        else Annotated[Finite, Field(gt=0, le=1e9)]
    )
    annotation = Annotated[least, Unit(unit)] if "unit" in entry.metadata else least
    described = f"{doc}, null: {value}" + (f" [{unit}]" if "unit" not in entry.metadata else "")
    return annotation | None, Field(default=None, description=described)


_RECOVERY = {
    name: (doc, unit)
    for name, doc, unit in re.findall(r"(?m)^ +(\w+): (.*) \[(.*)\]\.$", RecoveryParameters.__doc__ or "")
}
"""Meaning and unit of each number of the planner's recovery."""


def _annotation(value: Any) -> Any:
    """Type of a key whose default is this value; its range is the controller's to know."""
    if isinstance(value, tuple):
        return Annotated[tuple[(Finite,) * len(value)], BeforeValidator(as_tuple)]  # type: ignore[misc]
    return Annotated[int, WHOLE] if isinstance(value, int) else str if isinstance(value, str) else Finite


_TASKS = Annotated[tuple[Annotated[str, OneOf("", tasks)], ...], BeforeValidator(as_tuple)]

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
                Annotated[float, Field(ge=0.05, le=10, allow_inf_nan=False)] | None,
                Field(
                    default=None,
                    description="friction coefficient that it counts on, whatever the ground has, null: "
                    "terrain.friction + errors.friction [-]",
                ),
            ),
            "tasks": (_TASKS, Field(default=(), description="tasks of other packages in its QP, by name")),
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
    """Numbers of the planner's recovery, with what a scenario changes of them.

    Args:
        settings: the group ``planner.recovery``; None for none.
        usual: those of this robot.
    """
    changed: RecoveryParameters = _changed(usual, settings)
    return changed


def controller_parameters(settings: "ControllerSettings | None", size: Similarity = REFERENCE_SIZE) -> WbcParameters:
    """The controller's parameters for a robot of a size, with what a scenario changes of them.

    Args:
        settings: the group ``wbc``; None for none.
        size: of the robot.

    Raises:
        ParameterError: a number is out of its range, or a solver unknown.
    """
    changed: WbcParameters = _changed(size.scaled(WbcParameters()), settings)
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
    given = {entry.name: getattr(settings, entry.name, None) for entry in fields(parameters)}
    changed = {
        name: _changed(getattr(parameters, name), value) if isinstance(value, BaseModel) else value
        for name, value in given.items()
        if value is not None
    }
    return replace(parameters, **changed)
