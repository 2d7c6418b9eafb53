"""The metrics there are, ours and those of other packages, and their values for a log."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.errors import PartError
from surefoot.parts.guard import Guard, MisfitError, shown
from surefoot.parts.plugins import PluginError
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError, Problem, nearest
from surefoot.scenarios.judge import (
    acted,
    balance,
    computing,
    effort,
    feet,
    following,
    health,
    linked,
    people,
    pushed,
    sensed,
    strides,
    walking,
)
from surefoot.scenarios.judge.digest import CONTROL_TOPICS, GAIT, HELD, SENSED, Digest, RunView, Source
from surefoot.scenarios.judge.metric import Metric, Reduction
from surefoot.scenarios.judge.names import METRICS
from surefoot.scenarios.judge.placed import PLACED

if TYPE_CHECKING:
    from surefoot.scenarios.log import Log


def gathered(*modules: ModuleType) -> dict[str, Metric[Any]]:
    """The metrics of modules by name, in the order in which they are written there.

    Raises:
        PluginError: two have the same name.
    """
    found: dict[str, Metric[Any]] = {}
    for module in modules:
        for thing in vars(module).values():
            if isinstance(thing, Metric) and found.setdefault(thing.name, thing) is not thing:
                raise PluginError(f"metric '{thing.name}' is there twice", "choose another name")
    return found


OWN: Mapping[str, Metric[Any]] = gathered(
    walking, following, balance, feet, strides, people, effort, computing, sensed, linked
)
"""Ours, in the order in which they are shown."""


def register(made: Metric[Any]) -> Metric[Any]:
    """Have a metric computed, shown and bounded in this process, as if a package had brought it.

    Raises:
        PluginError: its name is one of ours.
    """
    METRICS.add(made.name, made)
    return made


def known(name: str) -> Metric[Any] | None:
    """The metric of a name, or of the name before a dot; None where there is none that can be used."""
    try:
        return _usable(name.partition(".")[0])
    except (KeyError, PluginError):
        return None


def unknown_metrics(criteria: Any) -> list[Problem]:
    """Criteria on names that are no metrics, or metrics of packages that cannot be used."""
    return [problem for name in criteria for problem in _unknown(name)] if isinstance(criteria, dict) else []


def _unknown(name: Any) -> Iterator[Problem]:
    try:
        if name not in _usable(str(name).partition(".")[0]).bounded:
            raise KeyError(name)
    except KeyError:
        yield Problem(("criteria", name), f"unknown metric '{name}'", partial(_meant, str(name)), True)
    except PluginError as error:
        yield Problem(("criteria", name), f"metric {error.what}", error.right, True)


def _meant(name: str) -> str:
    names = [bounded for metric in map(known, METRICS) if metric is not None for bounded in metric.bounded]
    return f"{nearest(name, names)}{METRICS.hint}"


def _usable(name: str) -> Metric[Any]:
    """The metric of a name; KeyError for none, PluginError where its package is broken or names it otherwise."""
    found = METRICS[name]
    if found.name != name:
        raise PluginError(f"'{name}' in {METRICS.group} is named '{found.name}' where it is made", "give both one name")
    return found


@dataclass(frozen=True, slots=True)
class Measured:
    """The metrics of a log.

    Attributes:
        values: by name, None where a metric does not apply or its channels or fields are missing; plain JSON values.
        notes: what another package's metric has not given and why, one sentence each.
    """

    values: dict[str, Any]
    notes: tuple[str, ...]


def compute(log: "Log | Digest") -> dict[str, Any]:
    """The values of `measure`, which has the arguments and errors."""
    return measure(log).values


def measure(log: "Log | Digest") -> Measured:
    """Compute every metric of a log, whole or truncated; one of another package that fails is None and a note.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(log if isinstance(log, Digest) else digest(log))
    notes = [f"metric {clash}" for clash in METRICS.clashes().values()]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        values = {name: _own_value(run, metric, notes) for name, metric in OWN.items()}
        for name in METRICS:
            if name not in OWN:
                values[name] = _foreign_value(run, name, notes)
    return Measured(values, tuple(notes))


