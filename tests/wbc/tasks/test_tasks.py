"""The structure of the cost, and each task's rows and target against finite differences of what it steers."""

from dataclasses import fields, replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.parameters import BalanceGains, WbcParameters
from surefoot.wbc.qp.data import WRENCH_UNIT, QpLayout, allocate
from surefoot.wbc.qp.solvers import QpSolution
from surefoot.wbc.tasks import DEFAULT_LAYOUT, TaskGains, TaskStack, TaskWeights
from surefoot.wbc.tasks.balance import BalanceLaw, SupportRegion
from surefoot.wbc.tasks.default import default_tasks
from surefoot.wbc.tasks.swing import SwingFoot
from surefoot.wbc.types import GRAVITY, ExternalLoad, RobotState

pytestmark = pytest.mark.unit

ONLY_DIAGONAL = {"upper_posture", "leg_posture", "acceleration", "force", "moment"}
NAMES = [name for name, _ in DEFAULT_LAYOUT]
PLACES = {
    name: slice(end - size, end)
    for (name, size), end in zip(DEFAULT_LAYOUT, np.cumsum([n for _, n in DEFAULT_LAYOUT]), strict=True)
}
TOE = 0.0375


@pytest.fixture
def state(robot, rng):
    return robot.moved(rng, 0.02, 0.3)


@pytest.fixture
def written(robot, state, references, loaded):
    """Controller, QP and task stack of a swing state, made with given changes of the weights."""

    def write(catching=False, **changes):
        controller = robot.controller(WbcParameters(weights=replace(TaskWeights(), **changes)))
        controller.observe(state)
        controller.update(references[1](catching=catching), loaded)
        return controller, controller.qp, controller.tasks

    return write


@pytest.fixture
def asked(robot, state, references):
    """Terms of the swing state, and by name each default task's J and a, with a scale of one."""
    controller = robot.controller()
    terms, reference = controller.observe(state), references[1](heading=0.2, heading_rate=0.3)
    region = SupportRegion(1.0, 1.0, 1.0)
    region.rebuild(terms.contact_position, terms.contact_rotation, (True, False))
    found = {}
    for task in default_tasks(WbcParameters(), region, (TOE, 0.05)):
        J = np.zeros((task.size, robot.nv + 12))
        a = np.array(tuple(task.write(terms, reference, np.ones((task.size, 1)), J)))
        found[task.name] = J, a
    return terms, reference, region, found


def test_the_default_layout_is_the_controllers(robot):
    assert robot.controller().task_layout == DEFAULT_LAYOUT
    assert NAMES == ["CoM", "angular momentum", "pelvis", "torso", "swing foot"]
    assert [size for _, size in DEFAULT_LAYOUT] == [3, 3, 3, 3, 6]


def test_a_torso_that_is_the_pelvis_is_held_once(robot):
    pelvis = replace(robot, frames=replace(robot.frames, torso="pelvis"))
    assert [name for name, _ in pelvis.controller().task_layout] == ["CoM", "angular momentum", "pelvis", "swing foot"]


def test_the_cost_is_least_squares_plus_a_diagonal(written):
    _, qp, tasks = written()
    T, t = tasks.rows, tasks.target
    np.testing.assert_allclose(qp.H, T.T @ T + np.diag(tasks.diagonal), atol=1e-10)
    np.testing.assert_allclose(qp.g, -(T.T @ t + tasks.linear), atol=1e-10)
    assert np.linalg.eigvalsh(qp.H).min() > 0.0


@pytest.mark.parametrize("name", NAMES)
def test_a_unit_weight_makes_the_cost_that_of_its_jacobian(robot, asked, name):
    """H = JᵀJ and g = -Jᵀa of one task alone, without any diagonal term."""
    terms, reference, region, found = asked
    task = next(task for task in default_tasks(WbcParameters(), region, (TOE, 0.05)) if task.name == name)
    task.weight = 1.0
    qp = allocate(QpLayout(robot.nv, 16))
    TaskStack(qp, (task,), ()).write(terms, reference)
    J, a = found[name]
    np.testing.assert_allclose(qp.H, J.T @ J, atol=1e-12)
    np.testing.assert_allclose(qp.g, -J.T @ a, atol=1e-12)


