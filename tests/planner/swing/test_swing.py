import math
from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.quintics import PEAK, detour
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit

START = np.array([1.0, 0.1, 0.0, 0.0, 0.0, 0.1])
GLIDING = [0, 1, 3, 4, 5]
TARGET = np.array([1.4, 0.15, 0.0, 0.2, -0.15, 0.0])


def swing(height=0.0, clearance=0.05, glide=(2.0, 2.4, 2.8), lifting=math.inf):
    target = TARGET + np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])
    begin, apex, end = ((time - 2.0) / 0.8 for time in glide)
    course = SwingCourse(apex, begin, end, clearance)
    parameters = PlannerParameters(touchdown_lead=0.0)
    return start_swing(Foot.LEFT, (START, target), (2.0, 40), course, parameters, lifting=lifting)


@pytest.mark.parametrize("height", [0.0, 0.15, -0.15])
def test_swing_leaves_rest_clears_both_heights_and_touches_down_softly(height):
    trajectory = swing(height)
    start, end = trajectory.evaluate(2.0), trajectory.evaluate(2.8 - 1e-9 - 1e-10)
    np.testing.assert_allclose(start, [START, np.zeros(6), np.zeros(6)], atol=1e-12)
    np.testing.assert_allclose(end[0], TARGET + np.array([0.0, 0.0, height, 0.0, 0.0, 0.0]), atol=1e-8)
    np.testing.assert_allclose(
        end[1], [0.0, 0.0, -PlannerParameters().search.touchdown_speed, 0.0, 0.0, 0.0], atol=1e-6
    )
    z = np.array([trajectory.evaluate(t)[0, 2] for t in np.linspace(2.0, 2.8, 801)])
    assert z.max() == pytest.approx(max(0.0, height) + 0.05, abs=1e-6)
    assert np.all(np.diff(z[:400]) >= -1e-12)
    assert np.all(np.diff(z[401:]) <= 1e-12)


def test_acceleration_is_continuous_and_derivatives_are_right():
    trajectory, step = swing(0.1), 1e-4
    motion = np.array([trajectory.evaluate(t) for t in np.arange(2.0, 2.7999, step)])
    np.testing.assert_allclose(np.gradient(motion[:, 0], step, axis=0)[1:-1], motion[1:-1, 1], atol=1e-4)
    np.testing.assert_allclose(np.gradient(motion[:, 1], step, axis=0)[1:-1], motion[1:-1, 2], atol=1e-2)
    assert np.abs(np.diff(motion[:, 2], axis=0)).max() < 0.05


def test_the_foot_glides_within_its_time_only():
    trajectory = swing(0.1, glide=(2.1, 2.5, 2.66))
    for time, place in ((2.05, START), (2.0999, START), (2.66, TARGET), (2.75, TARGET)):
        motion = trajectory.evaluate(time)[:, GLIDING]
        np.testing.assert_allclose(motion, [place[GLIDING], np.zeros(5), np.zeros(5)], atol=1e-9)
    motion = np.array([trajectory.evaluate(t) for t in np.arange(2.0, 2.7999, 1e-4)])
    assert np.abs(np.diff(motion[:, 2], axis=0)).max() < 0.3
    np.testing.assert_allclose(np.gradient(motion[:, 0], 1e-4, axis=0)[1:-1], motion[1:-1, 1], atol=1e-4)
    for time in (2.04, 2.3, 2.72):
        moved = trajectory.retargeted(time, TARGET + np.array([0.02, 0.01, 0.11, 0.0, 0.05, -0.05]))
        np.testing.assert_allclose(moved.evaluate(time), trajectory.evaluate(time), atol=1e-9)
        np.testing.assert_allclose(moved.evaluate(2.8 - 2e-9)[0], moved.target, atol=1e-6)


