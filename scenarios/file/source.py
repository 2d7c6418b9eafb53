"""YAML text to plain values that know where they stand in the text."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import IO, Any

import yaml

from surefoot.pointers import IS_A_POINTER, POINTER_BYTES, is_pointer
from surefoot.scenarios.errors import Key, Problem, ScenarioError

MAX_BYTES = 500_000
MAX_DEPTH = 20
MAX_VALUES = 20_000
_NAMED = 4
"""Settings from outside that a refusal names."""
_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]{0,18})")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf"), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
}


@dataclass(slots=True)
class Source:
    """Plain values with the places they came from.

    Attributes:
        name: file name as the user knows it.
        value: mappings, lists and scalars.
        key_places: 1-based (line, column) of each key, by path.
        value_places: 1-based (line, column) of each value, by path.
        overridden: places of paths that were set from outside the text.
        problems: faults of the text itself, such as a key given twice.
        written: how values stand in the text that have been translated since, by path.
    """

    name: str
    value: Any = None
    key_places: dict[Key, tuple[int, int]] = field(default_factory=dict)
    value_places: dict[Key, tuple[int, int]] = field(default_factory=dict)
    overridden: dict[Key, str] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    written: dict[Key, str] = field(default_factory=dict)

    def spot(self, problem: Problem) -> tuple[int, int]:
        """Line and column of what is at fault, or of the nearest enclosing value; (0, 0) outside the text."""
        key = problem.key
        if self._override(key):
            return 0, 0
        if problem.at_key and key in self.key_places:
            return self.key_places[key]
        return next(
            (self.value_places[key[:n]] for n in range(len(key), -1, -1) if key[:n] in self.value_places), (1, 1)
        )

    def describe(self, problem: Problem, together: bool = False) -> str:
        """Describe a fault and its place.

        Args:
            problem: what is wrong.
            together: whether it may come of values that do not fit together, so that one which was set from outside
                may be the cause although another stands in the text.
        """
        line, column = self.spot(problem)
        override = self._override(problem.key)
        written = None if override else self.written.get(problem.key)
        said = f"{override or f'{self.name}:{line}:{column}'}: {problem}" + (f" ({written})" if written else "")
        if override or not together or not self.overridden:
            return said
        named = list(dict.fromkeys(self.overridden.values()))
        more = f" and {len(named) - _NAMED} more" if len(named) > _NAMED else ""
        return f"{said} [set over the file: {', '.join(named[:_NAMED])}{more}]"

    def _override(self, key: Key) -> str | None:
        """Place of the override that set a path, part of it, or a group that the text has not got."""
        inside = (self.overridden[key[:n]] for n in range(len(key), 0, -1) if key[:n] in self.overridden)
        made = (place for path, place in self.overridden.items() if path[: len(key)] == key and key)
        return next(inside, None) or (next(made, None) if key not in self.value_places else None)


def decoded(file: IO[bytes], name: str, most_bytes: int = MAX_BYTES) -> str:
    """Text of an open file, whoever it is from, of at most so many bytes; its name is for messages.

    Raises:
        ScenarioError: it is a Git LFS pointer, too large, or no UTF-8.
    """
    data = file.read(most_bytes + 1)
    if is_pointer(data[:POINTER_BYTES]):
        raise ScenarioError([f"{name}: {IS_A_POINTER}"])
    if len(data) > most_bytes:
        raise ScenarioError([f"{name}:1:1: larger than {most_bytes} bytes; a scenario is a short YAML file"])
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - data.rfind(b"\n", 0, error.start)
        raise ScenarioError([f"{name}:{line}:{column}: not UTF-8 text; save the file as UTF-8"]) from None


def parse(text: str, name: str, most_values: int = MAX_VALUES) -> Source:
    """Read YAML text, named for messages, of at most so many values once aliases are expanded.

    Returns:
        its values with their places; keys given twice are listed as problems.

    Raises:
        ScenarioError: the text is no YAML, nests too deep or expands to too many values.
    """
    source = Source(name)
    try:
        root = Composer(text, most_values).get_single_node()
        if root is not None:
            source.value = Reader(source, most_values).read(root, ())
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{mark.line + 1}:{mark.column + 1}" if mark else "1:1"
        reason = " ".join(str(error.problem or error.context or "not YAML").split())
        raise ScenarioError([f"{name}:{place}: not valid YAML, {reason}; mend the YAML syntax here"]) from None
    except yaml.reader.ReaderError as error:
        before = text[: error.position]
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        message = f"{name}:{line}:{column}: a character that YAML does not allow; use plain text"
        raise ScenarioError([message]) from None
    except RecursionError:
        raise ScenarioError([f"{name}:1:1: nested too deep; at most {MAX_DEPTH} levels"]) from None
    return source


def plain_scalar(text: str) -> Any:
    """Plain scalar of the YAML 1.2 core schema (so 1e-3 is a number and `no` a word)."""
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        return int(text)
    return float(text) if _FLOAT.fullmatch(text) else text


class Composer(yaml.SafeLoader):
    """Composes nodes, and stops before nesting exhausts the interpreter's stack, or their number time and memory."""

    depth = made = 0

    def __init__(self, text: str, most_values: int) -> None:
        super().__init__(text)
        self.most = most_values

    def compose_node(self, parent: Any, index: Any) -> Any:
        """See PyYAML."""
        self.depth += 1
        self.made += index is not None  # which is None of a key
        if self.made > self.most:
            raise self._refusal(f"more than {self.most} values")
        if self.depth > MAX_DEPTH:
            raise self._refusal(f"nested deeper than {MAX_DEPTH} levels")
        tag = getattr(self.peek_event(), "tag", None)  # type: ignore[no-untyped-call]
        if tag is not None:
            raise self._refusal(f"a tag ('{tag.replace('tag:yaml.org,2002:', '!!')[:40]}'), which scenarios have not")
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def resolve(self, kind: Any, value: Any, implicit: Any) -> str:
        """Give no tag: `plain_scalar` says what a scalar is, and nobody asks for more."""
        return ""

    def _refusal(self, reason: str) -> yaml.MarkedYAMLError:
        mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
        return yaml.composer.ComposerError(None, None, reason, mark)


