"""``--set key=value``: values set over those of a scenario file."""

from typing import Any

from scenarios.errors import Key, ScenarioError
from scenarios.file.source import Source, parse


def apply_override(source: Source, override: str) -> None:
    """Set one value in place.

    Args:
        source: the scenario's values.
        override: ``key=value``; the key dotted, list elements by index, the value YAML.

    Raises:
        ScenarioError: it is no such pair, or the key leads into a scalar or past the end of a list.
    """
    name, equals, text = override.partition("=")
    name = name.strip()
    if not equals or not name:
        raise ScenarioError([f"--set {override}: not a setting; write --set key=value"])
    place = f"--set {name}"
    value = parse(text, place)
    if value.problems:
        raise ScenarioError([value.describe(problem) for problem in value.problems])
    key: Key = tuple(int(part) if part.isdecimal() and len(part) < 6 else part for part in name.split("."))
    _assign(source.value, key, value.value, place)
    source.overridden[key] = place


def _assign(group: Any, key: Key, value: Any, place: str) -> None:
    for part, following in zip(key, (*key[1:], None), strict=True):
        if isinstance(group, list):
            if not isinstance(part, int) or part >= len(group):
                raise ScenarioError([f"{place}: no element {part} of a list of {len(group)}; use an index within it"])
        elif not isinstance(group, dict):
            raise ScenarioError([f"{place}: '{part}' is not a key of a group; set the group itself"])
        elif isinstance(part, int):
            raise ScenarioError([f"{place}: {part} indexes no list; use a key"])
        if following is None:
            group[part] = value
        elif isinstance(group, dict) and group.get(part) is None:
            group[part] = {}
            group = group[part]
        else:
            group = group[part]