def test_unchanged_target_is_continued_identically():
    trajectory = replanned = swing(0.1)
    for t in np.arange(2.02, 2.72, 0.02):
        replanned = replanned.retargeted(t, trajectory.target)
        for later in (t, t + 0.01, 2.79):
            np.testing.assert_allclose(replanned.evaluate(later), trajectory.evaluate(later), atol=1e-8)


@pytest.mark.parametrize("time", [2.1, 2.5])
def test_new_target_is_reached_without_a_jump(time):
    trajectory = swing()
    target = TARGET + np.array([0.05, -0.03, 0.02, 0.1, 0.05, -0.1])
    moved = trajectory.retargeted(time, target)
    np.testing.assert_allclose(moved.evaluate(time), trajectory.evaluate(time), atol=1e-9)
    np.testing.assert_allclose(moved.evaluate(2.8 - 2e-9)[0], target, atol=1e-6)


def test_without_ground_the_sole_searches_downwards_without_a_jump_in_speed():
    parameters, step = PlannerParameters(), 1e-3
    motion = np.array([swing().evaluate(t) for t in 2.8 + step * np.arange(1000)])
    np.testing.assert_array_equal(motion[:, 0, GLIDING], np.tile(TARGET[GLIDING], (1000, 1)))
    np.testing.assert_allclose(np.gradient(motion[:, 0, 2], step)[1:-1], motion[1:-1, 1, 2], atol=1e-6 + step)
    assert motion[0, 1, 2] == pytest.approx(-parameters.search.touchdown_speed, abs=1e-6)
    assert motion[-1, 1, 2] == pytest.approx(-parameters.search.speed)
    assert np.abs(np.diff(motion[:, 1, 2])).max() <= parameters.search.acceleration * step + 1e-9


def test_positions_at_many_instants_are_those_of_evaluate():
    """With a glide that begins late and ends early, also after the target has moved."""
    pose, target = np.array([0.0, 0.1, 0.2, 0.1, 0.0, 0.05]), np.array([0.4, 0.2, 0.35, -0.1, 0.1, 0.0])
    swing = start_swing(Foot.LEFT, (pose, target), (1.0, 40), SwingCourse(0.6, 0.15, 0.8, 0.05), PlannerParameters())
    moved = swing.retargeted(1.4, target + np.array([0.05, -0.03, 0.01, 0.1, 0.0, 0.0]))
    for trajectory, start in ((swing, 1.0), (moved, 1.4)):
        instants = np.linspace(start, swing.touchdown_time, 97)
        each = [trajectory.evaluate(float(time))[0] for time in instants]
        np.testing.assert_allclose(trajectory.positions(instants), each, atol=1e-12)


def test_a_swing_that_glides_on_to_its_touchdown_bends_less():
    trajectory, target = swing(0.1, glide=(2.1, 2.5, 2.66)), TARGET + np.array([0.2, 0.1, 0.1, 0.0, 0.0, 0.0])
    times, bends = np.arange(2.3, 2.7999, 1e-3), []
    for gliding in (False, True):
        moved = trajectory.retargeted(2.3, target, gliding)
        np.testing.assert_allclose(moved.evaluate(2.3)[:, GLIDING], trajectory.evaluate(2.3)[:, GLIDING], atol=1e-9)
        np.testing.assert_allclose(moved.evaluate(2.7999999)[0], target, atol=1e-6)
        bends.append(max(np.abs(moved.evaluate(t)[2, :2]).max() for t in times))
    assert bends[1] < 0.6 * bends[0]


@pytest.mark.parametrize("delay", [0.04, 0.1, 0.4])
@pytest.mark.parametrize("time", [2.15, 2.3, 2.5, 2.7])
def test_a_swing_that_is_put_off_does_not_go_beyond_its_target(time, delay):
    """Its glide lasts no longer than a quintic comes to its target from one side; another one would go beyond it."""
    before = swing()
    after = before.retimed(time, delay, 0.02)
    np.testing.assert_allclose(after.evaluate(time)[:2], before.evaluate(time)[:2], atol=1e-9)
    assert after.touchdown_time == pytest.approx(before.touchdown_time + delay)
    way = after.positions(np.linspace(time, after.touchdown_time, 400))[:, 0]
    assert np.diff(way).min() > -1e-9
    assert way.max() < before.target[0] + 1e-9
    assert before.glide_end - 0.02 <= after.glide_end <= before.glide_end + delay + 0.02


