from dataclasses import fields
from itertools import pairwise

import numpy as np
import pytest
from pendulum_walk import Attended, walk_pendulum

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.planner.check import check_walk
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.ground.terrain import Box, Terrain, flat
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import CentroidalState, FeetState, Foot, PhaseKind, SolverStatus, Twist

pytestmark = pytest.mark.unit

HUMAN = (0.22, 0.11)


def assert_walks(planner, trace, rms, step_error):
    error = trace.zmp - trace.zmp_reference
    side = np.array([0.0, 0.5 * planner.gait.step_width, 0.0])
    whole = plan_footsteps(planner.gait, FeetState(np.array([side, -side]), np.zeros(2), (True, True)), flat())
    nominal = np.diff([step.position[:2] for step in whole[planner.schedule.steps[0].number + 2 :]], axis=0)
    taken = np.diff(planner.schedule.positions[1:, :2], axis=0)
    assert trace.fall_time is None
    assert trace.margin.min() > 0.0
    assert np.all(np.sqrt(np.mean(error**2, axis=0)) < rms)
    assert np.abs(taken - nominal).max() < step_error
    assert all(plan.status.solver is SolverStatus.SOLVED for plan in trace.plans)
    assert max(np.max(plan.status.zmp_slack) for plan in trace.plans) < 1e-6
    assert np.abs(trace.plans[-1].com_velocity[0]).max() < 1e-3
    assert np.abs(trace.com[-1, :2] - planner.schedule.support_points[-1, :2]).max() < 1e-3


def test_diagonal_walk_tracks_its_reference_inside_the_box(diagonal):
    assert_walks(*diagonal, rms=1e-3, step_error=2e-4)


@pytest.mark.parametrize(
    ("options", "foot"),
    [
        ({"step_length": 0.0, "lateral_step": 0.1}, (0.075, 0.075)),
        ({"step_length": -0.15, "steps": 3}, (0.075, 0.075)),
        ({"step_length": 0.25, "single_support": 0.8, "steps": 4}, (0.075, 0.075)),
        ({"single_support": 0.6, "double_support": 0.2, "steps": 8}, (0.075, 0.075)),
        ({"single_support": 0.5, "double_support": 0.16, "steps": 20}, HUMAN),
        ({"step_length": 0.1, "turn": 0.2, "steps": 6, "first_foot": Foot.RIGHT}, HUMAN),
        ({"steps": 1}, (0.075, 0.075)),
    ],
)
def test_other_walks_stay_inside_the_box(walk, options, foot):
    assert_walks(*walk(GaitParameters(**options), foot), rms=5e-3, step_error=2e-3)


def test_standing_for_ever_never_runs_out(walk):
    trace = walk(GaitParameters(steps=0), duration=5.0)[1]
    assert trace.fall_time is None
    assert trace.plans[-1].phase.kind is PhaseKind.STAND
    assert trace.plans[-1].phase.elapsed == pytest.approx(4.98)
    assert np.abs(trace.com[-1] - [0.0, 0.0, 1.0]).max() < 1e-9


def test_same_walk_twice_is_identical(diagonal, walk):
    again = walk(GaitParameters(lateral_step=0.1), duration=5.0)[1]
    np.testing.assert_array_equal(again.com, diagonal[1].com[: len(again.com)])
    np.testing.assert_array_equal(again.zmp, diagonal[1].zmp[: len(again.zmp)])


@pytest.mark.parametrize("turn", [0.0, 0.1])
def test_plan_far_away_and_turned_is_the_same_plan(stand, walk, turn):
    gait, origin, yaw = GaitParameters(lateral_step=0.1, steps=2, turn=turn), np.array([100.0, -50.0]), np.pi / 2
    here = walk(gait, duration=5.0)[1]
    feet = stand(origin=tuple(origin), yaw=yaw)
    planner = WalkingPlanner(gait, feet, 0.075, 0.075)
    there = walk_pendulum(planner, feet, 5.0, com=np.array([*origin, 1.0]), substeps=3)
    R = frame_rotation(yaw)
    np.testing.assert_allclose(there.com[:, :2], here.com[:, :2] @ R.T + origin, atol=1e-9)
    for a, b in zip(here.plans[::10], there.plans[::10], strict=True):
        np.testing.assert_allclose(b.zmp, a.zmp @ R.T + origin, atol=1e-9)


