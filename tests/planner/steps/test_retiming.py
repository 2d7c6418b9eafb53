"""Durations that are multiples of nothing, and that change at any moment: what was planned for a sample stays true."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.references.com_height import Rise, SmoothHeight
from surefoot.planner.steps.commands import Command
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.rolling import LEAD
from surefoot.planner.types import CentroidalState, Foot, PhaseKind, Twist

pytestmark = pytest.mark.unit

PARAMETERS = PlannerParameters(step_adaptation=StepAdaptation.NONE, horizon=40, preview=40)
T = PARAMETERS.sample_time


def plans_of(stand, gait, changes=(), rise=Rise.SINGLE, count=None):
    """Plans of a walk whose CoM and feet do exactly what is planned, with other durations from some ticks on."""
    planner = WalkingPlanner(gait, stand(), 0.2, 0.1, parameters=PARAMETERS, height_profile=SmoothHeight(rise))
    com, velocity, ideal, made = np.array([0.0, 0.0, gait.com_height]), np.zeros(3), IdealFeet(stand()), []
    changes, slowest = dict(changes), max([1.0, *(ratio for _, ratio in changes)])
    for tick in range(count or round(gait.duration * slowest / T) + 30):
        if tick in changes:
            ratio = changes[tick]
            durations = ratio * gait.single_support, ratio * gait.double_support
            planner.command(Command(single_support=durations[0], double_support=durations[1]))
        made.append(planner.update(CentroidalState(T * tick, com, velocity), ideal.state))
        com, velocity = made[-1].com[1], made[-1].com_velocity[1]
        ideal.follow(PlanSampler(made[-1]), T * (tick + 1))
    return made


def assert_continuous(plans):
    """Assert that a plan's next sample is the next plan's first one."""
    for before, after in pairwise(plans):
        for name in ("zmp_reference", "load_left", "stiffness"):
            np.testing.assert_allclose(getattr(after, name)[0], getattr(before, name)[1], atol=1e-7, err_msg=name)
        for name in ("com", "com_velocity", "com_acceleration"):
            np.testing.assert_allclose(getattr(after, name)[0, 2], getattr(before, name)[1, 2], atol=1e-7, err_msg=name)
        np.testing.assert_array_equal(after.contacts[0], before.contacts[1])
        if before.swing is not None and after.swing is not None:
            ends = [plan.swing.evaluate(after.time) for plan in (before, after)]
            np.testing.assert_allclose(ends[1][:2], ends[0][:2], atol=1e-7)
    assert_rolls_on(plans)
    for plan in plans:
        z, speed, bend = plan.com[:, 2], plan.com_velocity[:, 2], plan.com_acceleration[:, 2]
        rise = 0.5 * T * (speed[1:] + speed[:-1]) - T * T / 12.0 * np.diff(bend)
        np.testing.assert_allclose(np.diff(z), rise, atol=5e-5)
        np.testing.assert_allclose(np.diff(speed), 0.5 * T * (bend[1:] + bend[:-1]), atol=_TRAPEZOID)


def assert_rolls_on(plans):
    """Pitch and its rates go on, also where a plan has no roll any more."""
    for pair in pairwise(plans):
        for foot in Foot:
            rolls = [[roll.evaluate(pair[1].time) for roll in plan.rolls if roll.foot is foot] for plan in pair]
            ends = [np.sum([(0.0, 0.0, 0.0), *found], axis=0) for found in rolls]
            np.testing.assert_allclose(*ends, atol=1e-7)


def assert_walked(plans, steps):
    """Every step was swung once and landed where it was planned, and the robot stands in the end."""
    assert sorted({plan.phase.step for plan in plans if plan.phase.kind is PhaseKind.SINGLE}) == list(
        range(1, steps + 1)
    )
    assert plans[-1].phase.kind is PhaseKind.STAND
    swung = [(a, b) for a, b in pairwise(plans) if a.swing is not None and b.swing is None]
    assert len(swung) == steps
    for last, landed in swung:
        place = landed.footholds[last.swing.foot].position
        np.testing.assert_allclose(place, last.swing.target[:3], atol=1e-9)
    assert np.abs(plans[-1].com_velocity[0]).max() < 0.05


GAIT = GaitParameters(
    steps=4, step_length=0.25, lateral_step=0.05, turn=0.1, single_support=0.637, double_support=0.173,
    initial_stand=0.111, com_height=0.95, heel_off=0.2, heel_strike=0.15,
)  # fmt: skip

# Error T³/12 a'' of the trapezoidal rule over A sin³ in a double support that goes by half as fast again as it may.
_TRAPEZOID = T**3 / 12.0 * GAIT.apex_ds * (3.0 * np.pi / (0.6 * GAIT.double_support)) ** 4


def test_durations_that_are_multiples_of_nothing_keep_time(stand):
    plans = plans_of(stand, GAIT)
    assert_continuous(plans)
    assert_walked(plans, 4)
    lift_offs = [b.time for a, b in pairwise(plans) if a.swing is None and b.swing is not None]
    for step, time in enumerate(lift_offs, 1):
        assert 0.0 <= time - GAIT.lift_off(step) < T


def test_durations_may_change_as_a_foot_leaves_the_ground(stand):
    tick = 64
    plans = plans_of(stand, GAIT, [(tick, 0.75)], Rise.DOUBLE)
    assert (plans[tick - 1].phase.kind, plans[tick].phase.kind) == (PhaseKind.DOUBLE, PhaseKind.SINGLE)
    assert_continuous(plans)
    assert_walked(plans, 4)


def test_toes_that_would_be_up_already_after_a_longer_double_support_go_up_from_now(stand):
    """The roll takes as long before touchdown as the double support after it."""
    assert_rolls_on(plans_of(stand, GAIT, [(17, 0.75), (69, 1.0)], Rise.DOUBLE))


def test_a_swing_shortened_while_its_foot_rolls_lasts_until_it_is_level(stand):
    rolling = next(
        n
        for n, plan in enumerate(plans_of(stand, GAIT))
        if any(roll.pivot > 0.0 and roll.rolling(plan.time) for roll in plan.rolls)
    )
    plans = plans_of(stand, GAIT, [(rolling + 1, 0.45)])
    assert plans[rolling + 1].phase.kind is PhaseKind.DOUBLE
    assert_rolls_on(plans)
    assert_walked(plans, 4)


@settings(max_examples=8)
@given(data=st.data())
def test_durations_may_change_at_any_moment(stand, data):
    ticks = data.draw(st.sets(st.integers(1, 170), min_size=1, max_size=5))
    changes = [(tick, data.draw(st.floats(0.7, 1.3))) for tick in sorted(ticks)]
    plans = plans_of(stand, GAIT, changes, data.draw(st.sampled_from(Rise)))
    assert_continuous(plans)
    assert_walked(plans, 4)


@settings(max_examples=5)
@given(data=st.data())
def test_commands_at_any_moment_leave_no_jump(stand, data):
    """The steps that are not kept change; what was planned for the next sample never does."""
    gait = replace(GAIT, steps=0)
    planner = WalkingPlanner(gait, stand(), 0.2, 0.1, parameters=PARAMETERS, height_profile=SmoothHeight(Rise.SINGLE))
    com, velocity, ideal, made = np.array([0.0, 0.0, gait.com_height]), np.zeros(3), IdealFeet(stand()), []
    ticks = data.draw(st.sets(st.integers(0, 200), min_size=1, max_size=6))
    speed = st.floats(-0.3, 0.3)
    for tick in range(440):
        if tick in ticks:
            durations = st.none() | st.floats(0.7, 1.3)
            single, double = data.draw(durations), data.draw(durations)
            command = Command(
                twist=data.draw(st.none() | st.builds(Twist, speed, st.floats(-0.1, 0.1), speed)),
                single_support=single and single * gait.single_support,
                double_support=double and double * gait.double_support,
                swing_height=data.draw(st.none() | st.floats(0.03, 0.08)),
            )
            planner.command(command)
        if tick == 210:
            planner.command(Command(twist=Twist()))
        made.append(planner.update(CentroidalState(T * tick, com, velocity), ideal.state))
        com, velocity = made[-1].com[1], made[-1].com_velocity[1]
        ideal.follow(PlanSampler(made[-1]), T * (tick + 1))
    assert_continuous(made)
    assert made[-1].phase.kind is PhaseKind.STAND
    assert np.abs(made[-1].com_velocity[0]).max() < 0.05


def test_a_swing_that_is_nearly_over_keeps_its_time(stand):
    """With less than three samples until its foot is to touch down, which is some time before the phase is over."""
    lead, kept, count = PARAMETERS.touchdown_lead / T, [], 60
    plain = plans_of(stand, GAIT, count=count)
    swings = [tick for tick, plan in enumerate(plain) if plan.phase.kind is PhaseKind.SINGLE]
    for tick in swings[-6:]:
        left = plain[tick].footsteps[0].touchdown_time - plain[tick].time
        changed = plans_of(stand, GAIT, [(tick, 1.3)], count=tick + 1)[tick]
        keeps = changed.footsteps[0].touchdown_time == pytest.approx(plain[tick].footsteps[0].touchdown_time, abs=1e-9)
        assert keeps is (left / T < 3.0 + lead)
        kept.append(keeps)
    assert set(kept) == {False, True}


@pytest.mark.parametrize("ratio", [0.7, 1.3])
def test_what_is_left_of_a_step_changes_in_proportion(stand, ratio):
    tick = 40
    plain, changed = plans_of(stand, GAIT)[: tick + 1], plans_of(stand, GAIT, [(tick, ratio)])[: tick + 1]
    assert plain[tick].phase.kind is PhaseKind.SINGLE
    left = [plans[tick].footsteps[0].touchdown_time - plans[tick].time for plans in (plain, changed)]
    assert left[1] == pytest.approx(ratio * left[0])
    lead = LEAD * PARAMETERS.touchdown_lead  # of a foot that lands on its heel
    assert changed[tick].swing.touchdown_time == pytest.approx(changed[tick].time + left[1] - lead)
