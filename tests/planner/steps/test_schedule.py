from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.adaptation import with_foot_again, with_heel_lifted, with_step_in_place, with_steps_repeated
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import CommandSource, GaitSource
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Foot, PhaseKind, Twist

pytestmark = pytest.mark.unit


@pytest.fixture
def stop_and_go():
    """Three strides, standing for a second, two more without a stop before them, and two after half a second."""
    stride = Twist(0.2, width=0.2)
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
    assert plan.schedule.phase(plan.last + 10_000) is plan.phases[-1]


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
    rows = plan.schedule.supports
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
    assert progress[-1] == len(plan.schedule.supports) - 1
    assert np.abs(np.diff(plan.load_left)).max() <= 0.04 + 1e-12
    assert np.all(plan.samples.contacts.any(axis=1))
    assert np.all(plan.samples.contacts[plan.samples.fraction > 0.0])


def test_one_bout_of_equal_strides_is_the_plain_gait(schedule):
    plain = GaitParameters(steps=4, lateral_step=0.05, turn=0.1)
    same = GaitParameters(steps=4, bouts=plain.walk)
    assert same.walk == plain.walk
    assert schedule(same).phases == schedule(plain).phases


GROUND = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
NEAR = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters())


class Counted:
    """The steps of a source, counting those that were asked for."""

    def __init__(self, source):
        self.source, self.asked = source, 0

    def __getattr__(self, name):
        return getattr(self.source, name)

    def order(self, step, *where):
        self.asked = max(self.asked, step)
        return self.source.order(step, *where)


@pytest.mark.parametrize("single", [0.3, 0.637])
def test_the_steps_in_sight_say_what_the_whole_walk_says(schedule, stand, stop_and_go, single):
    """Whatever has been let go of and is not there yet, no window of a plan sees a difference."""
    for gait in (
        GaitParameters(steps=12, single_support=single, turn=0.1),
        replace(stop_and_go, single_support=single),
    ):
        whole, short = schedule(gait), Schedule.start(gait, stand(gait.step_width), GROUND)
        for clock in range(0, whole.last + 20, 7):
            short = short.extended(clock + 160).forgotten(clock)
            shown = np.maximum(clock + np.arange(-1.0, 155.0), 0.0)
            seen, all_of_it = short.samples(shown), whole.schedule.samples(shown)
            np.testing.assert_array_equal(seen.index + seen.first, all_of_it.index)
            for name in ("fraction", "fraction_rate", "elapsed", "length", "kind", "contacts"):
                np.testing.assert_array_equal(getattr(seen, name), getattr(all_of_it, name))
            for beyond in (0, 1):
                points = short.support_points, whole.schedule.support_points
                here, there = (
                    of[np.minimum(samples.index + beyond, len(of) - 1)]
                    for of, samples in zip(points, (seen, all_of_it), strict=True)
                )
                np.testing.assert_allclose(here, there, atol=1e-12)


def test_a_schedule_stays_as_long_as_what_a_plan_sees(stand):
    gait, sizes = GaitParameters(steps=10**6, single_support=0.5, double_support=0.12, initial_stand=0.0), []
    source = Counted(GaitSource(gait))
    schedule = Schedule.start(gait, stand(gait.step_width), GROUND, source)
    for clock in range(0, 60 * 31, 31):
        schedule = schedule.extended(clock + 160).forgotten(clock)
        sizes.append((len(schedule.phases), len(schedule.steps), len(schedule.supports)))
    assert max(map(max, sizes)) <= 24
    assert sizes[20:40] == sizes[40:]
    assert source.asked <= 60 + 10


def test_footholds_in_sight_shift_with_the_one_that_landed_elsewhere(stand):
    """Footholds that come into sight later shift, too, by the increments of the nominal path."""
    gait, offset = GaitParameters(steps=20, single_support=0.5, double_support=0.12, initial_stand=0.0), (0.03, -0.02)
    plain = Schedule.start(gait, stand(gait.step_width), GROUND).extended(160.0)
    moved = plain.moved(1, plain.step(1).place.position + np.array([*offset, 0.0]))
    shift = moved.extended(400.0).positions[2:, :2] - plain.extended(400.0).positions[2:, :2]
    assert len(shift) > 10
    np.testing.assert_allclose(shift, np.tile(offset, (len(shift), 1)), atol=1e-12)


