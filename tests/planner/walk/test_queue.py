from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.types import Foot, PhaseKind
from surefoot.planner.walk.commands import Twist
from surefoot.planner.walk.gait import Bout, GaitParameters, Stride
from surefoot.planner.walk.phases import Flow
from surefoot.planner.walk.queue import StepQueue
from surefoot.planner.walk.reach import StepRegion
from surefoot.planner.walk.source import CommandSource, GaitSource
from surefoot.planner.walk.step import Ground

pytestmark = pytest.mark.unit


@pytest.fixture
def stop_and_go():
    """Three strides, standing for a second, two more without a stop before them, and two after half a second."""
    stride = Stride(0.2, 0.0, 0.0, 0.2)
    bouts = (Bout(1.0, (stride,) * 3), Bout(1.0, (stride,) * 2), Bout(0.0, (stride,)), Bout(0.5, (stride,) * 2))
    return GaitParameters(steps=8, bouts=bouts)


@pytest.mark.parametrize("steps", [0, 1, 2, 7])
@pytest.mark.parametrize("stand", [0.0, 1.0])
def test_phases_cover_the_clock_without_gaps(schedule, steps, stand):
    plan = schedule(GaitParameters(steps=steps, initial_stand=stand))
    assert plan.phases[0].start == 0
    assert all(a.end == b.start for a, b in zip(plan.phases, plan.phases[1:], strict=False))
    assert [p.kind for p in plan.phases].count(PhaseKind.SINGLE) == steps
    assert plan.phases[-1].kind is PhaseKind.STAND
    assert plan.queue.phase(plan.last + 10_000) is plan.phases[-1]


def test_support_progress_is_continuous_and_never_goes_back(schedule):
    plan = schedule(GaitParameters(steps=4))
    progress = plan.samples.index + plan.samples.fraction
    assert np.all(np.diff(progress) >= 0.0)
    assert np.diff(progress).max() == pytest.approx(0.02 / 0.5)
    assert progress[0] == 0.0
    assert progress[-1] == 5.0


def test_one_foot_carries_all_in_single_support_and_load_is_continuous(schedule):
    plan = schedule(GaitParameters(steps=3))
    for phase in plan.phases:
        if phase.kind is PhaseKind.SINGLE:
            span = slice(round(phase.start), round(phase.end))
            assert np.all(plan.load_left[span] == float(phase.stance == 0))
            assert not plan.samples.contacts[span, phase.stance.other].any()
    assert np.abs(np.diff(plan.load_left)).max() <= 0.04 + 1e-12
    assert plan.load_left[0] == plan.load_left[-1] == 0.5


def test_first_double_support_rests_for_half_of_it(schedule):
    plan = schedule(GaitParameters(initial_stand=1.0, double_support=0.5))
    assert np.all(plan.samples.fraction[:76] == 0.0)
    assert plan.samples.fraction[76] > 0.0


def test_bouts_stand_between_the_feet_and_start_again_with_a_long_double_support(schedule, stop_and_go):
    plan = schedule(stop_and_go)
    rows = plan.steps.supports
    kinds = "".join("SDs"[phase.kind] for phase in plan.phases)
    assert kinds == "SD" + 3 * "sD" + "SD" + 2 * "sD" + "D" + "sD" + "SD" + 2 * "sD" + "S"
    assert rows[:, 0].tolist() == [0, 1, 2, 3, 3, 4, 5, 5, 6, 6, 7, 8, 8]
    assert (rows[:, 1] - rows[:, 0]).tolist() == [1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1]
    for number, phase in enumerate(plan.phases):
        span = plan.samples.which == number
        one, other = rows[phase.support]
        assert np.all(plan.samples.index[span] == phase.support)
        assert other == phase.step + (phase.stance is None and one != other)
        if phase.kind is PhaseKind.STAND:
            assert one != other
            assert np.all(plan.samples.fraction[span] == 0.0)
            assert np.all(plan.load_left[span] == 0.5)
        elif phase.kind is PhaseKind.SINGLE:
            assert one == other
            assert np.all(plan.load_left[span] == float(phase.stance == 0))
        else:
            assert phase.samples == (50 if one != other else 25)
            assert phase.rest == (25 if one != other else 0)


def test_progress_and_load_stay_continuous_over_stops(schedule, stop_and_go):
    plan = schedule(stop_and_go)
    progress = plan.samples.index + plan.samples.fraction
    assert np.diff(progress).min() >= 0.0
    assert np.diff(progress).max() == pytest.approx(0.02 / 0.5)
    assert progress[-1] == len(plan.steps.supports) - 1
    assert np.abs(np.diff(plan.load_left)).max() <= 0.04 + 1e-12
    assert np.all(plan.samples.contacts.any(axis=1))
    assert np.all(plan.samples.contacts[plan.samples.fraction > 0.0])


