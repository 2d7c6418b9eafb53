"""The keys of a scenario whose values are names that other packages may bring."""

from collections.abc import Callable, Iterator
from typing import Any

from surefoot.plugins import PluginError, Registry
from surefoot.scenarios.errors import Key, Problem, dotted


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
    from surefoot.scenarios.loop.estimator import ESTIMATORS

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
    """Every name that is written, with its place."""
    for key, registry in _REGISTRIES.items():
        value = keys
        for part in key:
            value = value.get(part) if isinstance(value, dict) else None
        if isinstance(value, str):
            yield key, value, registry
        for index, name in enumerate(value if isinstance(value, list) else ()):
            if isinstance(name, str):
                yield (*key, index), name, registry
