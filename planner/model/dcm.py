"""Divergent component of motion ξ = x + x'/ω of the pendulum x'' = λ(t) (x - p) with varying stiffness.

With ω' = ω² - λ the DCM obeys ξ' = (λ/ω) (ξ - p) exactly; at constant height ω = sqrt(λ) and this is the usual
first-order system. The DCM is the *unstable* part of the motion (the paper calls it stable).

A few blocks of jerk cannot follow a ZMP that jumps half a metre in a tenth of a second at the far end of the horizon,
nor a leg that swings in a third of a second; planned with them alone, fast steps are shortened for no physical reason.
So the optimiser plans only what differs from this motion.
"""

from typing import Any

import numpy as np

from surefoot.native.library import Bound, Library
from surefoot.planner.types import Array
from surefoot.values import dataclass


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
    mean = 0.5 * (stiffness[1:] + stiffness[:-1])
    root = np.sqrt(mean)
    stretched = np.tanh(root * sample_time) / root
    pull = (mean * stretched).tolist()
    w = float(np.sqrt(stiffness[-1]))
    values = [w]
    for t, b in zip(stretched[::-1].tolist(), reversed(pull), strict=True):
        w = (w + b) / (1.0 + w * t)
        values.append(w)
    values.reverse()
    return np.array(values)


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
    decay = decays(stiffness, omega, sample_time)
    share = 0.5 * (decay[:-1] - decay[1:])
    weights = np.zeros_like(stiffness)
    weights[:-1] = share
    weights[1:] += share
    weights[-1] += decay[-1]
    return weights


def decays(stiffness: Array, omega: Array, sample_time: float) -> Array:
    """Factors e^{-∫λ/ω} from the first sample to each, shape (n,); their inverse is how much a DCM error has grown."""
    rate = stiffness / omega
    return np.asarray(np.exp(-0.5 * sample_time * np.concatenate(([0.0], np.cumsum(rate[1:] + rate[:-1])))))


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
    decay = decays(stiffness, omega, sample_time)[:, None]
    share = 0.5 * (decay[:-1] - decay[1:]) * (zmp[:-1] + zmp[1:])
    ahead = np.concatenate((np.cumsum(share[::-1], axis=0)[::-1], np.zeros_like(zmp[:1])))
    return np.asarray((ahead + decay[-1] * zmp[-1]) / decay)


@dataclass(frozen=True, slots=True)
class NominalMotion:
    """A CoM motion with constant jerk between samples.

    Attributes:
        com: position, velocity, acceleration at samples 0..n-1, shape (3, n, 2) [m, m/s, m/s^2].
        zmp: the point that drives it, shape (n, 2) [m].
        jerk: of each interval, shape (n - 1, 2) [m/s^3].
        sample_time: length of an interval [s].
    """

    com: Array
    zmp: Array
    jerk: Array
    sample_time: float


def nominal_motion(position: Array, zmp: Array, stiffness: Array, sample_time: float) -> NominalMotion:
    """The motion c'' = λ (c - p) from a position that does not diverge, exact at the samples.

    With constant jerk between samples the motion is a cubic spline, whose values and second derivatives a obey
    (c_{k+1} - 2 c_k + c_{k-1}) / T² = (a_{k+1} + 4 a_k + a_{k-1}) / 6; with a = λ (c - p) that is one tridiagonal
    system. It starts at `position` and ends over the last ZMP: this fixes its velocity, which is that of a DCM with
    nothing to correct.

    Args:
        position: CoM now, shape (2,) [m].
        zmp: p, shape (n, 2) [m].
        stiffness: λ, shape (n,) [1/s^2].
        sample_time: T [s].
    """
    from scipy.linalg import lapack

    t = sample_time
    share = stiffness * (t * t / 6.0)
    pull = share[:, None] * zmp
    right = np.empty_like(zmp)
    right[1:-1] = -pull[2:] - 4.0 * pull[1:-1] - pull[:-2]
    right[0], right[-1] = position, zmp[-1]
    lower, diagonal, upper = 1.0 - share[:-1], -2.0 - 4.0 * share, 1.0 - share[1:]
    diagonal[0], diagonal[-1], upper[0], lower[-1] = 1.0, 1.0, 0.0, 0.0
    motion = np.empty((3, *zmp.shape))
    c, v, a = motion
    c[:] = lapack.dgtsv(lower, diagonal, upper, right)[3]
    np.multiply(stiffness[:, None], c - zmp, out=a)
    v[:-1] = (c[1:] - c[:-1]) / t - t / 6.0 * (2.0 * a[:-1] + a[1:])
    v[-1] = v[-2] + 0.5 * t * (a[-2] + a[-1])
    return NominalMotion(motion, zmp, (a[1:] - a[:-1]) / t, t)


def bind_motion(kernels: Library, sample_time: float, count: int, **given: Array) -> tuple[Bound, dict[str, Array]]:
    """The struct of `nominal_motion` for up to so many samples, and its arrays, as far as they are not given."""
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(("zmp", "com", "velocity", "acceleration", "jerk"), (count, 2))
    shapes |= {"position": (2,), "stiffness": (count,), "upper": (count,)}
    arrays: dict[str, Any] = {name: np.empty(shape) for name, shape in shapes.items()} | given
    return kernels.fill("NominalMotion", sample_time=sample_time, **arrays), arrays


def no_motion(count: int, sample_time: float) -> NominalMotion:
    """A CoM that rests at the origin: then the moves are the whole motion."""
    zero = np.zeros((3, count, 2))
    return NominalMotion(zero, zero[0], zero[0, 1:], sample_time)


def jerk_range(jerk: Array, starts: tuple[int, ...], limit: float) -> tuple[Array, Array]:
    """Bounds of the moves that keep the whole jerk within its limit where the nominal one is; zero always is allowed.

    Args:
        jerk: nominal jerk over the horizon, shape (N, 2) [m/s^3].
        starts: first sample of each block of moves.
        limit: of the whole jerk [m/s^3].

    Returns:
        Lower and upper bounds, shape (2, m) each: per axis and block [m/s^3].
    """
    lowest, highest = np.minimum.reduceat(jerk, starts), np.maximum.reduceat(jerk, starts)
    return np.minimum(-limit - lowest, 0.0).T, np.maximum(limit - highest, 0.0).T
