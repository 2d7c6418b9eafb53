"""A foot that rolls about an edge of its sole: its frame, its contact, its wrench."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.contact.cone import TOE_DEPTH, wrench_cone
from surefoot.wbc.contact.contacts import ContactParameters, ContactSchedule
from surefoot.wbc.parameters import ContactGains
from surefoot.wbc.reference import LEVEL
from surefoot.wbc.tasks.balance import SupportRegion
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

TOE, PITCH = 0.0375, 0.3
FRICTION, COP_SHARE = 0.8, 0.9


def edge(robot, q, foot, side):
    """Placement of the frame at the toe edge, or with side -1 the heel edge, that is level when the foot is pitched."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    sole = data.oMf[robot.model.getFrameId(robot.frames.soles[foot])]
    return sole * pin.SE3(pin.utils.rotate("y", -side * PITCH), np.array([side * TOE, 0.0, 0.0]))


@pytest.fixture
def state(robot, rng):
    return robot.moved(rng, 0.2, 1.0)


@pytest.fixture(params=[1, -1])
def side(request):
    """The edge in question."""
    return request.param


@pytest.fixture(params=[0, 1])
def shifted(request, robot, state, side):
    """Terms with one foot seen from an edge, that foot, and what takes its wrench to the sole."""
    terms = RobotTerms(robot.model, robot.frames)
    terms.update(state.q, state.v)
    return terms, request.param, terms.shift_foot(request.param, side * TOE, side * PITCH)


def test_jacobian_is_the_derivative_of_the_edges_placement(robot, state, side, shifted):
    terms, foot, _ = shifted
    h = 1e-6
    for i in range(robot.nv):
        step = np.zeros(robot.nv)
        step[i] = h
        ahead, behind = (edge(robot, pin.integrate(robot.model, state.q, s * step), foot, side) for s in (1.0, -1.0))
        rate = pin.log6(behind.actInv(ahead)).vector / (2 * h)
        np.testing.assert_allclose(terms.sole_jacobian[foot][:, i], rate, atol=1e-8)
    np.testing.assert_allclose(terms.sole_velocity[foot], terms.sole_jacobian[foot] @ state.v, atol=1e-10)


def test_bias_is_the_acceleration_that_velocity_alone_brings(robot, state, side, shifted):
    terms, foot, _ = shifted
    R, h = terms.contact_rotation[foot].copy(), 1e-4
    moved = (pin.integrate(robot.model, state.q, s * h * state.v) for s in (-1, 0, 1))
    places = [edge(robot, q, foot, side).translation for q in moved]
    acceleration = (places[2] - 2.0 * places[1] + places[0]) / h**2
    np.testing.assert_allclose(R @ terms.sole_bias[foot, :3], acceleration, atol=1e-3)


def test_other_foot_and_the_soles_themselves_are_left_alone(robot, state, shifted):
    terms, foot, _ = shifted
    plain = RobotTerms(robot.model, robot.frames)
    plain.update(state.q, state.v)
    np.testing.assert_array_equal(terms.sole_position, plain.sole_position)
    np.testing.assert_array_equal(terms.sole_rotation, plain.sole_rotation)
    np.testing.assert_array_equal(terms.sole_jacobian[1 - foot], plain.sole_jacobian[1 - foot])
    np.testing.assert_array_equal(terms.contact_position[1 - foot], plain.sole_position[1 - foot])


def test_wrench_means_the_same_at_the_edge_and_at_the_sole(robot, state, shifted, rng):
    terms, foot, to_sole = shifted
    plain = RobotTerms(robot.model, robot.frames)
    plain.update(state.q, state.v)
    w = rng.normal(size=6)
    columns = slice(6 * foot, 6 * foot + 6)
    np.testing.assert_allclose(
        terms.sole_wrench_map[:, columns] @ w, plain.sole_wrench_map[:, columns] @ to_sole @ w, atol=1e-12
    )
    np.testing.assert_allclose(terms.sole_jacobian[foot].T @ w, plain.sole_jacobian[foot].T @ (to_sole @ w), atol=1e-12)


def test_level_soles_undo_a_roll(robot, side):
    """About the toe edge where the heel is up, about the heel edge where the toes are."""
    terms = RobotTerms(robot.model, robot.frames)
    terms.update(robot.standing, np.zeros(robot.nv))
    flat = terms.sole_position.copy()
    q = robot.standing.copy()
    q[robot.model.joints[robot.model.getJointId("left_ankle_pitch")].idx_q] += side * PITCH
    terms.update(q, np.zeros(robot.nv))
    edge_now = terms.sole_position[0] + side * TOE * terms.sole_rotation[0, :, 0]
    levelled = terms.level_soles(TOE, -TOE)
    np.testing.assert_allclose(levelled[0], edge_now - np.array([side * TOE, 0.0, 0.0]), atol=1e-6)
    np.testing.assert_allclose(levelled[1], flat[1], atol=1e-6)
    np.testing.assert_array_equal(terms.level_soles(0.0, 0.0), terms.sole_position)


