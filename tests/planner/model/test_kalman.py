"""The filter against closed forms, its own statistics, and the plant on which the paper's variant must fail."""

import numpy as np
import pytest
from scipy.linalg import expm, solve_discrete_are

from surefoot.planner.model.filter import ZMP_ONLY, CentroidalFilter, FilterNoise, sensor_model
from surefoot.planner.model.jerk import jerk_model

pytestmark = pytest.mark.unit

T, STIFFNESS = 0.02, 9.81
OMEGA = np.sqrt(STIFFNESS)
ALL = (True, True, True)
NOISE = FilterNoise()


def started(noise=NOISE, sensors=ALL, mean=None, deviation=(0.01, 0.01, 0.05), sample_time=T):
    return CentroidalFilter(sample_time, noise, np.zeros((3, 2)) if mean is None else mean, deviation, sensors)


def jerks(rng, count):
    """A bounded motion: jerk that brings the noise-driven state back."""
    a, b = jerk_model(T)
    state, out = np.zeros((3, 2)), []
    for _ in range(count):
        jerk = rng.normal(0.0, 2.0, 2) - np.array([20.0, 25.0, 9.0]) @ state
        state = a @ state + np.outer(b, jerk)
        out.append(jerk)
    return out


def run(rng, count, noise=NOISE, sensors=ALL, stiffness=lambda k: STIFFNESS, match=True):
    """Simulate the filter's own model; errors, covariances and normalised innovations of each sample."""
    a, b = jerk_model(T)
    kalman = started(noise, sensors)
    q, r = np.array(noise.process), np.array([noise.zmp, noise.com, noise.com_velocity])
    state = np.diag([0.01, 0.01, 0.05]) @ rng.normal(size=(3, 2)) if match else np.zeros((3, 2))
    errors, covariances, normalised = [], [], []
    for k, jerk in enumerate(jerks(rng, count)):
        measured = sensor_model(stiffness(k)) @ state
        if match:
            measured = measured + r[:, None] * rng.normal(size=(3, 2))
        kalman.update(*measured, stiffness(k))
        errors.append(kalman.mean - state)
        covariances.append(kalman.covariance)
        normalised.append(kalman.innovation)
        kalman.predict(jerk)
        state = a @ state + np.outer(b, jerk)
        if match:
            state = state + q[:, None] * rng.normal(size=(3, 2))
    return np.array(errors), np.array(covariances), np.array(normalised)


def test_model_is_the_exact_motion_under_constant_jerk():
    generator = np.zeros((4, 4))
    generator[0, 1] = generator[1, 2] = generator[2, 3] = 1.0
    exact = expm(T * generator)
    a, b = jerk_model(T)
    np.testing.assert_allclose(a, exact[:3, :3], atol=1e-15)
    np.testing.assert_allclose(b, exact[:3, 3], atol=1e-15)


def test_zmp_row_is_the_pendulum():
    x, acceleration = 0.1, 0.7
    zmp = sensor_model(STIFFNESS)[0] @ [x, 3.0, acceleration]
    assert STIFFNESS * (x - zmp) == pytest.approx(acceleration)


@pytest.mark.parametrize("sensors", [ALL, ZMP_ONLY, (False, True, True)])
def test_covariance_settles_at_the_riccati_solution(sensors):
    a, _ = jerk_model(T)
    rows = np.array(sensors)
    c = sensor_model(STIFFNESS)[rows]
    r = np.diag(np.square([NOISE.zmp, NOISE.com, NOISE.com_velocity])[rows])
    prior = solve_discrete_are(a.T, c.T, np.diag(np.square(NOISE.process)), r)
    kalman = started(sensors=sensors)
    for _ in range(3000):
        kalman.update(*np.zeros((3, 2)), STIFFNESS)
        kalman.predict(np.zeros(2))
    np.testing.assert_allclose(kalman.covariance, prior, rtol=1e-6)


def test_deviation_of_the_dcm_estimate_is_millimetres():
    """The numbers are standard deviations: as variances they would give 23 mm."""
    _, covariances, _ = run(np.random.default_rng(0), 500)
    row = np.array([1.0, 1.0 / OMEGA, 0.0])
    assert np.sqrt(row @ covariances[-1] @ row) == pytest.approx(1.64e-3, rel=0.02)


def test_consistent_and_unbiased():
    """Normalised innovations average to the number of sensors, errors to zero within their own covariance."""
    errors, covariances, normalised = run(
        np.random.default_rng(1), 4000, stiffness=lambda k: 9.8 + 3.0 * np.sin(0.05 * k)
    )
    assert normalised.mean() == pytest.approx(3.0, rel=0.05)
    np.testing.assert_allclose(errors.var(axis=(0, 2)), covariances[500:].mean(axis=0).diagonal(), rtol=0.25)
    assert np.abs(errors.mean(axis=(0, 2)) / errors.std(axis=(0, 2))).max() < 0.15


def test_a_filter_that_trusts_too_much_is_found_out():
    rng = np.random.default_rng(1)
    kalman = started(FilterNoise(zmp=0.003, com=0.0006, com_velocity=0.003))
    normalised = []
    for _ in range(500):
        kalman.update(*(rng.normal(size=(3, 2)) * [[0.01], [0.002], [0.01]]), STIFFNESS)
        normalised.append(kalman.innovation)
        kalman.predict(np.zeros(2))
    assert np.mean(normalised) > 15.0


