"""A metric: a pure function of a run, with all that is known about it in one decorator.

`surefoot.scenarios.judge.metrics` collects them, with those of other packages.
"""

import keyword
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from operator import attrgetter
from pickle import PicklingError
from types import NoneType, UnionType
from typing import Any, Generic, TypeVar, Union, get_args, get_origin, get_type_hints

from surefoot.errors import ParameterError
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.documented import doc_of
from surefoot.scenarios.judge.digest import PLANNED, Array, RunView

__all__ = ["RESERVED", "TRUTH", "Metric", "Reads", "Reduction", "RunView", "metric", "reduction"]

T = TypeVar("T")
TRUTH = bool.__name__
"""Kind of a metric that is true or false."""
RESERVED = (
    *("verdict", "reasons", "notes", "log", "scenario", "truncated", "start", "end"),
    *("health", "topics", "versions"),
)
"""Names that stand beside the metrics in what `inspect --json` prints."""

MM, DEG = (1e3, "mm"), (180.0 / math.pi, "deg")
OF_THE_TIME, OF_HALF_THE_FOOT = (1e2, "% of the time"), (1e2, "% of half the foot")
"""Units of lengths, angles and shares as they are shown: factor and name."""

SHARE = 0.05
"""Share of its value by which a metric may differ between runs that count as the same, unless it says otherwise [-]."""

LITTLE = {"m": 2e-4, "rad": 2e-3, "s": 0.011, "m/s": 2e-3, "": 2e-3}
"""Difference beside that, by its unit: less than what anyone would call a change of the walk."""


ByName = tuple[Callable[[str, str], Any], tuple[str, str]]
"""Function and arguments by which pickle makes a thing again that a module has under its function's name."""


def _named(module: str, name: str) -> Any:
    return attrgetter(name)(import_module(module))


def _by_name(thing: Any, function: Callable[..., Any]) -> ByName:
    place = function.__module__, function.__qualname__
    try:
        if _named(*place) is thing:
            return _named, place
    except (ImportError, AttributeError):
        pass
    what = f"{type(thing).__name__} {'.'.join(place)} is not what its module has under that name"
    raise PicklingError(f"{what}; make it at the top of a module, with the decorator")


@dataclass(frozen=True, slots=True, eq=False)
class Reduction:
    """A function that makes wide channels narrow while a log is read, so that they need not be held for a whole run.

    Attributes:
        function: from a part of a run to one value or row for each tick or message, shape (n, ...).
        needs: topics without which it cannot be computed.
    """

    function: Callable[[RunView], Array]
    needs: tuple[str, ...]

    def __call__(self, run: RunView) -> Array:
        """The values of a part of a run, shape (n, ...)."""
        return self.function(run)

    def __reduce__(self) -> ByName:
        """Go to another process by name."""
        return _by_name(self, self.function)


def _given(function: Callable[..., Any]) -> tuple[Any, ...]:
    """Types of what a function gives."""
    try:
        given = get_type_hints(function).get("return", NoneType)
    except Exception:  # annotations in quotes are expressions of their author
        return (NoneType,)
    return get_args(given) if isinstance(given, UnionType) or get_origin(given) is Union else (given,)


@dataclass(frozen=True, slots=True, eq=False)
class Metric(Generic[T]):
    """A number, or a few, that a run is described by.

    Attributes:
        name: in criteria and in the verdict.
        function: from a run to the value: a number, a truth value, a list of ``size`` numbers or a dict of ``parts``;
            None where it means nothing.
        unit: of the value, SI; empty for a plain number.
        scale: from the value to what a person is shown.
        shown: unit of that.
        size: number of elements; more than one makes a list.
        parts: names of the parts, where the value has such.
        needs: topics without which the value is None.
        reads: fields that are held for the whole run, by topic; others are read from the log when they are asked for.
        reductions: that the function uses by `RunView.reduced`.
        body: whether it is of joints, sensors and real feet, which a pendulum has not got.
        repeatable: whether two runs of the same scenario give the same value; times on the wall's clock do not.
        least: value that it never goes below by its nature, so that no bound there checks anything; None for none.
        most: value that it never exceeds by its nature, so that no bound there checks anything; None for none.
        tolerance: by how much two runs may differ that count as the same, in its unit and as a share of its value;
            None for what its unit and kind say.
        at_end: whether it follows from the end of the run alone, of which a flight recorder keeps more.
        planned: whether it is of a plan, or needs a topic of planner or whole-body controller.
    """

    name: str
    function: Callable[[RunView], T]
    unit: str
    scale: float
    shown: str
    size: int
    parts: tuple[str, ...]
    needs: tuple[str, ...]
    reads: Reads
    reductions: tuple[Reduction, ...]
    body: bool
    repeatable: bool
    least: float | None = None
    most: float | None = None
    tolerance: tuple[float, float] | None = None
    at_end: bool = False
    planned: bool = False

    def __call__(self, run: RunView) -> T:
        """Its value for a run."""
        return self.function(run)

    def __reduce__(self) -> ByName:
        """Go to another process by name."""
        return _by_name(self, self.function)

    @property
    def meaning(self) -> str:
        """Meaning in a sentence: the first line of its function's documentation."""
        return doc_of(self.function).strip().split("\n", 1)[0]

    @property
    def bounded(self) -> tuple[str, ...]:
        """Names by which a criterion may bound it: its own, or those of its parts."""
        return tuple(f"{self.name}.{part}" for part in self.parts) or (self.name,)

    @property
    def kind(self) -> str:
        """Name of the type of its value, as its function's annotation says; empty where that says nothing."""
        names = {getattr(kind, "__name__", "Any") for kind in self._kinds} - {NoneType.__name__}
        return names.pop() if len(names) == 1 and "Any" not in names else ""

    @property
    def optional(self) -> bool:
        """True if its value may be None, as its function's annotation says; without one it may."""
        return NoneType in self._kinds

    @property
    def _kinds(self) -> tuple[Any, ...]:
        """Kinds that its function returns; what cannot be known counts as None."""
        return _given(self.function)

    def applies(self, walker: str) -> bool:
        """Return true if runs of a kind of walker have it: full, pendulum, or seat, where nothing is planned."""
        if walker == "seat":
            return not self.planned
        return walker != "pendulum" or not self.body

    def allowed(self, value: float | None) -> float:
        """Distance from this value at which another run counts as the same; counts may not differ, unless it says."""
        if self.tolerance is None and not isinstance(value, float):
            return 0.0
        little, share = self.tolerance or (LITTLE.get(self.unit, 0.0), SHARE)
        return little + share * abs(value or 0.0)

    def fits(self, value: Any) -> bool:
        """Return true if a value is of the kind that was promised, so that no part of it escapes a criterion."""
        if value is None:
            return True
        if self.parts:
            return isinstance(value, dict) and tuple(value) == self.parts and all(map(_is_number, value.values()))
        if self.size > 1:
            return isinstance(value, list) and len(value) == self.size and all(map(_is_number, value))
        return _is_number(value)


