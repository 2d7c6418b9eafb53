"""The nominal CoM motion: the one from here that has exactly the ZMP of the footsteps, whatever its jerk.

A few blocks of jerk cannot follow a ZMP that jumps half a metre in a tenth of a second at the far end of the horizon,
nor a leg that swings in a third of a second; planned with them alone, fast steps are shortened for no physical reason.
So the optimiser plans only what differs from this motion.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from planner.types import Array


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
