import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.types import ExternalLoad

pytestmark = pytest.mark.unit


def placements(robot, q):
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    names = (*robot.frames.soles, robot.frames.torso)
    return [data.oMf[robot.model.getFrameId(name)].copy() for name in names]


def terms_at(robot, q, v):
    terms = RobotTerms(robot.model, robot.frames)
    terms.update(q, v)
    return terms


@pytest.fixture
def state(robot, rng):
    return robot.moved(rng, 0.3, 1.0)


def test_jacobians_are_derivatives_of_the_placements(robot, state):
    terms, h = terms_at(robot, state.q, state.v), 1e-6
    jacobians = [terms.sole_jacobian[0], terms.sole_jacobian[1], terms.torso_jacobian]
    for i in range(robot.nv):
        step = np.zeros(robot.nv)
        step[i] = h
        ahead = placements(robot, pin.integrate(robot.model, state.q, step))
        behind = placements(robot, pin.integrate(robot.model, state.q, -step))
        for J, a, b in zip(jacobians, ahead, behind, strict=True):
            rate = pin.log6(b.actInv(a)).vector / (2 * h)
            np.testing.assert_allclose(J[:, i], rate[-len(J) :], atol=1e-8)


def test_velocities_and_bias_accelerations_are_time_derivatives(robot, state):
    h, times = 1e-4, (-1e-4, 0.0, 1e-4)
    behind, now, ahead = (terms_at(robot, pin.integrate(robot.model, state.q, t * state.v), state.v) for t in times)
    for k in (0, 1):
        R = now.sole_rotation[k]
        velocity = R.T @ (ahead.sole_position[k] - behind.sole_position[k]) / (2 * h)
        acceleration = R.T @ (ahead.sole_position[k] - 2 * now.sole_position[k] + behind.sole_position[k]) / h**2
        np.testing.assert_allclose(now.sole_velocity[k, :3], velocity, atol=1e-6)
        np.testing.assert_allclose(now.sole_bias[k, :3], acceleration, atol=1e-5)
        rate = (ahead.sole_velocity[k, 3:] - behind.sole_velocity[k, 3:]) / (2 * h)
        np.testing.assert_allclose(now.sole_bias[k, 3:], rate, atol=1e-5)
    np.testing.assert_allclose(now.torso_bias, (ahead.torso_velocity - behind.torso_velocity) / (2 * h), atol=1e-5)
    np.testing.assert_allclose(now.com_velocity, (ahead.com - behind.com) / (2 * h), atol=1e-7)


def test_velocities_are_jacobians_times_v(robot, state):
    terms = terms_at(robot, state.q, state.v)
    np.testing.assert_allclose(terms.sole_velocity, terms.sole_jacobian @ state.v, atol=1e-12)
    np.testing.assert_allclose(terms.torso_velocity, terms.torso_jacobian @ state.v, atol=1e-12)
    np.testing.assert_array_equal(terms.base_angular_velocity, state.v[3:6])


def test_mass_matrix_and_bias_are_those_of_inverse_dynamics(robot, state, rng):
    terms, data = terms_at(robot, state.q, state.v), robot.model.createData()
    a = rng.normal(size=robot.nv)
    torque = pin.rnea(robot.model, data, state.q, state.v, a)
    np.testing.assert_allclose(terms.mass_matrix @ a + terms.bias, torque, atol=1e-9)
    np.testing.assert_allclose(terms.mass_matrix, terms.mass_matrix.T, atol=1e-12)
    assert terms.mass == pytest.approx(100.0, abs=1e-6)


def test_the_wrench_map_gives_force_and_moment_about_the_origin(robot, state, rng):
    terms = terms_at(robot, state.q, state.v)
    wrench = rng.normal(size=(2, 6))
    force = np.einsum("kij,kj->ki", terms.sole_rotation, wrench[:, :3])
    moment = np.einsum("kij,kj->ki", terms.sole_rotation, wrench[:, 3:]) + np.cross(terms.sole_position, force)
    total = terms.sole_wrench_map @ wrench.reshape(12)
    np.testing.assert_allclose(total, np.concatenate([force.sum(0), moment.sum(0)]), atol=1e-12)


def test_an_update_leaves_nothing_of_the_state_before(robot, rng):
    first, second = robot.moved(rng, 0.3, 1.0), robot.moved(rng, 0.3, 1.0)
    used, fresh = terms_at(robot, first.q, first.v), terms_at(robot, second.q, second.v)
    used.update(second.q, second.v)
    names = [name for name in dir(fresh) if isinstance(getattr(fresh, name), np.ndarray)]
    assert {"com", "sole_jacobian", "torso_bias", "mass_matrix"} <= set(names)
    for name in names:
        np.testing.assert_array_equal(getattr(used, name), getattr(fresh, name), err_msg=name)