def _is_number(value: Any) -> bool:
    """Return true for None, and for what can be compared, scaled and written; some integers exceed all floats."""
    whole = isinstance(value, int)
    return value is None or isinstance(value, float) or (whole and value.bit_length() <= sys.float_info.max_exp - 1)


def reduction(*needs: str) -> Callable[[Callable[[RunView], Array]], Reduction]:
    """Make a function of a run one that is applied while a log is read; ``needs`` are its topics.

    Raises:
        ParameterError: that is no topic.
    """
    _check_topics("a reduction", "needs", needs)
    return lambda function: Reduction(function, needs)


def metric(
    *,
    unit: str = "",
    shown: tuple[float, str] | None = None,
    size: int = 1,
    parts: tuple[str, ...] = (),
    needs: tuple[str, ...] | None = None,
    reads: Reads | None = None,
    reduces: tuple[Reduction, ...] = (),
    body: bool = False,
    repeatable: bool = True,
    least: float | None = None,
    most: float | None = None,
    tolerance: tuple[float, float] | None = None,
    at_end: bool = False,
    planned: bool = False,
) -> Callable[[Callable[[RunView], T]], Metric[T]]:
    """Make a function of a run a metric of its name; the first line of its documentation says what it is.

    Arguments are attributes of `Metric`; ``shown`` is its factor and unit, by default those of the value, ``needs`` are
    by default the topics of ``reads`` and of ``reduces``, its reductions.

    Raises:
        ParameterError: these do not make a metric.
    """
    fields = dict(reads or {})
    scale, shown_unit = shown or (1.0, unit)

    def made(function: Callable[[RunView], T]) -> Metric[T]:
        name = function.__name__
        _check_reads(f"metric {name}", fields, reduces)
        reduced = (topic for one in reduces for topic in one.needs)
        topics = tuple(dict.fromkeys((*fields, *reduced))) if needs is None else needs
        found = Metric(
            name, function, unit, scale, shown_unit, size, parts, topics, fields, reduces, body, repeatable, least,
            most, tolerance, at_end, planned or any(topic in PLANNED for topic in topics),
        )  # fmt: skip
        _check(found)
        return found

    return made


def _check(made: Metric[Any]) -> None:
    """Refuse, by a ParameterError, what could not be computed, shown or bounded."""
    who = f"metric {made.name}"
    if not made.name.isidentifier() or keyword.iskeyword(made.name) or made.name in RESERVED:
        raise ParameterError(("name",), f"{who}: not a name for a metric", f"none of {', '.join(RESERVED)}, and a word")
    if not made.meaning:
        raise ParameterError(("meaning",), f"{who}: says not what it is", "document its function")
    if isinstance(made.size, bool) or not isinstance(made.size, int) or made.size < 1:
        raise ParameterError(("size",), f"{who}: size {made.size}", "give the number of elements, 1 or more")
    if made.size > 1 and made.parts:
        raise ParameterError(("parts",), f"{who}: both a size and parts", "give one of them")
    if not all(part.isidentifier() for part in made.parts):
        raise ParameterError(("parts",), f"{who}: parts {made.parts}", "give words")
    if made.least is not None and made.most is not None and not made.least < made.most:
        raise ParameterError(("least",), f"{who}: never below {made.least} nor above {made.most}", "give a range")
    if made.tolerance is not None and not all(0.0 <= part < math.inf for part in made.tolerance):
        raise ParameterError(("tolerance",), f"{who}: tolerance {made.tolerance}", "give two numbers from 0 on")
    if not math.isfinite(made.scale) or made.scale == 0.0:
        raise ParameterError(("shown",), f"{who}: shown times {made.scale}", "give a factor that is not zero")
    _check_topics(who, "needs", made.needs)


def _check_reads(who: str, reads: Reads, reduces: tuple[Reduction, ...]) -> None:
    _check_topics(who, "reads", tuple(reads))
    if any(isinstance(names, str) for names in reads.values()):
        raise ParameterError(("reads",), f"{who}: reads letters of a name", "give a tuple of names for each topic")
    if not all(isinstance(one, Reduction) for one in reduces):
        raise ParameterError(("reduces",), f"{who}: reduces by something else", "make it with @reduction")


def _check_topics(who: str, key: str, topics: tuple[str, ...]) -> None:
    for topic in topics if isinstance(topics, tuple) else (topics,):
        if isinstance(topics, str) or not str(topic).startswith("/"):
            raise ParameterError((key,), f"{who}: {key} {topic!r}", "give a tuple of topics such as /truth")
