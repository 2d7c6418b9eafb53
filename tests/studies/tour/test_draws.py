"""Random numbers of a tour: those of the benchmark are its own to the digit, by numbers that were recorded."""

import numpy as np
import pytest

from surefoot.studies.tour.draws import DRAWS, BenchmarkDraws, Twister, seed_sequence
from surefoot.studies.tour.rules import ARM_STEP, DURATION, SLOT, ArmWalk

pytestmark = pytest.mark.unit

RECORDED = {
    0: (
        [(0.662248716, 0.608099817, 3.122743715), (0.421046155, 0.424762972, -1.594198522)],
        [
            (23, False, (48.043125, -88.537421, -128.500625)),
            (18, True, (-110.337432, -26.246732, -62.35924)),
            (21, False, (79.549215, -152.571594, -15.399738)),
        ],
        [0.554166221, 0.136905593, -0.076484952, 0.444726877, 0.02102704, -0.162645996, 0.055237768],
    ),
    4321: (
        [(0.76272903, -0.198877261, -0.557419257), (-0.104585186, 0.563756233, -0.612195778)],
        [
            (24, False, (20.350156, -116.162746, -87.765025)),
            (23, True, (-38.596626, -50.372235, 103.650488)),
            (1, True, (-89.644249, 112.408506, 91.707115)),
        ],
        [0.236681061, 0.33635776, -0.184561328, 0.720281449, -0.057473001, 0.134245985, -0.16106299],
    ),
}
"""Draws by the run: its first places, its first punches (joint, of the parent, force), and its left arm after 1 s.

Written down from gaitkeeper 0.5.4, whose streams are those of the benchmark's own code; its arm has limits of 1 rad.
"""

STANCE = np.array([0.2, 0.2, 0.0, 0.6, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("run", RECORDED)
def test_a_run_of_the_benchmark_is_its_own_to_the_digit(run):
    places, punches, arm = RECORDED[run]
    tour = DRAWS["benchmark"].tour(run, 29)
    assert tour.places[: len(places)] == pytest.approx(np.array(places), abs=1e-8)
    for punch, (joint, of_parent, force) in zip(tour.punches, punches, strict=False):
        assert (punch.joint, punch.of_parent) == (joint, of_parent)
        assert punch.force * punch.direction == pytest.approx(np.array(force), abs=1e-5)
    walk = ArmWalk(DRAWS["benchmark"].arm_steps(run), STANCE, np.full(7, -1.0), np.full(7, 1.0), lambda _: True)
    assert [walk.angles(0.02 * k) for k in range(51)][50] == pytest.approx(np.array(arm), abs=1e-6)


def test_words_of_the_generator_are_those_of_the_standard_and_of_no_other_seed():
    first = Twister(7, 3)
    assert [int(first._bits.random_raw()) for _ in range(4)] == [351790320, 3488955865, 1077926635, 3160543647]
    assert Twister(7, 4).unit() != Twister(7, 3).unit() != Twister(8, 3).unit()
    assert seed_sequence((7, 3), 624) != seed_sequence((3, 7), 624)


def test_whole_numbers_are_each_as_likely_and_never_too_large():
    numbers = Twister(1, 9)
    found = np.array([numbers.below(29) for _ in range(5800)])
    assert found.min() == 0 and found.max() == 28
    assert np.bincount(found).min() > 140 and np.bincount(found).max() < 270


@pytest.mark.parametrize("draws", DRAWS)
def test_both_have_as_many_punches_in_order_and_are_the_same_each_time(draws):
    tours = [DRAWS[draws].tour(5, 29) for _ in range(2)]
    assert np.array_equal(tours[0].places, tours[1].places)
    assert len(tours[0].punches) == round(DURATION / SLOT) == len(tours[0].places)
    assert all(np.linalg.norm(punch.direction) == pytest.approx(1.0) for punch in tours[0].punches)
    steps = DRAWS[draws].arm_steps(5)(7)
    assert steps.shape == (25, 7) and np.abs(steps).max() <= ARM_STEP and np.abs(steps).max() > 0.9 * ARM_STEP


def test_half_of_the_benchmarks_punches_are_of_the_parent_and_none_of_ours():
    parents = [punch.of_parent for run in range(60) for punch in BenchmarkDraws().tour(run, 29).punches]
    assert np.mean(parents) == pytest.approx(0.5, abs=0.05)
    assert not any(punch.of_parent for punch in DRAWS["own"].tour(1, 29).punches)
