"""Dynamics of models in which joints follow others: those of the tree of all joints, seen from the independent ones."""

import coal
import numpy as np
import pinocchio as pin
import pytest

from surefoot.engines import mimic
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.body.separation import Separation
from surefoot.wbc.estimation.kinematics import ImuMount, SensedBody
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.parameters import SeparationParameters
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit

RATIO, OFFSET = 0.7, 0.1
SIDES, JOINTS = ("left", "right"), 6
SOLES, TORSO = ("left_sole", "right_sole"), "pelvis"
FRAMES = BodyFrames(SOLES, TORSO)


def tree() -> pin.Model:
    """Two legs of six hinges, the third and the fourth parallel, with random links."""
    pin.seed(7)
    rng, model = np.random.default_rng(7), pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    base = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    model.appendBodyToJoint(base, pin.Inertia.Random(), pin.SE3.Identity())
    model.addFrame(pin.Frame(TORSO, base, 0, pin.SE3.Random(), pin.FrameType.BODY))
    for side in SIDES:
        joint = base
        for number in range(JOINTS):
            axis = rng.normal(size=3) if number not in (2, 3) else np.array([0.0, 0.6, 0.8])
            place = pin.SE3.Random() if number != 3 else pin.SE3(np.eye(3), np.array([0.1, 0.2, -0.3]))
            kind = pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis))
            joint = model.addJoint(joint, kind, place, f"{side}_{number}")
            model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
        model.addFrame(pin.Frame(f"{side}_sole", joint, 0, pin.SE3.Random(), pin.FrameType.BODY))
    return model


def coupled(model: pin.Model) -> pin.Model:
    """The model whose fourth hinges follow the third ones."""
    for side in SIDES:
        leader, follower = (model.getJointId(f"{side}_{number}") for number in (2, 3))
        model = pin.transformJointIntoMimic(model, leader, follower, RATIO, OFFSET)
    return model


@pytest.fixture(scope="module")
def models():
    return coupled(tree()), tree()


def spread(model, q, v):
    """State of the tree and G, written out by name, apart from the code that is tested."""
    whole = tree()
    G, Q = np.zeros((whole.nv, model.nv)), pin.neutral(whole)
    G[:6, :6], Q[:7] = np.eye(6), q[:7]
    for joint in range(2, whole.njoints):
        side, number = whole.names[joint].split("_")
        follows = number == "3"
        own = model.getJointId(f"{side}_{2 if follows else number}")
        factor, offset = (RATIO, OFFSET) if follows else (1.0, 0.0)
        G[whole.idx_vs[joint], model.idx_vs[own]] = factor
        Q[whole.idx_qs[joint]] = factor * q[model.idx_qs[own]] + offset
    return Q, G @ v, G


def states(model, count=3):
    rng = np.random.default_rng(5)
    for _ in range(count):
        q = pin.integrate(model, pin.neutral(model), rng.normal(size=model.nv))
        yield q, rng.normal(size=model.nv)


def near(found, expected):
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11)


def test_names_are_those_of_the_independent_joints(models):
    short, whole = models
    expected = tuple(f"{side}_{number}" for side in SIDES for number in (0, 1, 2, 4, 5))
    assert mimic.names_of(short) == expected
    assert mimic.names_of(whole) == tuple(whole.names)[2:]
    assert (mimic.has_followers(short), mimic.has_followers(whole)) == (True, False)


def test_all_terms_are_those_of_the_tree_seen_from_the_independent_joints(models):
    short, whole = models
    terms, all_joints = RobotTerms(short, FRAMES), RobotTerms(whole, FRAMES)
    for q, v in states(short):
        Q, V, G = spread(short, q, v)
        terms.update(q, v)
        all_joints.update(Q, V)
        near(terms.mass_matrix, G.T @ all_joints.mass_matrix @ G)
        near(terms.bias, G.T @ all_joints.bias)
        for name in ("sole_jacobian", "torso_jacobian"):
            near(getattr(terms, name), getattr(all_joints, name) @ G)
        for name in (
            *("com", "com_velocity", "angular_momentum", "sole_position", "sole_rotation", "sole_velocity"),
            *("sole_bias", "torso_velocity", "torso_bias", "sole_wrench_map"),
        ):
            near(getattr(terms, name), getattr(all_joints, name))
        for each in (terms, all_joints):
            each.shift_foot(1, 0.1, 0.2)
        near(terms.sole_jacobian, all_joints.sole_jacobian @ G)
        terms.place(q, -v)
        all_joints.place(Q, -V)
        near(terms.com_velocity, all_joints.com_velocity)


def test_the_body_as_the_imu_sees_it_is_that_of_the_tree(models):
    short, _ = models
    one, other = (SensedBody(model, SOLES, ImuMount(TORSO)) for model in models)
    q, v = next(states(short))
    Q, _, G = spread(short, q, v)
    one.update(q[7:], np.eye(3))
    other.update(Q[7:], np.eye(3))
    near(one.position, other.position)
    J, J_tree, joints = one.offset_jacobians(), other.offset_jacobians(), G[6:, 6:]
    near(J[:, :, :-3], J_tree[:, :, :-3] @ joints[np.ix_(other.chain, one.chain)])
    near(J[:, :, -3:], J_tree[:, :, -3:])
    for body in (one, other):
        body.place_com()
    near(one.com_from(one.in_base(1)), other.com_from(other.in_base(1)))
    for of in (SensedBody.com_by, _of_sole):
        found, expected = (
            np.transpose([of(body, joint) for joint in range(n)]) for body, n in ((one, 10), (other, 12))
        )
        near(found, expected @ joints)


