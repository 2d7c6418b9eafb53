"""The laws of physics, the contacts and the limits hold in what the controller answers."""

import time
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.contact.cone import wrench_cone
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.types import GRAVITY, FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

HALF_SOLE, FRICTION, COP_SHARE = 0.0375, 0.8, 0.9


@pytest.fixture(params=range(4))
def answer(request, robot, reference, loaded):
    """Controller, state and report at a random state near standing."""
    rng = np.random.default_rng(request.param)
    controller, state = robot.controller(), robot.moved(rng, 0.03, 0.2)
    controller.observe(state)
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.SOLVED
    return controller, state, report


def test_the_equations_of_motion_hold(robot, answer):
    controller, state, report = answer
    terms = controller.terms
    generalised = pin.rnea(robot.model, robot.model.createData(), state.q, state.v, report.acceleration)
    contact = terms.contact_jacobian.T @ report.wrench.reshape(12)
    np.testing.assert_allclose(generalised - contact, np.concatenate([np.zeros(6), report.torque]), atol=1e-8)


def test_newton_and_euler_hold(robot, answer):
    controller, state, report = answer
    terms, data = controller.terms, robot.model.createData()
    rate = pin.computeCentroidalMomentumTimeVariation(robot.model, data, state.q, state.v, report.acceleration)
    R, w = terms.sole_rotation, report.wrench
    force = np.einsum("kij,kj->ki", R, w[:, :3])
    moment = np.einsum("kij,kj->ki", R, w[:, 3:]) + np.cross(terms.sole_position - terms.com, force)
    np.testing.assert_allclose(force.sum(0) - [0, 0, terms.mass * GRAVITY], rate.linear, atol=1e-7)
    np.testing.assert_allclose(moment.sum(0), rate.angular, atol=1e-7)
    pin.centerOfMass(robot.model, data, state.q, state.v, report.acceleration)
    np.testing.assert_allclose(terms.mass * data.acom[0], rate.linear, atol=1e-7)


def test_held_soles_only_settle_and_level(robot, answer):
    controller, _, report = answer
    terms = controller.terms
    for k in np.flatnonzero(report.active):
        tilt = terms.sole_rotation[k, 2]
        expected = -20.0 * terms.sole_velocity[k]
        expected[3:5] += 100.0 * np.array([-tilt[1], tilt[0]])
        motion = terms.sole_jacobian[k] @ report.acceleration + terms.sole_bias[k]
        np.testing.assert_allclose(motion, expected, atol=1e-8)


