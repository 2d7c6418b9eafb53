import numpy as np
import pytest

from surefoot.forces import ExternalLoad
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia, PlannerParameters
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.references.leg_offset import softening
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import GRAVITY, CentroidalState, Foot

pytestmark = pytest.mark.unit

CHAIN = LegChain(
    0.1, (0.0, 0.0, 0.3), Link(0.43, 0.1, 0.33, 1.7e-3), Link(0.43, 0.04, 0.4, 6e-4), 0.02, (0.0, 0.0, -0.04),
    (0.0, 0.0, 0.08),
)  # fmt: skip
LEG = LegInertia(mass_ratio=0.05, chain=CHAIN)


LEGS = LegReach(0.36, 0.2, 0.11, 0.12, 0.22, (60.0, 50.0))


def plans(stand, leg, until=3.0, kick=(0.0, 0.0), single=0.5):
    """Plans of a walk whose CoM and feet do exactly what is planned, but for a kick in mid-swing at 1.4 s [m/s]."""
    gait = GaitParameters(
        initial_stand=0.0,
        step_length=0.3,
        single_support=single,
        double_support=0.2,
        lateral_step=0.05,
        com_height=0.95,
    )
    planner = WalkingPlanner(gait, stand(), 0.2, 0.1, parameters=PlannerParameters(leg=leg), legs=LEGS)
    com, velocity, ideal, made = np.array([0.0, 0.0, 0.95]), np.zeros(3), IdealFeet(stand()), []
    for tick in range(round(until / 0.02)):
        made.append(planner.update(CentroidalState(0.02 * tick, com, velocity), ideal.state))
        com, velocity = made[-1].com[1], made[-1].com_velocity[1]
        velocity = velocity + np.array([*kick, 0.0]) * (tick == 70)
        ideal.follow(PlanSampler(made[-1]), 0.02 * (tick + 1))
    return made


def zmp_of_the_chain(plan, step=0.002):
    """ZMP soon after the plan's instant of the body with links, by the moment balance of its definition."""
    sampler, com, soles = PlanSampler(plan), [], []
    middle = plan.time + 0.01
    for time in middle + step * np.arange(-1, 2):
        sample = sampler.sample(time)
        feet = [plan.footholds[foot].position for foot in Foot]
        if sample.swing_foot is not None:
            feet[sample.swing_foot] = sample.swing[:3]
        com.append(sample.com)
        soles.append(feet)
    moment = CHAIN.momentum_rate(np.array(com), np.array(soles).transpose(1, 0, 2), np.zeros((2, 3)), step)[0]
    sample = sampler.sample(middle)
    c, force = sample.com, sample.com_acceleration + np.array([0.0, 0.0, GRAVITY])
    x = c[0] - (c[2] * force[0] + moment[1]) / force[2]
    y = c[1] - (c[2] * force[1] - moment[0]) / force[2]
    return np.array([x, y]), sample


@pytest.mark.parametrize("single", [0.5, 0.506, 0.494])
def test_zmp_of_the_plan_is_that_of_the_links_also_where_phases_begin_between_plans(stand, single):
    errors, offsets = [], []
    for plan in plans(stand, LEG, single=single):
        zmp, sample = zmp_of_the_chain(plan)
        errors.append(np.abs(sample.zmp - zmp).max())
        offsets.append(np.abs(sample.zmp - sample.pendulum_zmp).max())
    assert max(offsets) > 0.05
    assert np.percentile(errors, 90) < 0.03 * max(offsets)
    assert max(errors) < 0.12 * max(offsets)  # where swing accelerations bend within a sample


def test_legs_without_mass_are_the_papers_pendulum(stand):
    for plan in plans(stand, LegInertia(), until=1.5):
        assert not plan.zmp_offset.any()
        height = plan.com[:, 2]
        np.testing.assert_allclose(plan.stiffness, (GRAVITY + plan.com_acceleration[:, 2]) / height, rtol=1e-12)