@pytest.mark.parametrize("force", [(75.0, 75.0, 0.0), (-75.0, 75.0, 0.0), (300.0, 0.0, 0.0), (0.0, -300.0, 0.0)])
def test_small_pushes_are_survived(walk, force):
    push = Push(2.2, 0.01, np.array(force))
    trace = walk(GaitParameters(lateral_step=0.1, steps=3), pushes=(push,))[1]
    assert trace.fall_time is None
    assert np.abs(trace.plans[-1].com_velocity[0]).max() < 1e-3


def test_a_push_past_the_capture_limit_falls(walk):
    push = Push(3.2, 0.1, np.array([0.0, 300.0, 0.0]))
    assert walk(GaitParameters(lateral_step=0.1), pushes=(push,))[1].fall_time is not None


def test_a_frozen_plan_falls(stand):
    plans = []

    def update(planner, state, feet):
        """The last plan again after 2.5 s."""
        if not plans or state.time < 2.5:
            plans.append(planner.update(state, feet))
        return plans[-1]

    planner = Attended(WalkingPlanner(GaitParameters(lateral_step=0.1), stand(), 0.075, 0.075), update)
    trace = walk_pendulum(planner, stand(), 12.0, com=np.array([0.0, 0.0, 1.0]), substeps=3)
    assert trace.fall_time is not None
    assert trace.fall_time > 2.5


def test_without_any_terminal_bound_or_cost_and_feedback_it_falls(walk, stand):
    parameters = PlannerParameters(terminal_weight=0.0, terminal_slack=(1e-9, 0.0))
    planner = WalkingPlanner(GaitParameters(lateral_step=0.1), stand(), 0.075, 0.075, parameters=parameters)
    trace = walk_pendulum(planner, stand(), 12.0, com=np.array([0.0, 0.0, 1.0]), feedback=0.0, substeps=3)
    assert trace.fall_time is not None


def test_steps_move_only_when_adaptation_is_on(walk, stand, schedule):
    gait = GaitParameters(lateral_step=0.1, single_support=0.6, double_support=0.2)
    push, com = Push(2.0, 0.02, np.array([500.0, 0.0, 0.0])), np.array([0.0, 0.0, 1.0])
    moved = {}
    for adaptation in StepAdaptation:
        parameters = PlannerParameters(step_adaptation=adaptation)
        planner = WalkingPlanner(gait, stand(), 0.075, 0.075, parameters=parameters)
        trace = walk_pendulum(planner, stand(), 6.0, com=com, pushes=(push,), substeps=3)
        assert trace.fall_time is None
        ends = [(a, b) for a, b in pairwise(trace.plans) if a.swing is not None and b.swing is None]
        landed = np.array([after.footholds[before.swing.foot].position[:2] for before, after in ends])
        nominal = schedule(gait).schedule.positions[2 : 2 + len(landed), :2]
        moved[adaptation] = np.abs(np.diff(landed, axis=0) - np.diff(nominal, axis=0)).max()
    assert moved[StepAdaptation.NONE] < 1e-9
    assert moved[StepAdaptation.LOCATION] > 0.005


def drive(planner, feet, contact_of_swing, ticks):
    """Follow the planner's own CoM with feet that stand where they started and a scripted swing contact."""
    com, velocity, plans = np.array([0.0, 0.0, 1.0]), np.zeros(3), []
    for tick in range(ticks):
        plan = planner.update(CentroidalState(0.02 * tick, com, velocity), feet)
        plans.append(plan)
        com, velocity = plan.com[1], plan.com_velocity[1]
        position, contact = feet.position.copy(), [True, True]
        if plan.swing is not None:
            position[plan.swing.foot] = plan.swing.evaluate(0.02 * (tick + 1))[0, :3]
            contact[plan.swing.foot] = contact_of_swing(0.02 * (tick + 1))
        feet = FeetState(position, feet.yaw, (contact[0], contact[1]))
    return plans


