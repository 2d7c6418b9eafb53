"""Two samples against each other: alarms are as rare as they are said to be, and what is asked for gets decided."""

import math

import numpy as np
import pytest

from surefoot.maths.chance import look_error
from surefoot.scenarios.check.findings import ALARM, RATE, Asked, decided, findings
from surefoot.scenarios.check.sample import SeedSample, read_sample
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.file.source import parse
from surefoot.scenarios.judge.metrics import known

pytestmark = pytest.mark.unit

BOUNDED = {"zmp_error_rms": Bound(max=0.05), "speed_mean": Bound(min=0.1)}


def sample(seeds, passed=None, **values):
    """A sample with values of some metrics."""
    columns = {name.replace("__", "."): tuple(column) for name, column in values.items()}
    return SeedSample(tuple(seeds), tuple(passed or [True] * len(seeds)), columns)


def of(name, found):
    return next(one for one in found if one.name == name)


def noisy(rng, count, mean=0.2, spread=0.02):
    return [float(value) for value in rng.normal(mean, spread, count)]


@pytest.mark.parametrize(
    ("name", "factor", "verdict"),
    [
        ("speed_mean", 0.8, "worse"),
        ("speed_mean", 1.2, "better"),
        ("speed_mean", 1.005, "same"),
        ("path_length", 1.2, "moved"),
        ("path_length", 1.0001, "same"),
    ],
)
def test_pairs_tell_which_way_a_metric_went_by_what_the_criterion_asks_for(name, factor, verdict):
    rng = np.random.default_rng(1)
    before = noisy(rng, 12)
    now = [factor * value + float(rng.normal(0.0, 1e-4)) for value in before]
    found = findings(sample(range(12), **{name: before}), sample(range(12), **{name: now}), Asked(BOUNDED, {}))
    one = of(name, found)
    assert (one.verdict, one.pairs, one.deciding) == (verdict, 12, name == "speed_mean")
    assert one.difference.low < np.mean(now) - np.mean(before) < one.difference.high
    assert decided(found) == (verdict in ("worse", "moved"))  # the pass rate needs more runs


def test_the_same_runs_are_the_same_however_few_and_a_change_in_the_last_digit_kept_is_none():
    before = sample(range(6), speed_mean=[0.2, 0.3, 0.25, 0.21, 0.22, 0.23], fell=[False] * 6)
    now = sample(range(6), speed_mean=[value * (1.0 + 4e-6) for value in before.values["speed_mean"]], fell=[False] * 6)
    found = findings(before, now, Asked(BOUNDED, {}))
    assert {one.verdict for one in found} == {"same"}
    assert decided(found)
    assert of(RATE, findings(before, sample(range(6, 12), **now.values), Asked(BOUNDED, {}))).verdict == "not decided"


def test_a_shift_that_pairs_show_is_not_seen_without_them():
    rng = np.random.default_rng(2)
    before = noisy(rng, 12, spread=0.05)
    now = [0.9 * value for value in before]
    paired = findings(sample(range(12), speed_mean=before), sample(range(12), speed_mean=now), Asked(BOUNDED, {}))
    apart = findings(sample(range(12), speed_mean=before), sample(range(50, 62), speed_mean=now), Asked(BOUNDED, {}))
    assert of("speed_mean", paired).verdict == "worse"
    assert (of("speed_mean", apart).verdict, of("speed_mean", apart).pairs) == ("not decided", 0)


def alarms(replicas, error=ALARM):
    """Number of checks with an alarm, of an unchanged program with fresh seeds and noise with a long tail."""
    rng, count = np.random.default_rng(7), 0
    names = ["speed_mean", "path_length", "zmp_error_rms[0]", "zmp_error_rms[1]", "foot_slip_max", "torque_ratio_max"]
    for _ in range(replicas):
        draws = {name: [float(x) for x in rng.lognormal(-2.0, 0.6, 48)] for name in names}
        passed = [bool(one) for one in rng.random(48) < 0.8]
        before = SeedSample(tuple(range(24)), tuple(passed[:24]), {name: tuple(x[:24]) for name, x in draws.items()})
        rest = SeedSample(tuple(range(24, 48)), tuple(passed[24:]), {name: tuple(x[24:]) for name, x in draws.items()})
        looks = ((look, rest.at(range(24, 24 + 6 * 2 ** (look - 1)))) for look in (1, 2, 3))
        said = (findings(before, now, Asked(BOUNDED, {}, 1, look, error)) for look, now in looks)
        count += any(one.verdict in ("worse", "moved", "better") for found in said for one in found)
    return count


def test_an_unchanged_program_raises_an_alarm_in_less_than_a_percent_of_checks():
    assert alarms(600) <= 6


def test_without_its_parts_of_the_error_it_would_raise_many():
    assert alarms(150, 1.0) > 15


