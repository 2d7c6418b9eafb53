"""A baseline: what a scenario's run measured when it was as it should be, in a file that people read and review."""

import contextlib
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import yaml

from surefoot.scenarios.check.sample import MetricValue, SeedSample, read_sample
from surefoot.scenarios.check.signs import COLUMNS, FAR, SIGNS, Trace
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.source import decoded, parse, plain_scalar
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metrics import OWN, known
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.sim.options import Option, world_options

ENDING = ".baseline.yaml"

MOST_BYTES, MOST_VALUES = 2_000_000, 200_000
"""Ending of a baseline; each step has a row of the trace."""

SAME_OPTION = 1e-5
"""Share by which an option of the world may differ, which is written with six digits [-]."""

_MOST_GAPS = 5

_LABELS = ["stage", "foot"]
"""First columns of the table."""

Trend = Literal["better", "worse", "other"]


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
    before: MetricValue
    now: MetricValue
    allowed: float
    unit: str
    direction: Trend

    @property
    def far(self) -> bool:
        """True if it is better by so much that it counts as moved."""
        if self.before is None or self.now is None or self.direction != "better":
            return False
        return abs(self.now - self.before) > FAR * self.allowed

    @property
    def welcome(self) -> bool:
        """True if the run is better, and not by far."""
        return self.direction == "better" and not self.far


@dataclass(frozen=True, slots=True)
class Baseline:
    """Metrics and trace of a run that was as it should be.

    Attributes:
        scenario: its name.
        settings: what shapes the run and is not a default, so that a baseline of another scenario is not compared.
        world: options of the simulated world, by name; empty on a pendulum.
        metrics: those that two runs have in common, by name.
        trace: its signs, stage by stage.
        sample: what runs of several seeds measured, that one among them; None where it was the only one.
    """

    scenario: str
    settings: str
    world: Mapping[str, Option]
    metrics: Mapping[str, Any]
    trace: Trace
    sample: SeedSample | None = None

    @classmethod
    def of(
        cls, scenario: str, settings: str, metrics: Mapping[str, Any], log: Log, criteria: Iterable[str]
    ) -> "Baseline":
        """Make the baseline of a run; of metrics of other packages it keeps only those that a criterion names.

        Args:
            scenario: its name.
            settings: of it, in YAML.
            metrics: of the run, by name.
            log: of the run.
            criteria: names of the metrics that the scenario bounds.

        Raises:
            LogError: the world that the log carries is damaged.
        """
        return cls(scenario, settings, _world(log), comparable(metrics, criteria), Trace.of(log))

    def gaps(self, now: "Baseline", criteria: Mapping[str, Bound]) -> list[str]:
        """Parts of a run that this says nothing about, so that they could be anything; a sentence, or none."""
        counted = _counted(criteria)
        missing = [name for name in now.metrics if name not in self.metrics and name in counted]
        missing += [f"the trace's {column}" for column in now.trace.values if column not in self.trace.values]
        missing += [f"the world's {option}" for option in now.world if option not in self.world]
        missing += [f"the sample's {name}" for name in _unsampled(self.sample, now.sample)]
        more = [f"{len(missing) - _MOST_GAPS} more"] if len(missing) > _MOST_GAPS else []
        gaps = [f"the baseline says nothing of {', '.join((*missing[:_MOST_GAPS], *more))}"] if missing else []
        unknown = [name for name in self.metrics if name in counted and known(name) is None]
        right = "install the package that has this metric"
        return [*gaps, *(f"{name} of the baseline is not known here; {right}" for name in unknown)]

    def filled(self, now: "Baseline") -> "Baseline":
        """The baseline with what it lacks beside a run of its scenario; what it says of that run stays as it is.

        What the run has not got goes, such as a metric of a package that is not here.
        """
        world = {name: self.world.get(name, value) for name, value in now.world.items()}
        metrics = {name: self.metrics.get(name, value) for name, value in now.metrics.items()}
        trace = replace(now.trace, values={**now.trace.values, **self.trace.values})
        held = None if self.sample is None or now.sample is None else self.sample.filled(now.sample)
        return replace(now, world=world, metrics=metrics, trace=trace, sample=held or now.sample)

    def other_world(self, now: "Baseline") -> list[str]:
        """Options of the world that are not as here, a sentence each."""
        other = {name: was for name, was in self.world.items() if not _alike(was, now.world.get(name))}
        shown = {name: _flow(now.world[name]) if name in now.world else "none" for name in other}
        return [f"the world's {name} is {shown[name]}, {_flow(was)} in the baseline" for name, was in other.items()]

    def moves(self, metrics: Mapping[str, Any], criteria: Mapping[str, Bound]) -> Iterator[Move]:
        """Metrics that moved by more than their tolerance; those that only one side has, or nobody counts, do not."""
        counted = _counted(criteria)
        for name, before in self.metrics.items():
            metric = known(name) if name in counted else None
            if metric is None:
                continue
            for label, old, new in _elements(name, before, metrics.get(name)):
                allowed = 0.0 if isinstance(old, bool) else metric.allowed(old)
                if not _near(old, new, allowed):
                    yield Move(label, old, new, allowed, metric.unit, _direction(criteria.get(name), old, new))

    def others(self, scenario: str, settings: str) -> list[str]:
        """Differences of a scenario, its settings in YAML, from the one of this baseline, a sentence each."""
        named = [f"the baseline is of '{self.scenario}'"] if scenario != self.scenario else []
        before, now = (_flat(parse(text, "settings").value or {}) for text in (self.settings, settings))
        return named + [
            f"{key} is {now.get(key, 'the default')}, {before.get(key, 'the default')} in the baseline"
            for key in {**before, **now}
            if (key in before, before.get(key)) != (key in now, now.get(key))
        ]

    def text(self) -> str:
        """The file: the world's options, metrics with their units, then the trace."""
        lines = [
            "# What the run measured when it was as it should be; `surefoot check` compares, --update writes.",
            f"scenario: {self.scenario if plain_scalar(self.scenario) == self.scenario else json.dumps(self.scenario)}",
            "world:  # as simulated; SI units" if self.world else "world: {}",
            *(f"  {name}: {_flow(value)}" for name, value in self.world.items()),
            "metrics:",
        ]
        for name, value in self.metrics.items():
            metric = known(name)
            unit = f"  # {metric.unit}" if metric is not None and metric.unit else ""
            lines.append(f"  {name}: {_flow(value)}{unit}")
        lines += ["trace:  # lift-off to lift-off; SI units", *(f"  - {row}" for row in _table(self.trace))]
        if self.sample is not None:
            lines += ["sample:  # of each seed, in their order; SI units", *self.sample.text()]
        settings = "\n".join(f"  {line}" for line in self.settings.splitlines())
        return "\n".join([*lines, f"settings: |\n{settings}\n"])


