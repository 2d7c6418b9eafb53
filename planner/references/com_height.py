"""Vertical CoM motion: the paper's profile (eq. (15)), a smooth one, and one that legs can follow on stairs.

A profile has two parts: the base level, which changes from support to support, and the bumps above it. On stairs the
paper changes the level in double support, where the rear foot stands a riser below the front one and the CoM is
already over the front foot: the rear leg is then too short. So there are two places for the rise, see `Rise`.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import quintic
from surefoot.planner.types import GRAVITY, Array, PhaseKind
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.phases import CLOCK_ROUNDING, PhaseSamples

_FALL_LIMIT = 0.8
"""Downward CoM acceleration that a plan may ask for, as a share of gravity: beyond it the feet hardly press [-]."""

STEEPEST_FALL = _FALL_LIMIT * GRAVITY
"""The same in numbers [m/s^2]."""

_IMPULSE_LIMIT = 0.95
"""The same where one-sample impulses of a height with velocity jumps are cut off [-]."""

_LEAST_HEIGHT = 0.1
"""Height over the ZMP that the reference robot's pendulum never goes below [m]."""

LIFTING = 5.0
"""Vertical CoM acceleration, up or down, with which a body may be brought to another height in a hurry [m/s^2]."""

_ROUNDING = 1e-9
"""Accelerations are compared with this tolerance [m/s^2]."""

_LOOKED_AT = np.linspace(0.0, 1.0, 21)
"""Shares of a bridge at which its acceleration is looked at [-]."""

_CLIMB_SHARE, _DESCENT_SHARE = 0.8, 1.0
"""Shares of single support in which the level rises and sinks: the knee is bent most, and can lift least, at the begin
of a climb and at the end of a descent [-]."""

BENT_KNEES = 0.08
"""How much lower than stretched knees carry it bent ones carry the reference robot's CoM [m]."""


class Rise(Enum):
    """Where the base level of the CoM changes.

    DOUBLE, as in the paper: from the height of one support point to that of the next, while the ZMP moves.
    SINGLE: the level of a double support is that of the lower of its two feet, so that both legs reach the ground; it
    is changed in the single support before, on the new foot when going up and above the foot left behind when going
    down.
    """

    DOUBLE = "double"
    SINGLE = "single"


