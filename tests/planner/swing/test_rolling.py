from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from surefoot.planner.flight import swinging_to, upcoming
from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.ground.terrain import flat
from surefoot.planner.measured import Measured
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.references.nominal_feet import NominalFeet
from surefoot.planner.state import WalkState
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.rolling import FootRoll, bump, heel_strike, landing_pitch, stretched, toe_off
from surefoot.planner.track import advanced
from surefoot.planner.types import CentroidalState, Edge, Foot, Footstep, PhaseKind
from surefoot.planner.walk_model import WalkModel

pytestmark = pytest.mark.unit

GAIT = GaitParameters(
    steps=4, step_length=0.4, single_support=0.4, double_support=0.1, initial_stand=0.1, com_height=0.95, heel_off=0.5
)


@pytest.fixture
def walk(schedule):
    return schedule(GAIT)


def test_bump_starts_and_ends_at_rest_with_one_in_the_middle():
    assert bump(0.5) == pytest.approx((1.0, 0.0, -24.0))
    for s in (0.0, 1.0, -0.1, 1.1):
        assert bump(s) == (0.0, 0.0, 0.0)
    assert np.abs(bump(1e-6)).max() < 1e-3


def test_rates_of_a_roll_are_its_derivatives():
    roll, h = FootRoll(Foot.LEFT, 1.0, 1.3, 0.5, 0.11), 1e-5
    for time in (1.02, 1.1, 1.25):
        before, now, after = (roll.evaluate(time + d) for d in (-h, 0.0, h))
        assert now[1] == pytest.approx((after[0] - before[0]) / (2 * h), rel=1e-5)
        assert now[2] == pytest.approx((after[1] - before[1]) / (2 * h), rel=1e-5)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_centre_of_a_rolled_sole_keeps_the_edge_where_it_was(side):
    """Its velocity is the derivative of its way, and a foot turned about its edge by hand has it there."""
    roll, h = FootRoll(Foot.LEFT, 1.0, 1.3, side * 0.5, side * 0.11), 1e-5
    assert roll.edge is (Edge.TOE if side > 0.0 else Edge.HEEL)
    level, rates = np.array([0.3, 0.1, 0.02, 0.7, 0.1, -0.05]), np.array([1.0, 0.2, 0.5, 0.3, -0.4, 0.2])
    before, now, after = (roll.centre(1.2 + d, level + d * rates, rates) for d in (-h, 0.0, h))
    np.testing.assert_allclose(now[1], (after[0] - before[0]) / (2 * h), atol=1e-8)
    flat, angle = sole_rotation(*level[3:]), roll.evaluate(1.2)[0]
    turned = flat @ Rotation.from_euler("y", angle).as_matrix()
    edge = level[:3] + side * 0.11 * flat[:, 0]
    np.testing.assert_allclose(now[0] + side * 0.11 * turned[:, 0], edge, atol=1e-12)
    assert now[0][2] > level[2] + 0.03


def test_the_hardest_lift_of_a_roll_is_that_of_the_soles_centre():
    roll, times = FootRoll(Foot.LEFT, 1.0, 1.3, 0.5, 0.11), np.linspace(1.02, 1.15, 1001)
    pitch = np.array([roll.evaluate(time)[0] for time in times])
    lift = 0.11 * np.gradient(np.gradient(pitch, times), times)[2:-2]
    assert roll.hardest(1.02, 1.15) == pytest.approx(np.abs(lift).max(), rel=0.05)


@pytest.mark.parametrize(
    ("hips", "left", "begun", "least", "most"),
    [
        (60.0, 0.09, 0, 1.0, 1.0),  # hardly sooner than by the clock
        (60.0, 0.03, 0, 0.05, 0.9),
        (600.0, 0.03, 0, 1.0, 1.0),  # hips that are strong enough for it
        (60.0, 0.03, 3, 1.0, 1.0),  # it rolls already
    ],
)
def test_a_heel_is_lifted_no_harder_than_hips_swing_a_foot(stand, hips, left, begun, least, most):
    """A double support that is cut short by a push would roll the foot, by the same angle, at many times its rate."""
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    legs = LegReach(0.27, 0.2, 0.115, 0.12, 0.24, (hips, 50.0))
    feet = stand(GAIT.step_width)
    state = WalkState.start(WalkModel.of(GAIT, ground, SmoothHeight(), legs), feet)
    measured = Measured(CentroidalState(0.0, np.array([0.0, 0.0, GAIT.com_height]), np.zeros(3)), feet)
    while state.phase.kind is not PhaseKind.DOUBLE or not state.phase.rolls:
        state = advanced(state, measured)
    for _ in range(begun):
        state = advanced(state, measured)
    time = 0.02 * state.clock.ticks
    assert (state.rolls(time)[0].start < time) is bool(begun)
    angle = state.rolls(time)[0].angle
    state = state.ending_in(left, time)
    (roll,) = state.rolls(time)
    assert least <= roll.angle / angle <= most
    if most < 1.0:
        assert roll.hardest(time, time + state.time_left) == pytest.approx(hips, rel=0.01)
    while state.phase.kind is PhaseKind.DOUBLE:
        state = advanced(state, measured)
    assert state.phase.rolls[0].angle == pytest.approx(roll.angle)


