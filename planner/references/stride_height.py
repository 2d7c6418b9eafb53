"""CoM height of straight legs: highest over the stance foot, lowest between two feet, one smooth wave for each step."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.maths.algebra import Vector
from surefoot.planner.geometry import quintic
from surefoot.planner.references import com_height
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import Array, PhaseKind

_DOUBLE, _SINGLE, _PI = int(PhaseKind.DOUBLE), int(PhaseKind.SINGLE), float(np.pi)
_REST: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class StrideHeight(SmoothHeight):
    """C² height with one wave of A (1 - cos φ) / 2 for each step, A of the single support's rise.

    A leg of constant length carries its hip along an arc over its foot. So the CoM is highest in the middle of single
    support. It is lowest in the middle of double support, where both legs are stretched. A bump in each phase is at
    rest where phases change, which is where legs have the most to do. This one is a wave at the frequency of the steps:
    no other way up and down in that time takes less acceleration.

    φ is zero in the middle of double support and grows through each phase. Its rate at all changes of phase is that of
    the gait as it is asked for. So a phase that lasts longer or shorter is joined smoothly to others, of which it need
    not know. A double support after standing begins at rest, one before standing ends at rest.
    """

    def apexes(self, gait: GaitParameters) -> tuple[float, float, float]:
        """See `SmoothHeight`; the wave is no bump of a phase."""
        return (0.0, 0.0, 0.0)

    def height(self, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
        """See `HeightProfile`."""
        level = SmoothHeight.height(self, gait, samples, support_height)
        wave = np.zeros((3, len(samples.clock)))
        _fill(samples, gait.apex_ss, gait.single_support, gait.double_support, _rests(samples), wave)
        if samples.rate is not None:
            rate, bend = samples.rate
            wave[2] = wave[2] * rate * rate + wave[1] * bend
            wave[1] *= rate
        return level + wave


def _rests(samples: PhaseSamples) -> NDArray[np.uint8]:
    """For each phase in sight 1 where it begins at rest, and 1 where it ends at rest, shape (n, 2)."""
    phases, rests = samples.phases, np.zeros((len(samples.phases), 2), dtype=np.uint8)
    for k, phase in enumerate(phases):
        rests[k, 0] = phase.starts
        rests[k, 1] = k + 1 < len(phases) and phases[k + 1].kind is not PhaseKind.SINGLE
    return rests


def _fill(
    samples: PhaseSamples, apex: float, swinging: float, standing: float, rests: NDArray[np.uint8], wave: Array
) -> None:
    """Write the wave and its derivatives by the clock, shape (3, n), zero at first.

    Args:
        samples: the phases.
        apex: A [m].
        swinging: duration of single support of the gait [s].
        standing: duration of double support of the gait [s].
        rests: see `_rests`.
        wave: where it is written.
    """
    which, kind, t = samples.which, samples.kind, samples.sample_time
    elapsed, length = samples.elapsed, samples.length
    fraction, fraction_rate = samples.fraction, samples.fraction_rate
    omega, half = 2.0 * _PI / (swinging + standing), _PI * standing / (swinging + standing)
    edge = _cosine(apex, half, omega, 0.0)
    for k in range(wave.shape[1]):
        begins, ends = rests[which[k], 0] > 0, rests[which[k], 1] > 0
        lasting = length[k] * t
        z = _REST
        if kind[k] == _SINGLE:
            z = _through(apex, half, 2.0 * (_PI - half), omega, elapsed[k] / length[k], lasting)
        elif kind[k] == _DOUBLE and not begins and not ends:
            z = _through(apex, -half, 2.0 * half, omega, elapsed[k] / length[k], lasting)
        elif kind[k] == _DOUBLE and begins and not ends and fraction_rate[k] > 0.0:
            z = _from_rest(edge, fraction[k], 1.0 / fraction_rate[k])
        elif kind[k] == _DOUBLE and ends and not begins:
            z = _from_rest(edge, 1.0 - elapsed[k] / length[k], lasting)
            z = z[0], -z[1], z[2]
        wave[0, k], wave[1, k], wave[2, k] = z[0], z[1], z[2]


def _through(apex: float, first: float, way: float, omega: float, share: float, lasting: float) -> Vector:
    """The wave in a phase through which φ grows, at a rate of omega at both ends.

    Args:
        apex: A [m].
        first: φ at the begin of the phase [rad].
        way: by which it grows in the phase [rad].
        omega: its rate at both ends [rad/s].
        share: of the phase that is over [-].
        lasting: duration of the phase [s].
    """
    more, rise = way - omega * lasting, com_height.quintic_rise(share, 1.0 / lasting)
    phase = first + omega * lasting * share + more * rise[0]
    return _cosine(apex, phase, omega + more * rise[1], more * rise[2])


def _cosine(apex: float, phase: float, rate: float, bend: float) -> Vector:
    """A (1 - cos φ) / 2 and its derivatives by time, of φ [rad] with its derivatives."""
    c, s, a = math.cos(phase), math.sin(phase), 0.5 * apex
    return a * (1.0 - c), a * s * rate, a * (c * rate * rate + s * bend)


def _from_rest(end: Vector, share: float, lasting: float) -> Vector:
    """The quintic from rest at zero to an end after a time [s], when a share of that is over, and its derivatives."""
    way = quintic.between(_REST, end, lasting)
    return quintic.value(way, share * lasting), quintic.slope(way, share * lasting), quintic.bend(way, share * lasting)