class HeightProfile(Protocol):
    """A law of the CoM height: a function of the phases and of the heights of the footholds."""

    @property
    def impulsive(self) -> bool:
        """Whether the velocity jumps, which the second derivative then has as impulses of one sample."""

    def standing(self, gait: GaitParameters) -> float:
        """Height over the feet at which the robot stands [m]."""

    def height(self, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
        """z, z', z'' in the world frame at the samples of a window, shape (3, n) [m, m/s, m/s^2].

        Args:
            gait: gives height and apexes.
            samples: the phases there; what a law makes of the first and the last of them is not used.
            support_height: heights of the support points in sight, shape (m,) [m].
        """


@dataclass(frozen=True, slots=True)
class SmoothHeight:
    """C² height: a bump of A sin³ in each support phase, and a quintic change of level.

    The paper's A sin and its linear rise jump in velocity at every phase change, which asks for a ZMP that no foot
    has; sin³ and the quintic reach the same heights with continuous z, z', z''.

    Attributes:
        rise: where the level changes.
    """

    rise: Rise = Rise.DOUBLE

    @property
    def impulsive(self) -> bool:
        """See `HeightProfile`."""
        return False

    def standing(self, gait: GaitParameters) -> float:
        """See `HeightProfile`."""
        return gait.com_height

    def apexes(self, gait: GaitParameters) -> tuple[float, float, float]:
        """A in each kind of phase: standing, double and single support [m]."""
        return (0.0, gait.apex_ds, gait.apex_ss)

    def height(self, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
        """See `HeightProfile`."""
        bump = _sine_cubed(samples, samples.per_phase(self.apexes(gait)))
        bump[0] += self.standing(gait)
        return _on_levels(self.rise, samples, bump, support_height)


@dataclass(frozen=True, slots=True)
class BentKneeHeight(SmoothHeight):
    """Constant height over the level, lower than the gait's: the crouched gait of most humanoids.

    Attributes:
        lower: by so much [m].
    """

    lower: float = BENT_KNEES

    def standing(self, gait: GaitParameters) -> float:
        """See `HeightProfile`."""
        return gait.com_height - self.lower

    def apexes(self, gait: GaitParameters) -> tuple[float, float, float]:
        """See `SmoothHeight`."""
        return (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PaperHeight:
    """The paper's height as printed (eq. (15)): A sin in each support phase, a linear rise in double support.

    Two things are mended, without which the equation means nothing over more than one step: z_c0 goes up by Δz_c with
    every step, and t begins anew with every step and phase. Its velocity jumps at each phase change stay: z' and z''
    are central differences at the sample time, so that z'' carries the jumps as impulses of one sample, some of which
    ask for more than free fall (steps of 0.15 m in 0.5 s at 50 Hz do). λ is kept positive there. Taking the analytic
    z'' instead, which ignores the jumps, would leave a λ that stairs do not change at all.
    """

    @property
    def impulsive(self) -> bool:
        """See `HeightProfile`."""
        return True

    def standing(self, gait: GaitParameters) -> float:
        """See `HeightProfile`."""
        return gait.com_height

    def height(self, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
        """See `HeightProfile`."""
        amplitude = samples.per_phase((0.0, gait.apex_ds, gait.apex_ss))
        bump = gait.com_height + amplitude * np.sin(np.pi * samples.elapsed / samples.length)
        t = samples.sample_time
        # Where a rise has just ended its slope still counts: that sample belongs to the level that was left.
        index = samples.index - (np.diff(samples.index, prepend=samples.index[:1]) > 0)
        done = samples.first + samples.index + samples.fraction
        rise = _differences(done, t)
        rise[0] = done - (samples.first + index)
        return _lifted(_differences(bump, t), index, rise, rise, support_height)


def _differences(values: Array, sample_time: float) -> Array:
    """Values and their first and second central differences, at rest beyond both ends, shape (3, n)."""
    padded = np.pad(values, 1, mode="edge")
    slope = (padded[2:] - padded[:-2]) / (2.0 * sample_time)
    return np.stack((values, slope, (padded[2:] - 2.0 * values + padded[:-2]) / sample_time**2))


def _lifted(bump: Array, index: NDArray[np.intp], rise: Array, fall: Array, levels: Array) -> Array:
    """A height above base levels, shape (3, n).

    Args:
        bump: height above the base, and its first and second derivative, shape (3, n) [m, m/s, m/s^2].
        index: base level that the CoM leaves, shape (n,).
        rise: share of the change to the next level done, and its derivatives, shape (3, n) [-, 1/s, 1/s^2].
        fall: the same on the way down.
        levels: base levels, shape (m,) [m].
    """
    step = np.append(np.diff(levels), 0.0)[index]
    height = bump + np.where(step < 0.0, fall, rise) * step
    height[0] += levels[index]
    return np.asarray(height)


def _on_levels(place: Rise, samples: PhaseSamples, bump: Array, support_height: Array) -> Array:
    """A height with quintic changes of level at a place; the bump is by the clock."""
    if place is Rise.DOUBLE:
        rise = quintic_rise(samples.fraction, samples.fraction_rate)
        return samples.in_time(_lifted(bump, samples.index, rise, rise, support_height))
    swinging = samples.kind == PhaseKind.SINGLE
    index = np.maximum(samples.index - (swinging | samples.last_stand), 0)
    length = np.where(swinging, samples.length, np.inf)
    rise, fall = (_early_rise(samples, share * length) for share in (_CLIMB_SHARE, _DESCENT_SHARE))
    # The lower foot of each double support, and the last one again.
    lower = np.append(np.minimum(support_height[:-1], support_height[1:]), support_height[-1])
    return samples.in_time(_lifted(bump, index, rise, fall, lower))


def _early_rise(samples: PhaseSamples, length: Array) -> Array:
    """Quintic rise within the first so many samples of each phase and rest at 1 after it, shape (3, n)."""
    fraction = samples.elapsed / length
    rate = np.where(fraction < 1.0, 1.0 / (length * samples.sample_time), 0.0)
    return quintic_rise(np.minimum(fraction, 1.0), rate)


def quintic_rise(fraction: Array, rate: Array) -> Array:
    """Quintic from 0 to 1 with zero first and second derivative at both ends.

    Args:
        fraction: argument in [0, 1], shape (K,).
        rate: its time derivative, shape (K,) [1/s].

    Returns:
        Value and first and second time derivative, shape (3, K).
    """
    s = fraction
    value = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    slope = 30.0 * s**2 * (1.0 - s) ** 2
    curvature = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    return np.stack((value, slope * rate, curvature * rate**2))


def highest_apex(duration: float) -> float:
    """Highest rise of A sin³ in a support phase that falls with at most `STEEPEST_FALL` [m].

    It falls fastest at its apex, with 3 A (π / T)².

    Args:
        duration: T of the phase [s].
    """
    return STEEPEST_FALL / 3.0 * (duration / math.pi) ** 2


def shortest_support(apex: float) -> float:
    """The duration of a support phase for which an apex [m] is the highest [s]."""
    return math.pi * math.sqrt(3.0 * apex / STEEPEST_FALL)


def _sine_cubed(samples: PhaseSamples, amplitude: Array) -> Array:
    w = np.pi / (samples.length * samples.sample_time)
    angle = np.pi * samples.elapsed / samples.length
    s, c = np.sin(angle), np.cos(angle)
    return np.asarray(amplitude * np.stack((s**3, 3.0 * w * s**2 * c, 3.0 * w**2 * s * (2.0 * c**2 - s**2))))


@dataclass(frozen=True, slots=True)
class HeightPreview:
    """CoM height over a window of samples.

    Attributes:
        height: z, z', z'' in the world frame, shape (3, n) [m, m/s, m/s^2].
        stiffness: λ = (g + z'') / (z - p_z), shape (n,) [1/s^2].
    """

    height: Array
    stiffness: Array

    def part(self, count: int) -> "HeightPreview":
        """That of the first so many samples."""
        return HeightPreview(self.height[:, :count], self.stiffness[:count])


@dataclass(frozen=True, slots=True)
class Bridge:
    """The height from where it was at a tick to its law some time later.

    A law of phases has a rise in each of them, however short a push makes it: hurried through in 0.2 s it asks for
    more than free fall, and the swing leg's momentum over what is left of the weight for any ZMP. When a step that is
    adapted changes how the clock goes the body leaves its law, therefore, and comes to it smoothly at the end of the
    phase, or as much later as it takes not to be accelerated by more than `LIFTING`, or more than it is already.

    Attributes:
        start: tick at which it begins.
        samples: after which the law goes on.
        coefficients: of the height by time, shape (6, 1) [m, m/s, ...].
        sample_time: length of a sample [s].
    """

    start: int
    samples: int
    coefficients: Array
    sample_time: float

    @classmethod
    def onto(cls, height: Array, state: Array, start: int, left: float, sample_time: float) -> "Bridge":
        """That from a state onto a law.

        Args:
            height: z, z', z'' of the law at the samples from now on, shape (3, n) [m, m/s, m/s^2].
            state: z, z', z'' now, shape (3,).
            start: tick.
            left: until the phase ends [samples].
            sample_time: length of a sample [s].
        """
        bound, least = max(LIFTING, abs(float(state[2]))), math.inf
        soonest, last = max(math.ceil(left - CLOCK_ROUNDING), 1), height.shape[1] - 1
        for samples in range(min(soonest, last), last + 1):
            end = height[:, samples : samples + 1]
            bridge = cls(start, samples, quintic(state[:, None], end, samples * sample_time), sample_time)
            hardest = float(np.abs(bridge._at(samples * _LOOKED_AT)[2]).max())
            if hardest < least:
                least, best = hardest, bridge
            if hardest <= bound + _ROUNDING:
                break
        return best

    def _at(self, samples: Array) -> Array:
        """z, z', z'' so many samples after the start, shape (3, n)."""
        powers, order = (samples * self.sample_time)[:, None] ** np.arange(6), np.arange(1.0, 6.0)
        first = self.coefficients[1:, 0] * order
        ways = (self.coefficients[:, 0], first, first[1:] * order[:-1])
        return np.stack([powers[:, : len(way)] @ way for way in ways])

    def over(self, height: Array, tick: int) -> Array:
        """The law at the samples from a tick on with what is left of the bridge over it, shape (3, n)."""
        ahead = np.arange(tick - self.start, self.samples)[: height.shape[1]]
        return np.concatenate((self._at(ahead.astype(np.float64)), height[:, len(ahead) :]), axis=1)


def preview_height(
    profile: HeightProfile,
    gait: GaitParameters,
    samples: PhaseSamples,
    support_height: Array,
    zmp_height: Array,
    length: float = 1.0,
    bridged: Callable[[Array], Array] | None = None,
) -> HeightPreview:
    """CoM height and pendulum stiffness of a window, but for the first and the last of its samples.

    λ counts the height above the ZMP, z - p_z; the paper's equation leaves p_z out, which is wrong on stairs. Measured
    footholds of a falling robot may lie anywhere: λ stays finite and positive.

    Args:
        profile: law of the height.
        gait: the walk.
        samples: its phases over the window, shape (n + 2,).
        support_height: heights of the support points in sight, shape (m,) [m].
        zmp_height: height of the ground under the ZMP reference, shape (n,) [m].
        length: size of the robot (see `surefoot.similarity`) [-].
        bridged: what is made of the law's height; nothing by default.
    """
    height = profile.height(gait, samples, support_height)[:, 1:-1]
    if bridged is not None:
        height = bridged(height)
    limit = _IMPULSE_LIMIT if profile.impulsive else _FALL_LIMIT
    pressing = np.maximum(GRAVITY + height[2], (1.0 - limit) * GRAVITY)
    return HeightPreview(height, pressing / np.maximum(height[0] - zmp_height, _LEAST_HEIGHT * length))