def swinging(stand, count):
    """State in the second swing, so many samples after its foot has left the ground, and its time [s]."""
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    feet = stand(GAIT.step_width)
    state = WalkState.start(WalkModel.of(GAIT, ground, SmoothHeight(), None), feet)
    measured = Measured(CentroidalState(0.0, np.array([0.0, 0.0, GAIT.com_height]), np.zeros(3)), feet)
    while state.phase.kind is not PhaseKind.SINGLE or not state.phase.rolls:
        state = advanced(state, measured)
    for _ in range(count):
        state = advanced(state, measured)
    assert state.phase.kind is PhaseKind.SINGLE
    return state, 0.02 * state.clock.ticks


def test_a_foot_that_swings_anew_does_not_roll_off_the_ground_again(stand):
    """Sent elsewhere shortly before it landed, a foot rolled over its toes in the air, by 30 degrees."""
    state, _ = swinging(stand, 18)
    assert state.clock.now > state.phase.rolls[0].end
    anew = state.swinging_anew(state.clock)
    assert anew.clock.now == anew.phase.start
    assert anew.phase.rolls == ()
    assert all(step.toe_off is None or step.number != anew.phase.step for step in anew.schedule.steps)


def test_a_roll_under_way_goes_on_where_the_foot_swings_anew(stand):
    state, time = swinging(stand, 8)
    (roll,), (later,) = state.rolls(time), state.swinging_anew(state.clock).rolls(time)
    for ahead in (0.0, 0.04, 0.2):
        assert later.evaluate(time + ahead) == pytest.approx(roll.evaluate(time + ahead), abs=1e-9)
    assert roll.evaluate(time)[0] > 0.1


def test_a_roll_begins_in_double_support_and_ends_before_touchdown(walk):
    singles = [phase for phase in walk.phases if phase.rolls and phase.kind is PhaseKind.SINGLE]
    for phase in singles:
        ((_, start, end, _),) = phase.rolls
        assert phase.start - 5 < start < phase.start < end < phase.end
        # By then the ZMP has left the sole behind that is to roll.
        assert walk.samples.fraction[int(np.ceil(start))] * GAIT.step_length > 0.09
        assert walk.phases[walk.phases.index(phase) - 1].rolls == phase.rolls


def test_only_feet_that_are_left_behind_roll(walk):
    singles = [phase for phase in walk.phases if phase.kind is PhaseKind.SINGLE]
    assert [bool(phase.rolls) for phase in singles] == [False, True, True, True]


def test_pitch_over_a_window_is_that_of_the_rolls(walk):
    feet = NominalFeet(len(walk.samples.clock))
    feet.move(len(walk.samples.clock), walk.samples, walk.schedule, (np.eye(2), np.zeros(2)))
    pitch = feet.pitch
    _, start, end, angle = next(phase.rolls[0] for phase in walk.phases if phase.rolls)
    roll = FootRoll(Foot.RIGHT, 0.02 * start, 0.02 * end, angle, 0.11)
    for sample in range(int(start), int(end) + 2):
        assert pitch[Foot.RIGHT, sample] == pytest.approx(roll.evaluate(0.02 * sample)[0], abs=1e-12)
    assert 0.4 < pitch.max() <= 0.5


def test_plans_of_a_walk_carry_the_roll_of_the_foot_that_leaves(stand):
    planner = WalkingPlanner(GAIT, stand(), 0.22, 0.11)
    com, velocity, ideal, rolled = np.array([0.0, 0.0, 0.95]), np.zeros(3), IdealFeet(stand()), []
    for tick in range(90):
        plan = planner.update(CentroidalState(0.02 * tick, com, velocity), ideal.state)
        for roll in plan.rolls:
            if not roll.evaluate(plan.time)[0] > 0.0:
                continue
            foot = roll.foot
            assert plan.swing is None or plan.swing.foot is foot
            assert plan.phase.kind is PhaseKind.SINGLE or plan.footsteps[0].foot is foot
            rolled.append(plan.phase.step)
        com, velocity = plan.com[1], plan.com_velocity[1]
        ideal.follow(PlanSampler(plan), 0.02 * (tick + 1))
    assert {1, 2, 3} <= set(rolled)