def test_a_stop_is_made_once_its_last_foot_swings(stand):
    """Told to go on then, the robot shifts its weight anew; told so before, it steps on."""
    gait = GaitParameters(steps=2, single_support=0.8, double_support=0.3, initial_stand=0.0)
    source = CommandSource(gait, StepRegion(0.4, (0.08, 0.4), (0.075, 0.075)), Twist(0.1))
    kinds = []
    for number in (1, 2):
        schedule = Schedule.start(gait, stand(gait.step_width), GROUND).extended(1000.0)
        schedule = schedule.reordered(schedule.step(number).lift_off, source).extended(1000.0)
        after = schedule.following(schedule.step(2).lift_off)
        kinds.append("".join(phase.kind.name[0] for phase in after[:4]))
        assert bool(after[2].rest or after[3].rest) is (number == 2)
    assert kinds[0] == "SDSD"
    assert kinds[1].startswith("SDD")


def test_who_goes_on_without_standing_does_not_stop(schedule, stop_and_go):
    """Between two bouts with no time to stand there are two double supports."""
    whole = schedule(stop_and_go).schedule
    kinds = "".join(phase.kind.name[0] if phase.kind is not PhaseKind.STAND else "-" for phase in whole.phases)
    assert kinds == "-DSDSDSD-DSDSDDSD-DSDSD-"
    stopping = [at for at, phase in enumerate(whole.phases) if whole.stops(phase.start)]
    # From the double support before the last step of a bout on.
    assert stopping == [0, 5, 6, 7, 8, 14, 15, 16, 17, 20, 21, 22, 23]


@pytest.mark.parametrize("foot", [Foot.LEFT, Foot.RIGHT])
def test_a_robot_that_stands_steps_with_either_foot(stand, foot):
    gait = GaitParameters(steps=2, step_length=0.3, single_support=0.5, double_support=0.12, initial_stand=9.0)
    schedule = Schedule.start(gait, stand(gait.step_width), NEAR).extended(50.0)
    before = schedule.support_points[0]
    schedule = with_step_in_place(schedule, 10.0, foot).extended(1000.0, 10.0)
    stand_, double, swing, _ = schedule.phases[:4]
    assert (stand_.start, double.start, swing.start, swing.end) == (0.0, 10.0, 16.0, 41.0)
    assert [phase.kind for phase in (stand_, double, swing)] == [PhaseKind.STAND, PhaseKind.DOUBLE, PhaseKind.SINGLE]
    assert swing.stance is foot.other
    assert [step.place.foot for step in schedule.steps] == [foot, foot.other, foot, foot.other, foot]
    np.testing.assert_allclose(schedule.support_points[0], before)
    # On the spot, and then the steps of the gait after its stand.
    start = stand(gait.step_width).position
    np.testing.assert_allclose(schedule.positions[:3], start[[foot, foot.other, foot]])
    np.testing.assert_allclose(schedule.positions[3:, 0], [0.3, 0.3])
    assert [phase.kind for phase in schedule.phases[4:6]] == [PhaseKind.STAND, PhaseKind.DOUBLE]


def test_a_foot_that_steps_twice_comes_down_where_it_was_and_the_walk_goes_on(stand):
    gait = GaitParameters(steps=4, step_length=0.3, single_support=0.5, double_support=0.12, initial_stand=0.0)
    plain = Schedule.start(gait, stand(gait.step_width), NEAR).extended(1000.0)
    schedule = with_foot_again(plain, 2).extended(1000.0)
    later = schedule.after(2)
    assert [step.place.foot for step in later] == [Foot.RIGHT, Foot.LEFT, Foot.RIGHT]
    assert [step.inserted for step in later] == [True, False, False]
    np.testing.assert_allclose(later[0].place.position, plain.step(2).place.position)
    np.testing.assert_allclose(later[-1].place.position[0], plain.step(4).place.position[0])
    # The weight stays on the foot that would have gone, in phases that last as long as any.
    assert schedule.step(2).place.foot is Foot.LEFT
    np.testing.assert_allclose(schedule.step(2).place.position, plain.step(1).place.position)
    assert [phase.samples for phase in schedule.phases[:5]] == [phase.samples for phase in plain.phases[:5]]


def test_a_foot_that_steps_twice_after_a_wider_step_comes_down_where_it_was(stand):
    """And not as far beside the path as the gait's own width, which may be too near to the other foot."""
    gait = GaitParameters(bouts=(Bout(0.0, (Twist(0.2, width=0.3),) * 3),), steps=3)
    plain = Schedule.start(gait, stand(gait.step_width), NEAR).extended(1000.0)
    again = with_foot_again(plain, 2).after(2)[0]
    np.testing.assert_allclose(again.place.position, plain.step(2).place.position)
    last = plain.step(3).place
    in_place = with_step_in_place(plain, plain.last.end + 10.0, last.foot).after(3)[0]
    assert in_place.place.foot is last.foot
    np.testing.assert_allclose(in_place.place.position, last.position)