def test_late_touchdown_holds_the_clock_up_to_its_limit(stand):
    gait = GaitParameters(initial_stand=0.0, single_support=0.6, double_support=0.2)
    limit = round(PlannerParameters().late_touchdown / 0.02)
    plans = drive(WalkingPlanner(gait, stand(), *HUMAN), stand(), lambda t: t > 1.0 + 0.11, 70)
    waiting = [plan.status.late_touchdown for plan in plans]
    assert max(waiting) == 6
    landed = next(k for k, plan in enumerate(plans) if plan.phase.step == 1 and plan.phase.kind is PhaseKind.DOUBLE)
    assert landed == 50 + 6
    never = drive(WalkingPlanner(gait, stand(), *HUMAN), stand(), lambda t: False, 70)
    landed = next(k for k, plan in enumerate(never) if plan.phase.step == 1 and plan.phase.kind is PhaseKind.DOUBLE)
    assert landed == 50 + limit
    hasty = next(k for k, plan in enumerate(never) if plan.swing is not None and plan.swing.search.hurry_after < 1.0)
    assert min(plan.balance.planned for plan in never[: hasty - 1]) >= 0.0 > never[hasty - 1].balance.planned
    gentle, searched = (never[k].swing.evaluate(0.02 * k)[0, 2] for k in (hasty, 50 + limit - 2))
    assert -0.08 < searched < gentle - 0.03
    assert -0.02 < gentle < -0.005


def test_early_touchdown_fixes_the_footstep_and_never_moves_the_clock(stand):
    gait = GaitParameters(initial_stand=0.0, single_support=0.6, double_support=0.2)
    plans = drive(WalkingPlanner(gait, stand(), *HUMAN), stand(), lambda t: t > 0.9, 60)
    assert plans[46].status.early_touchdown
    assert plans[49].phase.kind is PhaseKind.SINGLE
    assert plans[50].phase.kind is PhaseKind.DOUBLE
    assert len({plan.footsteps[0].position.tobytes() for plan in plans[46:50]}) == 1


def catching(adaptation):
    """A planner of legs that are known, with this step adaptation, and the feet at its start."""
    gait = GaitParameters(initial_stand=0.0, single_support=0.6, double_support=0.2)
    legs = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0))
    feet = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
    parameters = PlannerParameters(step_adaptation=adaptation)
    planner = WalkingPlanner(gait, feet, *HUMAN, legs=legs, parameters=parameters)
    return planner, feet


def landed_early(kick, adaptation=StepAdaptation.CROSSING, kicked=30):
    """Plans until a step has touched down early, in whose swing the CoM gets a speed to the left [m/s] at a tick."""
    planner, feet = catching(adaptation)
    com, velocity, plans = np.array([0.0, 0.0, 1.0]), np.zeros(3), []
    for tick in range(90):
        plan = planner.update(CentroidalState(0.02 * tick, com, velocity), feet)
        plans.append(plan)
        com, velocity = plan.com[1], plan.com_velocity[1] + np.array([0.0, kick if tick == kicked else 0.0, 0.0])
        if plan.swing is None and any(one.swing is not None for one in plans):
            break
        position, contact = feet.position.copy(), [True, True]
        if plan.swing is not None:
            position[plan.swing.foot] = plan.swing.evaluate(0.02 * (tick + 1))[0, :3]
            contact[plan.swing.foot] = plan.phase.elapsed > 0.65 * plan.phase.duration
        feet = FeetState(position, feet.yaw, (contact[0], contact[1]))
    return plans


def test_a_step_that_catches_the_body_ends_its_phase_where_its_foot_lands():
    *_, before, after = landed_early(0.3)
    assert before.phase.kind is PhaseKind.SINGLE and after.phase.kind is PhaseKind.DOUBLE
    assert before.phase.left > 0.06 and not before.status.early_touchdown
    assert after.phase.elapsed == 0.0 and after.phase.landed == before.phase.step
    np.testing.assert_allclose(after.zmp_reference[0], before.zmp_reference[0], atol=1e-9)
    assert abs(after.com[0, 2] - before.com[1, 2]) < 1e-6


