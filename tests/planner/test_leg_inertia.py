import numpy as np
import pytest

from planner.gait import GaitParameters
from planner.leg_inertia import softening
from planner.parameters import LegInertia, PlannerParameters
from planner.pendulum_walk import IdealFeet
from planner.planner import WalkingPlanner
from planner.sampling import PlanSampler
from planner.types import GRAVITY, CentroidalState, Foot, PhaseKind

pytestmark = pytest.mark.unit

LEG = LegInertia(mass_ratio=0.05, lever=0.3)


def plans(stand, leg, until=3.0):
    """Plans of a walk whose CoM and feet do exactly what is planned."""
    gait = GaitParameters(initial_stand=0.0, single_support=0.8, double_support=0.4, lateral_step=0.05)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, parameters=PlannerParameters(leg=leg))
    com, velocity, ideal, made = np.array([0.0, 0.0, 1.0]), np.zeros(3), IdealFeet(stand()), []
    for tick in range(round(until / 0.02)):
        made.append(planner.update(CentroidalState(0.02 * tick, com, velocity), ideal.state))
        com, velocity = made[-1].com[1], made[-1].com_velocity[1]
        ideal.follow(PlanSampler(made[-1]), 0.02 * (tick + 1))
    return made


def zmp_of_three_masses(plan, leg):
    """ZMP at the plan's instant of a body with point masses at both soles, by the moment balance of its definition."""
    sample = PlanSampler(plan).sample(plan.time)
    c, a = sample.com, sample.com_acceleration
    moment = np.zeros(3)
    for foot in Foot:
        r, ra = plan.footholds[foot].position, np.zeros(3)
        if sample.swing_foot is foot:
            r, ra = sample.swing[:3], sample.swing_acceleration[:3]
        lever = np.array([leg.lever if sample.swing_foot is foot else 0.0, 0.0, 0.0])
        # d/dt of (r + lever - c) x (r' - c'), the lever acting on the vertical motion alone.
        moment += leg.mass_ratio * (np.cross(r - c, ra - a) + np.cross(lever, [0.0, 0.0, ra[2]]))
    force = a + np.array([0.0, 0.0, GRAVITY])
    x = c[0] - (c[2] * force[0] + moment[1]) / force[2]
    y = c[1] - (c[2] * force[1] - moment[0]) / force[2]
    return np.array([x, y])


def test_zmp_of_the_plan_is_that_of_three_masses(stand):
    errors, offsets = [], []
    for plan in plans(stand, LEG):
        errors.append(np.abs(plan.zmp[0] - zmp_of_three_masses(plan, LEG)).max())
        offsets.append(np.abs(plan.zmp_offset[0]).max())
    assert max(offsets) > 0.01
    # What the model leaves out: the swing sole's height, z'' times the legs' masses, c over p_ref.
    assert max(errors) < 0.2 * max(offsets)


def test_without_the_offset_the_zmp_would_be_wrong(stand):
    errors = [
        np.abs(plan.zmp[0] - plan.zmp_offset[0] - zmp_of_three_masses(plan, LEG)).max() for plan in plans(stand, LEG)
    ]
    assert max(errors) > 0.01


def test_legs_without_mass_are_the_papers_pendulum(stand):
    for plan in plans(stand, LegInertia(), until=1.5):
        assert not plan.zmp_offset.any()
        height = plan.com[:, 2]
        np.testing.assert_allclose(plan.stiffness, (GRAVITY + plan.com_acceleration[:, 2]) / height, rtol=1e-12)


def test_stiffness_is_softened_by_both_legs(stand):
    plan = plans(stand, LEG, until=0.1)[-1]
    point_mass = (GRAVITY + plan.com_acceleration[:, 2]) / plan.com[:, 2]
    np.testing.assert_allclose(plan.stiffness, softening(LEG) * point_mass, rtol=1e-12)


def test_offset_is_there_in_single_support_only(stand):
    for plan in plans(stand, LEG):
        if plan.phase.kind is not PhaseKind.SINGLE:
            assert not plan.zmp_offset[0].any()


@pytest.mark.parametrize(
    "leg", [{"mass_ratio": -0.1}, {"mass_ratio": 0.5}, {"mass_ratio": float("nan")}, {"lever": float("inf")}]
)
def test_impossible_legs_are_refused(leg):
    with pytest.raises(ValueError, match="ratio must be within"):
        LegInertia(**leg)