def heights(trajectory, time):
    """Height of the sole, its speed and its acceleration, from an instant until the touchdown."""
    times = np.linspace(time, trajectory.touchdown_time - 2e-9, 300).tolist()
    return np.array([trajectory.evaluate(instant)[:, 2] for instant in times])


@pytest.mark.parametrize("left", [0.08, 0.1, 0.14, 0.2, 0.3])
@pytest.mark.parametrize("time", [2.0, 2.1, 2.2, 2.3, 2.5])
def test_a_hurried_swing_is_lifted_and_lowered_no_harder_than_its_leg_can(time, left):
    """Lower in place of harder; all that a foot can do that is high up already is to go down at once."""
    free, bound = (swing(lifting=most).retimed(time, time + left - 2.8, 0.02) for most in (math.inf, 40.0))
    hard, eased = heights(free, time), heights(bound, time)
    np.testing.assert_allclose(eased[0, :2], hard[0, :2], atol=1e-9)
    assert eased[-1, 0] == pytest.approx(0.0, abs=1e-6)
    assert eased[:, 0].min() > -1e-6
    at_once = 1.2 * PEAK * eased[0, 0] / left**2
    assert np.abs(eased[:, 2]).max() < max(40.0, at_once)
    if np.abs(hard[:, 2]).max() < 37.0:
        np.testing.assert_allclose(eased, hard, atol=1e-9)


@pytest.mark.parametrize("delay", [0.1, 0.2, 0.4])
@pytest.mark.parametrize("time", [2.6, 2.7])
def test_a_foot_on_its_way_down_that_gets_more_time_is_lifted_again(time, delay):
    """In place of going on until it meets the ground too early, as one does of which no leg is known."""
    free, bound = (swing(lifting=most).retimed(time, delay, 0.02) for most in (math.inf, 40.0))
    assert bound.touchdown_time == free.touchdown_time == pytest.approx(2.8 + delay)
    meets, clears = heights(free, time)[:, 0], heights(bound, time)[:, 0]
    np.testing.assert_allclose(clears[0], meets[0])
    half = len(meets) // 2
    assert clears[half] > max(0.01, meets[half])
    assert clears.min() > -1e-6


def test_a_swing_that_will_go_beyond_its_target_is_not_hurried_by_a_delay():
    """Moved to two centimetres ahead of it, it can but go beyond and come back, in the time that it has."""
    target = np.array(TARGET)
    target[:2] = swing().evaluate(2.5)[0, :2] + (0.02, 0.0)
    before = swing().retargeted(2.5, target)
    after = before.retimed(2.5, 0.2, 0.02)
    assert after.glide_end == pytest.approx(before.glide_end)
    assert after.touchdown_time == pytest.approx(before.touchdown_time + 0.2)


def test_a_swing_bends_round_a_corner_smoothly_and_lands_as_before():
    straight = swing(0.1)
    corner = np.array([1.25, 0.3])
    bent, times = straight.around(corner, 0.02), np.arange(2.0, 2.7999, 1e-3)
    motion = np.array([bent.evaluate(t) for t in times])
    assert np.abs(bent.evaluate(bent.bend_time)[0, :2] - corner).max() < 1e-9
    assert np.abs(np.diff(motion[:, 2, GLIDING], axis=0)).max() < 0.2
    np.testing.assert_allclose(np.gradient(motion[:, 0], 1e-3, axis=0)[1:-1], motion[1:-1, 1], atol=1e-3)
    np.testing.assert_allclose(bent.positions(times), motion[:, 0], atol=1e-9)
    others = [straight.evaluate(t)[:, 2:] for t in times]
    np.testing.assert_allclose(motion[:, :, 2:], others, atol=1e-12)
    for instant in (2.0, 2.8 - 1e-9):
        np.testing.assert_allclose(bent.evaluate(instant)[:, :2], straight.evaluate(instant)[:, :2], atol=1e-5)
    # No other way through the corner has less jerk: seen from the way it is on, it goes on as it is.
    later = bent.evaluate(2.1)
    again = bent.retargeted(2.1, bent.target).around(corner, 0.02)
    assert again.bend_time == pytest.approx(bent.bend_time, abs=0.021)
    np.testing.assert_allclose(again.evaluate(2.1), later, atol=1e-9)


