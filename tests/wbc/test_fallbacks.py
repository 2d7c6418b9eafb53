"""Fallbacks of the controller when solvers fail or its input is no number."""

import numpy as np
import pytest

from surefoot.wbc.qp.data import EQUALITY_ROWS, WRENCH_UNIT
from surefoot.wbc.qp.solvers import Daqp, ProxQp, equalities_only
from surefoot.wbc.types import RobotState, SolveStatus

pytestmark = pytest.mark.unit


class Failing:
    name = "failing"

    def solve(self, qp):
        return None


@pytest.fixture
def controller(robot, rng):
    made = robot.controller()
    made.observe(robot.moved(rng, 0.02, 0.2))
    return made


def break_first(controller, solver):
    controller.solvers = (solver, *controller.solvers[1:])


def test_the_second_solver_answers_for_the_first(controller, reference, loaded):
    good = controller.update(reference, loaded).torque.copy()
    break_first(controller, Failing())
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.SECOND_SOLVER
    np.testing.assert_allclose(report.torque, good, atol=1e-3)


def test_so_does_the_last_one_for_both_before_it(controller, reference, loaded):
    good = controller.update(reference, loaded).torque.copy()
    controller.solvers = (Failing(), Failing(), Failing(), controller.solvers[-1])
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.SECOND_SOLVER
    np.testing.assert_allclose(report.torque, good, atol=1e-3)


@pytest.fixture
def contradicted(controller, reference, loaded):
    """A QP whose joints may not move but for a knee, which must, while both feet are held."""
    controller.update(reference, loaded)
    qp, layout = controller.qp.copy(), controller.layout
    qp.bounds_lower[6 : layout.nv] = qp.bounds_upper[6 : layout.nv] = 0.0
    knee = controller.terms.model.joints[controller.terms.model.getJointId("left_knee")].idx_v
    qp.bounds_lower[knee], qp.bounds_upper[knee] = 20.0, 30.0
    return qp


def test_limits_that_contradict_each_other_are_broken_and_no_others(robot, controller, contradicted):
    status, solution = controller.solve(contradicted)
    assert status is SolveStatus.SOFTENED
    assert contradicted.violation(solution.x) > 0.1
    assert contradicted.violation(solution.x, controller.layout.soft) <= 1e-6
    torque = contradicted.A[controller.layout.torque_rows] @ solution.x + controller.terms.bias[6:]
    assert (np.abs(torque) <= robot.limits.torque + 1e-6).all()


def test_the_equalities_alone_would_break_others_as_well(controller, contradicted):
    """Negative control."""
    assert contradicted.violation(equalities_only(contradicted).x, controller.layout.soft) > 0.1


def test_where_all_can_hold_none_is_broken(controller, reference, loaded):
    controller.update(reference, loaded)
    usual, softened = (controller.solvers[k].solve(controller.qp).x for k in (0, 1))
    assert controller.qp.violation(softened) <= 1e-3
    np.testing.assert_allclose(softened, usual, atol=1e-3)


def test_without_what_may_be_broken_there_is_no_solution(contradicted):
    """Negative control."""
    assert Daqp().solve(contradicted) is None
    assert ProxQp().solve(contradicted) is None


@pytest.fixture
def torn(controller, reference, loaded):
    """A QP whose left sole is to pitch harder than its leg can make it while the right one is held."""
    controller.update(reference, loaded)
    qp, pitch = controller.qp.copy(), controller.layout.variables + controller.layout.contact_rows(0).start + 4
    qp.bounds_lower[pitch] = qp.bounds_upper[pitch] = 2e4
    return qp


def test_a_sole_that_nothing_holds_is_let_go_of_before_the_robot_is_thrown(robot, controller, torn):
    """Dynamics, cones and torques hold; only joints, distances and the soles' motion do not."""
    status, solution = controller.solve(torn)
    n, layout = controller.layout.variables, controller.layout
    assert status is SolveStatus.SOFTENED
    assert solution.violation <= 1e-3
    assert torn.violation(solution.x, np.concatenate((layout.soft, n + np.arange(12)))) == solution.violation
    torque = torn.A[layout.torque_rows] @ solution.x + controller.terms.bias[6:]
    assert (np.abs(torque) <= robot.limits.torque + 1e-3).all()


