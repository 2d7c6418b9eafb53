"""A baseline: what a scenario's run measured when it was as it should be, in a file that people read and review."""

import contextlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import yaml

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metric import Metric
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import write_whole

ENDING = ".baseline.yaml"

TRACE_PERIOD = 0.5
"""Time between two samples of a baseline's trace [s]."""

TRACED: Mapping[str, tuple[str, str, float]] = {
    "CoM": ("/truth", "com", 2e-3),
    "ZMP": ("/contact", "zmp", 5e-3),
    "left sole": ("/truth", "left_sole", 2e-3),
    "right sole": ("/truth", "right_sole", 2e-3),
}
"""What is kept of a run over time: topic and field, of which x, y and z; and how far a run may part from it [m]."""

RELATIVE = 0.05
"""Share of a metric's value by which it may differ from its baseline."""

ABSOLUTE = {"m": 2e-4, "rad": 2e-3, "s": 0.011, "m/s": 2e-3, "": 2e-3}
"""How much it may differ whatever its value, by its unit: less than what anyone would call a change of the walk."""

Value = bool | int | float | None
Direction = Literal["better", "worse", "other"]


def tolerance(metric: Metric[Any], value: Value) -> float:
    """How far a metric may be from this value of its baseline, in its unit; counts may not differ at all."""
    if not isinstance(value, float):
        return 0.0
    return ABSOLUTE.get(metric.unit, 0.0) + RELATIVE * abs(value)


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
class Parting:
    """Where a run first is not where its baseline was.

    Attributes:
        time: of the sample [s].
        what: in words, such as "ZMP y".
        before: of the baseline [m].
        now: of the run [m]; NaN where it has ended.
    """

    time: float
    what: str
    before: float
    now: float

    def __str__(self) -> str:
        """In a sentence without a full stop."""
        now = "the run has ended" if math.isnan(self.now) else f"{self.now:.4f} m"
        return f"{self.what} at {self.time:g} s: {now}, {self.before:.4f} m in the baseline"


@dataclass(frozen=True, slots=True)
class Baseline:
    """Metrics and trace of a run that was as it should be.

    Attributes:
        scenario: its name.
        settings: what shapes the run and is not a default, so that a baseline of another scenario is not compared.
        metrics: those that two runs have in common, by name.
        trace: of each thing that is traced, samples every `TRACE_PERIOD`, shape (n, 3) [m].
    """

    scenario: str
    settings: str
    metrics: Mapping[str, Any]
    trace: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, scenario: str, settings: str, metrics: Mapping[str, Any], log: Log) -> "Baseline":
        """What is kept of a run."""
        kept = {name: value for name, value in metrics.items() if (m := known(name)) is not None and m.repeatable}
        return cls(scenario, settings, kept, traced(log))

    def moves(self, metrics: Mapping[str, Any], criteria: Mapping[str, Bound]) -> Iterator[Move]:
        """Metrics that moved by more than their tolerance; those that the baseline has not got are no moves."""
        for name, before in self.metrics.items():
            metric = known(name)
            if metric is None:
                yield Move(name, None, None, 0.0, "", "other")
                continue
            for label, old, new in _elements(name, before, metrics.get(name)):
                allowed = tolerance(metric, old)
                if not _near(old, new, allowed):
                    yield Move(label, old, new, allowed, metric.unit, _direction(criteria.get(name), old, new))

    def parting(self, log: Log) -> Parting | None:
        """Where the run of a log first parts from this one; None where it does not."""
        found, now = [], traced(log)
        for name, samples in self.trace.items():
            other = np.full_like(samples, np.nan)
            if name in now:
                common = min(len(samples), len(now[name]))
                other[:common] = now[name][:common]
            apart = ~(np.abs(other - samples) <= TRACED[name][2]) & np.isfinite(samples)
            if apart.any():
                row, axis = (int(index[0]) for index in np.nonzero(apart))
                values = float(samples[row, axis]), float(other[row, axis])
                found.append(Parting(row * TRACE_PERIOD, f"{name} {'xyz'[axis]}", *values))
        return min(found, key=lambda parting: parting.time, default=None)

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
        lines.append(f"trace:  # every {TRACE_PERIOD:g} s, x y z [m]")
        for name, samples in self.trace.items():
            lines.append(f"  {name}:")
            lines += [f"    - [{', '.join('.nan' if math.isnan(x) else f'{x:.4f}' for x in row)}]" for row in samples]
        settings = "\n".join(f"  {line}" for line in self.settings.splitlines())
        return "\n".join([*lines, f"settings: |\n{settings}\n"])


def traced(log: Log) -> dict[str, np.ndarray]:
    """Samples of a run every `TRACE_PERIOD`, shape (n, 3) [m], as far as its log has them."""
    found = {}
    for name, (topic, field, _) in TRACED.items():
        if topic in log:
            channel = log[topic]
            if len(channel.time):
                times = np.arange(0.0, channel.time[-1] + 1e-9, TRACE_PERIOD)
                rows = np.minimum(np.searchsorted(channel.time, times - 1e-9), len(channel.time) - 1)
                found[name] = np.asarray(channel.field(field)[rows, :3], dtype=float)
    return found


def read_baseline(path: Path) -> Baseline:
    """Read a baseline.

    Raises:
        ScenarioError: it is no baseline.
    """
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        trace = {str(name): np.array(rows, dtype=float).reshape(-1, 3) for name, rows in data["trace"].items()}
        return Baseline(str(data["scenario"]), str(data["settings"]), dict(data["metrics"]), trace)
    except OSError as error:
        raise ScenarioError([f"{path}: cannot be read, {error.strerror}; give a baseline"]) from None
    except (yaml.YAMLError, UnicodeError, KeyError, TypeError, ValueError, AttributeError):
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