def test_a_foot_left_far_behind_rolls_as_it_leaves_the_ground(stand):
    """From 1.1 radii on; the last foot of a walk stays."""
    gait = GaitParameters(steps=3, step_length=0.5, single_support=0.5, double_support=0.12, initial_stand=0.0)
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.6))
    for step, radius, angle in ((1, 0.5, None), (1, 0.4, 0.18), (1, 0.2, 0.5), (3, 0.2, None)):
        plain = Schedule.start(gait, stand(gait.step_width), ground).extended(1000.0)
        schedule = with_heel_lifted(plain, step, radius)
        double, after = schedule.following(schedule.step(step).touchdown)[:2]
        assert len(double.rolls) == (angle is not None)
        assert after.rolls == double.rolls
        for roll in double.rolls:
            assert roll.angle == pytest.approx(angle, abs=1e-9)
            assert double.start < roll.start < double.end < roll.end < after.end


@pytest.mark.parametrize(("apart", "farther"), [(0.2, 1), (0.1, 1), (0.6, 3), (0.9, 4.5)])
def test_who_brings_its_feet_together_at_leisure_shifts_its_weight_as_long_as_it_is_wide(stand, apart, farther):
    """At once it does so in the time of any step, and at rest in twice that, and in more from feet that are astride."""
    gait = GaitParameters(steps=0, single_support=0.5, double_support=0.12)
    for at_once, lasts in ((True, 6.0), (False, 6.0 + 6.0 * farther)):
        schedule = Schedule.start(gait, stand(gait.step_width), NEAR).extended(50.0)
        schedule = schedule.moved(0, schedule.step(0).place.position * (1.0, (apart - 0.1) / 0.1, 1.0))
        double = with_step_in_place(schedule, 10.0, at_once=at_once).extended(1000.0, 10.0).phases[1]
        assert (double.kind, double.samples) == (PhaseKind.DOUBLE, pytest.approx(lasts))
        assert double.rest == pytest.approx(0.0 if at_once else 6.0)


PLAIN = GaitParameters(steps=40, step_length=0.2, single_support=0.5, double_support=0.12, initial_stand=0.1)
clocks = st.floats(0.0, 400.0)
ratios = st.floats(0.6, 1.6)
gaits = st.builds(
    lambda single, double: replace(PLAIN, single_support=0.5 * single, double_support=0.12 * double), ratios, ratios
)
ways = st.tuples(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05))


def seen_from(stand, clock, gait=PLAIN):
    """The schedule of a walk when its clock shows an instant."""
    return Schedule.start(gait, stand(), GROUND).extended(clock + 160.0).forgotten(clock)


def next_to_land(schedule, clock):
    return schedule.phase(clock).leaves


def assert_whole(schedule):
    """Phases without gaps, steps without gaps whose feet alternate, and as many support points as phases name."""
    assert all(a.end == b.start and a.samples > 0.0 for a, b in pairwise(schedule.phases))
    assert all(b.number == a.number + 1 and b.place.foot is a.place.foot.other for a, b in pairwise(schedule.steps))
    named = schedule.phases[-1].support - schedule.first_support + 1
    assert named == len(schedule.supports)
    for phase in schedule.phases:
        one, other = (schedule.steps[at].number for at in schedule.supports[phase.support - schedule.first_support])
        if phase.kind is PhaseKind.SINGLE:
            assert one == other == phase.step - 1
            assert schedule.step(one).place.foot is phase.stance


OPERATIONS = st.one_of(
    st.tuples(st.just("extend"), st.floats(0.0, 200.0)),
    st.tuples(st.just("forget"), st.floats(0.0, 60.0)),
    st.tuples(st.just("retime"), gaits),
    st.tuples(st.just("move"), ways),
    st.tuples(st.just("repeat"), st.none()),
    st.tuples(st.just("reorder"), st.none()),
    st.tuples(st.just("in place"), st.booleans()),
)


def changed(schedule, now, operation, given):
    """The schedule after an operation, and what the clock shows then."""
    number = next_to_land(schedule, now)
    if operation == "extend":
        return schedule.extended(now + given, now), now
    if operation == "forget":
        return schedule.extended(now + given + 160.0, now).forgotten(now + given), now + given
    if operation == "retime":
        return schedule.retimed(replace(given, first_foot=schedule.gait.first_foot), now), now
    if operation == "move":
        return schedule.moved(number, schedule.step(number).place.position + np.array([*given, 0.0])), now
    if operation == "repeat":
        return with_steps_repeated(schedule, number).extended(now + 160.0, now), now
    if operation == "in place" and schedule.stops(now):
        return with_step_in_place(schedule, now, at_once=given).extended(now + 160.0, now), now
    return schedule.reordered(now).extended(now + 160.0, now), now


