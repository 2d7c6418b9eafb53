"""The causes that a scenario may have of an incident: what acts on the walk, each of which can be taken out."""

import json
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from surefoot.scenarios.errors import Key, dotted
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.sensing import SENSOR_KEYS

Values = dict[str, Any]
"""Keys of a scenario that are not at their defaults, as its file has them."""

_LISTS = ("pushes", "faults", "commands")
"""Keys each of whose entries acts by itself."""

_GROUPS = ("errors", "motors", "sensing", "start", "control", "planner", "wbc")
"""Groups each of whose keys acts by itself."""

_WHOLE = ("payload",)
"""Keys of groups that act as one."""

_PLACES = ("x", "y", "yaw")
"""Keys of the start that say where it is, which fells nobody."""

SETTINGS = ("control", "planner", "wbc", "controller")
"""Groups of the controller, which a test is to try: what of them fells a robot is to be mended there."""

_TRUTH = DEFAULTS["sensing"]

_NAMED = {
    "push": ("pushes",),
    "fault": ("faults",),
    "friction": ("terrain", "wbc", "errors"),
    "ground": ("terrain", "errors"),
    "mass": ("errors", "robot_options"),
    "gains": ("wbc", "control"),
    "late_commands": ("motors", "control"),
    "motors": ("motors",),
    "sensors": ("sensing",),
}
"""Groups in which a cause lies that `surefoot.scenarios.judge.causes` names."""


@dataclass(frozen=True, slots=True)
class Cause:
    """Something of a scenario that acts on the walk.

    Attributes:
        keys: paths that make it, which are at their defaults without it.
        text: what it is, as it is written.
    """

    keys: tuple[Key, ...]
    text: str

    @property
    def group(self) -> str:
        """The first word of its keys."""
        return str(self.keys[0][0])

    @property
    def is_setting(self) -> bool:
        """True of a setting of the controller."""
        return self.group in SETTINGS


def values_of(scenario: Scenario) -> Values:
    """The keys of a scenario that are not at their defaults, but for those that only say what its log holds."""
    found = scenario.model_dump(mode="json", exclude_defaults=True, exclude_none=True, exclude={"log", "name"})
    plain: Values = json.loads(json.dumps(found))
    sensing = plain.get("sensing", {})
    if scenario.sensing.source == _TRUTH:  # which reads no sensors; a preset alone would name another source
        for name in set(SENSOR_KEYS) & sensing.keys():
            _remove(plain, ("sensing", name))
    return plain


def causes_of(values: Values) -> tuple[Cause, ...]:
    """Everything in a scenario that may be a cause, in the order of its keys; the walk itself is none."""
    return tuple(_found(values))


def _found(values: Values) -> Iterator[Cause]:
    for name in _LISTS:
        yield from (_cause(values, ((name, index),)) for index in range(len(values.get(name, ()))))
    yield from _of_ground(values.get("terrain", {}), values)
    for group in _GROUPS:
        for key in _leaves((group,), values[group]) if group in values else ():
            yield from _of_key(key, values)
    for one in (("robot_options", "payload_mass"), ("gait", "heel_off")):
        if one[1] in values.get(one[0], {}):
            yield _cause(values, (one,))
    if "controller" in values:
        yield _cause(values, (("controller",),))


def _of_ground(terrain: Mapping[str, Any], values: Values) -> Iterator[Cause]:
    shape = tuple(("terrain", name) for name in terrain if name not in ("friction", "height_noise"))
    if shape:
        noise = (("terrain", "height_noise"),) if "height_noise" in terrain else ()
        text = f"terrain.kind {terrain['kind']}" if "kind" in terrain else ""
        yield _cause(values, (*shape, *noise), text)
    for name in ("height_noise", "friction"):
        if name in terrain:
            yield _cause(values, (("terrain", name),))


def _of_key(key: Key, values: Values) -> Iterator[Cause]:
    if key[0] == "start" and key[1] in _PLACES:
        return
    if key == ("sensing", "options"):  # of the source
        return
    if key == ("sensing", "source"):
        sensed = ("source", "options", *SENSOR_KEYS)
        keys = tuple(("sensing", name) for name in values["sensing"] if name in sensed)
        yield _cause(values, keys, f"sensing.source {values['sensing']['source']}")
        return
    yield _cause(values, (key,))


def _leaves(prefix: Key, value: Any) -> Iterator[Key]:
    """Paths of the single keys in a group, and of the entries of its lists of groups."""
    if isinstance(value, Mapping) and prefix[-1] not in _WHOLE and value:
        for name, part in value.items():
            yield from _leaves((*prefix, name), part)
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        yield from ((*prefix, index) for index in range(len(value)))
    else:
        yield prefix


def _cause(values: Values, keys: tuple[Key, ...], text: str = "") -> Cause:
    return Cause(keys, text or f"{dotted(keys[0])} {flow(_at(values, keys[0]))}")


def flow(value: Any) -> str:
    """A value in one line, as YAML reads it."""
    return json.dumps(value, ensure_ascii=False).replace('"', "")


def _at(values: Any, key: Key) -> Any:
    for part in key:
        values = values[part]
    return values


def without(values: Values, causes: Iterable[Cause]) -> Values:
    """The scenario without some of its causes."""
    left = deepcopy(values)
    keys = {key for cause in causes for key in cause.keys}
    # Of the entries of a list the last first, so that those before keep their numbers.
    for key in sorted(keys, key=lambda one: [(isinstance(part, int), part) for part in one], reverse=True):
        _remove(left, key)
    return left


def _remove(values: Any, key: Key) -> None:
    """Remove what stands at a path, and the groups and lists that are empty then."""
    first, *rest = key
    if isinstance(values, dict) and first not in values:
        return
    if rest:
        _remove(values[first], tuple(rest))
    if not rest or values[first] in ({}, []):
        del values[first]


def settings(values: Values, cause: Cause) -> tuple[str, ...]:
    """Settings of keys, as ``--set`` takes them, that take a cause out of a scenario."""
    key, left = cause.keys[0], without(values, (cause,))
    group = str(key[0])
    if len(cause.keys) > 1:
        return (f"{group}={json.dumps(left.get(group, {}))}",)
    if isinstance(key[-1], int):
        place = key[:-1]
        try:
            rest = _at(left, place)
        except KeyError:
            rest = []
        return (f"{dotted(place)}={json.dumps(rest)}",)
    return (f"{dotted(key)}={json.dumps(_default(key))}",)


def _default(key: Key) -> Any:
    """The default of a key; null of one in a group that is null."""
    value: Any = Scenario().model_dump(mode="json")
    for part in key:
        if not isinstance(value, dict):
            return None
        value = value.get(part)
    return value


def suspected(causes: Iterable[Cause], named: Iterable[str]) -> tuple[Cause, ...]:
    """The causes that lie where the checks of a log say that its causes are."""
    groups = {group for check in named for group in _NAMED.get(check, ())}
    return tuple(cause for cause in causes if cause.group in groups)