@pytest.mark.parametrize(
    ("weight", "rows"),
    [
        ("com_horizontal", [0, 1]),
        ("com_vertical", [2]),
        ("angular_momentum", PLACES["angular momentum"]),
        ("orientation", slice(PLACES["pelvis"].start, PLACES["torso"].stop)),
        ("swing", PLACES["swing foot"]),
    ],
)
def test_a_weight_of_zero_removes_its_task(written, weight, rows):
    _, qp, tasks = written(**{weight: 0.0})
    _, whole, full = written()
    assert not tasks.rows[rows].any()
    T = full.rows[rows]
    np.testing.assert_allclose(whole.H - qp.H, T.T @ T, atol=1e-9)
    np.testing.assert_allclose(whole.g - qp.g, -T.T @ full.target[rows], atol=1e-9)
    assert (tasks.unscale[rows] == 0.0).all()


def test_every_weight_matters(written):
    walking, caught = written()[1], written(catching=True)[1]
    for field in fields(TaskWeights):
        catching = field.name.endswith("catching")
        whole = caught if catching else walking
        _, qp, _ = written(catching, **{field.name: 2.0 * getattr(TaskWeights(), field.name)})
        changed = np.flatnonzero(np.abs(qp.H - whole.H).max(axis=0))
        assert changed.size > 0, field.name
        if field.name in ONLY_DIAGONAL:
            off = qp.H - whole.H
            np.testing.assert_allclose(off, np.diag(np.diag(off)), atol=1e-12)


def test_height_momentum_heading_and_posture_count_otherwise_while_a_step_catches_the_body_and_as_before_after_it(
    robot, state, references, loaded
):
    within = WbcParameters(balance=BalanceGains(beyond_catching=0.0))  # which changes what the CoM is to do
    controller, weights, seen = robot.controller(within), TaskWeights(), []
    for catching in (False, True, False):
        terms = controller.observe(state)
        qp = controller.build(
            terms, references[1](catching=catching), controller.schedule.update(references[1](), loaded)
        )
        residual = controller.interpret(terms, QpSolution(np.ones(qp.g.size), 0.0, 0)).task_error
        seen.append((controller.tasks.rows.copy(), controller.tasks.target.copy(), qp.H.copy(), residual.copy()))
    (rows, target, H, residual), (caught, aim, H_caught, same), (after, target_after, H_after, _) = seen
    more = np.ones(len(target))
    more[2] = np.sqrt(weights.com_vertical_catching / weights.com_vertical)
    more[3:6] = np.sqrt(weights.angular_momentum_catching / weights.angular_momentum)
    more[[6, 7, 9, 10]] = np.sqrt(weights.upright_catching / weights.orientation)
    more[[8, 11]] = np.sqrt(weights.turning_catching / weights.orientation)
    np.testing.assert_allclose(caught, more[:, None] * rows, rtol=1e-12)
    np.testing.assert_allclose(aim, more * target, rtol=1e-12)
    np.testing.assert_allclose(same, residual, rtol=1e-9, atol=1e-9)
    assert all((one == other).all() for one, other in ((after, rows), (target_after, target), (H_after, H)))
    np.testing.assert_allclose(H - rows.T @ rows, H_caught - caught.T @ caught, atol=1e-9)


def placed(robot, q, v):
    """Pinocchio's data of a state with its frames, and the frames by name."""
    data = robot.model.createData()
    pin.computeCentroidalMomentum(robot.model, data, q, v)
    pin.updateFramePlacements(robot.model, data)
    velocity = {
        name: pin.getFrameVelocity(robot.model, data, robot.model.getFrameId(name), pin.ReferenceFrame.LOCAL).copy()
        for name in (robot.frames.torso, robot.frames.soles[1])
    }
    return data, velocity


def rates(robot, state, acceleration, h=1e-6):
    """Values that each task steers, by name, differentiated along a motion with that generalised acceleration."""
    found = []
    for t in (-h, h):
        v = state.v + t * acceleration
        q = pin.integrate(robot.model, state.q, t * state.v + 0.5 * t * t * acceleration)
        data, velocity = placed(robot, q, v)
        sole = velocity[robot.frames.soles[1]]
        turned = data.oMf[robot.model.getFrameId(robot.frames.soles[1])].rotation
        found.append({
            "CoM": data.hg.linear.copy(), "angular momentum": data.hg.angular.copy(), "pelvis": v[3:6].copy(),
            "torso": velocity[robot.frames.torso].angular.copy(),
            "swing foot": np.concatenate([turned @ sole.linear, sole.angular]),
        })  # fmt: skip
    return {name: (found[1][name] - found[0][name]) / (2 * h) for name in found[0]}


def consistent(robot, terms, rng):
    """Generalised acceleration and sole wrenches, in their units, that obey the floating base's equations of motion."""
    acceleration = rng.normal(size=robot.nv)
    needed = terms.mass_matrix[:6] @ acceleration + terms.bias[:6]
    wrench = np.linalg.lstsq(terms.contact_jacobian.T[:6], needed, rcond=None)[0]
    return acceleration, wrench / WRENCH_UNIT


