"""The covariance of the filter's error against its dense equations, and the gain against the textbook's."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.similarity import GRAVITY
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, FOOT, FORCE, GYRO, OFFSETS, POSITION, SOLE, TURN, VELOCITY, Stand

pytestmark = pytest.mark.unit

JOINTS, TIME = 5, 0.01
OFFS = JOINTS + AXES
SENSORS = SensorNoise(3e-3, 1e-3, 2e-3, 4e-3, 0.02, 5e-3, 1e-3, 2e-3, 1e-3)
GROUND = GroundNoise(kinematics=3e-3, turning=4e-3, creep=2e-2, sinking=3e-2, rocking=5e-2, light=3.0, model=7e-3)


def made(rng, standing=(True, True)):
    """A filter somewhere, with any covariance."""
    rotations = [pin.exp3(rng.normal(size=3)) for _ in range(3)]
    stand = Stand(
        rotations[0], rng.normal(size=(4, 3)), np.stack(rotations[1:]), *rng.normal(size=(2, 3)), rng.normal(size=OFFS)
    )
    filter_ = InvariantFilter(stand, SENSORS, GROUND)
    some = 0.1 * rng.normal(size=filter_.P.shape)
    filter_.P[:] = some @ some.T
    for k in (0, 1):
        if not standing[k]:
            filter_.lift(k)
    return filter_


def turns(s):
    """B: what turns about world axes do to R and the columns."""
    return np.vstack((np.eye(3), *map(pin.skew, s.columns)))


def transition(s, t):
    """F by eq. 28 and 37 of Hartley et al. 2020."""
    F, g = np.eye(27 + OFFS), pin.skew(np.array([0.0, 0.0, -GRAVITY]))
    F[VELOCITY, TURN], F[POSITION, VELOCITY], F[POSITION, TURN] = t * g, t * np.eye(3), 0.5 * t * t * g
    F[:15, GYRO] = -t * turns(s) @ s.R
    F[VELOCITY, FORCE] = -t * s.R
    return F


@pytest.mark.parametrize("standing", [(True, True), (False, True), (False, False)])
def test_it_spreads_as_the_dense_equations_say(standing):
    filter_ = made(np.random.default_rng(sum(standing)), standing)
    s, P, loads = filter_.stand, filter_.P.copy(), (0.2, 0.9)
    filter_.propagate(np.zeros(3), np.zeros(3), TIME)
    F, B = transition(s, TIME), turns(s)
    Q = np.zeros_like(P)
    Q[:15, :15] = SENSORS.gyro_density**2 * TIME * B @ B.T
    D = np.einsum("ii->i", Q)
    D[VELOCITY] += (SENSORS.accelerometer_density**2 + GROUND.model**2) * TIME
    D[GYRO] += SENSORS.gyro_walk**2 * TIME
    D[FORCE] += SENSORS.accelerometer_walk**2 * TIME
    for k, more in ((0, 1.0 + (GROUND.light - 1.0) * 0.6), (1, 1.0)):
        if standing[k]:
            D[FOOT[k]] += np.square(more * np.array([GROUND.creep, GROUND.creep, GROUND.sinking])) * TIME
            D[SOLE[k]] += (more * GROUND.rocking) ** 2 * TIME
    filter_.spread(loads)
    np.testing.assert_allclose(filter_.P, F @ P @ F.T + Q, atol=1e-13)
    before = filter_.P.copy()
    filter_.spread(loads)
    np.testing.assert_array_equal(filter_.P, before)


@pytest.mark.parametrize("standing", [(True, True), (False, True), (True, False)])
@pytest.mark.parametrize("ticks", [1, 4])
def test_gain_and_covariance_are_those_of_the_textbook(standing, ticks):
    """K = P Hᵀ (H P Hᵀ + N)⁻¹ of a tick; the covariance has those that were taken, each with a noise of its own."""
    rng = np.random.default_rng(7)
    filter_ = made(rng, standing)
    s, P, J = filter_.stand, filter_.P.copy(), rng.normal(size=(2, 6, OFFS))
    feet = [k for k in (0, 1) if standing[k]]
    rows, noise = [], []
    for k in feet:
        for i, (own, from_) in enumerate(((FOOT[k], POSITION), (SOLE[k], TURN))):
            H, of_encoders = np.zeros((3, len(P))), J[k, 3 * i : 3 * i + 3]
            H[:, own], H[:, from_], H[:, OFFSETS] = np.eye(3), -np.eye(3), s.R @ of_encoders
            rows.append(H)
            levers = SENSORS.encoder**2 * np.square(of_encoders[:, :JOINTS]).sum(axis=1)
            noise.append((GROUND.kinematics, GROUND.turning)[i] ** 2 + levers)
    H, N = np.vstack(rows), np.diag(np.concatenate(noise))
    S = H @ P @ H.T + N
    expected = P - P @ H.T @ np.linalg.solve(H @ P @ H.T + N / ticks, H @ P)
    _count(filter_, J, P, ticks)
    np.testing.assert_allclose(filter_.P, expected, atol=1e-11)
    np.testing.assert_allclose(filter_.covariance.gain[:, : len(H)], P @ H.T @ np.linalg.inv(S), atol=1e-9)
    np.testing.assert_allclose(filter_.covariance.weights[: len(H), : len(H)], np.linalg.inv(S), rtol=1e-8, atol=1e-6)


def _count(filter_, J, P, ticks):
    """Weigh after so many ticks whose kinematics were taken, all of which say what is believed."""
    s = filter_.stand
    filter_.weigh(J)
    y = np.array([s.R.T @ (s.d[k] - s.p) for k in (0, 1)])
    Y = np.array([s.R.T @ s.Z[k] for k in (0, 1)])
    for _ in range(ticks):
        assert filter_.correct(y, Y, (np.inf, np.inf)) == ()
    filter_.P[:] = P
    filter_.weigh(J)


@pytest.mark.parametrize("standing", [(True, True), (False, True)])
def test_it_moves_the_state_by_the_gain_times_what_the_kinematics_say_else(standing):
    rng = np.random.default_rng(8)
    filter_ = made(rng, standing)
    s, J = filter_.stand, rng.normal(size=(2, 6, OFFS))
    filter_.weigh(J)
    x = 1e-6 * rng.normal(size=(2, 6))
    other = Stand(*(part.copy() for part in s.__reduce__()[1]))
    y = np.array([s.R.T @ (x[k, :3] + s.d[k] - s.p) for k in (0, 1)])
    Y = np.array([s.R.T @ pin.exp3(x[k, 3:]) @ s.Z[k] for k in (0, 1)])
    feet = [k for k in (0, 1) if standing[k]]
    assert filter_.correct(y, Y, (np.inf, np.inf)) == ()
    np.testing.assert_allclose(filter_.residual[: 6 * len(feet)], x[feet].ravel(), atol=1e-14)
    other.move(filter_.covariance.gain[:, : 6 * len(feet)] @ x[feet].ravel())
    for found, expected in zip(s.__reduce__()[1], other.__reduce__()[1], strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-13)


def test_a_covariance_that_is_not_positive_is_none():
    """Nothing follows from it, which whoever asks is told; numbers of before would be believed."""
    filter_ = made(np.random.default_rng(1))
    s = filter_.stand
    assert filter_.finite
    filter_.P[:] = -np.eye(len(filter_.P))
    filter_.weigh(np.zeros((2, 6, OFFS)))
    assert not filter_.finite
    filter_.correct(np.zeros((2, 3)), s.Z.copy(), (np.inf, np.inf))
    assert np.isnan(s.columns).all()
