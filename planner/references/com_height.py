"""Vertical CoM motion: the paper's profile (eq. (15)), a smooth one, and one that legs can follow on stairs.

A profile has two parts: the base level, which changes from support to support, and the bumps above it. On stairs the
paper changes the level in double support, where the rear foot stands a riser below the front one and the CoM is
already over the front foot: the rear leg is then too short. So there are two places for the rise, see `Rise`.
"""

import math
from collections.abc import Callable
from enum import Enum
from typing import Protocol

import numpy as np

from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import GRAVITY, Array, PhaseKind
from surefoot.values import dataclass

_FALL_LIMIT = 0.8
"""Downward CoM acceleration that a plan may ask for, as a share of gravity: beyond it the feet hardly press [-]."""

STEEPEST_FALL = _FALL_LIMIT * GRAVITY
"""The same in numbers [m/s^2]."""

_IMPULSE_LIMIT = 0.95
"""The same where one-sample impulses of a height with velocity jumps are cut off [-]."""

_LEAST_HEIGHT = 0.1
"""Height over the ZMP that the reference robot's pendulum never goes below [m]."""

CLIMB_SHARE, DESCENT_SHARE = 0.8, 1.0
"""Shares of single support in which the level rises and sinks: the knee is bent most, and can lift least, at the begin
of a climb and at the end of a descent [-]."""

BENT_KNEES = 0.08
"""How much lower than stretched knees carry it bent ones carry the reference robot's CoM, as crouched gaits do [m]."""


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
        return _lifted(_differences(bump, t), rise, _changes(support_height)[index], support_height[index])


def _differences(values: Array, sample_time: float) -> Array:
    """Values and their first and second central differences, at rest beyond both ends, shape (3, n)."""
    padded = np.pad(values, 1, mode="edge")
    slope = (padded[2:] - padded[:-2]) / (2.0 * sample_time)
    return np.stack((values, slope, (padded[2:] - 2.0 * values + padded[:-2]) / sample_time**2))


def _changes(levels: Array) -> Array:
    """From each level to the next one, and none after the last, shape (m,) [m]."""
    change = np.zeros_like(levels)
    np.subtract(levels[1:], levels[:-1], out=change[:-1])
    return change


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


def _on_levels(place: Rise, samples: PhaseSamples, bump: Array, support_height: Array) -> Array:
    """A height with quintic changes of level at a place; the bump is by the clock."""
    if place is Rise.DOUBLE:
        rise, index = quintic_rise(samples.fraction, samples.fraction_rate), samples.index
        return samples.in_time(_lifted(bump, rise, _changes(support_height)[index], support_height[index]))
    swinging = samples.kind == PhaseKind.SINGLE
    index = np.maximum(samples.index - (swinging | samples.last_stand), 0)
    length = np.where(swinging, samples.length, np.inf)
    # The lower foot of each double support, and the last one again.
    lower = support_height.copy()
    np.minimum(support_height[:-1], support_height[1:], out=lower[:-1])
    change = _changes(lower)[index]
    rise = _early_rise(samples, np.where(change < 0.0, DESCENT_SHARE, CLIMB_SHARE) * length)
    return samples.in_time(_lifted(bump, rise, change, lower[index]))


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
    s, left, square, rise = fraction, 1.0 - fraction, fraction**2, np.empty((3, len(fraction)))
    rise[0] = s**3 * (10.0 - 15.0 * s + 6.0 * square)
    rise[1] = 30.0 * square * left**2 * rate
    rise[2] = 60.0 * s * left * (1.0 - 2.0 * s) * rate**2
    return rise


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
    s, c, bump = np.sin(angle), np.cos(angle), np.empty((3, len(angle)))
    square = s**2
    bump[0], bump[1], bump[2] = s**3, 3.0 * w * square * c, 3.0 * w**2 * s * (2.0 * c**2 - square)
    bump *= amplitude
    return bump


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


def preview_height(
    profile: HeightProfile,
    gait: GaitParameters,
    samples: PhaseSamples,
    support_height: Array,
    zmp_height: Array,
    length: float = 1.0,
    transition: Callable[[Array], Array | None] | None = None,
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
        transition: what takes the place of the law's height, None where that stays; it always stays by default.
    """
    height = profile.height(gait, samples, support_height)[:, 1:-1]
    moved = None if transition is None else transition(height)
    height = height if moved is None else moved
    pressing, over = preview_limits(profile, length)
    return HeightPreview(height, np.maximum(GRAVITY + height[2], pressing) / np.maximum(height[0] - zmp_height, over))


def preview_limits(profile: HeightProfile, length: float) -> tuple[float, float]:
    """Least g + z'' [m/s^2] and height above the ZMP [m] with which a stiffness counts; see `preview_height`."""
    limit = _IMPULSE_LIMIT if profile.impulsive else _FALL_LIMIT
    return (1.0 - limit) * GRAVITY, _LEAST_HEIGHT * length