def test_stiffness_is_softened_by_both_legs(stand):
    plan = plans(stand, LEG, until=0.1)[-1]
    point_mass = (GRAVITY + plan.com_acceleration[:, 2]) / plan.com[:, 2]
    np.testing.assert_allclose(plan.stiffness, softening(LEG) * point_mass, rtol=1e-12)


def test_a_body_at_rest_has_no_offset(stand):
    planner = WalkingPlanner(GaitParameters(steps=0), stand(), 0.2, 0.1, parameters=PlannerParameters(leg=LEG))
    plan = planner.update(CentroidalState(0.0, np.array([0.0, 0.0, 1.0]), np.zeros(3)), IdealFeet(stand()).state)
    np.testing.assert_allclose(plan.zmp_offset, 0.0, atol=1e-6)


def test_a_body_that_leans_at_rest_into_a_force_has_the_offset_of_that_force_alone(stand):
    """Its CoM is where the force holds it over the middle of its feet, and the legs have nothing to turn."""
    load = ExternalLoad(np.array([0.25, 0.35, 0.0]), np.array([-0.03, 0.02, 0.0]))
    leaning = np.append(load.force[:2] * 1.0 + [load.moment[1], -load.moment[0]], 0.0) / GRAVITY
    planner = WalkingPlanner(GaitParameters(steps=0), stand(), 0.2, 0.1, parameters=PlannerParameters(leg=LEG))
    state = CentroidalState(0.0, np.array([0.0, 0.0, 1.0]) - leaning, np.zeros(3), load)
    plan = planner.update(state, IdealFeet(stand()).state)
    np.testing.assert_allclose(plan.zmp_offset, np.tile(leaning[:2], (len(plan.zmp_offset), 1)), atol=1e-6)


def test_offsets_serve_for_some_ticks_until_the_robot_stands_for_good(stand):
    """From then on they are made anew at each, since the clock of the walk tells nothing of them any more."""
    gait = GaitParameters(steps=2, step_length=0.2, initial_stand=0.0, single_support=0.4, double_support=0.1)
    planner = WalkingPlanner(gait, stand(gait.step_width), 0.2, 0.1, parameters=PlannerParameters(leg=LEG), legs=LEGS)
    com, velocity, ideal, ages = np.array([0.0, 0.0, 1.0]), np.zeros(3), IdealFeet(stand(gait.step_width)), {}
    for tick in range(round(gait.duration / 0.02) + 40):
        plan = planner.update(CentroidalState(0.02 * tick, com, velocity), ideal.state)
        com, velocity = plan.com[1], plan.com_velocity[1]
        ideal.follow(PlanSampler(plan), 0.02 * (tick + 1))
        state = planner.state
        stands = state.clock.now >= state.schedule.last_phase.start
        ages.setdefault(stands, []).append(state.clock.ticks - state.memory.offsets.start)
    assert len(ages[True]) > 20 and set(ages[True]) == {0}
    assert max(ages[False]) > 2


@pytest.mark.parametrize("ratio", [-0.1, 0.5, float("nan")])
def test_impossible_legs_are_refused(ratio):
    with pytest.raises(ValueError, match="must be within"):
        LegInertia(mass_ratio=ratio)


@pytest.mark.parametrize("kick", [(0.35, 0.0), (0.0, 0.25), (0.0, -0.3)])
def test_zmp_of_the_plan_is_that_of_the_links_while_a_swing_goes_elsewhere(stand, kick):
    """But for the ticks in which the swing is sent elsewhere, whose bend no spline of samples follows.

    Until its touchdown: a foot that searches for the ground is expected to find it at once. The last kick sends it
    across the stance foot in a tenth of a second.
    """
    errors = []
    for plan in plans(stand, LEG, until=1.9, kick=kick):
        if plan.time > 1.42 and plan.swing is not None and plan.time < plan.swing.touchdown_time - 1e-6:
            zmp, sample = zmp_of_the_chain(plan)
            errors.append(np.abs(sample.zmp - zmp).max())
    assert len(errors) > 10
    assert np.median(errors) < 0.01
    assert max(errors) < 0.05