def test_level_feet_have_no_roll(stand):
    planner = WalkingPlanner(GaitParameters(steps=2, initial_stand=0.0), stand(), 0.22, 0.11)
    plan = planner.update(CentroidalState(0.0, np.array([0.0, 0.0, 1.0]), np.zeros(3)), IdealFeet(stand()).state)
    assert plan.rolls == ()


ROLLING = replace(GAIT, heel_strike=0.3)


def test_a_foot_comes_down_on_its_heel_and_is_flat_before_the_other_one_leaves(schedule):
    """Its toes are highest as it lands, and are not on their way up before its toe-off is over."""
    walk = schedule(ROLLING)
    for single, double in pairwise(walk.phases):
        landing = [span for span in single.rolls if span.angle < 0.0]
        if not landing or single.kind is not PhaseKind.SINGLE:
            continue
        (strike,) = landing
        assert strike.foot is single.swing_foot and strike.angle == -0.3
        own = [span for span in single.rolls if span.foot is strike.foot and span is not strike]
        assert all(span.end <= strike.start + 1e-9 for span in own)
        assert strike in double.rolls and single.end < strike.end <= double.end
        roll = FootRoll(strike.foot, strike.start, strike.end, strike.angle, -0.11)
        assert roll.evaluate(single.end)[0] < 0.85 * strike.angle


def test_both_feet_roll_at_once_each_on_its_own_edge(schedule):
    walk, both = schedule(ROLLING), 0
    feet = NominalFeet(len(walk.samples.clock))
    feet.move(len(walk.samples.clock), walk.samples, walk.schedule, (np.eye(2), np.zeros(2)))
    for phase in walk.phases:
        if phase.kind is PhaseKind.DOUBLE and len(phase.rolls) == 2:
            assert {span.foot for span in phase.rolls} == {Foot.LEFT, Foot.RIGHT}
            both += 1
    assert both == 3
    rolls = feet.pitch
    assert np.any((rolls[0] > 0.0) & (rolls[1] < 0.0)) or np.any((rolls[0] < 0.0) & (rolls[1] > 0.0))
    assert rolls.min() == pytest.approx(-0.3, abs=0.02)


@pytest.mark.parametrize("changed", [{"step_length": 0.1}, {"step_length": -0.2}, {"heel_strike": 0.0}])
def test_feet_that_land_beside_or_behind_the_other_one_land_flat(schedule, changed):
    walk = schedule(replace(ROLLING, **changed))
    assert not [span for phase in walk.phases for span in phase.rolls if span.angle < 0.0]


def test_a_heel_leaves_the_ground_as_the_other_one_lands(schedule):
    """Without heel strike, and after standing, the weight has first to leave the foot."""
    flat_spans, spans = ({span for phase in schedule(gait).phases for span in phase.rolls if span.angle > 0.0}
                         for gait in (GAIT, ROLLING))  # fmt: skip
    assert {(span.foot, span.end) for span in flat_spans} == {(span.foot, span.end) for span in spans}
    touchdowns = {phase.end for phase in schedule(ROLLING).phases if phase.kind is PhaseKind.SINGLE}
    assert {span.start for span in flat_spans}.isdisjoint(touchdowns)
    assert spans and {span.start for span in spans} <= touchdowns


def test_a_heel_waits_where_ankles_do_not_bear_the_robot_on_its_toes(stand):
    starts = []
    for bear in (True, False):
        parameters = PlannerParameters(reach_length=0.8, toes_bear=bear)
        ground = Ground(flat(), np.array([0.11, 0.055]), parameters)
        schedule = Schedule.start(ROLLING, stand(ROLLING.step_width), ground).extended(np.inf)
        starts.append([step.toe_off.start for step in schedule.steps if step.toe_off])
    early, late = np.array(starts)
    np.testing.assert_allclose(late - early, 0.25 * ROLLING.double_support / 0.02)


