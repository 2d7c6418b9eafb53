"""Divergent component of motion ξ = x + x'/ω of the pendulum x'' = λ(t) (x - p) with varying stiffness.

With ω' = ω² - λ the DCM obeys ξ' = (λ/ω) (ξ - p) exactly; at constant height ω = sqrt(λ) and this is the usual
first-order system. The DCM is the *unstable* part of the motion (the paper calls it stable).
"""

import math

import numpy as np

from surefoot.planner.types import Array


def natural_frequency(stiffness: Array, sample_time: float) -> Array:
    """ω over a window, by backward integration of the Riccati equation ω' = ω² - λ.

    Backward in time the equation forgets its end value at the rate 2ω; the end value here is the constant-height
    sqrt(λ). Each interval is integrated exactly for the mean of λ at its ends.

    Args:
        stiffness: λ, shape (n,) [1/s^2].
        sample_time: [s].

    Returns:
        ω, shape (n,) [1/s].
    """
    omega = np.empty(len(stiffness))
    integrate_riccati(stiffness, sample_time, omega)
    return omega


def integrate_riccati(stiffness: Array, sample_time: float, omega: Array) -> None:
    """Write ω into an array, shape (n,); see `natural_frequency`."""
    last = stiffness.shape[0] - 1
    w = omega[last] = math.sqrt(stiffness[last])
    for k in range(last - 1, -1, -1):
        mean = 0.5 * (stiffness[k + 1] + stiffness[k])
        root = math.sqrt(mean)
        stretched = math.tanh(root * sample_time) / root
        w = (w + mean * stretched) / (1.0 + w * stretched)
        omega[k] = w


def dcm(position: Array, velocity: Array, omega: Array | float) -> Array:
    """DCM ξ = x + x'/ω (eq. (13)), with the ω of the Riccati equation when the height varies."""
    return np.asarray(position + velocity / omega)


def viability_weights(stiffness: Array, omega: Array, sample_time: float) -> Array:
    """Weights w with which the future ZMP fixes the DCM that stays bounded: ξ = Σ w_j p_j.

    It is the solution of ξ' = (λ/ω)(ξ - p) that ends on the last ZMP; the ZMP is linear between samples and the decay
    constant within one. A DCM outside the weighted sum of all ZMPs that the feet allow cannot be brought back.

    Args:
        stiffness: λ, shape (n,) [1/s^2].
        omega: ω, shape (n,) [1/s].
        sample_time: [s].

    Returns:
        Weights that sum to 1, shape (n,).
    """
    weights = np.empty(len(stiffness))
    weigh(decays(stiffness, omega, sample_time), weights)
    return weights


def decays(stiffness: Array, omega: Array, sample_time: float) -> Array:
    """Factors e^{-∫λ/ω} from the first sample to each, shape (n,); their inverse is how much a DCM error has grown."""
    decay = np.empty(len(stiffness))
    fade(np.asarray(stiffness, dtype=np.float64), np.asarray(omega, dtype=np.float64), sample_time, decay)
    return decay


def fade(stiffness: Array, omega: Array, sample_time: float, decay: Array) -> None:
    """Write what `decays` gives into an array, shape (n,)."""
    total, before = 0.0, stiffness[0] / omega[0]
    decay[0] = 1.0
    for k in range(1, decay.shape[0]):
        rate = stiffness[k] / omega[k]
        total += rate + before
        before = rate
        decay[k] = math.exp(-0.5 * sample_time * total)


def weigh(decay: Array, weights: Array) -> None:
    """Write the `viability_weights` that follow from decays into an array, shape (n,) each."""
    for k in range(decay.shape[0]):
        weights[k] = weight(decay, k)


def weight(decay: Array, k: int) -> float:
    """Weight of sample k: w_k = (d_{k-1} - d_k) / 2 + (d_k - d_{k+1}) / 2, and d_k in place of the last half."""
    return (share(decay, k - 1) if k > 0 else 0.0) + share(decay, k)


def share(decay: Array, k: int) -> float:
    """Weight of each end of the interval after sample k: (d_k - d_{k+1}) / 2, and d_k after the last one."""
    last = decay.shape[0] - 1
    counted: float = 0.5 * (decay[k] - decay[k + 1]) if k < last else decay[last]
    return counted


def nominal_dcm(stiffness: Array, omega: Array, zmp: Array, sample_time: float) -> Array:
    """DCM at each sample that a known future ZMP keeps bounded, by the backward recursion ξ' = (λ/ω)(ξ - p).

    It ends on the last ZMP and starts at `viability_weights` @ zmp.

    Args:
        stiffness: λ, shape (n,) [1/s^2].
        omega: ω, shape (n,) [1/s].
        zmp: future ZMP, shape (n, k) [m].
        sample_time: [s].

    Returns:
        ξ, shape (n, k) [m].
    """
    decay, bounded = decays(stiffness, omega, sample_time), np.empty(zmp.shape)
    for column in range(zmp.shape[1]):
        gather(decay, np.asarray(zmp[:, column], dtype=np.float64), bounded[:, column])
    return bounded


def gather(decay: Array, zmp: Array, bounded: Array) -> None:
    """Write ξ_k with ξ_k d_k = Σ_{j ≥ k} (d_j - d_{j+1}) (p_j + p_{j+1}) / 2, shape (n,); it ends on the last ZMP."""
    ahead, following = 0.0, 0.0
    for k in range(decay.shape[0] - 1, -1, -1):
        ahead += share(decay, k) * (zmp[k] + following)
        following = zmp[k]
        bounded[k] = ahead / decay[k]
