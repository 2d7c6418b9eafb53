from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.laws.tvmpc import corrected_shift, paper_shift
from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.swing.step_region import reachable_shifts

pytestmark = pytest.mark.unit

T, W = 0.02, np.sqrt(9.81)
P = PlannerParameters()
STEP = np.array([0.2, 0.2])
HALF = 0.03
UNBOUNDED = np.full((2, 2), -np.inf), np.full((2, 2), np.inf)


def problem(error=(0.0, 0.0), left=0.6, transfer=0.5, parameters=P, **context):
    """Right foot stands, the left one swings; the DCM is the nominal one plus an error."""
    count, touchdown, ramp = 151, round(left / T), round(transfer / T)
    share = np.clip((np.arange(count) - touchdown) / ramp, 0.0, 1.0)[:, None]
    stiffness, omega = np.full(count, W * W), np.full(count, W)
    half = np.full((count, 2), HALF)
    reference = ZmpReference(
        share * STEP, np.hstack((share, np.zeros_like(share))), half, np.zeros(count), np.zeros((count, 2))
    )
    here = nominal_dcm(stiffness, omega, reference.point, T)[0] + error
    state = np.column_stack((here - 0.1 / W, np.full(2, 0.1), np.zeros(2)))
    steps = StepContext(
        np.array([STEP, STEP]), (1.0, -1.0), (True, True), np.array([0.1, 0.2]), left, transfer, *UNBOUNDED
    )
    steps = replace(steps, **context)
    lower, upper = reachable_shifts(parameters, steps.increment, 1.0, steps.free, steps.swing, steps.time_left)
    zero = np.zeros((50, 2))
    return MotionProblem(
        state, stiffness, omega, reference, replace(steps, lower=lower, upper=upper), zero[0], zero, np.eye(2)
    )


def test_paper_law_is_the_printed_formula_outside_its_margin_and_inside_the_reach():
    """ζ is on neither axis where the printed formula gives the nominal step."""
    left, transfer = 0.3, 0.2
    tick = problem((0.0, 0.0), left, transfer)
    dcm = tick.state[:, 0] + tick.state[:, 1] / W
    printed = dcm * np.exp(W * (left + transfer))
    wide = replace(P, reach_length=9.0, reach_width=(0.01, 9.0))
    np.testing.assert_allclose(paper_shift(tick, wide), printed - STEP, atol=1e-12)
    step = paper_shift(tick, P) + STEP
    np.testing.assert_allclose(step, np.clip(printed, (-0.4, 0.08), (0.4, 0.4)))
    np.testing.assert_array_equal(paper_shift(tick, replace(P, compliance_margin=9.0)), 0.0)


def test_without_dcm_error_the_corrected_law_steps_nominally_and_the_papers_does_not():
    for left in (0.2, 0.6, 1.4):
        assert np.abs(corrected_shift(problem(left=left), P)).max() < 1e-12
        assert np.abs(paper_shift(problem(left=left), P)).max() > 0.05


def test_corrected_law_leaves_to_the_foot_what_the_cop_cannot_do():
    """After the best CoP until touchdown, the shifted nominal DCM is where the true one is."""
    left = 0.6
    growth = np.exp(W * left)
    authority = HALF * (1.0 - 1.0 / growth)
    assert np.abs(corrected_shift(problem((0.99 * authority, -0.99 * authority), left), P)).max() == 0.0
    error = np.array([authority + 0.002, -authority - 0.001])
    shift = corrected_shift(problem(error, left), P)
    at_touchdown = np.sign(error) * (np.abs(error) * growth - HALF * (growth - 1.0))
    moved = problem(left=left)
    point = moved.reference.point + moved.reference.gain[:, :1] * shift
    k = round(left / T)
    nominal = [nominal_dcm(moved.stiffness, moved.omega, p, T)[k] for p in (moved.reference.point, point)]
    np.testing.assert_allclose(nominal[1] - nominal[0], at_touchdown, rtol=1e-9)
    assert np.abs(shift).min() > 0.01


@pytest.mark.parametrize("law", [paper_shift, corrected_shift])
def test_shifts_stay_in_reach_and_need_a_free_swing(law):
    far = problem((0.5, 0.5))
    step = law(far, P) + STEP
    assert np.all(step <= 0.4 + 1e-12)
    assert np.abs(law(far, P)).max() > 0.0
    for still in ({"free": (False, True)}, {"swing": None}):
        assert not law(replace(far, steps=replace(far.steps, **still)), P).any()


def test_corrected_law_freezes_and_keeps_to_the_swing_speed():
    assert not corrected_shift(problem((0.5, 0.5), left=0.08), P).any()
    late = problem((0.5, 0.5), left=0.1, parameters=replace(P, reach_length=9.0))
    reach = P.swing_speed * 0.1 / np.sqrt(2.0)
    assert np.all(STEP + corrected_shift(late, P) <= np.array([0.1, 0.2]) + reach + 1e-12)
    assert not corrected_shift(problem((0.5, 0.5), left=3.5), P).any()