def test_rows_are_the_derivatives_of_what_the_tasks_steer(robot, state, asked, rng):
    terms, _, _, found = asked
    acceleration, wrench = consistent(robot, terms, rng)
    x = np.concatenate([acceleration, wrench])
    rate = rates(robot, state, acceleration)
    J = {name: J @ x for name, (J, _) in found.items()}
    R = terms.sole_rotation[1]
    weight = np.array([0.0, 0.0, GRAVITY])
    np.testing.assert_allclose(J["CoM"] - weight, rate["CoM"] / terms.mass, atol=1e-6)
    np.testing.assert_allclose(J["angular momentum"], rate["angular momentum"] / terms.mass, atol=1e-6)
    np.testing.assert_allclose(J["pelvis"], rate["pelvis"], atol=1e-8)
    np.testing.assert_allclose(J["torso"] + terms.torso_bias, rate["torso"], atol=1e-6)
    sole = J["swing foot"] + terms.sole_bias[1]
    np.testing.assert_allclose(np.concatenate([R @ sole[:3], sole[3:]]), rate["swing foot"], atol=1e-6)


def test_targets_are_the_feedback_that_they_claim(robot, state, asked):
    """Error and velocity in world axes, from forward kinematics alone."""
    terms, reference, region, found = asked
    gains = TaskGains()
    com = BalanceLaw(BalanceGains(), region).acceleration(reference, terms.com, terms.com_velocity)
    np.testing.assert_allclose(found["CoM"][1], np.array(com) + np.array([0.0, 0.0, GRAVITY]))
    np.testing.assert_allclose(found["angular momentum"][1] * terms.mass, -3.0 * terms.angular_momentum)
    data, velocity = placed(robot, state.q, state.v)
    upright = pin.utils.rotate("z", reference.heading)
    for name, R, spin, bias in (
        ("pelvis", data.oMi[1].rotation, state.v[3:6], 0.0),
        ("torso", terms.torso_rotation, velocity[robot.frames.torso].angular, terms.torso_bias),
    ):
        k, d = gains.orientation
        wanted = k * pin.log3(upright @ R.T) + d * (np.array([0.0, 0.0, reference.heading_rate]) - R @ spin)
        np.testing.assert_allclose(R @ (found[name][1] + bias), wanted, atol=1e-9, err_msg=name)
    (k, d), R, sole = gains.swing, terms.sole_rotation[1], velocity[robot.frames.soles[1]]
    a = found["swing foot"][1] + terms.sole_bias[1]
    linear = k * (reference.swing_position - terms.sole_position[1])
    linear += d * (reference.swing_velocity - R @ sole.linear) + reference.swing_acceleration
    angular = k * pin.log3(reference.swing_rotation @ R.T)
    angular += d * (reference.swing_angular_velocity - R @ sole.angular) + reference.swing_angular_acceleration
    np.testing.assert_allclose(R @ a[:3], linear, atol=1e-9)
    np.testing.assert_allclose(R @ a[3:], angular, atol=1e-9)


def test_the_pelvis_follows_its_turn_and_its_list_without_lag(robot, references):
    """On its way, with the velocity of that, it accelerates as the way does: finite differences of the orientation."""
    q, v, t, step = robot.standing.copy(), np.zeros(robot.nv), 0.3, 1e-4
    polynomials = np.array([[0.05, -0.2, 0.4, 0.3], [0.02, 0.4, -0.3, 0.2]])
    yaw, roll = (np.polynomial.Polynomial(c) for c in polynomials)
    heading = np.polynomial.Polynomial([0.1, 0.3])  # turns at a steady rate

    def turned(at):
        return pin.utils.rotate("z", heading(at) + yaw(at)) @ pin.utils.rotate("x", roll(at))

    def spin(at):
        return pin.log3(turned(at - step).T @ turned(at + step)) / (2.0 * step)

    def motion(angle):
        return tuple(float(angle.deriv(k)(t)) for k in range(3))

    q[3:7], v[3:6] = pin.Quaternion(turned(t)).coeffs(), spin(t)
    alpha = (spin(t + step) - spin(t - step)) / (2.0 * step)
    controller = robot.controller()
    terms = controller.observe(RobotState(q, v))
    pelvis = default_tasks(WbcParameters(), SupportRegion(1.0, 1.0, 1.0), (TOE, 0.05))[2]

    def asked(**changes):
        given = {"heading": heading(t), "heading_rate": float(heading.deriv()(t)), **changes}
        J = np.zeros((3, robot.nv + 12))
        return np.array(tuple(pelvis.write(terms, references[1](**given), np.ones((3, 1)), J)))

    np.testing.assert_allclose(asked(pelvis_yaw=motion(yaw), pelvis_list=motion(roll)), alpha, atol=1e-3)
    assert np.abs(asked() - alpha).max() > 1.0
    lagging = asked(pelvis_yaw=(yaw(t), 0.0, 0.0), pelvis_list=(roll(t), 0.0, 0.0))
    assert np.abs(lagging - alpha).max() > 1.0