@settings(max_examples=60)
@given(operations=st.lists(OPERATIONS, min_size=1, max_size=8))
def test_whatever_is_done_to_a_schedule_leaves_another_whole_one_and_the_first_as_it_was(stand, operations):
    now, schedule = 0.0, seen_from(stand, 0.0)
    for operation, given_ in operations:
        before, present = (schedule.phases, schedule.positions.tobytes()), schedule.phase(now)
        after, later = changed(schedule, now, operation, given_)
        assert (replace(schedule).phases, replace(schedule).positions.tobytes()) == before
        assert_whole(after)
        if later == now:
            # The present phase began when it did, whatever comes after it.
            assert after.phase(now).start == present.start or operation == "in place"
        schedule, now = after, later


@given(clock=clocks, gait=gaits)
@settings(max_examples=40)
def test_steps_that_are_retimed_keep_their_order_and_what_has_begun(stand, clock, gait):
    before = seen_from(stand, clock)
    after, present = before.retimed(gait, clock), before.phase(clock)
    for a, b in zip(before.phases, after.phases, strict=True):
        assert (a.kind, a.step, a.support, a.stance) == (b.kind, b.step, b.support, b.stance)
        if a.start <= present.start:
            assert (a.start, a.samples, a.rest) == (b.start, b.samples, b.rest)
        elif a.kind is PhaseKind.SINGLE:
            assert b.samples == pytest.approx(gait.single_support / 0.02)
    np.testing.assert_array_equal(after.positions, before.positions)
    again = after.retimed(PLAIN, clock)
    assert [phase.samples for phase in again.phases] == pytest.approx([phase.samples for phase in before.phases])


@given(clock=clocks, way=ways)
@settings(max_examples=40)
def test_a_step_lands_where_it_is_moved_and_those_before_it_stay(stand, clock, way):
    before, offset = seen_from(stand, clock), np.array([*way, 0.0])
    number = next_to_land(before, clock)
    at = before.index(number)
    after = before.moved(number, before.step(number).place.position + offset)
    shifts = np.outer(np.arange(len(before.steps)) >= at, offset)
    np.testing.assert_allclose(after.positions - before.positions, shifts, atol=1e-12)
    assert after.steps[:at] == before.steps[:at]
    assert all(a.nominal is b.nominal for a, b in zip(after.steps, before.steps, strict=True))
    back = after.moved(number, before.step(number).place.position)
    np.testing.assert_allclose(back.positions, before.positions, atol=1e-12)
    np.testing.assert_allclose(back.shift, before.shift, atol=1e-12)


@given(clock=clocks)
@settings(max_examples=40)
def test_steps_that_are_inserted_and_dropped_again_leave_the_walk_as_it_was(stand, clock):
    before = seen_from(stand, clock)
    number = next_to_land(before, clock)
    inserted = with_steps_repeated(before, number).extended(clock + 160.0, clock)
    assert [step.inserted for step in inserted.after(number)][:3] == [True, True, False]
    # Steps of the source that come after the inserted ones are those that came before, two later.
    for earlier, later in zip(before.after(number), inserted.after(number + 2), strict=False):
        assert (earlier.ordinal, earlier.stride) == (later.ordinal, later.stride)
        np.testing.assert_allclose(later.place.position, earlier.place.position, atol=1e-12)
    # Asked anew, a source that is the same goes on after the inserted steps, and another one drops them.
    kept, dropped = inserted.reordered(clock), inserted.reordered(clock, GaitSource(PLAIN))
    assert sum(step.inserted for step in kept.steps) == 2
    assert not any(step.inserted for step in dropped.steps)
    assert dropped.steps[:-1] == before.steps[: len(dropped.steps) - 1]


@pytest.mark.parametrize("again", [1, 2, 3])
def test_steps_inserted_once_more_take_the_place_of_those_not_yet_made(stand, again):
    """While none, one or both of two inserted steps have been made; the gait goes on with all of its steps."""
    gait = replace(PLAIN, steps=4, step_length=0.3)
    schedule = with_steps_repeated(Schedule.start(gait, stand(), GROUND).extended(1000.0), 1)
    schedule = with_steps_repeated(schedule, again).extended(1000.0)
    strides = [step.stride.x for step in schedule.after(0) if not step.inserted]
    assert strides == [0.3, 0.3, 0.3, 0.0]
    assert sum(step.inserted for step in schedule.steps) == again - 1 + 2
    assert [step.ordinal for step in schedule.steps if not step.inserted] == [-1, 0, 1, 2, 3, 4]