@pytest.mark.parametrize("bent", [False, True])
def test_quick_looks_at_a_swing_see_what_it_does(bent):
    trajectory = swing(0.1, glide=(2.1, 2.3, 2.6))
    if bent:
        trajectory = trajectory.around(np.array([1.1, 0.3]), 0.02)
        assert trajectory.bent
    times = np.linspace(2.1, 2.79, 70)
    seen = np.array([trajectory.evaluate(time) for time in times.tolist()])
    np.testing.assert_allclose(trajectory.bends(times), seen[:, 2, :2], atol=1e-9)
    if not bent:
        places = trajectory.places(*times.tolist())
        np.testing.assert_allclose(places, seen[:, 0, :2], atol=1e-12)
        assert trajectory.places(3.0) == [tuple(trajectory.target[:2])]


def test_a_braking_foot_is_later_and_at_rest_as_it_touches_down():
    """It comes down faster, and ends its swing nearer to the end of single support."""
    pose, target = np.zeros(6), np.array([0.8, 0.1, 0.0, 0.2, 0.0, 0.0])
    parameters, plain = PlannerParameters(), SwingCourse(0.5, 0.0, 1.0, 0.05)
    braking = replace(plain, braking=6.0, lead=0.25, sinking=0.1)
    smooth, late = (start_swing(Foot.LEFT, (pose, target), (1.0, 21), one, parameters) for one in (plain, braking))
    assert late.touchdown_time == pytest.approx(smooth.touchdown_time + 0.75 * parameters.touchdown_lead)
    end = late.evaluate(late.glide_end - 1e-7)
    gliding = late.glide_end - late.start_time
    np.testing.assert_allclose(end[0, [0, 1, 3]], target[[0, 1, 3]], atol=1e-6)
    np.testing.assert_allclose(end[1, [0, 1, 3]], 0.0, atol=1e-5)
    np.testing.assert_allclose(end[2, [0, 1, 3]], -6.0 * target[[0, 1, 3]] / gliding**2, rtol=1e-4)
    times = np.linspace(1.01, smooth.glide_end - 0.01, 30)
    assert (late.positions(times)[:, 0] < smooth.positions(times)[:, 0]).all()
    down = [swing.evaluate(swing.touchdown_time - 1e-7)[1, 2] for swing in (smooth, late)]
    assert down[1] == pytest.approx(down[0] - 0.1, abs=1e-4)


def made(**changes):
    """A swing from the ground to a step, of half a second that glides for three quarters of it."""
    start, target = np.array([0.0, 0.1, 0.0, 0.2, 0.0, 0.0]), np.array([0.4, 0.15, 0.05, -0.1, 0.0, 0.0])
    course = SwingCourse(0.5, 0.125, 0.875, 0.06)
    return start_swing(Foot.LEFT, (start, target), (1.0, 25), course, PlannerParameters(**changes))


