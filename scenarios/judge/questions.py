"""Questions to a log: the stretches of time in which its quantities lie within bounds.

    zmp_edge < 0.01 and /truth:torso_tilt > 0.2

A quantity is a column of a topic, as `surefoot inspect LOG --topic TOPIC --export` names it, or one of `DERIVED`.
Where several topics have a column of one name, its topic goes before it. A stretch begins with the message at which
the condition comes to hold and ends with that at which it no longer does; NaN fulfils nothing.
"""

import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.judge.balance import zmp_edge
from surefoot.scenarios.judge.digest import Array, RunView, Window, in_step
from surefoot.scenarios.judge.metric import Reduction
from surefoot.scenarios.log import Log
from surefoot.scenarios.log.spec import Column, FieldSpec
from surefoot.scenarios.record.provenance import RunConstants


@dataclass(frozen=True, slots=True)
class Derived:
    """A quantity that follows from several topics at each control tick.

    Attributes:
        reduction: makes it.
        unit: of it.
    """

    reduction: Reduction
    unit: str


DERIVED = {"zmp_edge": Derived(zmp_edge, "m")}
"""Quantities by name that no topic has."""

_COMPARED: dict[str, Callable[[Array, float], Array]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
_CONDITION = re.compile(r"\s*(?:(?P<topic>/[^\s:]+):)?(?P<name>[\w.]+)\s*(?P<sign><=|>=|==|!=|<|>)\s*(?P<bound>\S+)\s*")
_EXAMPLE = "write it as 'zmp_edge < 0.01 and /truth:torso_tilt > 0.2'"


class Condition(NamedTuple):
    """A bound on a quantity: its topic, empty where one only is meant, its name, how it is compared, and with what."""

    topic: str
    name: str
    sign: str
    bound: float

    @property
    def text(self) -> str:
        """As it is written."""
        return f"{self.topic and f'{self.topic}:'}{self.name} {self.sign} {self.bound:g}"


class Stretch(NamedTuple):
    """A stretch of time in which a question holds.

    Attributes:
        start: of the first message at which it holds [s].
        end: of the first one after it at which it does not, or of the last one of the log [s].
        worst: value of the first condition's quantity farthest beyond its bound; None where several are asked for.
        at: time of that value [s].
    """

    start: float
    end: float
    worst: float | None = None
    at: float | None = None


def conditions(text: str) -> tuple[Condition, ...]:
    """The conditions of a question, joined by `and`.

    Raises:
        LogError: it is none.
    """
    return tuple(map(_condition, re.split(r"\band\b", text)))


def _condition(text: str) -> Condition:
    found = _CONDITION.fullmatch(text)
    try:
        bound = float(found["bound"]) if found else math.nan
    except ValueError:
        bound = math.nan
    if found is None or math.isnan(bound):
        raise LogError(f"--where {text.strip()[:100]!r} is no condition; {_EXAMPLE}")
    return Condition(found["topic"] or "", found["name"], found["sign"], bound)


def stretches(
    log: Log, question: str, start: float | None = None, end: float | None = None, topics: Sequence[str] = ()
) -> tuple[list[Stretch], tuple[str, ...]]:
    """Find where a question holds, in memory that does not grow with the log.

    Args:
        log: that is asked.
        question: conditions that are joined by `and`.
        start: of the time that is asked for, that of the log if None [s].
        end: of the time that is asked for, that of the log if None [s].
        topics: whose columns are meant where none is written; () for all.

    Returns:
        stretches in order of time, and the unit of each condition's quantity.

    Raises:
        LogError: the question is none, or the log has not got a quantity.
    """
    common, units, until = [Stretch(-math.inf, math.inf)], [], math.inf
    asked = conditions(question)
    for condition in asked:
        values, unit = _quantity(log, condition, start, end, topics)
        found, last = holding(values, condition)
        common = found if len(asked) == 1 else list(both(common, found))
        units.append(unit)
        until = min(until, last)
    closed = (one._replace(end=min(one.end, until)) for one in common if one.start <= until)
    return list(closed), tuple(units)


_Parts = Iterable[tuple[Array, Array]]
"""Times [s] and values of the parts of a log, shape (n,) each."""


def _quantity(
    log: Log, condition: Condition, start: float | None, end: float | None, topics: Sequence[str]
) -> tuple[_Parts, str]:
    """A quantity's values part by part, and its unit."""
    derived = None if condition.topic else DERIVED.get(condition.name)
    if derived is not None:
        return _derived(log, derived.reduction, condition.name, start, end), derived.unit
    topic, field, column = _column(log, condition, topics)
    return _read(log, topic, field, column, start, end), column.unit


def _derived(
    log: Log, reduce: Reduction, name: str, start: float | None, end: float | None
) -> Iterator[tuple[Array, Array]]:
    missing = [topic for topic in reduce.needs if topic not in log.numeric or not log.count(topic)]
    if missing:
        raise LogError(f"{log.path}: {name} needs topic {missing[0]}, which is not there; ask for a column of a topic")
    constants = RunConstants.from_metadata(log.metadata, str(log.path))
    for channels in in_step(log.windows(reduce.needs, start=start, end=end)):
        run = RunView(Window(log, channels), constants)
        if run.ticks:
            yield run.time, reduce(run)


def _read(
    log: Log, topic: str, field: FieldSpec, column: Column, start: float | None, end: float | None
) -> Iterator[tuple[Array, Array]]:
    for part in log.parts(topic, start, end):
        yield part.time, np.moveaxis(part.field(field.name), 0, -1)[column.place]


def _column(log: Log, condition: Condition, topics: Sequence[str]) -> tuple[str, FieldSpec, Column]:
    """The column that a condition is of."""
    among = (condition.topic,) if condition.topic else topics or log.numeric
    found, names = [], set() if condition.topic or topics else set(DERIVED)
    for topic in among:
        for field in log.fields(topic):
            columns = list(field.columns(log.joints))
            names |= {column.name for column in columns}
            found += [(topic, field, column) for column in columns if column.name == condition.name]
    if not found:
        raise LogError(f"{log.path}: has no quantity {condition.name}; {_meant(condition.name, names)}")
    if len(found) > 1:
        several = " or ".join(f"{topic}:{condition.name}" for topic, *_ in found)
        raise LogError(f"{log.path}: {condition.name} is of {len(found)} topics; write {several}")
    return found[0]


_MOST_NAMED = 40


def _meant(name: str, names: set[str]) -> str:
    """The probable meaning of a name: the parts of a field, or the nearest name."""
    parts = sorted(one for one in names if one.startswith((f"{name}_", f"{name}.")))
    if parts:
        return f"its elements are {', '.join(parts[:_MOST_NAMED])}"
    said = nearest(name, names)
    return said if len(names) <= _MOST_NAMED or said.startswith("did") else "--topic lists the fields of one"


def holding(parts: _Parts, condition: Condition) -> tuple[list[Stretch], float]:
    """Stretches in which one condition holds, without end if it holds at the last message, and the time of that [s].

    The parts have times [s] and values, shape (n,) each, in order of time.
    """
    compared = _COMPARED[condition.sign]
    worst_of = np.argmin if condition.sign in ("<", "<=") else np.argmax
    found: list[Stretch] = []
    last = -math.inf
    for time, values in parts:
        if not len(time):
            continue
        numbers = np.asarray(values, float)
        holds = compared(numbers, condition.bound) & np.isfinite(numbers)
        turns = np.flatnonzero(np.diff(holds)) + 1
        for rows in np.split(np.arange(len(time)), turns):
            goes_on = bool(found) and found[-1].end == math.inf
            if holds[rows[0]]:
                row = rows[int(worst_of(numbers[rows]))]
                here = Stretch(float(time[rows[0]]), math.inf, float(numbers[row]), float(time[row]))
                if goes_on:
                    here = _joined(found.pop(), here, worst_of)
                found.append(here)
            elif goes_on:
                found[-1] = found[-1]._replace(end=float(time[rows[0]]))
        last = float(time[-1])
    return found, last


def _joined(one: Stretch, other: Stretch, worst_of: Callable[[Any], Any]) -> Stretch:
    """A stretch and its next part, with the worst value of both, the first of equal ones."""
    worse = (one, other)[int(worst_of([one.worst, other.worst]))]
    return other._replace(start=one.start, worst=worse.worst, at=worse.at)


def both(some: Sequence[Stretch], others: Sequence[Stretch]) -> Iterator[Stretch]:
    """The common parts of two lists of stretches in order of time."""
    one = other = 0
    while one < len(some) and other < len(others):
        start, end = max(some[one].start, others[other].start), min(some[one].end, others[other].end)
        if start < end:
            yield Stretch(start, end)
        if some[one].end < others[other].end:
            one += 1
        else:
            other += 1
