"""Draws for a tour, by the laws of the benchmark's description."""

import numpy as np
import pytest

from surefoot.studies.tour.draws import OwnDraws
from surefoot.studies.tour.rules import (
    ARM_STEP,
    ARM_STEPS,
    CENTRE,
    DURATION,
    RADIUS,
    SLOT,
    STRONGEST,
    ArmWalk,
    drawn,
)

pytestmark = pytest.mark.unit

TOURS = [drawn(seed, 29) for seed in range(200)]


def test_places_fill_a_disc_evenly():
    places = np.concatenate([tour.places for tour in TOURS])
    away = np.hypot(*(places[:, :2] - CENTRE).T)
    assert away.max() <= RADIUS
    # Half of the area is within radius / sqrt 2.
    assert np.mean(away < RADIUS / np.sqrt(2.0)) == pytest.approx(0.5, abs=0.03)
    assert np.abs(places[:, 2]).max() <= np.pi and abs(places[:, 2].mean()) < 0.1


def test_punches_come_once_a_slot_grow_and_point_everywhere():
    punches = [punch for tour in TOURS for punch in tour.punches]
    assert [punch.time for punch in TOURS[0].punches] == pytest.approx(np.arange(18) * SLOT + 0.1)
    first, late = ([tour.punches[k].force for tour in TOURS] for k in (0, 17))
    assert min(first) >= STRONGEST / 6.0 and max(first) <= STRONGEST / 3.0
    assert min(late) >= STRONGEST / 2.0 and STRONGEST * 0.9 < max(late) <= STRONGEST
    directions = np.array([punch.direction for punch in punches])
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0)
    assert np.abs(directions.mean(axis=0)).max() < 0.03
    # On a sphere each coordinate is uniform.
    assert np.mean(np.abs(directions) < 0.5, axis=0) == pytest.approx(0.5, abs=0.03)
    assert {punch.joint for punch in punches} == set(range(29))


def test_a_punch_acts_for_its_time_and_no_longer():
    tour = TOURS[3]
    assert tour.punch(0.098) is None and tour.punch(0.182) is None
    assert tour.punch(0.1) is tour.punches[0] is tour.punch(0.178)
    assert tour.punch(5.1) is tour.punches[1]
    steps = [tour.punch(k / 500) for k in range(round(DURATION * 500))]
    assert sum(punch is not None for punch in steps) == 18 * 40


def test_a_seed_is_the_same_tour_each_time_and_no_other_is():
    again = drawn(7, 29)
    assert np.array_equal(again.places, TOURS[7].places) and again.punches[4].force == TOURS[7].punches[4].force
    assert not np.array_equal(again.places, TOURS[8].places)


def arms(allowed, seed=0):
    return ArmWalk(OwnDraws().arm_steps(seed), np.zeros(7), np.full(7, -1.0), np.full(7, 1.0), allowed)


def test_arms_go_from_pose_to_pose_and_are_never_still():
    walk = arms(lambda _: True)
    poses = np.array([walk.angles(0.02 * k) for k in range(1000)])
    steps = np.abs(np.diff(poses, axis=0))
    assert steps.max() <= ARM_STEP and (steps.max(axis=1) > 0.0).all()
    assert np.abs(poses).max() <= 1.0
    # A random walk of so many steps of a uniform number each has this deviation.
    ends = np.diff(poses[24::25], axis=0)
    free = np.abs(poses[24:-25:25]) < 0.5
    assert np.std(ends[free[: len(ends)]]) == pytest.approx(ARM_STEP * np.sqrt(ARM_STEPS / 3.0), rel=0.15)


def test_poses_that_are_not_allowed_are_not_taken():
    walk = arms(lambda angles: bool(angles[0] >= 0.0))
    ends = np.array([walk.angles(0.02 * k) for k in range(2000)])[24::25]
    assert ends[:, 0].min() >= 0.0 and ends[:, 1].min() < -0.2
    held = arms(lambda _: False)
    assert not np.array([held.angles(0.02 * k) for k in range(100)]).any()