@given(way=st.floats(-0.5, 0.8), usual=st.floats(-0.3, 0.6), yaw=st.floats(-3.0, 3.0))
def test_a_foot_lands_the_more_on_its_heel_the_farther_ahead_it_lands(way, usual, yaw):
    """As much as is asked for at the gait's own way, and not at all less than one and a half half soles ahead."""

    def pitch(way):
        ahead, right, up = np.array(
            [[np.cos(yaw), np.sin(yaw), 0.0], [np.sin(yaw), -np.cos(yaw), 0.0], [0.0, 0.0, 1.0]]
        )
        stance = Footstep(Foot.LEFT, np.zeros(3), yaw, up)
        landing = Footstep(Foot.RIGHT, way * ahead + 0.2 * right, yaw, up)
        return landing_pitch(stance, landing, 0.11, usual, 0.3)

    assert 0.0 <= pitch(way) <= pitch(way + 0.01) <= 0.3
    assert (pitch(way) == 0.0) == (way <= 0.165) or abs(way - 0.165) < 1e-6
    if usual > 0.17:
        assert pitch(usual) == 0.3
        assert pitch(0.5 * (usual + 0.165)) == pytest.approx(0.15, abs=1e-5)


def starting(stand, gait):
    """The first swing of a gait as it begins: state, what is measured, and where its foot lands."""
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    feet = stand(gait.step_width)
    state = WalkState.start(WalkModel.of(gait, ground, SmoothHeight(), None), feet)
    measured = Measured(CentroidalState(0.0, np.array([0.0, 0.0, gait.com_height]), np.zeros(3)), feet)
    while state.phase.kind is not PhaseKind.SINGLE:
        state = advanced(state, measured)
    (landing,) = upcoming(state, 0.0, np.zeros((2, 2)))[:1]
    return state, measured, landing


def test_a_step_that_is_moved_back_lands_flat_unless_its_toes_are_on_their_way_up(stand):
    state, measured, landing = starting(stand, ROLLING)
    strike = state.schedule.step(1).heel_strike
    short = replace(landing, position=landing.position * (0.0, 1.0, 1.0))
    middle = replace(landing, position=landing.position * (0.7, 1.0, 1.0))
    (half,) = [span for span in swinging_to(state, middle, measured, False).phase.rolls if span.angle < 0.0]
    assert strike.angle < half.angle < 0.3 * strike.angle and half[:3] == strike[:3]
    for footstep, flatly in ((landing, False), (short, True)):
        swung = swinging_to(state, footstep, measured, False)
        assert (swung.schedule.step(1).heel_strike is None) is flatly
        assert bool([span for span in swung.phase.rolls if span.angle < 0.0]) is not flatly
    while state.clock.now < strike.start:
        state = advanced(state, measured)
    assert swinging_to(state, short, measured, False).schedule.step(1).heel_strike == strike


@pytest.mark.parametrize("begun", [False, True])
def test_a_step_that_catches_lands_flat_and_arrives_as_feet_that_do(stand, begun):
    """It does so before its swing has begun, and after it: what is left of the swing is then sooner over."""

    def swung(gait, catches):
        state, measured, landing = starting(stand, gait)
        if begun:
            state = swinging_to(state, landing, measured, False)
        return swinging_to(replace(state, adapted=catches), landing, measured, False)

    flatly, heels, caught = swung(GAIT, True), swung(ROLLING, False), swung(ROLLING, True)
    assert heels.schedule.step(1).heel_strike is not None is caught.schedule.step(1).heel_strike
    arrivals = [state.swing.trajectory.touchdown_time for state in (flatly, heels, caught)]
    speeds = [state.swing.trajectory.search.touchdown_speed for state in (flatly, heels, caught)]
    assert arrivals[2] == pytest.approx(arrivals[0]) and arrivals[1] > arrivals[0] + 0.01
    assert speeds[2] == pytest.approx(speeds[0]) and speeds[1] > speeds[0] + 0.05


@pytest.mark.parametrize(("back", "same"), [(0.0, True), (0.002, True), (-0.1, True), (0.02, False)])
def test_a_step_keeps_its_schedule_until_it_is_moved_far_enough_to_land_otherwise(stand, back, same):
    state, measured, landing = starting(stand, ROLLING)
    moved = replace(landing, position=landing.position - (back, 0.0, 0.0))
    swung = swinging_to(state, moved, measured, False)
    assert (swung.schedule is state.schedule) is same