def comparable(metrics: Mapping[str, Any], criteria: Iterable[str]) -> dict[str, Any]:
    """Metrics that two runs have in common: ours, and of those of other packages what a criterion names."""
    counted = _counted(criteria)
    here = {name: found for name in metrics if name in counted and (found := known(name)) is not None}
    return {name: metrics[name] for name, metric in here.items() if metric.repeatable}


def _unsampled(before: SeedSample | None, now: SeedSample | None) -> list[str]:
    """Names that a sample lacks beside another, of metrics without their elements and parts."""
    if before is None or now is None:
        return []
    had = {name.partition("[")[0] for name in before.values}
    return [one for one in dict.fromkeys(name.partition("[")[0] for name in now.values) if one not in had]


def _counted(criteria: Iterable[str]) -> set[str]:
    """Names of metrics that are compared: ours, and of those of other packages what a criterion names.

    Which packages are installed beside Surefoot says nothing of a walk.
    """
    return {*OWN, *(name.partition(".")[0] for name in criteria)}


def read_baseline(path: Path) -> Baseline:
    """Read a baseline, whoever it is from.

    Raises:
        ScenarioError: it is none.
    """
    try:
        if path.exists() and not path.is_file():
            raise ValueError("it is no regular file")
        with path.open("rb") as file:
            source = parse(decoded(file, str(path), MOST_BYTES), str(path), MOST_VALUES)
        if source.problems:
            raise ScenarioError([source.describe(source.problems[0])])
        return _of_values(source.value, path)
    except OSError as error:
        raise ScenarioError([f"{path}: cannot be read, {error.strerror}; give a baseline"]) from None
    except ScenarioError as fault:
        raise _spoilt(str(fault).partition(";")[0]) from None
    except ValueError as fault:
        raise _spoilt(f"{path}: {fault}") from None


def _spoilt(what: str) -> ScenarioError:
    return ScenarioError([f"{what}, so it is no baseline; write it anew with `surefoot check --update`"])


def _of_values(data: Any, path: Path) -> Baseline:
    """A baseline of what its file holds; ScenarioError or ValueError where it is none."""
    groups = {"scenario": object, "settings": str, "metrics": dict, "trace": list}
    values = data if isinstance(data, dict) else {}
    if wrong := [name for name, kind in groups.items() if name not in values or not isinstance(values[name], kind)]:
        raise ValueError(f"it has no {wrong[0]}")
    scenario, settings, metrics = str(values["scenario"]), values["settings"], values["metrics"]
    world = values.get("world", {})
    keys = parse(settings, f"{path}/settings")
    if keys.problems or not isinstance(keys.value or {}, dict):
        raise ValueError("its settings are no group of keys")
    for name, value in metrics.items():
        if (metric := known(name)) is not None and not metric.fits(value):
            raise ValueError(f"its {name} is not what the metric gives")
    if not isinstance(world, dict) or not _are_finite([world, metrics]):
        raise ValueError("its metrics or its world hold what is no finite number")
    sample = read_sample(values["sample"]) if "sample" in values else None
    return Baseline(scenario, settings, world, metrics, read_trace(values["trace"]), sample)