def test_places_and_bends_are_those_of_the_positions():
    """Also before it glides, after it has, and at an instant of its own to rounding."""
    swing, h = made(), 1e-4
    times = [1.0, 1.05, 1.2, swing.glide_end - 1e-12, swing.glide_end, 1.45, swing.touchdown_time - 1e-12, 1.6]
    np.testing.assert_allclose(swing.places(*times), swing.positions(np.array(times))[:, :2], atol=1e-12)
    inside = np.array([1.1, 1.2, 1.3, 1.4])
    around = [swing.positions(inside + d)[:, :2] for d in (-h, 0.0, h)]
    np.testing.assert_allclose(swing.bends(inside), (around[0] - 2.0 * around[1] + around[2]) / h**2, atol=1e-3)
    assert not swing.bends(np.array([swing.glide_end - 1e-12, 1.49])).any()
    bent = made().around(np.array([0.15, 0.2]), 0.02)
    at = np.array([bent.bend_time - 0.01, bent.bend_time + 0.01])
    around = [bent.positions(at + d)[:, :2] for d in (-h, 0.0, h)]
    np.testing.assert_allclose(bent.bends(at), (around[0] - 2.0 * around[1] + around[2]) / h**2, atol=1e-3)


@pytest.mark.parametrize("height", [0.0, 0.05, 0.12])
def test_a_swing_to_another_height_has_its_clearance_over_the_higher_end(height):
    swing = made(touchdown_lead=0.0)
    target = swing.target + (height - 0.05) * np.eye(6)[2]
    moved = swing.retargeted(1.02, target)
    top = moved.positions(np.linspace(1.02, moved.touchdown_time, 2000))[:, 2].max()
    if height != 0.05:
        lifted = swing.positions(np.array([1.02]))[0, 2]
        assert top == pytest.approx(max(lifted, height) + swing.clearance, abs=1e-4)


@pytest.mark.parametrize("delay", [-0.08, 0.1])
def test_what_is_left_of_a_swing_changes_in_proportion(delay):
    """On a grid but for the touchdown; its apex stays as high, and what is over stays."""
    swing, now, grid = made(touchdown_lead=0.0), 1.1, 0.01
    moved = swing.retimed(now, delay, grid)
    share = 1.0 + delay / (swing.touchdown_time - now)
    assert moved.touchdown_time == pytest.approx(swing.touchdown_time + delay)
    assert moved.start_time == now
    for name in ("apex_time", "glide_end"):
        assert getattr(moved, name) == pytest.approx(now + share * (getattr(swing, name) - now), abs=0.5 * grid + 1e-9)
        assert (getattr(moved, name) - now) / grid == pytest.approx(round((getattr(moved, name) - now) / grid))
    tops = [s.positions(np.array([s.apex_time]))[0, 2] for s in (swing, moved)]
    assert tops[0] == pytest.approx(tops[1])
    np.testing.assert_allclose(moved.evaluate(now), swing.evaluate(now), atol=1e-9)


@pytest.mark.parametrize(("time", "duration"), [(0.1, 0.5), (0.3, 0.4), (0.2, 0.4)])
def test_a_detour_is_as_smooth_as_its_least_jerk_makes_it(time, duration):
    """From rest to one and back to rest, without a jump up to the fourth derivative (Euler and Lagrange)."""
    before, after = (np.polynomial.Polynomial(way) for way in detour(time, duration))
    for order in range(3):
        assert before.deriv(order)(0.0) == pytest.approx(0.0, abs=1e-9)
        assert after.deriv(order)(duration - time) == pytest.approx(0.0, abs=1e-7)
    assert after(0.0) == pytest.approx(1.0)
    for order in range(5):
        assert before.deriv(order)(time) == pytest.approx(after.deriv(order)(0.0), rel=1e-9, abs=1e-6)


def test_a_foot_that_searches_has_the_rates_of_its_way():
    """After its touchdown, until it goes down evenly and from then on."""
    swing, h = made(touchdown_lead=0.0), 1e-5
    for late in np.linspace(2.0 * h, 0.2, 23):
        before, now, after = (swing.evaluate(swing.touchdown_time + late + d) for d in (-h, 0.0, h))
        np.testing.assert_allclose(now[1], (after[0] - before[0]) / (2 * h), atol=1e-5)
        np.testing.assert_allclose(now[2], (after[1] - before[1]) / (2 * h), atol=2e-2)
