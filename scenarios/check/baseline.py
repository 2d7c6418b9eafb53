"""A baseline: what a scenario's run measured when it was as it should be, in a file that people read and review."""

import contextlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import yaml

from surefoot.scenarios.check.trace import Trace
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import write_whole

ENDING = ".baseline.yaml"

Value = bool | int | float | None
Direction = Literal["better", "worse", "other"]


@dataclass(frozen=True, slots=True)
class Move:
    """A metric that is not where its baseline has it.

    Attributes:
        name: of the metric, with the element or part after it.
        before: value of the baseline, in SI units.
        now: value of the run.
        allowed: how far apart they may be.
        unit: of the values.
        direction: whether the run is better, worse, or just other, by what the scenario's criterion asks for.
    """

    name: str
    before: Value
    now: Value
    allowed: float
    unit: str
    direction: Direction


@dataclass(frozen=True, slots=True)
class Baseline:
    """Metrics and trace of a run that was as it should be.

    Attributes:
        scenario: its name.
        settings: what shapes the run and is not a default, so that a baseline of another scenario is not compared.
        metrics: those that two runs have in common, by name.
        trace: its signs, stage by stage.
    """

    scenario: str
    settings: str
    metrics: Mapping[str, Any]
    trace: Trace

    @classmethod
    def of(cls, scenario: str, settings: str, metrics: Mapping[str, Any], log: Log) -> "Baseline":
        """What is kept of a run."""
        kept = {name: value for name, value in metrics.items() if (m := known(name)) is not None and m.repeatable}
        return cls(scenario, settings, kept, Trace.of(log))

    def moves(self, metrics: Mapping[str, Any], criteria: Mapping[str, Bound]) -> Iterator[Move]:
        """Metrics that moved by more than their tolerance; those that the baseline has not got are no moves."""
        for name, before in self.metrics.items():
            metric = known(name)
            if metric is None:
                yield Move(name, None, None, 0.0, "", "other")
                continue
            for label, old, new in _elements(name, before, metrics.get(name)):
                allowed = 0.0 if isinstance(old, bool) else metric.allowed(old)
                if not _near(old, new, allowed):
                    yield Move(label, old, new, allowed, metric.unit, _direction(criteria.get(name), old, new))

    def other_settings(self, settings: str) -> list[str]:
        """Which keys of a scenario's settings, in YAML, are not as here, a sentence each."""
        before, now = (_flat(yaml.safe_load(text) or {}) for text in (self.settings, settings))
        return [
            f"{key} is {now.get(key, 'the default')}, {before.get(key, 'the default')} in the baseline"
            for key in {**before, **now}
            if (key in before, before.get(key)) != (key in now, now.get(key))
        ]

    def text(self) -> str:
        """The file: metrics with their units, then the trace."""
        lines = [
            "# What the run measured when it was as it should be; `surefoot check` compares, --update writes.",
            f"scenario: {self.scenario}",
            "metrics:",
        ]
        for name, value in self.metrics.items():
            metric = known(name)
            unit = f"  # {metric.unit}" if metric is not None and metric.unit else ""
            lines.append(f"  {name}: {yaml.safe_dump(_rounded(value), default_flow_style=True).splitlines()[0]}{unit}")
        lines += ["trace:  # lift-off to lift-off; SI units", *(f"  - {row}" for row in self.trace.lines())]
        settings = "\n".join(f"  {line}" for line in self.settings.splitlines())
        return "\n".join([*lines, f"settings: |\n{settings}\n"])


def read_baseline(path: Path) -> Baseline:
    """Read a baseline.

    Raises:
        ScenarioError: it is no baseline.
    """
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        settings, metrics = str(data["settings"]), dict(data["metrics"])
        _flat(yaml.safe_load(settings) or {})
        if wrong := [name for name, value in metrics.items() if (m := known(name)) is not None and not m.fits(value)]:
            raise ValueError(wrong)
        return Baseline(str(data["scenario"]), settings, metrics, Trace.from_rows(data["trace"]))
    except OSError as error:
        raise ScenarioError([f"{path}: cannot be read, {error.strerror}; give a baseline"]) from None
    except (yaml.YAMLError, UnicodeError, LookupError, TypeError, ValueError, AttributeError):
        raise ScenarioError([f"{path}: is no baseline; write it anew with `surefoot check --update`"]) from None


def write_baseline(path: Path, baseline: Baseline) -> None:
    """Write a baseline.

    Raises:
        LogError: it cannot be written.
    """
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
    with write_whole(path, replace=True) as temporary:
        temporary.write_text(baseline.text(), encoding="utf-8")


def _elements(name: str, before: Any, now: Any) -> Iterator[tuple[str, Value, Value]]:
    """Each number of a metric, named, of the baseline and of the run."""
    if isinstance(before, list):
        numbers = now if isinstance(now, list) else [None] * len(before)
        yield from ((f"{name}[{i}]", old, new) for i, (old, new) in enumerate(zip(before, numbers, strict=False)))
    elif isinstance(before, dict):
        parts = now if isinstance(now, dict) else {}
        yield from ((f"{name}.{part}", old, parts.get(part)) for part, old in before.items())
    else:
        yield name, before, now


def _flat(settings: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Settings by dotted key."""
    flat: dict[str, Any] = {}
    for key, value in settings.items():
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def _near(before: Value, now: Value, allowed: float) -> bool:
    if before is None or now is None or isinstance(before, bool) or isinstance(now, bool):
        return before is now
    return abs(now - before) <= allowed


def _direction(bound: Bound | None, before: Value, now: Value) -> Direction:
    """By the criterion: a bound above asks for less, one below for more; a value that is gone is worse."""
    if now is None:
        return "worse"
    if before is None or bound is None or (bound.min is not None) == (bound.max is not None):
        return "other"
    more = float(now) > float(before)
    return "better" if more == (bound.min is not None) else "worse"


def _rounded(value: Any) -> Any:
    """Six digits, far finer than any tolerance."""
    if isinstance(value, list):
        return [_rounded(one) for one in value]
    if isinstance(value, dict):
        return {name: _rounded(one) for name, one in value.items()}
    return float(f"{value:.6g}") if isinstance(value, float) else value