def write_baseline(path: Path, baseline: Baseline) -> None:
    """Write a baseline.

    Raises:
        LogError: it cannot be written.
    """
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
    if path.exists() and not path.is_file():
        raise LogError(f"{path}: cannot be written, is no regular file; remove it, or give another --baselines")
    with write_whole(path, replace=True) as temporary:
        temporary.write_text(baseline.text(), encoding="utf-8")


def _world(log: Log) -> Mapping[str, Option]:
    """Options of the world that a log carries, none of a pendulum's; LogError where it is damaged."""
    try:
        return world_options(log.attachments[WORLD_FILE].decode()) if WORLD_FILE in log.attachments else {}
    except ValueError as error:
        raise LogError(f"{log.path}: {WORLD_FILE} is damaged, {str(error).splitlines()[0]}; run it anew") from None


def _table(trace: Trace) -> list[str]:
    """A trace as a table in YAML, a row for each stage."""
    digits = {column: sign.digits for sign in SIGNS for column in sign.columns}
    rows = [[*_LABELS, *trace.values]]
    for stage, (label, foot) in enumerate(zip(trace.labels, trace.feet, strict=True)):
        numbers = ((column, values[stage]) for column, values in trace.values.items())
        written = (f"{x:.{digits[column]}f}" if math.isfinite(x) else "~" for column, x in numbers)
        rows.append([label, foot, *written])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [f"[{', '.join(map(str.rjust, row, widths))}]" for row in rows]


def read_trace(rows: Any) -> Trace:
    """Read such a table of a trace back.

    Raises:
        ValueError: it is none; says why.
    """
    if not isinstance(rows, list) or not rows or not all(isinstance(row, list) for row in rows):
        raise ValueError("its trace is no table")
    head, *below = rows
    named = all(isinstance(name, str) for name in head) and len(set(head)) == len(head)
    if not named or head[:2] != _LABELS or not set(head[2:]) <= set(COLUMNS):
        raise ValueError(f"its trace has columns other than {', '.join((*_LABELS, *COLUMNS))}")
    if any(len(row) != len(head) for row in below):
        raise ValueError("its trace has rows of other lengths than the first")
    if any(not (x is None or (is_number(x) and math.isfinite(x))) for row in below for x in row[2:]):
        raise ValueError("its trace holds what is no finite number")
    columns = {
        name: np.array([math.nan if row[i] is None else float(row[i]) for row in below])
        for i, name in enumerate(head[2:], 2)
    }
    return Trace(tuple(str(row[0]) for row in below), tuple(str(row[1]) for row in below), columns)


def _elements(name: str, before: Any, now: Any) -> Iterator[tuple[str, MetricValue, MetricValue]]:
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


def _are_finite(value: Any) -> bool:
    """Return true if every number in a value is finite."""
    if isinstance(value, dict | list):
        return all(map(_are_finite, value.values() if isinstance(value, dict) else value))
    return not isinstance(value, float) or math.isfinite(value)


def _alike(before: Any, now: Any) -> bool:
    """Return true if an option is the same, but for the digits that are not written."""
    if isinstance(before, list) and isinstance(now, list):
        return len(before) == len(now) and all(map(_alike, before, now))
    if isinstance(before, int | float) and isinstance(now, int | float):
        return math.isclose(before, now, rel_tol=SAME_OPTION, abs_tol=1e-12)
    return bool(before == now)


def _near(before: MetricValue, now: MetricValue, allowed: float) -> bool:
    if before is None or now is None or isinstance(before, bool) or isinstance(now, bool):
        return before is now
    return abs(now - before) <= allowed


def _direction(bound: Bound | None, before: MetricValue, now: MetricValue) -> Trend:
    """Direction of a change: a bound above asks for less, one below for more; a value that is gone is worse."""
    if now is None:
        return "worse"
    if before is None or bound is None or (bound.min is not None) == (bound.max is not None):
        return "other"
    more = float(now) > float(before)
    return "better" if more == (bound.min is not None) else "worse"


def _flow(value: Any) -> str:
    """A value on one line of YAML, parts in their order."""
    text = yaml.safe_dump(_rounded(value), default_flow_style=True, width=math.inf, sort_keys=False)
    return str(text).splitlines()[0]


def _rounded(value: Any) -> Any:
    """Six digits, far finer than any tolerance."""
    if isinstance(value, list):
        return [_rounded(one) for one in value]
    if isinstance(value, dict):
        return {name: _rounded(one) for name, one in value.items()}
    return float(f"{value:.6g}") if isinstance(value, float) else value