@pytest.fixture
def rolled(robot, references, loaded, side):
    """Answer of a controller whose right foot rolls, the weight between the left sole and the right edge."""
    standing, _ = references
    controller = robot.controller()
    state = RobotState(robot.standing, np.zeros(robot.nv))
    roll = (0.0, side * 0.5, side * 4.0)
    reference = standing(
        zmp=np.array([side * 0.02, 0.03]),
        load_share=(0.7, 0.3),
        lifting_foot=1,
        time_to_switch=0.05,
        edge=(0, side),
        roll=(LEVEL, roll),
    )
    controller.observe(state)
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.SOLVED
    plain = RobotTerms(robot.model, robot.frames)
    plain.update(state.q, state.v)
    return controller, state, report, roll, plain


def test_the_edge_rests_and_the_foot_pitches_as_planned(rolled, side):
    controller, _, report, roll, _ = rolled
    terms = controller.terms
    motion = terms.sole_jacobian[1] @ report.acceleration + terms.sole_bias[1]
    expected = np.zeros(6)
    expected[4] = (20.0 if side > 0 else 100.0) * roll[1] + roll[2]
    np.testing.assert_allclose(motion, expected, atol=1e-5)


def test_the_wrench_is_on_the_line_of_the_edge_and_in_its_cone(rolled, side):
    _, _, report, _, _ = rolled
    fx, fy, fz, tx, ty, tz = report.wrench[1]
    assert fz > 20.0
    assert abs(-ty / fz - side * TOE) <= TOE_DEPTH + 1e-6
    assert abs(tx / fz) <= COP_SHARE * TOE + 1e-6
    at_edge = np.array([fx, fy, fz, tx, ty + side * TOE * fz, tz - side * TOE * fy])
    cone = wrench_cone(TOE_DEPTH, COP_SHARE * TOE, FRICTION / np.sqrt(2.0))
    assert (cone @ at_edge).max() <= 1e-5


def test_the_equations_of_motion_hold_with_the_wrench_at_the_sole(robot, rolled):
    _, state, report, _, plain = rolled
    generalised = pin.rnea(robot.model, robot.model.createData(), state.q, state.v, report.acceleration)
    contact = plain.contact_jacobian.T @ report.wrench.reshape(12)
    np.testing.assert_allclose(generalised - contact, np.concatenate([np.zeros(6), report.torque]), atol=1e-6)


def test_without_a_roll_the_sole_carries_again(robot, references, loaded, rolled):
    controller, state, *_ = rolled
    standing, _ = references
    controller.observe(state)
    after = controller.update(standing(), loaded)
    fresh = robot.controller()
    fresh.observe(state)
    np.testing.assert_array_equal(after.torque, fresh.update(standing(), loaded).torque)


def test_only_the_edge_of_a_rolling_foot_supports():
    region = SupportRegion(0.1, 0.05, 1.0)
    positions = np.array([[0.5, 0.1, 0.0], [0.1, -0.1, 0.0]])  # left sole's centre, right toe edge
    rotations = np.tile(np.eye(3), (2, 1, 1))
    region.rebuild(positions, rotations, (True, True), (0, 1))
    assert region.project(0.05, -0.1) == pytest.approx((0.1, -0.1))
    assert region.project(0.12, -0.1) == (0.12, -0.1)


def test_a_foot_in_the_air_stands_on_no_edge_and_one_that_carries_alone_may(references):
    standing, _ = references
    schedule = ContactSchedule(ContactParameters(), 981.0, 0.002)
    assert schedule.update(standing(edge=(-1, 1)), FootSensing((500.0, 400.0))).edge == (-1, 1)
    lifted = standing(planned_contact=(True, False), swing_foot=1, edge=(0, 1))
    assert schedule.update(lifted, FootSensing((900.0, 0.0))).edge == (0, 0)
    both = standing(planned_contact=(True, False), swing_foot=1, edge=(1, -1))
    assert schedule.update(both, FootSensing((900.0, 0.0))).edge == (1, 0)


@pytest.mark.parametrize("seed", range(3))
def test_a_foot_that_moves_and_leans_is_brought_back_to_its_roll(robot, references, loaded, side, seed):
    """Its edge comes to rest, and about it the foot turns with the roll: the harder at heel strike."""
    standing, _ = references
    controller, gains = robot.controller(), ContactGains()
    controller.observe(robot.moved(np.random.default_rng(seed), 0.03, 0.2))
    _, rate, bend = roll = (0.0, side * 0.5, side * 4.0)
    reference = standing(zmp=np.array([side * 0.02, 0.0]), load_share=(0.7, 0.3), edge=(0, side), roll=(LEVEL, roll))
    report = controller.update(reference, loaded)
    assert report.status is SolveStatus.SOLVED
    terms = controller.terms
    v, normal = terms.sole_velocity[1].copy(), terms.contact_rotation[1, 2]
    expected = -gains.damping * v
    expected[3] -= gains.levelling * normal[1]
    if side > 0:
        expected[4] += gains.levelling * normal[0] + gains.damping * rate + bend
    else:
        expected[4] = gains.striking * normal[0] + gains.striking_damping * (rate - v[4]) + bend
    motion = terms.sole_jacobian[1] @ report.acceleration + terms.sole_bias[1]
    assert np.abs(terms.sole_bias[1]).min() > 1e-4
    np.testing.assert_allclose(motion, expected, atol=1e-5)
