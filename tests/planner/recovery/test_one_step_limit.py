"""The one-step limit of a push: closed forms along a line, and sums of polygons by their hulls."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.planner.recovery.capturability import Moment, Way, landing_points, swing_box

pytestmark = pytest.mark.unit

OMEGA, LANDING, HALF, REACH = 3.2, 0.4, 0.11, 0.46
AHEAD = 0.05
WIDE = 10.0
"""So wide that nothing sideways binds [m]."""


def strip(low, high):
    return np.array([(x, y) for x in (low, high) for y in (-WIDE, WIDE)])


STANCE = strip(-HALF, HALF)
AS_PLANNED = Way(((STANCE, (0.0, LANDING)),), strip(-REACH - HALF, REACH + HALF))


def line(*ways, **changes):
    """A moment in which all that matters lies along x."""
    return replace(Moment(np.array([AHEAD, 0.0]), OMEGA, ways or (AS_PLANNED,), 1e-6), **changes)


def edge(decay, reach=REACH):
    """Farthest DCM now that the landing still catches [m]."""
    return HALF * (1.0 - decay) + decay * (reach + HALF)


def test_limit_of_a_hit_is_what_lies_between_the_dcm_and_the_edge():
    decay = math.exp(-OMEGA * LANDING)
    assert line().limit(0.0) == pytest.approx(OMEGA * (edge(decay) - AHEAD), rel=1e-5)
    assert line().limit(math.pi) == pytest.approx(OMEGA * (edge(decay) + AHEAD), rel=1e-5)


@pytest.mark.parametrize("duration", [0.1, 0.3, 0.8])
def test_limit_of_a_long_push_is_higher_by_what_diverges_less(duration):
    """Also of one that goes on after the landing."""
    spread = OMEGA * duration
    slower = spread / (1.0 - math.exp(-spread))
    assert line(duration=duration).limit(0.0) == pytest.approx(slower * line().limit(0.0), rel=1e-5)


def test_whoever_stands_has_the_soles_alone():
    standing = line(Way((), STANCE))
    assert standing.limit(0.0) == pytest.approx(OMEGA * (HALF - AHEAD), rel=1e-5)


def test_double_support_counts_for_as_long_as_it_lasts():
    lift, back = 0.1, -0.5
    supports = ((strip(back, HALF), (0.0, lift)), (strip(-HALF, HALF), (lift, LANDING)))
    early, decay = math.exp(-OMEGA * lift), math.exp(-OMEGA * LANDING)
    behind = back * (1 - early) - HALF * (early - decay) - decay * (REACH + HALF)
    both = line(replace(AS_PLANNED, supports=supports))
    assert both.limit(math.pi) == pytest.approx(OMEGA * (AHEAD - behind), rel=1e-5)
    assert both.limit(0.0) == pytest.approx(line().limit(0.0), rel=1e-5)


def test_nothing_is_survived_by_what_falls_already():
    assert line(dcm=np.array([2.0, 0.0])).limit(0.0) == 0.0


def test_a_push_aslant_is_bound_by_whichever_side_comes_first():
    narrow = np.array([(x, y) for x in (-HALF, HALF) for y in (-HALF, HALF)])
    square = line(Way((), narrow), dcm=np.zeros(2))
    assert square.limit(math.pi / 4) == pytest.approx(math.sqrt(2.0) * square.limit(0.0), rel=1e-5)


def test_the_best_way_to_land_counts_in_each_direction():
    sooner = Way(((STANCE, (0.0, 0.2)),), strip(-0.1, REACH + HALF))
    both = line(AS_PLANNED, sooner)
    assert both.limit(0.0) == line(sooner).limit(0.0) > line().limit(0.0)
    assert both.limit(math.pi) == line().limit(math.pi) > line(sooner).limit(math.pi)


def test_a_foot_is_where_full_acceleration_and_full_braking_bring_it():
    """Times to brake are tried out, also with a speed that cannot be lost in time."""
    most, time, ends = 5.0, 0.4, []
    for speed in (0.0, 0.8, -1.5):
        for way in (-1.0, 1.0):
            switch = np.linspace(0.0, time, 4001)
            final = speed + way * most * (2.0 * switch - time)
            top = speed * switch + 0.5 * way * most * switch**2
            rest = time - switch
            place = top + (speed + way * most * switch) * rest - 0.5 * way * most * rest**2
            ends.append(place[np.argmin(np.abs(final))])
        found = swing_box(np.zeros(2), np.full(2, speed), np.full(2, most), time)
        assert (found[0][0], found[1][1]) == pytest.approx(tuple(ends[-2:]), abs=1e-3)
    low, high = swing_box(np.zeros(2), np.full(2, 9.0), np.full(2, most), time)
    assert (low == high).all()


def test_the_limit_is_the_edge_of_the_sum_of_all_polygons():
    """Aslant ones, of some points within them, by the hull of all sums of their corners."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        hulls = [rng.normal(size=(count, 2)) for count in (2, 3, 5)]
        supports = tuple((hull, (0.1 * i, 0.1 * (i + 1))) for i, hull in enumerate(hulls[:2]))
        way = Way(supports, hulls[2])
        sums = [sum(corners) for corners in itertools.product(*way.summands(OMEGA))]
        edges = ConvexHull(sums).equations
        dcm, angle = np.mean(sums, axis=0), rng.uniform(-math.pi, math.pi)
        along = edges[:, :2] @ (math.cos(angle), math.sin(angle))
        room = -(edges[:, :2] @ dcm + edges[:, 2])
        wanted = OMEGA * np.min(room[along > 0.0] / along[along > 0.0])
        assert Moment(dcm, OMEGA, (way,), 1e-6).limit(angle) == pytest.approx(wanted, rel=1e-5)


def test_landing_turns_with_the_stance_foot():
    reach = (np.array([-0.3, 0.1]), np.array([0.3, 0.4]))
    stance = np.array([1.0, 2.0, math.pi / 2])
    points = landing_points(stance, (0.1, 0.05), reach)
    assert points[:, 0].min() == pytest.approx(1.0 - 0.45)  # the left of whoever faces left is behind
    assert points[:, 1].max() == pytest.approx(2.0 + 0.4)