def test_terms_tell_whether_their_state_is_finite(robot, state):
    terms = terms_at(robot, state.q, state.v)
    assert terms.is_finite
    for values in (state.q.copy(), state.v.copy()):
        values[9] = np.nan
        terms.update(*((values, state.v) if len(values) == len(state.q) else (state.q, values)))
        assert not terms.is_finite
    terms.update(state.q, state.v)
    assert terms.is_finite


PLACED = (
    "q", "v", "com", "com_velocity", "angular_momentum", "base_rotation", "torso_rotation", "sole_position",
    "sole_rotation", "sole_pose",
)  # fmt: skip


def test_a_place_is_that_of_an_update(robot, rng):
    placed = RobotTerms(robot.model, robot.frames)
    for _ in range(20):
        state = robot.moved(rng, 0.5, 2.0)
        placed.place(state.q, state.v)
        whole = terms_at(robot, state.q, state.v)
        for name in PLACED:
            np.testing.assert_allclose(
                getattr(placed, name), getattr(whole, name), rtol=1e-12, atol=1e-12, err_msg=name
            )
    assert not placed.sole_jacobian.any()


def test_the_state_of_terms_is_their_own(robot, state):
    """A record reads it where it lies, also of a state that is in other arrays at each tick."""
    terms = terms_at(robot, state.q, state.v)
    q, v = terms.q, terms.v
    assert not np.shares_memory(q, state.q)
    terms.update(state.q + 0.1, state.v + 0.1)
    assert terms.q is q
    assert terms.v is v
    np.testing.assert_array_equal(q, state.q + 0.1)


def test_an_unknown_frame_is_named(robot):
    with pytest.raises(ValueError, match="no frame 'left_sol'"):
        RobotTerms(robot.model, BodyFrames(("left_sol", "right_sole"), robot.frames.torso))


def test_another_gravity_is_refused(robot):
    model = pin.Model(robot.model)
    model.gravity.linear = np.array([0.0, 0.0, -1.62])
    with pytest.raises(ValueError, match="gravity"):
        RobotTerms(model, robot.frames)


def test_a_lasting_load_is_a_force_on_the_body_and_a_moment_about_its_com(robot, state):
    """The rows of the base tell: its force and its moment about the base; the momentum balance is that of the load."""
    force, moment = np.array([30.0, -20.0, 8.0]), np.array([4.0, 7.0, -2.0])
    free, loaded = (terms_at(robot, state.q, state.v) for _ in range(2))
    loaded.bear(ExternalLoad(force, moment, 1.0))
    R, place = pin.Quaternion(state.q[3:7]).matrix(), state.q[:3]
    about = moment + np.cross(free.com - place, force)
    np.testing.assert_allclose((free.bias - loaded.bias)[:6], np.concatenate((force @ R, about @ R)), atol=1e-9)
    assert loaded.mass == free.mass


def test_a_heavier_body_has_as_much_more_inertia_but_for_its_rotors(robot, state):
    model = robot.model.copy()
    model.armature[6:] = np.linspace(0.1, 0.5, model.nv - 6)
    free, loaded = (RobotTerms(model, robot.frames) for _ in range(2))
    for terms in (free, loaded):
        terms.update(state.q, state.v)
    loaded.bear(ExternalLoad(np.zeros(3), np.zeros(3), 1.2))
    rotors = np.diag(model.armature)
    np.testing.assert_allclose(loaded.mass_matrix - rotors, 1.2 * (free.mass_matrix - rotors), atol=1e-9)
    np.testing.assert_allclose(loaded.bias, 1.2 * free.bias, atol=1e-9)
    assert loaded.mass == pytest.approx(1.2 * free.mass)


@pytest.mark.parametrize("foot", [0, 1])
@pytest.mark.parametrize(("forward", "pitch"), [(0.1, 0.3), (-0.08, -0.2), (0.05, 0.0)])
def test_a_foot_that_is_pitched_is_level_seen_from_its_edge(robot, foot, forward, pitch):
    """Heel up about its toes, or toes up about its heel; the frame lies ahead of the sole's centre."""
    terms = RobotTerms(robot.model, robot.frames)
    q = pin.integrate(robot.model, robot.standing, 0.2 * np.random.default_rng(4).normal(size=robot.nv))
    terms.update(q, np.zeros(robot.nv))
    R, p = terms.sole_rotation[foot].copy(), terms.sole_position[foot].copy()
    terms.shift_foot(foot, forward, pitch)
    np.testing.assert_allclose(terms.contact_rotation[foot] @ pin.utils.rotate("y", pitch), R, atol=1e-12)
    np.testing.assert_allclose(terms.contact_position[foot], p + forward * R[:, 0], atol=1e-12)
