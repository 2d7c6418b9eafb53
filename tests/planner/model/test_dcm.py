from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from surefoot.planner.model.dcm import dcm, natural_frequency, nominal_dcm, viability_weights
from surefoot.planner.model.pendulum import com_after, moving_cop
from surefoot.planner.plants import Pendulum

pytestmark = pytest.mark.unit

T = 0.02
WIDE = np.array([[9.0, 9.0], [-9.0, 9.0], [-9.0, -9.0], [9.0, -9.0]])


def test_closed_form_equals_the_pendulum():
    pendulum = Pendulum(100.0, np.array([0.02, 0.01]), np.array([0.1, -0.05]))
    w, zmp = np.sqrt(9.81), np.array([0.01, -0.02])
    start = dcm(pendulum.position, pendulum.velocity, w)
    for _ in range(40):
        pendulum.advance(T, zmp, WIDE, 9.81, np.zeros(2))
    there = zmp + (start - zmp) * np.exp(w * 40 * T)
    np.testing.assert_allclose(dcm(pendulum.position, pendulum.velocity, w), there, atol=1e-12)


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


def test_nominal_dcm_starts_at_the_viability_weights_and_obeys_the_recursion():
    rng = np.random.default_rng(0)
    stiffness = 9.81 + 2.0 * np.sin(0.1 * np.arange(151))
    omega, zmp = natural_frequency(stiffness, T), np.cumsum(rng.normal(size=(151, 2)), axis=0)
    nominal = nominal_dcm(stiffness, omega, zmp, T)
    for k in (0, 40, 149):
        expected = viability_weights(stiffness[k:], omega[k:], T) @ zmp[k:]
        np.testing.assert_allclose(nominal[k], expected, rtol=1e-10)
    growth = np.exp(0.5 * T * ((stiffness / omega)[1:] + (stiffness / omega)[:-1]))[:, None]
    held = 0.5 * (zmp[1:] + zmp[:-1])
    np.testing.assert_allclose(nominal[1:], held + (nominal[:-1] - held) * growth, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(nominal[-1], zmp[-1])


@pytest.mark.parametrize("corner", [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)])
def test_terminal_set_is_viable_from_its_corners_and_not_beyond(corner):
    """At a corner of Σ w_j [lo_j, hi_j] the ZMP at that corner of every box holds the DCM; 1 mm beyond nothing does."""
    count, half = 150, np.array([0.03, 0.02])
    stiffness = np.full(count, 9.81)
    omega = np.sqrt(stiffness)
    center = np.where(np.arange(count)[:, None] < 60, (0.0, 0.1), (0.2, -0.1))
    zmp = center + half * corner
    edge = viability_weights(stiffness, omega, T) @ zmp
    for outside, bounded in ((0.0, True), (1e-3, False)):
        pendulum = Pendulum(100.0, edge + outside * np.array(corner), np.zeros(2))
        for before, after in pairwise(zmp):
            pendulum.advance(T, 0.5 * (before + after), WIDE, 9.81, np.zeros(2))
        distance = np.abs(pendulum.position + pendulum.velocity / omega[-1] - center[-1])
        assert np.all(distance <= half + 1e-4) if bounded else np.all(distance > 5.0)


@pytest.mark.parametrize("time", [0.05, 0.3])
def test_the_laws_of_dcm_and_com_are_the_motion_of_the_pendulum(time):
    omega = 3.2
    com, dcm, start, end = np.array([0.1, 0.02]), np.array([0.2, -0.03]), np.array([-0.1, 0.1]), np.array([0.2, 0.0])

    def rate(at, state, moves):
        cop = start + moves * (end - start) * at / time
        return np.concatenate((omega * (state[2:] - state[:2]), omega * (state[2:] - cop)))

    moved, fixed = (
        solve_ivp(rate, (0.0, time), np.concatenate((com, dcm)), args=(moves,), rtol=1e-10, atol=1e-12).y[:, -1]
        for moves in (1.0, 0.0)
    )
    grown = np.exp(omega * time)
    taken = [moving_cop(*ends, omega, time) for ends in zip(start, end, strict=True)]
    np.testing.assert_allclose(grown * dcm - taken, moved[2:], atol=1e-8)
    here = [com_after(*now, grown) for now in zip(com, dcm, start, strict=True)]
    np.testing.assert_allclose(here, fixed[:2], atol=1e-8)