def test_covariance_stays_symmetric_and_positive_semidefinite():
    _, covariances, _ = run(np.random.default_rng(2), 1000, FilterNoise(zmp=1e-9, com=1e-9, com_velocity=1e-9))
    np.testing.assert_array_equal(covariances, covariances.transpose(0, 2, 1))
    assert min(np.linalg.eigvalsh(p)[0] for p in covariances) > -1e-15


@pytest.mark.parametrize("sensors", [ALL, ZMP_ONLY])
def test_without_noise_it_tracks_exactly(sensors):
    errors, _, _ = run(np.random.default_rng(3), 300, sensors=sensors, match=False)
    assert np.abs(errors).max() < 1e-12


def test_a_missing_zmp_is_left_out():
    kalman, without = started(), started(sensors=(False, True, True))
    for each, zmp in ((kalman, np.full(2, np.nan)), (without, np.ones(2))):
        each.update(zmp, np.array([0.01, 0.0]), np.zeros(2), STIFFNESS)
    np.testing.assert_array_equal(kalman.mean, without.mean)
    paper = started(sensors=ZMP_ONLY)
    paper.update(np.full(2, np.nan), np.zeros(2), np.zeros(2), STIFFNESS)
    assert paper.innovation is None


def test_shorter_samples_add_less_noise():
    kalman = started(sample_time=0.5 * T, deviation=(0.0, 0.0, 0.0))
    kalman.predict(np.zeros(2))
    np.testing.assert_allclose(kalman.covariance, np.diag(0.5 * np.square(NOISE.process)))


# The paper's filter measures the ZMP alone.


def observability(a, c):
    return np.concatenate([c @ np.linalg.matrix_power(a, k) for k in range(3)])


PENDULUM = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, STIFFNESS, 0.0]])
"""d/dt of (x, x', x'') when the ZMP p is what is commanded: x''' = λ (x' - p')."""


def test_zmp_sees_everything_of_the_cart_table_and_only_itself_of_the_pendulum():
    zmp = sensor_model(STIFFNESS)[:1]
    assert np.linalg.matrix_rank(observability(jerk_model(T)[0], zmp)) == 3
    matrix = observability(expm(T * PENDULUM), zmp)
    assert np.linalg.matrix_rank(matrix, tol=1e-12) == 1
    with_com = observability(expm(T * PENDULUM), sensor_model(STIFFNESS))
    assert np.linalg.matrix_rank(with_com, tol=1e-12) == 3


def test_the_mode_that_the_zmp_does_not_see_is_the_dcm():
    mode = np.array([1.0, OMEGA, OMEGA**2])
    np.testing.assert_allclose(PENDULUM @ mode, OMEGA * mode)
    assert sensor_model(STIFFNESS)[0] @ mode == pytest.approx(0.0, abs=1e-12)
    gramian = sum(
        np.outer(row, row) for row in (sensor_model(STIFFNESS)[0] @ expm(k * T * PENDULUM) for k in range(100))
    )
    assert mode @ gramian @ mode < 1e-12 * np.trace(gramian)


def balance(sensors, plant, seed, seconds=8.0):
    """Stand in place by feedback of the *estimated* DCM; largest true DCM error over 5 s to the end [m].

    Args:
        sensors: of the filter.
        plant: "pendulum", which does the ZMP that is commanded, or "cart", which does the jerk.
        seed: of the noise.
        seconds: how long.
    """
    rng, kalman = np.random.default_rng(seed), started(sensors=sensors)
    a, b = jerk_model(T)
    exact = expm(T * np.array([[0.0, 1.0, 0.0], [STIFFNESS, 0.0, -STIFFNESS], [0.0, 0.0, 0.0]]))
    state, zmp, dcm = np.zeros((3, 2)), np.zeros(2), []
    for _ in range(round(seconds / T)):
        readings = np.stack((zmp, state[0], state[1]))
        readings = readings + np.clip(rng.normal(size=(3, 2)), -2, 2) * [[NOISE.zmp], [NOISE.com], [NOISE.com_velocity]]
        kalman.update(*readings, STIFFNESS)
        command = np.clip(2.0 * (kalman.mean[0] + kalman.mean[1] / OMEGA), -0.0375, 0.0375)
        planned = STIFFNESS * (kalman.mean[0] - command)
        jerk = np.clip((planned - kalman.mean[2]) / T, -60.0, 60.0)
        kalman.predict(jerk)
        if plant == "cart":
            state = a @ state + np.outer(b, jerk)
            zmp = state[0] - state[2] / STIFFNESS
        else:
            zmp = np.clip(command, -0.0375, 0.0375)
            state[:2] = (exact @ np.stack((state[0], state[1], zmp)))[:2]
        dcm.append(np.abs(state[0] + state[1] / OMEGA).max())
    return max(dcm[-round(3.0 / T) :])


@pytest.mark.parametrize("seed", range(4))
def test_zmp_alone_works_on_the_cart_table_and_falls_on_the_pendulum(seed):
    assert balance(ZMP_ONLY, "cart", seed) < 0.03
    assert balance(ZMP_ONLY, "pendulum", seed) > 1.0
    assert balance(ALL, "pendulum", seed) < 0.03