def test_one_bout_of_equal_strides_is_the_plain_gait(schedule):
    plain = GaitParameters(steps=4, lateral_step=0.05, turn=0.1)
    same = GaitParameters(steps=4, bouts=plain.walk)
    assert same.walk == plain.walk
    assert schedule(same).phases == schedule(plain).phases


GROUND = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))


class Counted(GaitSource):
    """The steps of a gait, counting those that were asked for."""

    asked = 0

    def order(self, at):
        self.asked = max(self.asked, at.step)
        return super().order(at)


@pytest.mark.parametrize("single", [0.3, 0.637])
def test_a_short_queue_says_what_the_whole_walk_says(schedule, stand, stop_and_go, single):
    """Whatever has been let go of and is not there yet, no window of a plan sees a difference."""
    for gait in (
        GaitParameters(steps=12, single_support=single, turn=0.1),
        replace(stop_and_go, single_support=single),
    ):
        whole, short = schedule(gait), StepQueue(gait, stand(gait.step_width), GROUND)
        for clock in range(0, whole.last + 20, 7):
            short.extend(clock + 160)
            short.enter(clock)
            flow = Flow(np.maximum(clock + np.arange(-1.0, 155.0), 0.0))
            seen, all_of_it = short.samples(flow), whole.queue.samples(flow)
            np.testing.assert_array_equal(seen.index + seen.first, all_of_it.index)
            for name in ("fraction", "fraction_rate", "elapsed", "length", "kind", "contacts"):
                np.testing.assert_array_equal(getattr(seen, name), getattr(all_of_it, name))
            for beyond in (0, 1):
                points = short.footsteps.support_points(), whole.steps.support_points()
                here, there = (
                    of[np.minimum(samples.index + beyond, len(of) - 1)]
                    for of, samples in zip(points, (seen, all_of_it), strict=True)
                )
                np.testing.assert_allclose(here, there, atol=1e-12)


def test_a_queue_stays_as_long_as_what_a_plan_sees(stand):
    gait, sizes = GaitParameters(steps=10**6, single_support=0.5, double_support=0.12, initial_stand=0.0), []
    source = Counted(gait)
    queue = StepQueue(gait, stand(gait.step_width), GROUND, source)
    for clock in range(0, 60 * 31, 31):
        queue.extend(clock + 160)
        queue.enter(clock)
        sizes.append((len(queue.phases), len(queue.steps), len(queue.footsteps.feet), len(queue.footsteps.supports)))
    assert max(map(max, sizes)) <= 24
    assert sizes[20:40] == sizes[40:]
    assert source.asked <= 60 + 10


def test_footholds_in_sight_shift_with_the_one_that_landed_elsewhere(stand):
    """Those that come into sight later too, by the increments of the nominal path."""
    gait, offset = GaitParameters(steps=20, single_support=0.5, double_support=0.12, initial_stand=0.0), (0.03, -0.02)
    plain, moved = (StepQueue(gait, stand(gait.step_width), GROUND) for _ in range(2))
    moved.extend(160.0)
    place = moved.footsteps.position[2] + np.array([*offset, 0.0])
    moved.footsteps = moved.footsteps.moved(2, place, flat())
    for queue in (plain, moved):
        queue.extend(400.0)
    shift = moved.footsteps.position[2:, :2] - plain.footsteps.position[2:, :2]
    assert len(shift) > 10
    np.testing.assert_allclose(shift, np.tile(offset, (len(shift), 1)), atol=1e-12)


def test_a_stop_is_made_once_its_last_foot_swings(stand):
    """Told to go on then, the robot shifts its weight anew; told so before, it steps on."""
    gait = GaitParameters(steps=2, single_support=0.8, double_support=0.3, initial_stand=0.0)
    source = CommandSource(gait, StepRegion(0.4, (0.08, 0.4), (0.075, 0.075)), Twist(0.1))
    kinds = []
    for number in (1, 2):
        queue = StepQueue(gait, stand(gait.step_width), GROUND)
        queue.extend(1000.0)
        queue.reorder(queue.lift_off(number), source)
        queue.extend(1000.0)
        after = queue.phases[queue.phases.index(queue.lift_off(2)) :]
        kinds.append("".join(phase.kind.name[0] for phase in after[:4]))
        assert bool(after[2].rest or after[3].rest) is (number == 2)
    assert kinds[0] == "SDSD"
    assert kinds[1].startswith("SDD")