def test_held_soles_turn_flat_on_the_ground_of_the_plan(robot, references, loaded):
    """At rest each sole turns by the rotation vector from its own normal to the planned one."""
    normals = np.array([[-0.1, 0.05, 1.0], [0.08, 0.02, 1.0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    controller, standing = robot.controller(), references[0]
    controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
    report = controller.update(standing(ground_normal=normals), loaded)
    terms = controller.terms
    for k in (0, 1):
        motion = terms.sole_jacobian[k] @ report.acceleration + terms.sole_bias[k]
        towards = np.cross(terms.sole_rotation[k][:, 2], normals[k])
        np.testing.assert_allclose(terms.sole_rotation[k] @ motion[3:], 100.0 * towards, atol=1e-6)


def test_wrenches_lie_in_their_cones_and_lifted_feet_carry_nothing(answer):
    _, _, report = answer
    cone = wrench_cone(COP_SHARE * HALF_SOLE, COP_SHARE * HALF_SOLE, FRICTION / np.sqrt(2))
    for k in (0, 1):
        if report.active[k]:
            assert (cone @ report.wrench[k]).max() <= 1e-6
            assert report.wrench[k, 2] > 0.0
        else:
            np.testing.assert_allclose(report.wrench[k], 0.0, atol=1e-9)


def test_limits_hold_where_the_task_asks_for_more(robot, loaded, references):
    """A swing target far away would take thousands of newton metres."""
    controller = robot.controller()
    controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
    far = references[1](swing_position=np.array([3.0, -0.1, 0.8]))
    report = controller.update(far, loaded)
    limit, qp, nv = robot.limits.torque, controller.qp, robot.nv
    assert report.status is SolveStatus.SOLVED
    assert (np.abs(report.torque) <= limit).all()
    np.testing.assert_allclose(np.abs(report.torque / limit).max(), 1.0, atol=1e-6)
    assert (report.acceleration >= qp.bounds_lower[:nv] - 1e-6).all()
    assert (report.acceleration <= qp.bounds_upper[:nv] + 1e-6).all()
    assert report.primal_residual < 1e-6


def test_a_knee_at_its_limit_is_not_pushed_further(robot, loaded, references):
    knee = robot.model.getJointId("left_knee") - 2
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    q[7 + knee], v[6 + knee] = robot.limits.lower[knee] + 1e-3, -0.5
    controller = robot.controller()
    controller.observe(RobotState(q, v))
    report = controller.update(references[0](), loaded)
    T = robot.limits.position_horizon
    assert q[7 + knee] + T * v[6 + knee] + 0.5 * T**2 * report.acceleration[6 + knee] >= robot.limits.lower[knee] - 1e-9


def test_standing_at_rest_asks_for_no_motion(robot, loaded, references):
    controller = robot.controller()
    controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
    report = controller.update(references[0](), loaded)
    np.testing.assert_allclose(report.acceleration, 0.0, atol=1e-4)
    np.testing.assert_allclose(report.wrench[:, 2], 0.5 * controller.terms.mass * GRAVITY, rtol=1e-3)
    assert np.abs(report.task_error).max() < 1e-4


def test_a_com_beside_its_reference_is_pushed_back(robot, loaded, references):
    """Negative control: with the CoM off to the left the answer accelerates it, and more at more gain."""
    shifted = references[0](com=np.array([0.0, -0.004, 1.0]))
    pushes = []
    for gain in (2.0, 3.0):
        parameters = WbcParameters()
        controller = robot.controller(replace(parameters, balance=replace(parameters.balance, dcm=gain)))
        controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
        report = controller.update(shifted, loaded)
        pushes.append(report.wrench[:, 1].sum() / controller.terms.mass)
    assert pushes[1] < pushes[0] < -0.01


def test_place_and_heading_do_not_matter(robot, loaded, references):
    """The same standing robot 100 m away and turned gets the same torque."""
    torques = []
    for turn, shift in ((0.0, 0.0), (2.0, 100.0)):
        Rz = pin.utils.rotate("z", turn)
        base = pin.SE3(Rz, np.array([shift, shift, 0.0])) * pin.XYZQUATToSE3(robot.standing[:7])
        q = np.concatenate([pin.SE3ToXYZQUAT(base), robot.standing[7:]])
        controller = robot.controller()
        controller.observe(RobotState(q, np.full(robot.nv, 0.05)))
        com = Rz @ [0.002, 0.001, 1.0] + [shift, shift, 0.0]
        reference = references[0](com=com, zmp=com[:2], heading=turn)
        torques.append(controller.update(reference, loaded).torque.copy())
    np.testing.assert_allclose(torques[0], torques[1], atol=1e-6)


def test_the_same_inputs_give_the_same_bits(robot, rng, reference):
    states = [robot.moved(rng, 0.02, 0.3) for _ in range(5)]
    runs = []
    for _ in range(2):
        controller, torques = robot.controller(), []
        for state in states:
            controller.observe(state)
            torques.append(controller.update(reference, FootSensing((500.0, 400.0))).torque.tobytes())
        runs.append(torques)
    assert runs[0] == runs[1]


def test_the_time_of_an_update_is_that_of_building_and_that_of_solving(robot, reference, loaded, monkeypatch):
    """The clock is three seconds later when the QP is built, and five more when it is solved."""
    controller, looks = robot.controller(), iter((10.0, 13.0, 18.0))
    controller.observe(RobotState(robot.standing, np.zeros(robot.nv)))
    monkeypatch.setattr(time, "perf_counter", lambda: next(looks))
    report = controller.update(reference, loaded)
    assert (report.build_time, report.solve_time) == (3.0, 5.0)
