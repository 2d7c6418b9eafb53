import numpy as np
import pytest

from planner.dcm import dcm, dcm_constant_zmp, natural_frequency, viability_weights
from planner.pendulum import Pendulum

pytestmark = pytest.mark.unit

T = 0.02
WIDE = np.array([[9.0, 9.0], [-9.0, 9.0], [-9.0, -9.0], [9.0, -9.0]])


def test_closed_form_equals_the_pendulum():
    pendulum = Pendulum(100.0, np.array([0.02, 0.01]), np.array([0.1, -0.05]))
    w, zmp = np.sqrt(9.81), np.array([0.01, -0.02])
    start = dcm(pendulum.position, pendulum.velocity, w)
    for _ in range(40):
        pendulum.advance(T, zmp, WIDE, 9.81, np.zeros(2))
    np.testing.assert_allclose(
        dcm(pendulum.position, pendulum.velocity, w), dcm_constant_zmp(start, zmp, w, 40 * T), atol=1e-12
    )


def test_constant_height_gives_the_usual_frequency():
    np.testing.assert_allclose(natural_frequency(np.full(60, 9.0), T), 3.0, rtol=1e-14)


def test_frequency_obeys_the_riccati_equation():
    step = 1e-3
    time = step * np.arange(4000)
    stiffness = 9.81 + 2.0 * np.sin(3.0 * time)
    omega = natural_frequency(stiffness, step)
    np.testing.assert_allclose(np.gradient(omega, step)[5:-5], (omega**2 - stiffness)[5:-5], atol=1e-4)


def test_motion_from_the_weighted_zmps_stays_bounded_and_ends_on_the_last():
    rng = np.random.default_rng(1)
    stiffness = 9.81 + np.sin(0.1 * np.arange(301))
    omega = natural_frequency(stiffness, T)
    zmp = np.where(np.arange(301) < 200, np.repeat(rng.uniform(-0.1, 0.1, 43), 7)[:301], 0.05)
    weights = viability_weights(stiffness, omega, T)
    assert weights.sum() == pytest.approx(1.0)
    here = weights @ zmp
    rate = 0.5 * (stiffness / omega)[:-1] + 0.5 * (stiffness / omega)[1:]
    held = 0.5 * (zmp[:-1] + zmp[1:])
    for p, r in zip(held, rate, strict=True):
        here = p + (here - p) * np.exp(r * T)
    assert abs(here - 0.05) < 1e-6
