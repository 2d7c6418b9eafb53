"""YAML that a program has written, as the scenario in a log; libyaml, where it is there, reads it ten times as fast."""

import json
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import yaml

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.source import MAX_VALUES, Composer, Reader, Source, parse

if TYPE_CHECKING:
    from surefoot.scenarios.file.schema import Scenario


def parse_dumped(text: str, name: str) -> Source:
    """Parse as `parse` does, with its arguments and errors; where libyaml finds a fault, `parse` looks for it."""
    if yaml.__with_libyaml__ and text.isascii() and "\t" not in text:  # of which the two think differently
        source = Source(name)
        try:
            root = _composer()(text, MAX_VALUES).get_single_node()
            source.value = None if root is None else Reader(source, MAX_VALUES).read(root, ())
        except (yaml.YAMLError, RecursionError):
            return parse(text, name)
        return source
    return parse(text, name)


def dumped_values(text: str, name: str) -> Any:
    """The values of `parse_dumped`, which has the arguments and errors; nobody may change them.

    A text that a program has written gives no key twice; one that does is an error as well.
    """
    keys = _KEYS.split(text)
    try:
        groups = [_values(part) for part in keys if part]
    except (ScenarioError, ValueError, RecursionError):
        return _sound(parse_dumped(text, name))
    whole = {key: value for group in groups for key, value in group.items()}
    return whole if 0 < len(whole) == len(groups) <= _MOST_KEYS else _sound(parse_dumped(text, name))


def _sound(source: Source) -> Any:
    if source.problems:
        raise ScenarioError([source.describe(problem) for problem in source.problems])
    return source.value


_KEYS, _MOST_KEYS = re.compile(r"^(?=[a-z_]+:)", re.MULTILINE), 64


def _values(text: str) -> dict[str, Any]:
    """The values of one key, with it."""
    found = _sound(parse_dumped(text, ""))
    if not isinstance(found, dict) or len(found) != 1:
        raise ValueError("not one key")
    return found


@cache
def _composer() -> type[Composer]:
    """Composes the same nodes from the events of libyaml."""

    class Quick(Composer, yaml.CSafeLoader):
        peek_event = yaml.CSafeLoader.peek_event
        check_event = yaml.CSafeLoader.check_event
        get_event = yaml.CSafeLoader.get_event

        def __init__(self, text: str, most_values: int) -> None:
            yaml.CSafeLoader.__init__(self, text)
            yaml.composer.Composer.__init__(self)
            self.most = most_values

    return Quick


def scenario_yaml(scenario: "Scenario") -> str:
    """The scenario as run: every key with its value, but for those left null."""
    groups = scenario.model_dump(mode="json", exclude_none=True)
    # Through JSON no two groups share a list, which YAML would tell by an anchor.
    return "".join(
        yaml.safe_dump({name: json.loads(json.dumps(group))}, sort_keys=False) for name, group in groups.items()
    )
