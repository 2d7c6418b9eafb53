import numpy as np
import pytest

from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.nominal_feet import NominalFeet, swing_of
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.rolling import FootRoll
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit


def moved_soles(samples, schedule):
    """Centres of both soles over a window, shape (2, n, 3)."""
    feet = NominalFeet(len(samples.clock))
    feet.move(len(samples.clock), samples, schedule, (np.eye(2), np.zeros(2)))
    return feet.soles


def test_feet_that_search_for_the_ground_are_expected_to_find_it(schedule):
    """A swing goes on down after its touchdown; planned through the ground, its legs would seem to accelerate."""
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    soles = moved_soles(made.samples, made.schedule)
    assert (made.samples.kind == PhaseKind.SINGLE).any()
    assert soles[..., 2].max() > 0.04
    assert soles[..., 2].min() > -1e-9


@pytest.mark.parametrize(("over", "follows"), [(0.02, True), (-0.01, True), (4e-4, True), (2e-4, False), (0.0, True)])
def test_a_foot_that_lands_higher_or_lower_than_its_swing_was_laid_comes_to_rest_there(schedule, over, follows):
    """A foot that was a sample later where it stands would seem to accelerate; what soles sink is no matter."""
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    place = made.schedule.step(1).place
    moved = made.schedule.moved(1, place.position + np.array([-0.03, 0.0, over]))
    soles = moved_soles(made.samples, moved)
    height = soles[place.foot, :, 2]
    swings = np.flatnonzero([made.samples.phases[k].step == 1 for k in made.samples.which])
    swings = swings[made.samples.kind[swings] == PhaseKind.SINGLE]
    assert height[swings[-1] + 1] == pytest.approx(over, abs=1e-9)
    assert height[swings[-1]] == pytest.approx(over if follows else 0.0, abs=1e-9)
    # Where the foot went off the ground, nothing has changed.
    assert height[swings[0]] == pytest.approx(0.0, abs=1e-9)


def test_in_a_frame_that_is_turned_and_moved_feet_are_turned_and_moved(schedule):
    turn, origin = 0.4, np.array([0.3, -0.2])
    R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    world, framed = NominalFeet(len(made.samples.clock)), NominalFeet(len(made.samples.clock))
    world.move(len(made.samples.clock), made.samples, made.schedule, (np.eye(2), np.zeros(2)))
    framed.move(len(made.samples.clock), made.samples, made.schedule, (R, origin))
    np.testing.assert_allclose(framed.heading, world.heading - turn, atol=1e-12)
    np.testing.assert_allclose(framed.soles[..., :2], (world.soles[..., :2] - origin) @ R, atol=1e-12)
    np.testing.assert_array_equal(framed.soles[..., 2], world.soles[..., 2])


@pytest.fixture
def climbing(stand):
    """A walk that turns, up steps whose heels lift, and its samples."""
    gait = GaitParameters(
        steps=4, step_length=0.3, turn=0.05, single_support=1.2, double_support=0.3, swing_height=0.12, heel_off=0.4,
        initial_stand=0.1,
    )  # fmt: skip
    stairs = Stairs(0.05, 0.3, 4, Direction.UP, start=0.15, landing=1.0, beyond=2.0).build(Site(np.zeros(2), 0.0, 0.8))
    ground = Ground(stairs, np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    made = Schedule.start(gait, stand(gait.step_width), ground).extended(np.inf)
    return made, made.samples(np.arange(round(made.phases[-1].start), dtype=float))


def test_a_foot_goes_as_its_swing_from_one_place_to_the_next(climbing):
    """Its share of way and turn is that of the swing of a metre, and its height that over the place before."""
    schedule, samples = climbing
    feet = NominalFeet(len(samples.clock))
    feet.move(len(samples.clock), samples, schedule, (np.eye(2), np.zeros(2)))
    looked = 0
    for k, number in enumerate(samples.which):
        phase = samples.phases[number]
        if phase.kind is not PhaseKind.SINGLE:
            continue
        swing, late = swing_of(phase, schedule, samples.elapsed[k])
        time = (samples.elapsed[k] - late) * 0.02
        if time >= swing.touchdown_time:
            continue
        step = schedule.step(phase.step)
        foot, number = step.place.foot, phase.step
        before, after = schedule.step(number - 2).place, step.place
        progress, _, height = swing.positions(np.array([time]))[0, :3]
        way = before.position + progress * (after.position - before.position)
        np.testing.assert_allclose(feet.soles[foot, k, :2], way[:2], atol=1e-9)
        over = after.position[2] - before.position[2] - swing.target[2]
        assert feet.soles[foot, k, 2] == pytest.approx(before.position[2] + height + progress * over, abs=1e-3)
        assert feet.heading[foot, k] == pytest.approx(before.yaw + progress * (after.yaw - before.yaw))
        looked += 1
    assert looked > 100 and abs(feet.heading).max() > 0.1


def test_a_foot_that_rolls_is_pitched_between_two_instants(climbing):
    schedule, samples = climbing
    feet = NominalFeet(len(samples.clock))
    feet.move(len(samples.clock), samples, schedule, (np.eye(2), np.zeros(2)))
    expected = np.zeros_like(feet.pitch)
    for k, number in enumerate(samples.which):
        for foot, start, over, angle in samples.phases[number].rolls:
            expected[foot, k] += FootRoll(foot, start, over, angle, 0.1).evaluate(samples.clock[k])[0]
    np.testing.assert_allclose(feet.pitch, expected, atol=1e-12)
    assert expected.max() > 0.3


@pytest.mark.parametrize(("elapsed", "late"), [(3.0, 0.0), (3.0 - 1e-12, 0.0), (3.0 + 1e-12, 0.0), (3.25, 0.25)])
def test_a_foot_that_a_plan_lifts_swings_as_its_step_was_laid(climbing, elapsed, late):
    """To rounding; one that is lifted between two plans has less time."""
    schedule, samples = climbing
    phase = next(phase for phase in samples.phases if phase.kind is PhaseKind.SINGLE)
    swing, after = swing_of(phase, schedule, elapsed)
    assert after == late and (swing is schedule.step(phase.step).swing) is (late == 0.0)
