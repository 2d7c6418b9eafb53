"""Rates and thresholds of each value of an axis, with intervals, and tests of pairs that had the same pushes.

One rate over all says nothing of a campaign that compares laws or gains.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

from surefoot.maths.chance import Difference, SuccessRate, mcnemar, paired_mean, wilson
from surefoot.studies.campaigns.points import Cell
from surefoot.studies.campaigns.spec import Axis, text

if TYPE_CHECKING:
    from surefoot.studies.campaigns.sweep import Swept

UNSURE = 0.05
"""Share by which an interval may miss, and level of a test after Holm [-]."""

_SHOWN = 12
"""Tests of an axis that are printed; the object has all."""

Key = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Reached:
    """Rate of the runs, or mean threshold of the searches, of one value of an axis.

    Attributes:
        axis: its name.
        value: label of the value.
        passed: runs that met their criteria; 0 of searches.
        judged: runs that met or missed them, or searches with a threshold in their range.
        rate: share of runs that passed; None of searches.
        mean: mean threshold with its interval, of two searches or more; None of runs.
    """

    axis: str
    value: str
    passed: int
    judged: int
    rate: SuccessRate | None = None
    mean: Difference | None = None


@dataclass(frozen=True, slots=True)
class PairTest:
    """Two values of an axis, by pairs that differ in it alone: the same seed, the same pushes, the same of all else.

    Attributes:
        axis: its name.
        one: label of the one value.
        other: label of the other.
        pairs: that both have.
        only_one: pairs in which only the one passed, or reached more.
        only_other: pairs in which only the other did.
        difference: mean of the other's thresholds minus the one's, with its interval; None of runs.
        chance: probability of so uneven pairs by chance alone, by McNemar's exact test, or by the sign test of
            thresholds; of all tests of the axis together, by Holm.
    """

    axis: str
    one: str
    other: str
    pairs: int
    only_one: int
    only_other: int
    chance: float
    difference: Difference | None = None

    @property
    def differs(self) -> bool:
        """True if chance alone hardly does that."""
        return self.chance <= UNSURE


def reached(swept: "Swept") -> list[Reached]:
    """Rates or thresholds of each value of each axis that varies, axis by axis."""
    return [one for axis in varied(swept) for one in _of_axis(swept, axis)]


def pair_tests(swept: "Swept") -> list[PairTest]:
    """Tests between the values of each axis that varies and does not itself change the pushes."""
    return [test for axis in varied(swept) if not _pushes(swept, axis) for test in _tests(swept, axis)]


def varied(swept: "Swept") -> list[Axis]:
    """Axes of a campaign with several values."""
    axes = (Axis(name, tuple(one.label for one in settings)) for name, settings in swept.campaign.axes.items())
    return [axis for axis in axes if len(axis.values) > 1]


def _pushes(swept: "Swept", axis: Axis) -> bool:
    keys = {key for setting in swept.campaign.axes[axis.name] for key in setting.keys}
    return any(key.partition(".")[0] == "pushes" or key.startswith("bisect.") for key in keys)


def _of_axis(swept: "Swept", axis: Axis) -> Iterator[Reached]:
    for value, ends in _ends(swept, axis, swept.campaign.spec.bisect is None).items():
        if swept.campaign.spec.bisect is None:
            passed, judged = sum(map(bool, ends.values())), len(ends)
            yield Reached(axis.name, value, passed, judged, wilson(passed, judged) if judged else None)
        else:
            found = [float(one) for one in ends.values()]
            yield Reached(axis.name, value, 0, len(found), None, paired_mean(found, UNSURE) if found[1:] else None)


def _tests(swept: "Swept", axis: Axis) -> list[PairTest]:
    ends, searches = _ends(swept, axis, False), swept.campaign.spec.bisect is not None
    tests = [_test(axis.name, (one, ends[one]), (other, ends[other]), searches) for one, other in combinations(ends, 2)]
    return _by_holm([test for test in tests if test.pairs])


def _test(
    axis: str, one: tuple[str, Mapping[Key, float]], other: tuple[str, Mapping[Key, float]], searches: bool
) -> PairTest:
    pairs = [(value, other[1][key]) for key, value in one[1].items() if key in other[1]]
    more, less = sum(new > old for old, new in pairs), sum(new < old for old, new in pairs)
    apart = [new - old for old, new in pairs]
    difference = paired_mean(apart, UNSURE) if searches and len(pairs) > 1 else None
    return PairTest(axis, one[0], other[0], len(pairs), less, more, mcnemar(less, more), difference)


def _by_holm(tests: Sequence[PairTest]) -> list[PairTest]:
    """The tests with chances that hold for all of them together.

    S. Holm, A simple sequentially rejective multiple test procedure, Scandinavian Journal of Statistics 6, 1979.
    """
    order, least, adjusted = sorted(range(len(tests)), key=lambda at: tests[at].chance), 0.0, {}
    for rank, at in enumerate(order):
        least = max(least, min(1.0, (len(tests) - rank) * tests[at].chance))
        adjusted[at] = least
    return [
        PairTest(one.axis, one.one, one.other, one.pairs, one.only_one, one.only_other, adjusted[at], one.difference)
        for at, one in enumerate(tests)
    ]


def _ends(swept: "Swept", axis: Axis, once: bool) -> dict[str, dict[Key, float]]:
    """Ends of runs (1 passed, 0 missed) or searches (thresholds) by value of an axis, by all else that they are of.

    Of runs that only repeat another the first alone counts: seeds that do nothing make no pairs.
    """
    found: dict[str, dict[Key, float]] = {text(value): {} for value in axis.values}
    first = set(swept.campaign.spec.first)
    if swept.campaign.spec.bisect is None:
        facts = {point.id for point, _ in swept.facts}
        runs = [run for run in swept.runs if run[1].status in ("pass", "fail")]
        new = {_key(point.labels, axis.name, first) for point, _ in runs if point.id in facts}
        for point, record in runs:
            key = _key(point.labels, axis.name, first)
            if point.id in facts if once else key in new:
                found[text(point.labels[axis.name])][key] = float(record.status == "pass")
        return found
    for outcome in swept.outcomes:
        if outcome.threshold is not None and outcome.threshold.side == "inside" and isinstance(outcome.cell, Cell):
            labels, value = outcome.cell.labels, outcome.threshold.value
            found[text(labels[axis.name])][_key(labels, axis.name, first)] = float(value or 0.0)
    return found


def _key(labels: Mapping[str, Any], axis: str, first: set[str]) -> Key:
    return tuple(sorted((name, repr(value)) for name, value in labels.items() if name != axis and name not in first))


def reached_lines(swept: "Swept") -> Iterator[str]:
    """Lines of tables for a person, one for each axis, and the tests below each."""
    tests = pair_tests(swept)
    for axis in varied(swept):
        found = list(_of_axis(swept, axis))
        if not any(one.judged for one in found):
            continue
        rows = [_heads(axis.name, swept.campaign.spec.bisect is None), *map(_row, found)]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        for row in rows:
            yield "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        own = sorted((test for test in tests if test.axis == axis.name), key=lambda test: test.chance)
        yield from map(_test_line, own[:_SHOWN])
        if len(own) > _SHOWN:
            yield f"and {len(own) - _SHOWN} pairs of values more"


def _heads(axis: str, runs: bool) -> tuple[str, ...]:
    if runs:
        return (axis, "passed", "rate [%]", "95 % interval [%]")
    return (axis, "in range", "mean threshold", "95 % interval")


def _row(one: Reached) -> tuple[str, ...]:
    if one.rate is not None:
        return (one.value, f"{one.passed} of {one.judged}", f"{100 * one.rate.rate:.1f}", one.rate.between)
    if one.mean is not None:
        return (one.value, str(one.judged), f"{one.mean.value:.4g}", f"{one.mean.low:.4g} to {one.mean.high:.4g}")
    return (one.value, str(one.judged), "-", "-")


def _test_line(test: PairTest) -> str:
    what = "differ" if test.differs else "are not told apart"
    by = ""
    if test.difference is not None:
        low, high = test.difference.low, test.difference.high
        by = f", by {test.difference.value:.3g} ({low:.3g} to {high:.3g}) in the mean"
    counts = f"{test.only_one} of {test.pairs} pairs for the one, {test.only_other} for the other"
    return f"{test.one} and {test.other} {what}: {counts}{by}; p = {test.chance:.2g}"


def to_json(swept: "Swept") -> dict[str, Any]:
    """Rates or thresholds and the tests, as parts of the object of a campaign."""
    return {"reached": [_reached_json(one) for one in reached(swept)], "tests": list(map(_json, pair_tests(swept)))}


def _reached_json(one: Reached) -> dict[str, Any]:
    rate = None if one.rate is None else one.rate._asdict()
    mean = None if one.mean is None else one.mean._asdict()
    counts = {"passed": one.passed, "judged": one.judged}
    return {"axis": one.axis, "value": one.value, **counts, "rate": rate, "threshold": mean}


def _json(test: PairTest) -> dict[str, Any]:
    counts = {"pairs": test.pairs, "only_one": test.only_one, "only_other": test.only_other}
    apart = None if test.difference is None else test.difference._asdict()
    named = {"axis": test.axis, "one": test.one, "other": test.other}
    return {**named, **counts, "chance": test.chance, "differs": test.differs, "difference": apart}
