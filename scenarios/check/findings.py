"""Two samples of a scenario against each other: what is worse, better, the same within its tolerance, or not decided.

Where both have the same seeds, whose runs draw the same noise, pairs are compared: what the seed does to both is left
out. Else means are compared by Welch's t and rates by Fisher's exact test.

Two errors are kept apart. An alarm, that something is worse or has moved though nothing has, may come in `ALARM` of all
checks. Scenarios and looks share that; in each one half is for the pass rate, and one for all metrics. That a metric is
called the same though it is not within its tolerance may come in `UNSURE` of the metrics.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from surefoot.maths.chance import (
    Difference,
    fisher,
    look_error,
    mcnemar,
    paired_mean,
    paired_share,
    unpaired_mean,
    unpaired_share,
)
from surefoot.scenarios.check.sample import MARGIN, MetricValue, SeedSample
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metrics import known

ALARM, UNSURE = 0.01, 0.05
"""Share of checks of an unchanged program that may raise an alarm; share by which an interval may miss [-]."""

RATE, RATE_MARGIN = "pass rate", 0.15
"""Name of the share of runs that met their criteria, and how far it may be off to be the same [-]."""

_HALF_A_COUNT = 0.5
"""Tolerance of the mean of a count, of which single runs may not differ at all."""

MOST_NEEDED = 100_000
"""Runs beyond which it is not said how many more are needed."""

ChanceVerdict = Literal["worse", "better", "moved", "same", "not decided"]
ALARMS: tuple[ChanceVerdict, ...] = ("worse", "moved")


@dataclass(frozen=True, slots=True)
class Finding:
    """One number of two samples.

    Attributes:
        name: pass rate, or a metric with the element or part after it.
        verdict: moved is neither better nor worse: no criterion says which way is.
        before: share or mean in the baseline.
        now: the same now.
        difference: now minus before, with an interval that holds at all looks together with 95 %.
        margin: up to which it counts as the same.
        deciding: whether the check goes on until it is decided: the pass rate, a number that a criterion bounds, a
            threshold.
        pairs: that were compared; 0 where the samples have no seeds in common.
        needs: about how many runs more would decide it; 0 where it is decided.
    """

    name: str
    verdict: ChanceVerdict
    before: float
    now: float
    difference: Difference
    margin: float
    deciding: bool
    pairs: int
    needs: int = 0


@dataclass(frozen=True, slots=True)
class Asked:
    """The question that two samples are held against each other for.

    Attributes:
        criteria: bounds of the scenario by metric; they say which way is better.
        margins: its searches by name.
        scenarios: number of scenarios of the check, among which the error is shared.
        look: number of this look, from 1 on.
        alarm: error that all looks at the check may spend on alarms.
    """

    criteria: Mapping[str, Bound]
    margins: Mapping[str, Bisect]
    scenarios: int = 1
    look: int = 1
    alarm: float = ALARM


def findings(before: SeedSample, now: SeedSample, asked: Asked) -> tuple[Finding, ...]:
    """Hold a sample against that of a baseline; the pass rate comes first.

    Args:
        before: sample of the baseline.
        now: of today.
        asked: what is better, and how much error may be spent.
    """
    common = [seed for seed in now.seeds if seed in set(before.seeds)]
    paired = len(common) > 1
    if paired:
        before, now = before.at(common), now.at(common)
    else:  # of equal number: then the noise of both is symmetric, however skewed that of one is
        before = before.at(before.seeds[: len(now.seeds)])
    names = [name for name in before.values if name in now.values and _is_compared(name, asked)]
    half = 0.5 * asked.alarm / asked.scenarios
    held = _Held(asked, paired, half, half / max(1, 2 * len(names)))
    found = [held.rate(before, now)]
    for name in names:
        found += held.metric(name, before.values[name], now.values[name])
    if paired and now.is_as(before):  # the same runs are the same, however few
        return tuple(replace(one, verdict="same", needs=0) for one in found)
    return tuple(found)


def decided(found: Sequence[Finding]) -> bool:
    """Return true if more runs are not needed: there is an alarm, or all that decides is decided."""
    alarm = any(one.verdict in ALARMS for one in found)
    return alarm or not any(one.deciding and one.verdict == "not decided" for one in found)


def _is_compared(name: str, asked: Asked) -> bool:
    return name.removeprefix(MARGIN) in asked.margins if name.startswith(MARGIN) else known(_metric(name)) is not None


def _metric(name: str) -> str:
    """Name of the metric of an element or a part."""
    return name.partition("[")[0].partition(".")[0]


@dataclass(frozen=True, slots=True)
class _Held:
    """Compares two samples, as pairs or not, with the error of an alarm that the rate and a metric may spend."""

    asked: Asked
    paired: bool
    of_rate: float
    of_metric: float

    def _errors(self, alarm: float) -> tuple[float, float]:
        """Errors of an alarm and of the interval that is shown, at this look."""
        return look_error(alarm, self.asked.look), look_error(UNSURE, self.asked.look)

    def rate(self, before: SeedSample, now: SeedSample) -> Finding:
        """The pass rate; where no seed missed its criteria, each must meet them again."""
        both_sides = 2.0 * self.of_rate  # of which one is an alarm
        found = self._share(RATE, before.passed, now.passed, True, True, both_sides)
        news = self.paired and not before.missed and bool(now.missed)
        return replace(found, verdict="worse", needs=0) if news else found

    def metric(self, name: str, before: Sequence[MetricValue], now: Sequence[MetricValue]) -> Iterator[Finding]:
        """A metric, and first whether it has a value as often as before."""
        has_value = [value is not None for value in before], [value is not None for value in now]
        if not all(has_value[0]) or not all(has_value[1]):
            found = self._share(f"share of {name}", *has_value, True, False)
            if found.verdict in ("worse", "better"):
                yield found
        bound = self.asked.criteria.get(name, self.asked.criteria.get(_metric(name)))
        deciding = bound is not None or name.startswith(MARGIN)
        better = _upwards(name, bound)
        if any(isinstance(value, bool) for value in (*before, *now)):
            flags = [bool(value) for value in before], [bool(value) for value in now]
            yield self._share(name, *flags, better, False)  # what a criterion asks of it is in the pass rate
            return
        numbers = _numbers(before, now, self.paired)
        if min(map(len, numbers)) > 1:
            yield self._mean(name, *numbers, better, deciding)

    def _mean(
        self, name: str, before: Sequence[float], now: Sequence[float], better: bool | None, deciding: bool
    ) -> Finding:
        pairs = len(now) if self.paired else 0

        def interval(error: float) -> Difference:
            if self.paired:
                return paired_mean([new - old for old, new in zip(before, now, strict=True)], error)
            return unpaired_mean(before, now, error)

        margin, levels = self._margin(name, before), (sum(before) / len(before), sum(now) / len(now))
        sure, shown = map(interval, self._errors(self.of_metric))
        alarm = sure.excludes_zero and abs(sure.value) > margin
        half = 0.5 * (sure.high - sure.low) if abs(sure.value) > margin else 0.5 * (shown.high - shown.low)
        found = Finding(name, "not decided", *levels, shown, margin, deciding, pairs)
        return _judged(found, better, alarm, half, len(now))

    def _share(
        self,
        name: str,
        before: Sequence[bool],
        now: Sequence[bool],
        better: bool | None,
        deciding: bool,
        error: float | None = None,
    ) -> Finding:
        then, today = (sum(before), len(before)), (sum(now), len(now))
        sure, unsure = self._errors(error or self.of_metric)
        if self.paired:
            kinds = [(old, new) for old, new in zip(before, now, strict=True)]
            lost, gained = kinds.count((True, False)), kinds.count((False, True))
            both, neither = kinds.count((True, True)), kinds.count((False, False))
            chance, shown = mcnemar(lost, gained), paired_share(both, lost, gained, neither, unsure)
        else:
            chance, shown = fisher(then, today), unpaired_share(then, today, unsure)
        levels = then[0] / then[1], today[0] / today[1]
        alarm, half = chance <= sure and shown.value != 0.0, 0.5 * (shown.high - shown.low)
        pairs = len(now) if self.paired else 0
        found = Finding(name, "not decided", *levels, shown, RATE_MARGIN, deciding, pairs)
        return _judged(found, better, alarm, half, len(now))

    def _margin(self, name: str, before: Sequence[float]) -> float:
        """Distance up to which a mean counts as the same, in SI units."""
        if name.startswith(MARGIN):
            bisect, mean = self.asked.margins[name.removeprefix(MARGIN)], sum(before) / len(before)
            return bisect.tolerance or abs(mean) * ((bisect.ratio or 1.0) - 1.0)
        metric = known(_metric(name))
        assert metric is not None
        if metric.tolerance is None and metric.kind == int.__name__:
            return _HALF_A_COUNT
        return metric.allowed(sum(before) / len(before))


def _judged(found: Finding, better: bool | None, alarm: bool, half: float, runs: int) -> Finding:
    """A finding that is not decided yet, with its verdict, or with the runs that it still needs.

    Args:
        found: the finding.
        better: whether more is better; None where that is not known.
        alarm: whether the difference is beyond chance.
        half: half width of its interval.
        runs: that it is made of.
    """
    shown = found.difference
    if alarm:
        which: ChanceVerdict = "moved" if better is None else "better" if better == (shown.value > 0.0) else "worse"
        return replace(found, verdict=which)
    if shown.within(found.margin):
        return replace(found, verdict="same")
    room = abs(shown.value) if abs(shown.value) > found.margin else found.margin - abs(shown.value)
    wanted = runs * (half / room) ** 2 if room > 0.0 else math.inf
    return replace(found, needs=max(1, math.ceil(min(wanted, 2.0 * MOST_NEEDED)) - runs))


def _upwards(name: str, bound: Bound | None) -> bool | None:
    """True if more is better, by the criterion's one bound or truth value, of a threshold always; else None."""
    if name.startswith(MARGIN):
        return True
    if bound is None:
        return None
    if isinstance(bound.equals, bool):
        return bound.equals
    return None if (bound.min is None) == (bound.max is None) else bound.min is not None


def _numbers(
    before: Sequence[MetricValue], now: Sequence[MetricValue], paired: bool
) -> tuple[list[float], list[float]]:
    """The values that are numbers; of pairs those of which both are."""
    if paired:
        both = [(old, new) for old, new in zip(before, now, strict=True) if is_number(old) and is_number(new)]
        return [float(old or 0) for old, _ in both], [float(new or 0) for _, new in both]
    return [float(one or 0) for one in before if is_number(one)], [float(one or 0) for one in now if is_number(one)]