class Reader:
    """Builds values from nodes and remembers the places."""

    def __init__(self, source: Source, most_values: int) -> None:
        self._source, self._most = source, most_values
        self._count = 0

    def read(self, node: yaml.Node, key: Key) -> Any:
        """The value of a node at a path."""
        self._count += 1
        if self._count > self._most or len(key) > MAX_DEPTH:
            reason = f"more than {self._most} values or {MAX_DEPTH} levels once aliases are expanded"
            raise yaml.composer.ComposerError(None, None, reason, node.start_mark)
        self._source.value_places[key] = _spot(node)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, key)
        if isinstance(node, yaml.SequenceNode):
            return [self.read(item, (*key, i)) for i, item in enumerate(node.value)]
        plain = isinstance(node, yaml.ScalarNode) and not node.style
        return plain_scalar(node.value) if plain else node.value

    def _mapping(self, node: yaml.MappingNode, key: Key) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if not isinstance(key_node, yaml.ScalarNode):
                raise yaml.constructor.ConstructorError(None, None, "a key must be a word", key_node.start_mark)
            path = (*key, key_node.value)
            spot = _spot(key_node)
            if key_node.value in values:
                first = self._source.key_places[path]
                what = f"'{key_node.value}' is given twice, first at line {first[0]}"
                self._source.key_places[path] = spot
                self._source.problems.append(Problem(path, what, "keep one of them", at_key=True))
                continue
            self._source.key_places[path] = spot
            if key_node.value == "<<" and not key_node.style:
                self._source.problems.append(Problem(path, "'<<' merges no groups here", "write the keys", at_key=True))
                continue
            values[key_node.value] = self.read(value_node, path)
        return values


def _spot(node: yaml.Node) -> tuple[int, int]:
    return node.start_mark.line + 1, node.start_mark.column + 1


Overrides = Sequence[str] | Mapping[str, Any]
"""Values set over those of a scenario: ``key=value`` with YAML values, or values by dotted key."""


def apply_overrides(source: Source, overrides: Overrides) -> None:
    """Set values in place, in order; list elements are reached by index.

    Raises:
        ScenarioError: one is no setting, or its key leads into a scalar or past the end of a list.
    """
    if isinstance(overrides, Mapping):
        for name, value in overrides.items():
            _set(source, str(name), _plain(value, f"--set {name}"))
        return
    for override in overrides:
        _set(source, *setting(override))


def setting(override: str) -> tuple[str, Any]:
    """Dotted key and value of ``key=value``.

    Raises:
        ScenarioError: it is none.
    """
    name, equals, text = override.partition("=")
    name = name.strip()
    if not equals or not name:
        raise ScenarioError([f"--set {override}: not a setting; write --set key=value"])
    parsed = parse(text, f"--set {name}")
    if parsed.problems:
        raise ScenarioError([parsed.describe(problem) for problem in parsed.problems])
    return name, parsed.value


def _set(source: Source, name: str, value: Any) -> None:
    place = f"--set {name if len(name) <= 100 else name[:97] + '...'}"
    key = _path(name)
    if not name.isprintable():
        raise ScenarioError([f"{place}: no key is spelt so; use plain text"])
    if len(key) > MAX_DEPTH:
        raise ScenarioError([f"{place}: a key of {len(key)} parts; give at most {MAX_DEPTH}"])
    _assign(source.value, key, value, place)
    source.overridden[key] = place


def value_at(values: Any, name: str) -> Any:
    """The value at a dotted key.

    Raises:
        LookupError: there is none.
    """
    for part in _path(name):
        values = values[part]
    return values


def _path(name: str) -> Key:
    return tuple(int(part) if part.isdecimal() and len(part) < 6 else part for part in name.split("."))


def _plain(value: Any, place: str, depth: int = 0) -> Any:
    """A value as YAML would give it: numpy's numbers and arrays, and tuples, as plain ones, huge integers as floats."""
    if depth > MAX_DEPTH:
        raise ScenarioError([f"{place}: nested deeper than {MAX_DEPTH} levels; give a plainer value"])
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(inner, place, depth + 1) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner, place, depth + 1) for inner in value]
    if isinstance(value, int) and abs(value) >= 10**19:
        return float(value) if abs(value) < 10**308 else math.inf if value > 0 else -math.inf
    return value


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