def test_what_is_not_decided_is_decided_by_about_as_many_runs_more_as_it_says():
    """A shift of twice the tolerance in noise as wide: enough runs find it, a quarter of them do not."""
    rng = np.random.default_rng(5)
    allowed = known("speed_mean").allowed(0.2)
    before, now = noisy(rng, 4000, spread=2.0 * allowed), noisy(rng, 4000, 0.2 - 2.0 * allowed, 2.0 * allowed)

    def verdict(count, look=1):
        parts = (sample(range(at, at + count), speed_mean=x[:count]) for at, x in ((0, before), (9000, now)))
        return of("speed_mean", findings(*parts, Asked(BOUNDED, {}, 1, look)))

    first = verdict(6)
    assert first.verdict == "not decided"
    assert 6 < first.needs < 400
    assert verdict(2 * (6 + first.needs)).verdict == "worse"
    assert verdict(max(2, (6 + first.needs) // 4)).verdict == "not decided"


def test_a_seed_that_is_lost_where_none_was_is_worse_and_else_chance_is_asked():
    values = {"speed_mean": [0.2 + 0.001 * seed for seed in range(12)]}
    good, bad = [True] * 12, [True] * 11 + [False]
    lost = findings(sample(range(12), good, **values), sample(range(12), bad, **values), Asked(BOUNDED, {}))
    assert lost[0].verdict == "worse"
    fresh = findings(sample(range(12), good, **values), sample(range(20, 32), bad, **values), Asked(BOUNDED, {}))
    assert fresh[0].verdict == "not decided"
    other = [False, *[True] * 11]
    flipped = findings(sample(range(12), other, **values), sample(range(12), bad, **values), Asked(BOUNDED, {}))
    assert flipped[0].verdict == "not decided"
    none = findings(sample(range(40), [True] * 30 + [False] * 10), sample(range(40), [False] * 40), Asked(BOUNDED, {}))
    assert none[0].verdict == "worse"


def test_a_metric_that_is_gone_is_worse():
    before = sample(range(24), speed_mean=[0.2 + 0.001 * seed for seed in range(24)])
    gone = sample(range(24), speed_mean=[None] * 24)
    (_, share) = findings(before, gone, Asked(BOUNDED, {}))
    assert (share.name, share.verdict, share.now) == ("share of speed_mean", "worse", 0.0)


def test_a_count_may_be_off_by_half_of_one_in_the_mean():
    before = sample(range(24), steps_taken=[5] * 24)
    asked = Asked({"steps_taken": Bound(equals="steps_planned")}, {})
    assert of("steps_taken", findings(before, sample(range(24), steps_taken=[5] * 23 + [6]), asked)).verdict == "same"
    assert of("steps_taken", findings(before, sample(range(24), steps_taken=[6] * 24), asked)).verdict == "moved"


def test_a_threshold_decides_and_more_of_it_is_better():
    margins = {"push": Bisect(key="pushes.0.impulse", low=0.1, high=0.9, tolerance=0.01)}
    before = sample(range(12), margins__push=[0.5, 0.51, 0.49, 0.5] * 3)
    less = sample(range(12), margins__push=[0.95 * x for x in before.values["margins.push"]])
    for now, verdict in ((less, "worse"), (before, "same")):
        found = findings(before, now, Asked(BOUNDED, margins))
        assert (of("margins.push", found).verdict, of("margins.push", found).deciding) == (verdict, True)
    assert not [one for one in findings(before, less, Asked(BOUNDED, {})) if one.name == "margins.push"]


def test_errors_are_shared_among_scenarios_and_looks():
    rng = np.random.default_rng(4)
    before, now = noisy(rng, 6, spread=0.001), noisy(rng, 6, 0.23, 0.001)

    def verdict(scenarios, look):
        parts = sample(range(6), speed_mean=before), sample(range(10, 16), speed_mean=now)
        return of("speed_mean", findings(*parts, Asked(BOUNDED, {}, scenarios, look))).verdict

    assert (verdict(1, 1), verdict(10**30, 1), verdict(1, 10**15)) == ("better", "not decided", "not decided")
    assert math.fsum(look_error(0.01, look) for look in range(1, 100)) < 0.01


def read_back(one):
    source = parse("\n".join(one.text()), "sample")
    assert not source.problems
    return read_sample(source.value)


def test_a_sample_is_read_back_as_it_was_written():
    one = sample(range(3), [True, False, True], speed_mean=[0.2, 1.0, None], steps_taken=[1, 2, 3], fell=[True] * 3)
    assert read_back(one) == one
    assert one.missed == (1,)
    assert one.at([2, 0]).values["speed_mean"] == (None, 0.2)
    assert one.is_random
    assert not sample(range(3), speed_mean=[1.0] * 3).is_random


@pytest.mark.parametrize(
    ("data", "why"),
    [
        ([], "no seeds, passed or values"),
        ({"seeds": [0], "passed": [True]}, "no seeds, passed or values"),
        ({"seeds": [0, 0], "passed": [True, True], "values": {}}, "or one twice"),
        ({"seeds": [-1], "passed": [True], "values": {}}, "seeds that are none"),
        ({"seeds": [True], "passed": [True], "values": {}}, "seeds that are none"),
        ({"seeds": [], "passed": [], "values": {}}, "seeds that are none"),
        ({"seeds": [0], "passed": [1], "values": {}}, "whether it passed"),
        ({"seeds": [0, 1], "passed": [True], "values": {}}, "whether it passed"),
        ({"seeds": [0], "passed": [True], "values": {"speed_mean": [math.nan]}}, "no value of speed_mean"),
        ({"seeds": [0], "passed": [True], "values": {"speed_mean": [1.0, 2.0]}}, "no value of speed_mean"),
        ({"seeds": [0], "passed": [True], "values": {"speed_mean": ["fast"]}}, "no value of speed_mean"),
    ],
)
def test_what_is_no_sample_is_refused(data, why):
    with pytest.raises(ValueError, match=why):
        read_sample(data)


def test_a_sample_gains_the_values_that_it_lacks_and_one_of_other_seeds_takes_its_place():
    before, now = sample((1, 2), a=(1.0, 2.0)), sample((1, 2), a=(1.1, 2.1), b=(3.0, 4.0))
    assert before.filled(now).values == {"a": (1.0, 2.0), "b": (3.0, 4.0)}
    others = sample((1, 3), a=(1.1, 2.1))
    assert before.filled(others) == others