def test_one_that_catches_nothing_does_not():
    """Negative control: the clock of a walk that is not disturbed goes on as it goes."""
    *_, before, after = landed_early(0.0)
    assert before.status.early_touchdown and before.phase.left < 0.03
    assert after.phase.kind is PhaseKind.DOUBLE


def again(plans):
    """Plans in which a single support begins that has begun before."""
    swung = [plan for plan in plans if plan.swing is not None]
    return [b for a, b in pairwise(swung) if b.phase.elapsed < a.phase.elapsed]


def test_a_foot_that_lands_short_of_the_dcm_on_its_own_side_goes_on():
    """Pushed to the left just before that the DCM is beyond the left foot; the right one would have to cross it."""
    plans = landed_early(0.8, kicked=38)
    [once] = again(plans)
    before = plans[plans.index(once) - 1]
    assert once.phase.kind is PhaseKind.SINGLE and once.phase.step == before.phase.step
    dcm = once.com[0, 1] + once.com_velocity[0, 1] / once.omega[0]
    short = before.swing.evaluate(once.time)[0, 1]
    assert dcm > short + 0.5 * HUMAN[1]
    assert plans[-1].footholds[Foot.LEFT].position[1] > short + 0.05
    assert abs(once.com[0, 2] - before.com[1, 2]) < 1e-6


@pytest.mark.parametrize(
    ("kick", "adaptation"),
    [
        (0.5, StepAdaptation.CROSSING),
        (-0.8, StepAdaptation.CROSSING),
        (3.0, StepAdaptation.CROSSING),
        (0.8, StepAdaptation.LOCATION),
    ],
)
def test_one_that_lands_beyond_it_or_cannot_get_there_or_may_not_take_another_time_stays(kick, adaptation):
    """Negative control."""
    assert not again(landed_early(kick, adaptation, kicked=38))


DECIDED = 48
"""Plan before which the footstep of the first step has been decided."""


def about_to_land(disturb, count, begin=DECIDED):
    """Plans; from 40 ms before a landing, or another one on, CoM velocity and feet are disturbed."""
    planner, feet = catching(StepAdaptation.CROSSING)
    com, velocity, plans = np.array([0.0, 0.0, 1.0]), np.zeros(3), []
    for tick in range(count):
        if tick >= begin:
            disturb(velocity, feet.position)
        plan = planner.update(CentroidalState(0.02 * tick, com, velocity), feet)
        plans.append(plan)
        com, velocity = plan.com[1], plan.com_velocity[1].copy()
        position, contact = feet.position.copy(), [True, True]
        if plan.swing is not None:
            position[plan.swing.foot] = plan.swing.evaluate(0.02 * (tick + 1))[0, :3]
            contact[plan.swing.foot] = False
        feet = FeetState(position, feet.yaw, (contact[0], contact[1]))
    return plans


def moved(plans):
    """Way of the next footstep after it has been decided [m]."""
    return float(np.hypot(*(plans[-1].footsteps[0].position - plans[DECIDED - 1].footsteps[0].position)[:2]))


def pushed_and_lifted(height):
    """A push to the left that lifts the swing foot with the body [m]."""

    def disturb(velocity, position):
        velocity[1] += 0.5
        position[Foot.LEFT, 2] += height

    return disturb


@pytest.mark.parametrize("height", [0.0, 0.005, 0.03])
def test_a_step_that_is_decided_lands_where_and_when_it_was_also_with_its_foot_above_its_swing(height):
    """Sent elsewhere it would be late by a tenth of a second, in which the DCM goes on.

    A foot is above its swing because its leg is short of the ground more often than because it was lifted.
    """
    plans = about_to_land(pushed_and_lifted(height), count=DECIDED + 2)
    assert moved(plans) == 0.0 and not again(plans)
    assert plans[-1].phase.left == pytest.approx(plans[DECIDED].phase.left - 0.02, abs=1e-9)


def test_one_that_is_not_decided_is_moved_by_the_same_push():
    """Negative control."""

    def early(velocity, position):
        velocity[1] += 0.5

    plans = about_to_land(early, begin=DECIDED - 10, count=DECIDED - 8)
    assert np.hypot(*(plans[-1].footsteps[0].position - plans[DECIDED - 11].footsteps[0].position)[:2]) > 0.02


