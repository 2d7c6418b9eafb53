"""What two logs were made of: versions, settings, attached files and metrics, flattened to lines side by side."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.file.source import parse
from surefoot.scenarios.judge.metrics import measure
from surefoot.scenarios.log import Log
from surefoot.scenarios.record.provenance import RECORD, SCENARIO_FILE

VERSIONS_RECORD = "versions"
"""Metadata record of what made a log, by which two runs may differ and still be the same."""

_AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Difference:
    """A value of two logs.

    Attributes:
        name: what it is.
        a: in the first log, None when it is not there.
        b: in the second log, None when it is not there.
    """

    name: str
    a: Any
    b: Any

    @property
    def delta(self) -> float | None:
        """Second minus first, when both are numbers."""
        numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in (self.a, self.b))
        return float(self.b - self.a) if numbers else None


def version_differences(a: Log, b: Log) -> tuple[Difference, ...]:
    """Versions that are not the same."""
    return _differences(*(dict(log.metadata.get(VERSIONS_RECORD, {})) for log in (a, b)))


def setting_differences(a: Log, b: Log) -> tuple[Difference, ...]:
    """Settings of the attached scenarios, or of the run's constants, that are not the same."""
    return _differences(*(_settings(log) for log in (a, b)))


def file_differences(a: Log, b: Log) -> tuple[str, ...]:
    """Attached files other than the scenario that are not the same in both."""
    names = sorted((a.attachments.keys() | b.attachments.keys()) - {SCENARIO_FILE})
    return tuple(name for name in names if a.attachments.get(name) != b.attachments.get(name))


def record_differences(a: Log, b: Log) -> tuple[str, ...]:
    """Metadata records other than the versions that are not the same: constants, pushes, how the run ended."""
    names = sorted((a.metadata.keys() | b.metadata.keys()) - {VERSIONS_RECORD})
    return tuple(name for name in names if a.metadata.get(name) != b.metadata.get(name))


def metric_pairs(a: Log, b: Log) -> tuple[tuple[Difference, ...], tuple[str, ...]]:
    """Every metric of both logs, element by element, and a note for each log that has none."""
    values: list[dict[str, Any]] = []
    notes: list[str] = []
    for name, log in (("A", a), ("B", b)):
        try:
            measured = measure(log)
        except LogError as error:
            values.append({})
            notes.append(f"{name} has no metrics: {error}")
        else:
            values.append(_flat(measured.values, names=_AXES))
            notes += [f"{name}: {note}" for note in measured.notes]
    first, second = values
    return tuple(Difference(name, first.get(name), second.get(name)) for name in {**first, **second}), tuple(notes)


def _settings(log: Log) -> dict[str, Any]:
    try:
        text = log.attachments[SCENARIO_FILE].decode()
        return _flat(parse(text, SCENARIO_FILE).value)
    except (KeyError, UnicodeDecodeError, ScenarioError):
        return dict(log.metadata.get(RECORD, {}))


def _differences(a: Mapping[str, Any], b: Mapping[str, Any]) -> tuple[Difference, ...]:
    pairs = (Difference(name, a.get(name), b.get(name)) for name in {**a, **b})
    return tuple(pair for pair in pairs if pair.a != pair.b)


def _flat(value: Any, prefix: str = "", names: tuple[str, ...] = ()) -> dict[str, Any]:
    """Values by dotted name; elements of a list by number, or by the names given to them."""
    if isinstance(value, dict):
        parts = [(str(key), part) for key, part in value.items()]
    elif isinstance(value, list):
        parts = [(names[i] if i < len(names) else str(i), part) for i, part in enumerate(value)]
    else:
        return {prefix: value}
    flat: dict[str, Any] = {}
    for key, part in parts:
        flat |= _flat(part, f"{prefix}.{key}" if prefix else key, names)
    return flat
