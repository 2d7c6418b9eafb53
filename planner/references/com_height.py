"""Vertical CoM motion: the paper's profile (eq. (15)), a smooth one, and one that legs can follow on stairs.

A profile has two parts: the base level, which changes from support to support, and the bumps above it. On stairs the
paper changes the level in double support, where the rear foot stands a riser below the front one and the CoM is
already over the front foot: the rear leg is then too short. So there are two places for the rise, see `Rise`.
"""

import math
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np

from surefoot.maths.algebra import Vector
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import GRAVITY, Array, PhaseKind

_FALL_LIMIT = 0.8
"""Downward CoM acceleration that a plan may ask for, as a share of gravity: beyond it the feet hardly press [-]."""

STEEPEST_FALL = _FALL_LIMIT * GRAVITY
"""The same in numbers [m/s^2]."""

_IMPULSE_LIMIT = 0.95
"""The same where one-sample impulses of a height with velocity jumps are cut off [-]."""

_LEAST_HEIGHT = 0.1
"""Height over the ZMP that the reference robot's pendulum never goes below [m]."""

BENT_KNEES = 0.08
"""Height by which bent knees carry the reference robot's CoM lower than stretched ones, as crouched gaits do [m]."""


_DOUBLE, _SINGLE, _PI = int(PhaseKind.DOUBLE), int(PhaseKind.SINGLE), float(np.pi)


class Rise(Enum):
    """The time at which the base level of the CoM changes.

    DOUBLE, as in the paper: from the height of one support point to that of the next, while the ZMP moves.
    SINGLE: the level of a double support is that of the lower of its two feet, so that both legs reach the ground. The
    level changes throughout the single support before. It rises over the new foot, and sinks over the foot left behind.
    A quicker climb asks more of the knee where it is bent most, and can lift least.
    """

    DOUBLE = "double"
    SINGLE = "single"


class HeightProfile(Protocol):
    """A law of the CoM height: a function of the phases and of the heights of the footholds."""

    @property
    def impulsive(self) -> bool:
        """True if the velocity jumps, which the second derivative then has as impulses of one sample."""

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

    The paper's A sin and its linear rise jump in velocity at every phase change, which asks for a ZMP that no foot has.
    Here sin³ and the quintic reach the same heights with continuous z, z', z''.

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
        height = np.empty((3, len(samples.clock)))
        levels = np.asarray(support_height, dtype=np.float64)
        _fill(samples, self.apexes(gait), self.standing(gait), levels, self.rise is Rise.SINGLE, height)
        if samples.rate is not None:
            rate, bend = samples.rate
            _in_time(rate, bend, height)
        return height


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
        return _lifted(_differences(bump, t), rise, _changes(support_height)[index], support_height[index])


def _differences(values: Array, sample_time: float) -> Array:
    """Values and their first and second central differences, at rest beyond both ends, shape (3, n)."""
    padded, n = np.pad(values, 1, mode="edge"), len(values)
    before, after = padded[:n], padded[2:]
    return np.stack((values, (after - before) / (2.0 * sample_time), (after - 2.0 * values + before) / sample_time**2))


def _changes(levels: Array) -> Array:
    """From each level to the next one, and none after the last, shape (m,) [m]."""
    return np.append(np.diff(levels), 0.0)


def _lifted(bump: Array, rise: Array, change: Array, level: Array) -> Array:
    """A height above base levels, shape (3, n).

    Args:
        bump: height above the base, and its first and second derivative, shape (3, n) [m, m/s, m/s^2].
        rise: share of the change to the next level done, and its derivatives, shape (3, n) [-, 1/s, 1/s^2].
        change: of the base level from the one that the CoM leaves, shape (n,) [m].
        level: that one, shape (n,) [m].
    """
    height = bump + rise * change
    height[0] += level
    return np.asarray(height)


def _fill(samples: PhaseSamples, apexes: Vector, standing: float, levels: Array, early: bool, height: Array) -> None:
    """Write a smooth height by the clock, shape (3, n).

    Args:
        samples: the phases.
        apexes: A in each kind of phase [m].
        standing: height over the feet at which the robot stands [m].
        levels: heights of the support points, shape (m,) [m].
        early: whether the level changes in single support, see `Rise`.
        height: where it is written.
    """
    elapsed = samples.elapsed
    length = samples.length
    fraction = samples.fraction
    rate = samples.fraction_rate
    kind, index, t = samples.kind, samples.index, samples.sample_time
    for k in range(height.shape[1]):
        swings, at = kind[k] == _SINGLE, index[k]
        apex = apexes[2] if swings else apexes[1] if kind[k] == _DOUBLE else apexes[0]
        if early and at > 0 and (swings or math.isinf(length[k])):
            at -= 1
        low = _level(levels, at, early)
        change = _level(levels, at + 1, early) - low if at + 1 < levels.shape[0] else 0.0
        share, pace = fraction[k], rate[k]
        if early:
            share, pace = elapsed[k] / length[k] if swings else 0.0, 1.0 / (length[k] * t) if swings else 0.0
        rise = quintic_rise(share, pace)
        bump = sine_cubed(apex, elapsed[k], length[k], t)
        height[0, k] = bump[0] + rise[0] * change + (standing + low)
        height[1, k] = bump[1] + rise[1] * change
        height[2, k] = bump[2] + rise[2] * change


