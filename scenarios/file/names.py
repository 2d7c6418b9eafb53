"""Names that a scenario may use and other packages may bring: how a value is checked, and what is wrong with one."""

from collections.abc import Iterator
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from surefoot.models.names import is_file
from surefoot.parts.plugins import OWN_PACKAGE, Registry
from surefoot.scenarios.errors import Key, Problem, dotted
from surefoot.scenarios.file.registries import DEFAULTS, REGISTRIES


def usable(found: Registry[Any]) -> list[str]:
    """Names of a registry but for what a broken package has registered."""
    return [name for name in found if found.package(name) == OWN_PACKAGE or found.refusal(name) is None]


class OneOf:
    """One of the names that a registry has when a value is checked: other packages may bring more of them.

    Args:
        key: whose registry it is; its default name is accepted without a look at the others.
    """

    def __init__(self, *key: str) -> None:
        self._default, self._names = DEFAULTS.get(key[0], ""), REGISTRIES[key]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Check as a literal would, with its message."""
        return core_schema.no_info_after_validator_function(self._check, core_schema.str_schema(strict=True))

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Describe as a literal would; what a broken package has registered is not among the names."""
        return {"enum": usable(self._names), "type": "string"}

    def _check(self, value: str) -> str:
        if value == self._default or value in (known := list(self._names)):
            return value
        names = [repr(name) for name in known]
        expected = " or ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
        expected = expected or "one that an installed package brings, and none does"
        raise PydanticCustomError("literal_error", "{expected}", {"expected": f"{expected}{self._names.hint}"})


def unusable(keys: Any) -> list[Problem]:
    """List a scenario's names whose package cannot be used, or has taken one of surefoot's own for something else."""
    refused = ((key, registry.refusal(name)) for key, name, registry in _named(keys))
    return [Problem(key, f"{dotted(key)} {why.what}", why.right) for key, why in refused if why is not None]


def unknown(keys: Any) -> list[Problem]:
    """List a scenario's names, among plain values, that no installed package brings; no package is loaded."""
    return [
        Problem(
            key,
            f"{dotted(key)} '{name}' is not known here",
            "install the package that brings it, again where its entry points have changed",
        )
        for key, name, registry in _named(keys)
        if name != DEFAULTS.get(str(key[0])) and name not in registry
    ]


def _named(keys: Any) -> Iterator[tuple[Key, str, Registry[Any]]]:
    """Every name that is written, with its place; a robot file is no name."""
    for path, registry in REGISTRIES.items():
        for key, value in _written(keys, path):
            if isinstance(value, str) and not (key == ("robot",) and is_file(value)):
                yield key, value, registry
            for index, name in enumerate(value if isinstance(value, list) else ()):
                if isinstance(name, str):
                    yield (*key, index), name, registry


def _written(values: Any, path: Key, at: Key = ()) -> Iterator[tuple[Key, Any]]:
    """The values at a path of keys into plain values, with their places, of which a list on the way has several."""
    if not path:
        yield at, values
    elif isinstance(values, list):
        for index, element in enumerate(values):
            yield from _written(element, path, (*at, index))
    elif isinstance(values, dict):
        yield from _written(values.get(path[0]), path[1:], (*at, path[0]))
