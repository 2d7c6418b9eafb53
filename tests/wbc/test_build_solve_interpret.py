"""The three parts of a tick, each by itself."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.wbc.body.ik import PostureTarget
from surefoot.wbc.contact.contacts import ContactState
from surefoot.wbc.parameters import ContactGains
from surefoot.wbc.qp.data import EQUALITY_ROWS, WRENCH_UNIT
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

BOTH = ContactState((True, True), (True, True), (2943.0, 2943.0))
LEFT = ContactState((True, False), (True, False), (2943.0, 0.0))
SENSED = FootSensing((490.0, 490.0))


@pytest.fixture
def state(robot, rng):
    return robot.moved(rng, 0.02, 0.2)


def test_an_update_is_build_solve_and_interpret(robot, state, reference):
    whole, parts = robot.controller(), robot.controller()
    whole.observe(state)
    report = whole.update(reference, SENSED)
    terms = parts.observe(state)
    qp = parts.build(terms, reference, parts.schedule.update(reference, SENSED))
    status, solution = parts.solve(qp)
    answer = parts.interpret(terms, solution)
    assert status is report.status is SolveStatus.SOLVED
    for name in ("torque", "acceleration", "wrench", "task_error"):
        np.testing.assert_array_equal(getattr(answer, name), getattr(report, name), err_msg=name)


@pytest.mark.parametrize("part", ["build", "solve", "interpret"])
def test_an_update_asks_a_class_below_for_the_part_that_it_does_its_own_way(robot, state, reference, part):
    usual, asked = robot.controller(), []
    below = type("Below", (type(usual),), {part: lambda self, *given: asked.append(part) or own(self, *given)})
    own, other = getattr(type(usual), part), robot.controller(kind=below)
    for controller in (usual, other):
        controller.observe(state)
    torque = usual.update(reference, SENSED).torque
    np.testing.assert_array_equal(other.update(reference, SENSED).torque, torque)
    assert asked == [part]


def test_a_copied_qp_outlives_the_next_build_and_solves_the_same(robot, state, references):
    controller = robot.controller()
    terms = controller.observe(state)
    kept = controller.build(terms, references[1](), LEFT).copy()
    x = controller.solve(kept)[1].x
    other = controller.build(terms, references[0](), BOTH)
    assert np.abs(other.g - kept.g).max() > 0.1
    np.testing.assert_array_equal(controller.solve(kept)[1].x, x)
    again = controller.build(terms, references[1](), LEFT)
    for name in ("H", "g", "A", "bounds_lower", "bounds_upper"):
        np.testing.assert_array_equal(getattr(again, name), getattr(kept, name), err_msg=name)


def test_equations_of_motion_can_be_read_off_a_qp_without_a_solver(robot, state, references, rng):
    controller = robot.controller()
    terms = controller.observe(state)
    qp, x = controller.build(terms, references[0](), BOTH), rng.normal(size=robot.nv + 12)
    base = slice(12, EQUALITY_ROWS)
    bound = qp.bounds_lower[x.size :][base]
    force = terms.contact_jacobian.T @ (WRENCH_UNIT * x[robot.nv :])
    expected = terms.mass_matrix @ x[: robot.nv] + terms.bias - force
    np.testing.assert_allclose(qp.A[base] @ x - bound, expected[:6], atol=1e-8)


@pytest.mark.parametrize("raised", [-0.4, 0.4])
def test_a_foot_that_lands_goes_on_down_along_its_normal_at_a_speed_of_its_own(robot, state, references, raised):
    """Its equality is J q̈ + J' v = -d J v; along the normal of a foot that lands it is -d (J v + its speed)."""
    controller, gains, targets = robot.controller(), ContactGains(), {}
    v = state.v.copy()
    v[2] += raised
    terms = controller.observe(RobotState(state.q, v))
    for landing in (False, True):
        contacts = replace(BOTH, landing=(False, landing))
        qp = controller.build(terms, references[0](), contacts)
        targets[landing] = qp.bounds_lower[qp.g.size :][6:12].copy()
    speed = terms.sole_velocity[1, 2]
    assert abs(speed) > 0.2 and bool(speed < 0.0) is (raised < 0.0)
    more = gains.damping * speed - gains.softening * (speed + gains.sinking)
    np.testing.assert_allclose(targets[True] - targets[False], [0.0, 0.0, more, 0.0, 0.0, 0.0], atol=1e-9)


def test_a_rolling_foot_can_be_built_twice_from_one_state(robot, state, references):
    """The toe edge is the frame of that QP only, and shifting it again starts from the sole."""
    controller = robot.controller()
    terms = controller.observe(state)
    sole = terms.sole_jacobian.copy()
    rolling = references[0](edge=(0, 1), roll=((0.0, 0.0, 0.0), (0.3, 0.5, 0.0)))
    contacts = ContactState((True, True), (True, True), (2943.0, 2943.0), edge=(0, 1))
    first = controller.build(terms, rolling, contacts).copy()
    assert np.abs(terms.sole_jacobian[1] - sole[1]).max() > 1e-2
    np.testing.assert_array_equal(controller.build(terms, rolling, contacts).A, first.A)
    controller.build(terms, references[0](), BOTH)
    np.testing.assert_array_equal(terms.sole_jacobian, sole)


def test_without_a_solution_the_last_torque_fades_and_the_rest_stays(robot, state, reference):
    controller = robot.controller()
    terms = controller.observe(state)
    qp = controller.build(terms, reference, controller.schedule.update(reference, SENSED))
    answer = controller.interpret(terms, controller.solve(qp)[1])
    torque, wrench = answer.torque.copy(), answer.wrench.copy()
    faded = controller.interpret(terms, None)
    assert np.abs(faded.torque).sum() < np.abs(torque).sum()
    np.testing.assert_array_equal(faded.wrench, wrench)
    for _ in range(500):
        faded = controller.interpret(terms, None)
    rates = terms.v[6:]
    assert (np.sign(faded.torque) == -np.sign(rates)).all() and np.abs(rates).max() > 0.0


def test_a_posture_step_can_be_built_without_being_solved(robot):
    ik = robot.ik()
    target = PostureTarget(np.array([[0.1, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), np.array([0.0, 0.0, 0.95]), 0.0)
    step = ik.build_step(target, robot.standing)
    J, e = ik.linearise(target, robot.standing)
    assert step.error == np.abs(e).max() > 0.04
    free = step.H - J.T @ J
    np.testing.assert_allclose(free, np.diag(np.diag(free)), atol=1e-12)
    assert np.diag(free).min() > 0.0
    assert np.diag(free).max() < 1e-8
    near = ik.build_step(target, robot.standing, nearness=1e-3)
    away = robot.nominal - robot.standing[7:]
    np.testing.assert_allclose(near.g[6:] + J[:, 6:].T @ e, -1e-3 * away, atol=1e-12)
    assert np.abs(away).max() > 0.01
    dq = ik.solve_step(step)
    gradient = step.H @ dq + step.g
    inside = (dq > step.lower + 1e-9) & (dq < step.upper - 1e-9)
    assert inside.sum() > robot.nv // 2
    assert np.abs(gradient[inside]).max() < 1e-8
    assert (gradient[dq <= step.lower + 1e-9] >= -1e-9).all()
    assert (gradient[dq >= step.upper - 1e-9] <= 1e-9).all()
