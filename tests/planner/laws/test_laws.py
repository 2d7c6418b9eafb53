"""The closed-form laws: preview gains, DCM feedback, limits."""

import numpy as np
import pytest

from surefoot.planner.laws.dcm_feedback import limited
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.laws.zmp_preview import preview_gains
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState

pytestmark = pytest.mark.unit

T = 0.02
A = np.array([[1.0, T, T * T / 2], [0.0, 1.0, T], [0.0, 0.0, 1.0]])
B = np.array([T**3 / 6, T * T / 2, T])
C = np.array([1.0, 0.0, -1.0 / 9.81])


def follow(reference, samples):
    """ZMP of the cart-table under preview control, from rest at 0."""
    gains = preview_gains(T, 9.81, samples)
    state, summed, zmp = np.zeros(3), 0.0, []
    for k in range(len(reference) - samples):
        zmp.append(C @ state)
        summed += zmp[-1] - reference[k]
        u = -gains.integral * summed - gains.state @ state - gains.preview @ reference[k + 1 : k + 1 + samples]
        state = A @ state + B * u
    return np.array(zmp)


def test_preview_control_is_stable():
    assert np.abs(np.linalg.eigvals(preview_gains(T, 9.81).system)).max() < 1.0


def test_preview_control_tracks_a_step_with_foresight_only():
    reference = np.where(np.arange(500) < 150, 0.0, 0.3)
    error = np.abs(follow(reference, 80) - reference[:420])
    assert error[:70].max() < 1e-12
    assert error[70:220].max() < 0.1
    assert error[220:].max() < 1e-5
    blind = np.abs(follow(reference, 2) - reference[:498])
    assert blind[:220].max() > 1.0


def test_preview_law_does_not_depend_on_the_origin():
    gains = preview_gains(T, 9.81)
    assert gains.state[0] + gains.preview.sum() == pytest.approx(0.0, abs=1e-9)


def plan_at(stand, name, offset, velocity=(0.0, 0.0)):
    gait = GaitParameters(steps=0)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, profile=PROFILES[name])
    return planner.update(CentroidalState(0.0, np.array([*offset, 1.0]), np.array([*velocity, 0.0])), stand())


def test_dcm_error_decays_exponentially_inside_the_box(stand):
    """p = p_ref + (1 + k/ω)(ξ - ξ_ref) makes e' = -k e; standing, the reference rests at the origin."""
    plan = plan_at(stand, "dcm", (0.004, -0.003))
    error = plan.com[1:, :2] + plan.com_velocity[1:, :2] / plan.omega[1:, None]
    np.testing.assert_allclose(plan.zmp[1:], (1.0 + 4.0 / plan.omega[1:, None]) * error, atol=1e-12)
    rate = np.log(error[0] / error[25]) / (25 * T)
    np.testing.assert_allclose(rate, 4.0, rtol=0.05)


def test_dcm_feedback_stops_at_the_edge_of_the_box(stand):
    plan = plan_at(stand, "dcm", (0.0, 0.0), (0.5, 0.0))
    assert plan.zmp[1:, 0].max() == pytest.approx(0.9 * 0.0375)


def test_limits_of_jerk_and_rate():
    parameters = PlannerParameters(jerk_limit=1.5, jerk_rate_limit=0.1)
    assert limited(9.0, 0.0, parameters) == 0.1
    assert limited(9.0, 1.45, parameters) == 1.5
    assert limited(-9.0, 0.0, parameters) == -0.1
    assert limited(0.03, 0.0, parameters) == 0.03