def _own_value(run: RunView, metric: Metric[Any], notes: list[str]) -> Any:
    """The value of a metric of ours; None where the log lacks a field of it, or has it otherwise than runs do."""
    try:
        return _value(run, metric)
    except LogError:  # the log of another version
        return None
    except Exception as error:
        notes.append(f"metric {metric.name} means nothing for this log, {type(error).__name__}: {error}")
        return None


def _foreign_value(run: RunView, name: str, notes: list[str]) -> Any:
    """The value of another package's metric, whatever it does."""
    try:
        metric = _usable(name)
    except PluginError as error:
        notes.append(f"metric {error}")
        return None
    try:
        with METRICS.guard(name):
            value = _value(run, metric)
            if not metric.fits(value):
                raise MisfitError(f"gave {shown(value)}, which is not what it says it gives")
            return value
    except PartError as fault:
        notes.append(fault.what)
        return None


def _value(run: RunView, metric: Metric[Any]) -> Any:
    if not metric.applies(run.constants.walker) or not run.has(*metric.needs):
        return None
    if run.kept is not None and not metric.at_end:
        return None  # of a part of the run it would be another number
    return plain(metric(run))


def plain(value: Any, lost: Callable[[float], str | None] = lambda _: None) -> Any:
    """The value for JSON: numbers of classes of their own as plain ones, and what is ``lost``: those not finite."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [plain(element, lost) for element in value]
    if isinstance(value, dict):
        return {key: plain(element, lost) for key, element in value.items()}
    if isinstance(value, float):
        return float.__pos__(value) if math.isfinite(value) else lost(value)
    return int.__pos__(value) if isinstance(value, int) and not isinstance(value, bool) else value


def judged_topics() -> frozenset[str]:
    """Topics that a verdict or a health check needs, by metrics of ours and of other packages."""
    metrics = [metric for metric in map(known, METRICS) if metric is not None]
    fields = (HELD, *_reads(metrics))
    topics = (*CONTROL_TOPICS, GAIT, SENSED, *health.TOPICS, *(topic for metric in metrics for topic in metric.needs))
    reduced = (topic for metric in metrics for one in metric.reductions for topic in one.needs)
    return frozenset((*topics, *reduced, *(topic for reads in fields for topic in reads)))


def _reads(metrics: Iterable[Metric[Any]]) -> list[Reads]:
    """Fields that metrics, health checks and what is said of pushes and commands read."""
    return [health.READS, PLACED, pushed.READS, acted.READS, *(metric.reads for metric in metrics)]


_REDUCING = Guard("a reduction")


def digest(log: "Log") -> Digest:
    """Gather what the metrics and the health checks need, in one pass with bounded memory.

    Raises:
        LogError: the log does not describe a run.
    """
    constants = RunView(log).constants
    _check_joints(log, len(constants.joint_names))
    metrics = [metric for metric in map(known, METRICS) if metric is not None]
    wanted = dict.fromkeys((*health.REDUCTIONS, *(one for metric in metrics for one in metric.reductions)))
    failed: set[Reduction] = set()

    def reduce(part: Source) -> dict[Any, Any]:
        run, found = RunView(part, constants), {}
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            for reduction in wanted:
                if reduction not in failed and run.has(*reduction.needs):
                    try:
                        with _REDUCING:
                            found[reduction] = np.asarray(reduction(run))
                    except PartError:
                        failed.add(reduction)  # its metric will say so, computing it anew
        return found

    gathered = Digest(log, constants, _reads(metrics), reduce)
    for reduction in failed:
        gathered.reduced.forget(reduction)
    return gathered


def _check_joints(log: "Log", joints: int) -> None:
    """Refuse, by a LogError, a log whose joints are not as many as its run has."""
    for topic, name in (("/torque", "command"), ("/measurement", "joint_position")):
        shapes = [field.shape for field in log.fields(topic) if field.name == name] if topic in log.numeric else []
        if shapes and shapes != [(joints,)]:
            what = f"{log.path}: {topic} {name} has not the {joints} joints of its run"
            raise LogError(f"{what}; give a log that `surefoot run` has written")
