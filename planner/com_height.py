"""Vertical CoM motion: the paper's profile (eq. z_traj), made twice continuously differentiable."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.gait import GaitParameters
from planner.schedule import Phase, Schedule
from planner.types import GRAVITY, Array, PhaseKind

_FALL_LIMIT = 0.8
"""Downward CoM acceleration that a plan may ask for, as a share of gravity: beyond it the feet hardly press [-]."""

_LEAST_HEIGHT = 0.1
"""Height over the ZMP that the pendulum never goes below [m]."""


@dataclass(frozen=True, slots=True)
class HeightShape:
    """CoM height of a whole walk, before the heights of the footholds are known.

    At sample k the CoM is at `base + rise[0, k] * step + bump[0, k]` over the support point `index[k]`, where `base` is
    that support's height and `step` the difference to the next one's.

    Attributes:
        index: support point that the base leaves, shape (K,).
        rise: share of the height step done, and its first and second derivative [1/s, 1/s^2], shape (3, K).
        bump: height above the base, and its first and second derivative, shape (3, K) [m, m/s, m/s^2].
    """

    index: NDArray[np.intp]
    rise: Array
    bump: Array


class HeightProfile(Protocol):
    """Anything that lays a CoM height on a schedule."""

    def shape(self, gait: GaitParameters, schedule: Schedule) -> HeightShape:
        """The height of the whole walk."""


@dataclass(frozen=True, slots=True)
class SmoothHeight:
    """C² height: a bump of A sin³ in each support phase, and a quintic rise to the next support in double support.

    The paper's A sin and its linear rise jump in velocity at every phase change, which asks for a ZMP that no foot
    has; sin³ and the quintic reach the same heights with continuous z, z', z''.
    """

    def shape(self, gait: GaitParameters, schedule: Schedule) -> HeightShape:
        """The height of the whole walk (see `HeightProfile`)."""
        rise = quintic_rise(schedule.fraction, schedule.fraction_rate)
        bump = np.zeros_like(rise)
        bump[0] = gait.com_height
        for phase in schedule.phases:
            amplitude = {PhaseKind.SINGLE: gait.apex_ss, PhaseKind.DOUBLE: gait.apex_ds}.get(phase.kind, 0.0)
            if amplitude:
                bump[:, phase.start : phase.end] += _sine_cubed(phase, amplitude, schedule.sample_time)
        return HeightShape(schedule.index, rise, bump)


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


def _sine_cubed(phase: Phase, amplitude: float, sample_time: float) -> Array:
    w = np.pi / (phase.samples * sample_time)
    angle = np.pi * np.arange(phase.samples) / phase.samples
    s, c = np.sin(angle), np.cos(angle)
    return amplitude * np.stack((s**3, 3.0 * w * s**2 * c, 3.0 * w**2 * s * (2.0 * c**2 - s**2)))


@dataclass(frozen=True, slots=True)
class HeightPreview:
    """CoM height over a window of samples.

    Attributes:
        height: z, z', z'' in the world frame, shape (3, n) [m, m/s, m/s^2].
        stiffness: λ = (g + z'') / (z - p_z), shape (n,) [1/s^2].
    """

    height: Array
    stiffness: Array


def preview_height(
    shape: HeightShape, start: int, count: int, support_height: Array, zmp_height: Array
) -> HeightPreview:
    """CoM height and pendulum stiffness of a window.

    λ counts the height above the ZMP, z - p_z; the paper's equation leaves p_z out, which is wrong on stairs. Measured
    footholds of a falling robot may lie anywhere: λ stays finite and positive.

    Args:
        shape: height of the walk.
        start: first sample of the window.
        count: its length.
        support_height: heights of the support points 0..n+1, shape (n + 2,) [m].
        zmp_height: height of the ground under the ZMP reference over the window, shape (count,) [m].
    """
    window = slice(start, start + count)
    index = shape.index[window]
    step = np.append(np.diff(support_height), 0.0)[index]
    height = shape.bump[:, window] + shape.rise[:, window] * step
    height[0] += support_height[index]
    pressing = np.maximum(GRAVITY + height[2], (1.0 - _FALL_LIMIT) * GRAVITY)
    return HeightPreview(height, pressing / np.maximum(height[0] - zmp_height, _LEAST_HEIGHT))


def check_height(shape: HeightShape, schedule: Schedule, support_height: Array) -> None:
    """Refuse a height that the body could only follow by nearly free fall, or that goes into the ground.

    Args:
        shape: height of the walk.
        schedule: its phases.
        support_height: heights of the support points 0..n+1, shape (n + 2,) [m].

    Raises:
        ValueError: names the acceleration or the height that is out of bounds.
    """
    step = np.append(np.diff(support_height), 0.0)[schedule.index]
    ground = support_height[schedule.index] + schedule.fraction * step
    height = preview_height(shape, 0, len(ground), support_height, ground).height
    lowest = float(np.min(height[0] - ground))
    if lowest <= 0.0:
        raise ValueError(f"The CoM comes within {lowest:.2f} m of the ground under it, but it must stay above it.")
    fall = float(np.min(height[2]))
    if fall < -_FALL_LIMIT * GRAVITY:
        raise ValueError(
            f"The CoM height falls off with {fall:.1f} m/s^2, but {-_FALL_LIMIT * GRAVITY:.1f} m/s^2 is the limit:"
            " the height step between two footsteps needs a longer gait.double_support."
        )
