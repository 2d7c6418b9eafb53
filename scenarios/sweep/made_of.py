"""What a result depends on beside its scenario: results of the same may stand in one table."""

import hashlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from surefoot.models.registry import describe, is_file
from surefoot.models.types import RobotOptions
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.source import parse
from surefoot.scenarios.record.packages import packages_of
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.setup.load import Written
from surefoot.scenarios.sweep.points import Point

OF_A_MACHINE = ("machine", "python")
"""Versions in which the machines of a cluster may differ from each other."""


class _Base(NamedTuple):
    """What a scenario names: its robot, a robot file by its full path, and every word of its keys and values."""

    robot: str
    words: frozenset[str]


class MadeOf:
    """Digests of versions, code and robots, each robot looked at once: what changes meanwhile takes another object."""

    def of(self, point: Point, anywhere: bool = False) -> str:
        """Digest of all that the result of a run depends on but its scenario.

        Args:
            point: the run.
            anywhere: leave out in what the machines of a cluster may differ.
        """
        base = self._base(point.base.written)
        words = frozenset((*base.words, *_words(dict(point.settings))))
        versions = {name: one for name, one in relevant_versions().items() if not (anywhere and name in OF_A_MACHINE)}
        robot = self._robot(str(point.settings.get("robot", base.robot)))
        return _digest([versions, dict(packages_of(words)), robot])

    @cached_property
    def _base(self) -> Callable[[Written], _Base]:
        return lru_cache(maxsize=None)(_named)

    @cached_property
    def _robot(self) -> Callable[[str], str]:
        return lru_cache(maxsize=None)(robot_digest)


def robot_digest(name: str) -> str:
    """Digest of a robot as it is described now, of what is wrong with it if it cannot be."""
    try:
        return _digest(asdict(describe(name, RobotOptions())))
    except (Exception, SystemExit) as error:  # whatever the parts of others raise
        return _digest(f"{type(error).__name__}: {error}")


def _named(written: Written) -> _Base:
    """What a scenario names."""
    values = parse(written.text, written.place).value
    robot = str(values.get("robot", Scenario.model_fields["robot"].default)) if isinstance(values, dict) else ""
    if is_file(robot):
        robot = os.path.normpath(Path(written.place).parent.absolute() / robot)
    return _Base(robot, frozenset(_words(values)))


def _words(value: Any) -> Iterator[str]:
    """Texts among values, and the parts of their keys."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from str(key).split(".")
            yield from _words(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _words(inner)
    elif isinstance(value, str):
        yield value


def _digest(values: Any) -> str:
    text = json.dumps(values, sort_keys=True, default=lambda value: value.tolist())
    return hashlib.sha256(text.encode()).hexdigest()[:16]