def test_the_swing_task_is_absent_when_both_feet_stand(robot, references, loaded):
    controller = robot.controller()
    controller.observe(robot.moved(np.random.default_rng(0)))
    controller.update(references[1](), loaded)
    swing = PLACES["swing foot"]
    assert controller.tasks.rows[swing].any()
    report = controller.update(references[0](), loaded)
    assert not controller.tasks.rows[swing].any()
    assert not report.task_error[swing].any()


@pytest.mark.parametrize("side", [1, -1])
def test_a_rolling_foot_is_steered_by_its_edge(robot, state, references, side):
    """The edge goes to that of the planned sole, and the pitch is damped towards the planned one."""
    terms, roll, (k, d) = robot.controller().observe(state), (0.3, 0.5, 2.0), TaskGains().swing
    terms.shift_foot(1, side * TOE, roll[0])
    task = SwingFoot(TaskWeights(), TaskGains(), (TOE, 0.05), 1.0)
    targets = []
    for edge in (side, 0):
        reference, J = references[1](edge=(0, edge), roll=((0.0, 0.0, 0.0), roll)), np.zeros((6, robot.nv + 12))
        targets.append(np.array(task.write(terms, reference, np.ones((6, 1)), J)))
        np.testing.assert_array_equal(J[:, : robot.nv], terms.sole_jacobian[1])
    ahead = terms.contact_rotation[1].T @ (k * side * TOE * reference.swing_rotation[:, 0])
    np.testing.assert_allclose(targets[0] - targets[1], [*ahead, 0.0, d * 0.5 + 2.0, 0.0], atol=1e-9)


def test_diagonal_terms_ask_for_posture_share_and_rest(robot, state, references, loaded):
    """Each single variable is what it would be if nothing else weighed it."""
    controller = robot.controller(WbcParameters(arm_swing=0.0))
    controller.observe(state)
    controller.update(references[0](load_share=(0.7, 0.3)), loaded)
    terms, tasks, weights = controller.terms, controller.tasks, TaskWeights()
    k, d = TaskGains().posture
    posture = np.where(robot.leg_joints, weights.leg_posture, weights.upper_posture)
    wanted = posture * (k * (robot.standing[7:] - state.q[7:]) - d * state.v[6:])
    np.testing.assert_allclose(tasks.linear[6 : robot.nv], wanted, atol=1e-12)
    np.testing.assert_allclose(tasks.diagonal[6 : robot.nv], posture + weights.acceleration)
    assert not tasks.linear[:6].any()
    wrench = WRENCH_UNIT * (tasks.linear / tasks.diagonal)[robot.nv :].reshape(2, 6)
    load = terms.mass * GRAVITY
    np.testing.assert_allclose(wrench[:, 2], [0.7 * load, 0.3 * load])
    assert not np.delete(wrench, 2, axis=1).any()


def test_the_ground_need_not_give_what_a_lasting_load_gives(robot, state, references):
    """Its force per mass is left out of what is asked of the soles for the CoM, and its moment for the momentum."""
    load, asked = ExternalLoad(np.array([30.0, -20.0, 8.0]), np.array([4.0, 7.0, -2.0]), 1.0), []
    for bears in (False, True):
        controller = robot.controller()
        terms, reference = controller.observe(state), references[1]()
        if bears:
            terms.bear(load)
        region = SupportRegion(1.0, 1.0, 1.0)
        region.rebuild(terms.contact_position, terms.contact_rotation, (True, False))
        tasks = {task.name: task for task in default_tasks(WbcParameters(), region, (TOE, 0.05))}
        asked.append(
            [
                np.array(tasks[name].write(terms, reference, np.ones((3, 1)), np.zeros((3, robot.nv + 12))))
                for name in ("CoM", "angular momentum")
            ]
        )
    (com, momentum), (loaded_com, loaded_momentum) = asked
    np.testing.assert_allclose(loaded_com, com - load.force / terms.mass, atol=1e-12)
    np.testing.assert_allclose(loaded_momentum, momentum - load.moment / terms.mass, atol=1e-12)