def _of_sole(body, joint):
    """Motion of the right sole against the base by a joint [m/rad]."""
    return np.multiply(body.carries(joint, 1), body.moved_by(joint, body.in_base(1)))


def test_the_coriolis_matrix_gives_the_rate_of_momentum(models):
    """Cᵀ v - g is what drives the momentum M v beside torques and contacts, by finite differences."""
    short, _ = models
    q, v = next(states(short))
    dynamics = mimic.Dynamics(short, short.createData())
    data, step = dynamics.data, 1e-6
    a = np.random.default_rng(2).normal(size=short.nv)
    momenta = []
    for time in (-step, step):
        dynamics.mass_matrix(pin.integrate(short, q, time * v + 0.5 * time**2 * a))
        momenta.append(data.M @ (v + time * a))
    dynamics.coriolis(q, v)
    torque = pin.rnea(short, data, q, v, a)  # without armatures, of which there are none
    gravity = pin.computeGeneralizedGravity(short, data, q)
    rate = (momenta[1] - momenta[0]) / (2.0 * step)
    np.testing.assert_allclose(rate, torque + dynamics.C.T @ v - gravity, rtol=0.0, atol=1e-6)


def test_wrenches_from_torques_are_the_same_with_all_joints_and_with_the_independent_ones(models):
    """Residuals of the observers are Σ Jᵀ w in the coordinates of each; that of the tree, seen from the others."""
    short, whole = models
    observers = [TorqueWrench(model, SOLES, 0.002, SensorNoise()) for model in models]
    for q, v in states(short):
        Q, V, G = spread(short, q, v)
        torque = np.linspace(-3.0, 5.0, whole.nv - 6)
        observers[0].update(RobotState(q, v), (G.T @ np.concatenate((np.zeros(6), torque)))[6:])
        observers[1].update(RobotState(Q, V), torque)
        near(observers[0].residual, G.T @ observers[1].residual)


def test_rows_that_keep_limbs_apart_are_those_of_the_tree(models):
    q, v = next(states(models[0]))
    Q, V, G = spread(models[0], q, v)
    rows, bounds = [], []
    for model, at, speed in ((models[0], q, v), (models[1], Q, V)):
        balls, data, parameters = ends_of_legs(model), model.createData(), SeparationParameters(attention=100.0)
        mimic.Dynamics(model, data).all_terms(at, speed)
        row, lower = np.zeros((parameters.slots, model.nv)), np.zeros(parameters.slots)
        Separation(model, balls, parameters).write(data, speed, row, lower, 1e9)
        rows.append(row[0])
        bounds.append(lower[0])
    assert np.abs(rows[0]).max() > 0.1
    near(rows[0], rows[1] @ G)
    assert bounds[0] == pytest.approx(bounds[1], rel=1e-9)


def ends_of_legs(model):
    """A small ball at the end of each leg, which are kept apart."""
    balls = pin.GeometryModel()
    for side in SIDES:
        end = model.getJointId(f"{side}_5")
        balls.addGeometryObject(pin.GeometryObject(side, end, pin.SE3.Identity(), coal.Sphere(1e-3)))
    balls.addCollisionPair(pin.CollisionPair(0, 1))
    return balls


def test_what_pinocchio_itself_gives_is_refused_or_wrong(models):
    """If one of these fails, Pinocchio has learnt it, and `surefoot.engines.mimic` can do without it."""
    short, whole = models
    data, tree_data = short.createData(), whole.createData()
    (q, v), (later, _), *_ = states(short)
    with pytest.raises(RuntimeError, match="does not support Joint Mimic"):
        pin.computeAllTerms(short, data, q, v)
    Q, V, G = spread(short, q, v)
    C = G.T @ pin.computeCoriolisMatrix(whole, tree_data, Q, V) @ G
    assert np.abs(pin.computeCoriolisMatrix(short, data, q, v) - C).max() > 0.1
    Q, V, G = spread(short, later, v)
    M = G.T @ pin.crba(whole, tree_data, Q) @ G
    near(pin.crba(short, short.createData(), later), M)
    data = short.createData()
    pin.crba(short, data, q)
    assert np.abs(pin.crba(short, data, later) - M).max() > 0.1
    assert data.J.shape[1] == whole.nv


def test_a_body_between_a_joint_and_its_follower_is_not_steered(models):
    short, _ = models
    assert mimic.moving_columns(short, short.getJointId("left_5")) == [*range(6), 6, 7, 8, 9, 10]
    with pytest.raises(ValueError, match="'left_2' between 'left_2' and 'left_3'"):
        mimic.moving_columns(short, short.getJointId("left_2"))


def test_rotors_add_their_inertia_to_the_independent_joints(models):
    short, _ = models
    heavy = short.copy()
    heavy.armature[6:] = np.linspace(0.1, 1.0, heavy.nv - 6)
    (q, _), *_ = states(short)
    plain, loaded = (mimic.Dynamics(model, model.createData()) for model in (short, heavy))
    plain.mass_matrix(q)
    loaded.mass_matrix(q)
    near(loaded.data.M - plain.data.M, np.diag(heavy.armature))
