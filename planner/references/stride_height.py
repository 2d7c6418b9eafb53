"""CoM height of straight legs: highest over the stance foot, lowest between two feet, one smooth wave for each step."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import Array, PhaseKind


@dataclass(frozen=True, slots=True)
class StrideHeight(SmoothHeight):
    """C² height with one wave of A (1 - cos φ) / 2 for each step, A of the single support's rise.

    A leg of constant length carries its hip along an arc over its foot. So the CoM is highest in the middle of single
    support. It is lowest in the middle of double support, where both legs are stretched. A bump in each phase is at
    rest where phases change, which is where the legs have the most to do; this one is a wave at the frequency of the
    steps, of which z'' has the least maximum.

    φ is zero in the middle of double support and grows through each phase. Its rate at all changes of phase is that of
    the gait as it is asked for, so that a phase of another length needs to know of no other phase. A double support
    from or into standing goes from or to the gait's height at rest.
    """

    def apexes(self, gait: GaitParameters) -> tuple[float, float, float]:
        """See `SmoothHeight`; the wave is no bump of a phase."""
        return (0.0, 0.0, 0.0)

    def height(self, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
        """See `HeightProfile`."""
        height = SmoothHeight.height(self, gait, samples, support_height)
        wave = _wave(gait, samples)
        if samples.rate is not None:
            rate, bend = samples.rate
            wave = np.stack((wave[0], wave[1] * rate, wave[2] * rate * rate + wave[1] * bend))
        return np.asarray(height + wave)


def _wave(gait: GaitParameters, samples: PhaseSamples) -> Array:
    """The wave and its derivatives by the clock at the samples, shape (3, n) [m, m/s, m/s^2]."""
    n, step = len(samples.clock), gait.single_support + gait.double_support
    omega, half = 2.0 * np.pi / step, np.pi * gait.double_support / step
    begins, ends = _rests(samples)
    single, double = samples.kind == int(PhaseKind.SINGLE), samples.kind == int(PhaseKind.DOUBLE)
    wave = np.zeros((3, n))
    length = np.where(np.isfinite(samples.length), samples.length, 1.0) * samples.sample_time
    share = samples.elapsed * samples.sample_time / length
    for where, first, way in ((single, half, 2.0 * np.pi - 2.0 * half), (double & ~begins & ~ends, -half, 2.0 * half)):
        wave[:, where] = _cosine(gait.apex_ss, first, way, omega, share[where], length[where])
    edge = _cosine(gait.apex_ss, half, 0.0, 0.0, np.zeros(1), np.ones(1))
    edge[1:] = np.array([[0.5 * gait.apex_ss * np.sin(half) * omega], [0.5 * gait.apex_ss * np.cos(half) * omega**2]])
    moving = 1.0 / np.maximum(samples.fraction_rate, 1e-9)  # the part of the phase in which the weight goes over [s]
    for where, forward in ((double & begins & ~ends, True), (double & ends & ~begins, False)):
        way = samples.fraction[where] if forward else 1.0 - share[where]
        lasting = moving[where] if forward else length[where]
        still = forward & (samples.fraction_rate[where] == 0.0)
        arc = _from_rest(edge[:, 0], way, np.where(still, 1.0, lasting), 1.0 if forward else -1.0)
        wave[:, where] = np.where(still, 0.0, arc)
    return wave


def _rests(samples: PhaseSamples) -> tuple[Array, Array]:
    """Samples in a phase that begins at rest, and in one that ends at rest, shape (n,) each."""
    phases, swings = samples.phases, PhaseKind.SINGLE
    begins = [phase.rest > 0.0 if k == 0 else phases[k - 1].kind is not swings for k, phase in enumerate(phases)]
    ends = [k + 1 < len(phases) and phases[k + 1].kind is not swings for k in range(len(phases))]
    return np.array(begins)[samples.which], np.array(ends)[samples.which]


def _cosine(apex: float, first: float, way: float, omega: float, share: Array, length: Array) -> Array:
    """A (1 - cos φ) / 2 and its derivatives, with φ from `first` over `way`, at a rate of omega at both ends.

    Args:
        apex: A [m].
        first: φ at the begin of the phase [rad].
        way: by which it grows in the phase [rad].
        omega: its rate at both ends [rad/s].
        share: of the phase that is over, shape (n,) [-].
        length: of the phase, shape (n,) [s].

    Returns:
        Shape (3, n) [m, m/s, m/s^2].
    """
    left, over = 1.0 - share, way - omega * length
    phi = first + omega * length * share + over * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    rate = omega + over * 30.0 * (share * left) ** 2 / length
    bend = over * 60.0 * share * left * (1.0 - 2.0 * share) / length**2
    cosine, sine = np.cos(phi), np.sin(phi)
    return 0.5 * apex * np.stack((1.0 - cosine, sine * rate, cosine * rate**2 + sine * bend))


def _from_rest(end: Array, share: Array, length: Array, sign: float) -> Array:
    """Quintic from rest at zero to an end, shape (3,), or the way back from it where the sign is -1, shape (3, n)."""
    z, v, a = end[0], end[1] * length, end[2] * length**2
    c3, c4, c5 = 10.0 * z - 4.0 * v + 0.5 * a, -15.0 * z + 7.0 * v - a, 6.0 * z - 3.0 * v + 0.5 * a
    s = share
    value = s**3 * (c3 + s * (c4 + s * c5))
    slope = s**2 * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)) / length
    bend = s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5)) / length**2
    return np.stack((value, sign * slope, bend))
