"""Intervals cover as often as they say, and exact tests are those of scipy.stats, by which they are held."""

import math

import numpy as np
import pytest
from scipy import stats

from surefoot.maths.chance import (
    fisher,
    look_error,
    mcnemar,
    paired_mean,
    paired_share,
    unpaired_mean,
    unpaired_share,
    wilson,
)

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("error", [0.1, 0.05, 1e-4])
def test_means_are_those_of_student_and_of_welch(error):
    rng = np.random.default_rng(3)
    before, now = rng.normal(1.0, 0.3, 9), rng.normal(1.2, 0.9, 14)
    wanted = stats.ttest_rel(now[:9], before).confidence_interval(1.0 - error)
    assert paired_mean((now[:9] - before).tolist(), error)[1:] == pytest.approx(tuple(wanted), rel=1e-9)
    wanted = stats.ttest_ind(now, before, equal_var=False).confidence_interval(1.0 - error)
    found = unpaired_mean(before.tolist(), now.tolist(), error)
    assert found[1:] == pytest.approx(tuple(wanted), rel=1e-9)
    assert found.value == pytest.approx(now.mean() - before.mean())


def test_pairs_of_one_difference_leave_no_doubt():
    same = paired_mean([0.0] * 6, 1e-6)
    assert tuple(same) == (0.0, 0.0, 0.0)
    assert same.within(0.0)
    assert not same.excludes_zero
    moved = paired_mean([0.25] * 6, 1e-6)
    assert moved.excludes_zero
    assert moved.within(0.25)
    assert not moved.within(0.24)
    assert tuple(unpaired_mean([1.0, 1.0], [1.5, 1.5], 0.01)) == (0.5, 0.5, 0.5)


def test_mcnemar_and_fisher_are_exact():
    for lost in range(9):
        for gained in range(9):
            wanted = stats.binomtest(lost, lost + gained, 0.5).pvalue if lost + gained else 1.0
            assert mcnemar(lost, gained) == pytest.approx(wanted)
    for before in range(8):
        for now in range(13):
            wanted = stats.fisher_exact([[before, 7 - before], [now, 12 - now]]).pvalue
            assert fisher((before, 7), (now, 12)) == pytest.approx(wanted, abs=1e-9)


def test_the_interval_of_shares_is_newcombes_own_example():
    """Table II of his paper on independent proportions: 56 of 70 against 48 of 80, method 10."""
    found = unpaired_share((48, 80), (56, 70), 0.05)
    assert found[1:] == pytest.approx((0.0524, 0.3339), abs=1e-4)


def test_intervals_of_paired_shares_cover_as_often_as_they_say():
    """Exactly, over all tables of 20 pairs; pairs that are taken for independent are too wide, which shows here."""
    count, rates = 20, np.array([0.7, 0.1, 0.05, 0.15])  # both, lost, gained, neither
    covered = total = wider = 0.0
    for both in range(count + 1):
        for lost in range(count + 1 - both):
            for gained in range(count + 1 - both - lost):
                table = (both, lost, gained, count - both - lost - gained)
                weight = stats.multinomial.pmf(table, count, rates)
                found = paired_share(*table, 0.05)
                apart = unpaired_share((both + lost, count), (both + gained, count), 0.05)
                covered += weight * (found.low <= rates[2] - rates[1] <= found.high)
                wider += weight * ((apart.high - apart.low) - (found.high - found.low))
                total += weight
    assert total == pytest.approx(1.0)
    assert 0.94 < covered < 0.995
    assert wider > 0.05


def test_the_parts_of_an_error_never_sum_to_more_than_it():
    spent = [look_error(0.01, look) for look in range(1, 2000)]
    assert math.fsum(spent) < 0.01
    assert math.fsum(spent) == pytest.approx(0.01, rel=1e-3)
    assert sorted(spent, reverse=True) == spent


def test_looks_one_after_another_keep_the_error_which_looks_at_the_whole_error_do_not():
    rng = np.random.default_rng(1)
    spent = whole = 0
    for _ in range(1500):
        values = rng.normal(size=96).tolist()
        looks = [(number, values[: 6 * 2 ** (number - 1)]) for number in range(1, 6)]
        spent += any(paired_mean(part, look_error(0.05, number)).excludes_zero for number, part in looks)
        whole += any(paired_mean(part, 0.05).excludes_zero for _, part in looks)
    assert spent / 1500 < 0.05
    assert whole / 1500 > 0.09


def test_a_greater_error_is_a_narrower_interval_of_a_rate():
    wide, narrow = wilson(9, 12, 0.01), wilson(9, 12, 0.2)
    assert wide.low < narrow.low < 0.75 < narrow.high < wide.high
    assert wilson(9, 12) == wilson(9, 12, 0.05)