def test_the_equalities_alone_would_throw_it(robot, controller, torn):
    """Negative control: with torques far beyond their limits."""
    assert Daqp(soft=controller.layout.soft).solve(torn) is None
    torque = torn.A[controller.layout.torque_rows] @ equalities_only(torn).x + controller.terms.bias[6:]
    assert (np.abs(torque) / robot.limits.torque).max() > 3.0


@pytest.mark.parametrize("reference", ["swing"], indirect=True)
def test_a_foot_in_the_air_carries_nothing_where_the_other_one_is_let_go_of(controller, torn):
    solution = controller.solve(torn)[1]
    np.testing.assert_allclose(solution.x[controller.layout.wrench(1)], 0.0, atol=1e-9)


def test_a_solver_that_lies_is_not_believed(controller, reference, loaded):
    class Lying:
        name = "lying"

        def __init__(self, inner):
            self.inner = inner

        def solve(self, qp):
            solution = self.inner.solve(qp)
            wrong = solution.x + 0.1
            return type(solution)(wrong, qp.violation(wrong), solution.iterations)

    break_first(controller, Lying(controller.solvers[0]))
    assert controller.update(reference, loaded).status is SolveStatus.SECOND_SOLVER


def test_without_solvers_the_equalities_hold_and_the_torque_is_clipped(robot, controller, references, loaded):
    far = references[1](swing_position=np.array([9.0, 0.0, 5.0]))
    report = controller.update(far, loaded, fail_solvers=True)
    assert report.status is SolveStatus.EQUALITIES_ONLY
    assert (np.abs(report.torque) <= robot.limits.torque).all()
    assert np.abs(report.torque / robot.limits.torque).max() == 1.0
    qp, n = controller.qp, controller.layout.variables
    x = np.concatenate([report.acceleration, report.wrench.reshape(12) / WRENCH_UNIT])
    np.testing.assert_allclose(qp.A[:EQUALITY_ROWS] @ x, qp.bounds_lower[n : n + EQUALITY_ROWS], atol=1e-6)


def test_within_the_limits_the_fallback_is_the_answer(robot, controller, references, loaded):
    controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
    still = references[0]()
    good = controller.update(still, loaded).torque.copy()
    np.testing.assert_allclose(controller.update(still, loaded, fail_solvers=True).torque, good, atol=1e-6)


@pytest.mark.parametrize("part", ["configuration", "velocity", "reference"])
def test_what_is_no_number_holds_the_last_torque_and_says_so(robot, controller, references, loaded, part):
    q, v, reference = robot.standing.copy(), np.zeros(robot.nv), references[0]()
    last = controller.update(reference, loaded).torque.copy()
    if part == "reference":
        reference = references[0](com=np.full(3, np.nan))
    else:
        (q if part == "configuration" else v)[9] = np.nan
    controller.observe(RobotState(q, v))
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.HELD
    assert report.primal_residual == np.inf
    assert np.isfinite(report.torque).all()
    assert np.abs(report.torque).sum() < np.abs(last).sum()
    for _ in range(500):
        report = controller.update(reference, loaded)
    np.testing.assert_allclose(report.torque, 0.0, atol=1e-3)


def test_after_a_held_tick_the_controller_recovers(robot, controller, references, loaded):
    controller.observe(RobotState(np.full(robot.model.nq, np.nan), np.zeros(robot.nv)))
    assert controller.update(references[0](), loaded).status is SolveStatus.HELD
    state = RobotState(robot.standing, np.zeros(robot.nv))
    controller.observe(state)
    report = controller.update(references[0](), loaded)
    fresh = robot.controller()
    fresh.observe(state)
    assert report.status is SolveStatus.SOLVED
    np.testing.assert_array_equal(report.torque, fresh.update(references[0](), loaded).torque)