def test_who_goes_on_without_standing_does_not_stop(schedule, stop_and_go):
    """Between two bouts with no time to stand there are two double supports."""
    queue = schedule(stop_and_go).queue
    kinds = "".join(phase.kind.name[0] if phase.kind is not PhaseKind.STAND else "-" for phase in queue.phases)
    assert kinds == "-DSDSDSD-DSDSDDSD-DSDSD-"
    stopping = [at for at, phase in enumerate(queue.phases) if queue.stops(phase)]
    # From the double support before the last step of a bout on.
    assert stopping == [0, 5, 6, 7, 8, 14, 15, 16, 17, 20, 21, 22, 23]


@pytest.mark.parametrize("foot", [Foot.LEFT, Foot.RIGHT])
def test_a_robot_that_stands_steps_with_either_foot(stand, foot):
    gait = GaitParameters(steps=2, step_length=0.3, single_support=0.5, double_support=0.12, initial_stand=9.0)
    queue = StepQueue(gait, stand(gait.step_width), Ground(flat(), np.array([0.11, 0.055]), PlannerParameters()))
    queue.extend(50.0)
    before = queue.footsteps.support_points()[0]
    queue.go_on(queue.phase(10.0), foot)
    queue.extend(1000.0, 10.0)
    stand_, double, swing, _ = queue.phases[:4]
    assert (stand_.start, double.start, swing.start, swing.end) == (0.0, 10.0, 16.0, 41.0)
    assert [phase.kind for phase in (stand_, double, swing)] == [PhaseKind.STAND, PhaseKind.DOUBLE, PhaseKind.SINGLE]
    assert swing.stance is foot.other
    steps = queue.footsteps
    assert steps.feet == (foot, foot.other, foot, foot.other, foot)
    np.testing.assert_allclose(steps.support_points()[0], before)
    # On the spot, and then the steps of the gait after its stand.
    start = stand(gait.step_width).position
    np.testing.assert_allclose(steps.position[:3], start[[foot, foot.other, foot]])
    np.testing.assert_allclose(steps.position[3:, 0], [0.3, 0.3])
    assert [phase.kind for phase in queue.phases[4:6]] == [PhaseKind.STAND, PhaseKind.DOUBLE]


def test_a_foot_left_far_behind_rolls_as_it_leaves_the_ground(stand):
    """From 1.1 radii on; the last foot of a walk stays."""
    gait = GaitParameters(steps=3, step_length=0.5, single_support=0.5, double_support=0.12, initial_stand=0.0)
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.6))
    for step, radius, angle in ((1, 0.5, None), (1, 0.4, 0.18), (1, 0.2, 0.5), (3, 0.2, None)):
        queue = StepQueue(gait, stand(gait.step_width), ground)
        queue.extend(1000.0)
        queue.lift_heel(step, radius)
        double, after = queue.phases[queue.phases.index(queue.lift_off(step)) + 1 :][:2]
        assert (double.roll is None) is (angle is None)
        assert after.roll == double.roll
        if angle is not None:
            assert double.roll.angle == pytest.approx(angle, abs=1e-9)
            assert double.start < double.roll.start < double.end < double.roll.end < after.end


@pytest.mark.parametrize(("apart", "farther"), [(0.2, 1), (0.1, 1), (0.6, 3), (0.9, 4.5)])
def test_who_brings_its_feet_together_at_leisure_shifts_its_weight_as_long_as_it_is_wide(stand, apart, farther):
    """At once it does so in the time of any step, and at rest in twice that, and in more from feet that are astride."""
    gait = GaitParameters(steps=0, single_support=0.5, double_support=0.12)
    for at_once, lasts in ((True, 6.0), (False, 6.0 + 6.0 * farther)):
        queue = StepQueue(gait, stand(gait.step_width), Ground(flat(), np.array([0.11, 0.055]), PlannerParameters()))
        queue.extend(50.0)
        aside = queue.footsteps.position[1] * (1.0, (apart - 0.1) / 0.1, 1.0)
        queue.footsteps = queue.footsteps.moved(1, aside, flat())
        queue.go_on(queue.phase(10.0), at_once=at_once)
        queue.extend(1000.0, 10.0)
        double = queue.phases[1]
        assert (double.kind, double.samples) == (PhaseKind.DOUBLE, pytest.approx(lasts))
        assert double.rest == pytest.approx(0.0 if at_once else 6.0)