def test_measured_foothold_replaces_the_planned_one_and_carries_the_next(stand):
    gait = GaitParameters(initial_stand=0.0, single_support=0.6, double_support=0.2)
    planner = WalkingPlanner(gait, stand(), *HUMAN)
    nominal = planner.schedule.positions
    offset = np.array([0.02, -0.01, 0.003])
    com, feet = np.array([0.0, 0.0, 1.0]), stand()
    for tick in range(52):
        plan = planner.update(CentroidalState(0.02 * tick, com, np.zeros(3)), feet)
        position = feet.position.copy()
        position[0] = nominal[2] + offset
        feet = FeetState(position, feet.yaw, (True, True) if tick >= 48 else (False, True))
    assert plan.phase.kind is PhaseKind.DOUBLE
    np.testing.assert_allclose(plan.footholds[Foot.LEFT].position, nominal[2] + offset)
    np.testing.assert_allclose(planner.schedule.positions[3, :2], nominal[3, :2] + offset[:2], atol=1e-12)


def test_plan_arrays_have_the_shapes_they_say(diagonal):
    plan = diagonal[1].plans[130]
    shapes = {"com": (51, 3), "com_velocity": (51, 3), "com_acceleration": (51, 3), "zmp": (51, 2), "jerk": (50, 2)}
    shapes |= {"zmp_reference": (51, 2), "stiffness": (51,), "omega": (51,), "contacts": (51, 2), "load_left": (51,)}
    for field in fields(plan):
        if field.name in shapes:
            assert getattr(plan, field.name).shape == shapes[field.name]
    assert [f.step for f in plan.footsteps] == [1, 2, 3]
    assert plan.footsteps[0].touchdown_time == pytest.approx(2.0 + 1.5)


def test_out_of_reach_and_nonsense_are_refused(stand):
    with pytest.raises(ValueError, match=r"footstep 1 would land 0\.500 m ahead") as refused:
        WalkingPlanner(GaitParameters(step_length=0.5), stand(), 0.075, 0.075)
    assert refused.value.key == ("footsteps", 0, "ahead")
    with pytest.raises(ValueError, match="foot_length is -1"):
        WalkingPlanner(GaitParameters(), stand(), -1.0, 0.075)
    with pytest.raises(ValueError, match="not finite at 0 s"):
        WalkingPlanner(GaitParameters(), stand(), 0.075, 0.075).update(
            CentroidalState(0.0, np.array([np.nan, 0.0, 1.0]), np.zeros(3)), stand()
        )


def test_stairs_are_climbed_with_the_previewed_stiffness(stand):
    treads = [(0.1 + 0.2 * i, 0.1 * (i + 1)) for i in range(3)]
    boxes = [Box(np.array([x + 5.0, 0.0, z / 2]), np.array([5.0, 2.0, z / 2]), np.eye(3)) for x, z in treads]
    gait = GaitParameters(steps=4, single_support=0.8)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, terrain=Terrain(tuple(boxes)))
    trace = walk_pendulum(planner, stand(), 10.0, com=np.array([0.0, 0.0, 1.0]), substeps=3)
    assert_walks(planner, trace, rms=2e-3, step_error=1e-3)
    assert trace.com[-1, 2] == pytest.approx(1.3)
    assert min(plan.stiffness.min() for plan in trace.plans) < 8.0


def test_a_step_that_is_not_in_sight_is_refused_before_the_walk(stand):
    good, far = Twist(0.2, width=0.2), Twist(0.7, width=0.2)
    gait = GaitParameters(steps=13, bouts=(Bout(1.0, (*(good,) * 11, far, good)),))
    given = (gait, stand(), *HUMAN, flat(), PlannerParameters())
    planner = WalkingPlanner(*given)
    with pytest.raises(ParameterError, match="footstep 12 would land") as refused:
        check_walk(planner.schedule, SmoothHeight())
    assert refused.value.key == ("footsteps", 11, "ahead")
    check_walk(WalkingPlanner(GaitParameters(steps=10**6), *given[1:]).schedule, SmoothHeight())