def _level(levels: Array, at: int, early: bool) -> float:
    """Base level at a support point; where it changes early that of the lower foot of each double support."""
    level: float = levels[at]
    return min(level, levels[at + 1]) if early and at + 1 < levels.shape[0] else level


def _in_time(rate: Array, bend: Array, height: Array) -> None:
    """Turn derivatives by a clock of this rate into those by time."""
    for k in range(height.shape[1]):
        height[2, k] = height[2, k] * rate[k] * rate[k] + height[1, k] * bend[k]
        height[1, k] *= rate[k]


def quintic_rise(s: float, rate: float) -> Vector:
    """Quintic from 0 to 1 with zero first and second derivative at both ends, and its derivatives by time.

    Args:
        s: argument in [0, 1].
        rate: its time derivative [1/s].
    """
    left = 1.0 - s
    return (
        s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
        30.0 * s * s * left * left * rate,
        60.0 * s * left * (1.0 - 2.0 * s) * rate * rate,
    )


def sine_cubed(apex: float, elapsed: float, length: float, sample_time: float) -> Vector:
    """A sin³ over a phase, and its derivatives by time.

    Args:
        apex: A [m].
        elapsed: since the phase began [samples].
        length: of the phase [samples].
        sample_time: [s].
    """
    w, angle = _PI / (length * sample_time), _PI * elapsed / length
    s, c = math.sin(angle), math.cos(angle)
    return apex * s * s * s, apex * 3.0 * w * s * s * c, apex * 3.0 * w * w * s * (2.0 * c * c - s * s)


def highest_apex(duration: float) -> float:
    """Highest rise of A sin³ in a support phase that falls with at most `STEEPEST_FALL` [m].

    It falls fastest at its apex, with 3 A (π / T)².

    Args:
        duration: T of the phase [s].
    """
    return STEEPEST_FALL / 3.0 * (duration / _PI) ** 2


def shortest_support(apex: float) -> float:
    """The duration of a support phase for which an apex [m] is the highest [s]."""
    return _PI * math.sqrt(3.0 * apex / STEEPEST_FALL)


@dataclass(frozen=True)
class HeightPreview:
    """CoM height over a window of samples.

    Attributes:
        height: z, z', z'' in the world frame, shape (3, n) [m, m/s, m/s^2].
        stiffness: λ = (g + z'') / (z - p_z), shape (n,) [1/s^2].
    """

    height: Array
    stiffness: Array

    def part(self, count: int) -> "HeightPreview":
        """The first so many samples of it."""
        return HeightPreview(self.height[:, :count], self.stiffness[:count])


def law_height(profile: HeightProfile, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> Array:
    """CoM height of a window by its law, but for the first and the last of its samples, shape (3, n).

    Args:
        profile: law of the height.
        gait: the walk.
        samples: its phases over the window, shape (n + 2,).
        support_height: heights of the support points in sight, shape (m,) [m].
    """
    height = np.empty((3, len(samples.clock) - 2))
    height[...] = profile.height(gait, samples, support_height)[:, 1:-1]
    return height


def preview_height(profile: HeightProfile, height: Array, zmp_height: Array, length: float = 1.0) -> HeightPreview:
    """CoM height of a window with its pendulum stiffness.

    λ counts the height above the ZMP, z - p_z; the paper's equation leaves p_z out, which is wrong on stairs. Measured
    footholds of a falling robot may lie anywhere: λ stays finite and positive.

    Args:
        profile: law of the height.
        height: z, z', z'' in the world frame, shape (3, n) [m, m/s, m/s^2].
        zmp_height: height of the ground under the ZMP reference, shape (n,) [m].
        length: size of the robot (see `surefoot.similarity`) [-].
    """
    stiffness = np.empty(len(zmp_height))
    pressing, over = preview_limits(profile, length)
    _stiffen(height, zmp_height, pressing, over, stiffness)
    return HeightPreview(height, stiffness)


def _stiffen(height: Array, ground: Array, pressing: float, over: float, stiffness: Array) -> None:
    """Write λ over a ground, shape (n,), which counts with no less than these, see `preview_limits`."""
    for k in range(stiffness.shape[0]):
        stiffness[k] = max(GRAVITY + height[2, k], pressing) / max(height[0, k] - ground[k], over)


def preview_limits(profile: HeightProfile, length: float) -> tuple[float, float]:
    """Least g + z'' [m/s^2] and height above the ZMP [m] with which a stiffness counts; see `preview_height`."""
    limit = _IMPULSE_LIMIT if profile.impulsive else _FALL_LIMIT
    return (1.0 - limit) * GRAVITY, _LEAST_HEIGHT * length
