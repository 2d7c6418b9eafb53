"""The gait as feet feel it: phases, steps and how long they last."""

import math
from itertools import pairwise

import numpy as np
import pytest

from surefoot.planner.types import Foot, PhaseKind
from surefoot.scenarios.run.felt import GRAZE, STILL, FeltGait
from surefoot.scenarios.setup.groups.gait import PushPoint

pytestmark = pytest.mark.unit

PERIOD = 0.002


def walked(spells, gait=None):
    """Phases of a gait after loads of both feet for so long each."""
    gait, told, now = gait or FeltGait(50.0), [], 0.0
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