@pytest.mark.parametrize(("ticks", "goes_on"), [(2, False), (12, False), (17, True)])
def test_a_swing_that_is_nearly_over_arrives_when_it_would_have(stand, ticks, goes_on):
    """Else it arrives as one that lands flat: sooner by what such a foot waits less for the ground."""
    state, measured, landing = starting(stand, replace(ROLLING, double_support=0.05))
    state = swinging_to(state, landing, measured, False)
    for _ in range(ticks):
        state = advanced(state, measured)
    assert state.clock.now < state.schedule.step(1).heel_strike.start
    later = replace(measured, body=replace(measured.body, time=0.02 * ticks))
    caught = swinging_to(replace(state, adapted=True), landing, later, False)
    assert caught.schedule.step(1).heel_strike is None
    sooner = state.swing.trajectory.touchdown_time - caught.swing.trajectory.touchdown_time
    assert sooner == pytest.approx(0.0 if goes_on else 0.75 * state.model.parameters.touchdown_lead)


def test_a_rolling_foot_turns_about_its_toe_edge_and_lifts_the_ankle():
    chain = LegChain(
        0.1, (0.0, 0.0, 0.3), Link(0.43, 0.1, 0.33, 1.7e-3), Link(0.43, 0.04, 0.4, 6e-4), 0.02, (0.0, 0.0, -0.04),
        (-0.022, 0.0, 0.08),
    )  # fmt: skip
    com, soles, heading = np.array([[0.0, 0.0, 0.9]]), np.zeros((2, 1, 3)), np.zeros((2, 1))
    level = chain.joints(com, soles, heading)[2][0, 0]
    rolled, flat = chain.joints(com, soles, heading, np.array([[0.5], [0.0]]), 0.11)[2][:, 0]
    edge = np.array([0.11, 0.0, 0.0])
    assert np.linalg.norm(rolled - edge) == pytest.approx(np.linalg.norm(level - edge))
    assert rolled[0] > level[0] + 0.05
    assert rolled[2] > level[2] + 0.05
    np.testing.assert_allclose(flat, level)
    toes_up = chain.joints(com, soles, heading, np.array([[-0.3], [0.0]]), 0.11)[2][0, 0]
    assert np.linalg.norm(toes_up + edge) == pytest.approx(np.linalg.norm(level + edge))
    assert toes_up[0] < level[0] and toes_up[2] > level[2]


def test_a_foot_pitches_the_more_the_farther_the_other_one_is_ahead():
    """Not at all up to a share of the reach, by as much more a metre from there on, and no farther than it can."""
    ahead = np.linspace(0.0, 3.0, 3001)
    pitch = np.array([stretched(way, 0.4) for way in ahead])
    begins = ahead[np.flatnonzero(pitch)[0]]
    assert 0.1 < begins < 0.6 and pitch[-1] == pitch.max() > 0.0
    rises = (pitch > 0.0) & (pitch < pitch[-1])
    slope = np.diff(pitch)[rises[1:] & rises[:-1]] / 0.001
    np.testing.assert_allclose(slope, slope[0])
    # Lengths grow with the robot, and angles do not.
    assert stretched(2.0 * begins + 0.02, 0.8, 2.0) == pytest.approx(stretched(begins + 0.01, 0.4))


def test_a_foot_lifts_its_toes_as_soon_as_it_is_level_at_most_a_double_support_before_it_lands():
    """And is flat before the double support is over."""
    off = toe_off(Foot.LEFT, 10.0, 100.0, 40.0, 0.5, True)
    level = (off.end - 100.0) / 40.0  # share of its swing after which its heel is level again
    assert 0.0 < level < 1.0
    short, long = (heel_strike(Foot.LEFT, 140.0, 40.0, double, 0.3) for double in (5.0, 60.0))
    assert short.start == 135.0 and long.start == pytest.approx(100.0 + 40.0 * level)
    assert 140.0 < short.end < 145.0 and 140.0 < long.end < 200.0 and long.angle == -0.3


def test_rates_of_a_roll_on_a_clock_that_changes_its_rate_are_its_derivatives():
    clock = TimeScaling(0.02, now=50.0).scaled(20.0, 26.0).advanced().advanced()
    roll, h = FootRoll(Foot.LEFT, 1.0, 1.35, 0.5, 0.11, clock, 1.05), 1e-5
    for time in (1.06, 1.2, 1.33):
        before, now, after = (roll.evaluate(time + d) for d in (-h, 0.0, h))
        assert now[1] == pytest.approx((after[0] - before[0]) / (2 * h), rel=1e-5)
        assert now[2] == pytest.approx((after[1] - before[1]) / (2 * h), rel=1e-4)
    assert clock.seconds(1.05, 1.2)[2] != 0.0
