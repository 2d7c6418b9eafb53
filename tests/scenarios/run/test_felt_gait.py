"""The gait as feet feel it: phases, steps and how long they last."""

import math
from itertools import pairwise

import numpy as np
import pytest

from surefoot.planner.types import Foot, PhaseKind
from surefoot.scenarios.run.felt import GRAZE, STILL, FeltGait
from surefoot.scenarios.setup.groups.gait import PushPoint

pytestmark = pytest.mark.unit

PERIOD = 2.0**-9


def walked(spells, begin=0.0):
    """Phases of a gait after loads of both feet for so long each, from an instant on."""
    gait, told, now = FeltGait(50.0), [], begin
    for left, right, lasts in spells:
        for _ in range(round(lasts / PERIOD)):
            gait.update(now, np.array([250.0 * left, 250.0 * right]))
            told.append((now, gait.phase, gait.landed))
            now += PERIOD
    return told


def test_phases_follow_the_loads_and_steps_are_counted():
    told = walked([(1, 1, 0.5), (1, 0, 0.3), (1, 1, 0.1), (0, 1, 0.3), (1, 1, 1.0)])
    kinds = [phase.kind for _, phase, _ in told]
    runs = [kinds[0], *(b for a, b in pairwise(kinds) if a is not b)]
    stand, double, single = PhaseKind.STAND, PhaseKind.DOUBLE, PhaseKind.SINGLE
    assert runs == [stand, single, double, single, double, stand]
    assert [foot for *_, foot in told if foot is not None] == [Foot.RIGHT, Foot.LEFT]
    assert told[-1][1].step == 2
    swings = [phase for _, phase, _ in told if phase.kind is single]
    assert {phase.stance for phase in swings} == {Foot.LEFT, Foot.RIGHT}
    assert swings[-1].duration == pytest.approx(0.3, abs=2 * PERIOD)
    standing = next(now for now, phase, _ in told[500:] if phase.kind is stand)
    assert standing == pytest.approx(1.2 + GRAZE + STILL, abs=3 * PERIOD)


def test_a_graze_is_no_step_and_a_flight_has_no_stance_foot():
    assert walked([(1, 1, 0.2), (1, 0, 0.5 * GRAZE), (1, 1, 0.2)])[-1][1].step == 0
    flies = walked([(1, 1, 0.2), (0, 0, 0.2)])[-1][1]
    assert (flies.kind, flies.stance) == (PhaseKind.SINGLE, None)


def test_a_push_finds_its_point_of_the_felt_gait():
    told = walked([(1, 1, 0.5), (1, 0, 0.3), (1, 1, 0.1), (0, 1, 0.3), (1, 1, 0.1)])
    point = PushPoint(2, PhaseKind.SINGLE, 0.5)
    reached = next(now for now, phase, _ in told if now + point.left(phase) < now + PERIOD)
    assert reached == pytest.approx(0.9 + GRAZE + 0.15, abs=4 * PERIOD)
    assert math.isinf(PushPoint(9, PhaseKind.SINGLE, 0.5).left(told[-1][1]))


WALK = [(1, 1, 0.8), (1, 0, 0.3), (1, 1, 0.1), (0, 1, 0.35), (1, 1, 0.12), (0, 0, 0.2), (1, 1, 1.0)]


def test_time_passes_in_each_phase_as_on_the_clock_and_none_is_left_over():
    """A phase that lasts longer than it is taken to has nothing left."""
    for (before, was, _), (now, phase, _) in pairwise(walked(WALK)):
        begins = phase.kind is not was.kind and phase.kind is not PhaseKind.STAND
        passed = phase.elapsed if begins else phase.elapsed - was.elapsed
        assert passed == pytest.approx(0.0 if begins else now - before)
        assert phase.left == pytest.approx(max(phase.duration - phase.elapsed, 0.0))
        if phase.kind is not PhaseKind.STAND and phase.elapsed < phase.duration:
            assert phase.elapsed + phase.left == pytest.approx(phase.duration)


@pytest.mark.parametrize("begin", [3.0, 100.0])
def test_a_gait_is_felt_the_same_whenever_it_is(begin):
    """But for how long it has stood at first, of which nobody tells."""
    for (_, phase, landed), (_, other, there) in zip(walked(WALK), walked(WALK, begin), strict=True):
        assert (phase.kind, phase.stance, phase.step, phase.leads_to) == (
            other.kind, other.stance, other.step, other.leads_to
        )  # fmt: skip
        assert landed == there
        if phase.step:
            assert phase.elapsed == pytest.approx(other.elapsed, abs=1e-9)
            assert phase.duration == pytest.approx(other.duration, abs=1e-9)
