"""Heel-off: at the end of its stance a foot rolls about its toe edge, and comes back level in its swing.

A rear foot that stays flat is what a long step runs out of: with the heel up the ankle comes forward and up, by 7 cm at
0.5 rad. The roll begins in double support, once the ZMP has left the foot behind: from then on the toe edge and the
front foot can carry it.
"""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import frame_rotation, sole_rates, sole_rotation
from surefoot.planner.types import Array, Foot, PhaseKind
from surefoot.planner.walk.clock import Schedule
from surefoot.planner.walk.footsteps import FootstepPlan

_BEGIN = 0.25
"""Share of the weight shift after which the heel leaves the ground [-]."""

_END = 0.6
"""Share of single support after which the foot is level again, before it comes down [-]."""

_LEAST_STEP = 1.5
"""Feet nearer to each other than so many half soles along the foot do not roll [-]."""


@dataclass(frozen=True, slots=True)
class FootRoll:
    """Pitch of one foot about its toe edge over time; the heel is up where it is positive.

    θ = 64 A s³ (1 - s)³ between begin and end: twice continuously differentiable, and highest shortly after the foot
    has left the ground, as a person's.

    Attributes:
        foot: which.
        start: begin [s].
        end: end [s].
        angle: A, the greatest pitch [rad].
        toe: toe edge from the sole's centre [m].
    """

    foot: Foot
    start: float
    end: float
    angle: float
    toe: float

    def evaluate(self, time: float) -> tuple[float, float, float]:
        """Pitch, its rate and its acceleration [rad, rad/s, rad/s^2]."""
        span = self.end - self.start
        value, slope, bend = bump((time - self.start) / span)
        return self.angle * value, self.angle * slope / span, self.angle * bend / span**2

    def centre(self, time: float, level: Array, rates: Array) -> tuple[Array, Array]:
        """Where the sole's centre is and how it moves, with the foot turned about its toe edge.

        Args:
            time: [s].
            level: pose of the sole as if it were level, x, y, z [m], yaw, pitch, roll [rad], shape (6,).
            rates: its rates, shape (6,) [m/s, rad/s].

        Returns:
            Position, shape (3,) [m], and velocity, shape (3,) [m/s], in the world frame.
        """
        pitch, rate, _ = self.evaluate(time)
        sine, cosine = math.sin(pitch), math.cos(pitch)
        rotation = sole_rotation(*level[3:].tolist())
        back = self.toe * rotation @ (1.0 - cosine, 0.0, sine)
        turning, _ = sole_rates(level[3:], rates[3:], np.zeros(3))
        rolling = self.toe * rate * rotation @ (sine, 0.0, cosine)
        return level[:3] + back, rates[:3] + rolling + np.cross(turning, back)


def bump(s: float) -> tuple[float, float, float]:
    """64 s³ (1 - s)³ within 0 to 1, else zero, and its first and second derivative."""
    if not 0.0 < s < 1.0:
        return 0.0, 0.0, 0.0
    w = s * (1.0 - s)
    return 64.0 * w**3, 192.0 * w**2 * (1.0 - 2.0 * s), 384.0 * w * ((1.0 - 2.0 * s) ** 2 - w)


@dataclass(frozen=True, slots=True)
class RollPlan:
    """The rolls of a whole walk on the planner's clock.

    Attributes:
        start: first instant of the roll before step i + 1, in samples, shape (n,).
        end: its last, shape (n,).
        angle: its greatest pitch, zero where the foot stays flat, shape (n,) [rad].
        toe: toe edge from the sole's centre [m].
    """

    start: Array
    end: Array
    angle: Array
    toe: float

    def of_step(self, step: int, foot: Foot, time: float, sample: int, sample_time: float) -> FootRoll | None:
        """The roll before or in a step at a sample, None if there is none any more.

        Args:
            step: number of the step.
            foot: the foot that takes it.
            time: now [s].
            sample: now on the planner's clock.
            sample_time: [s].
        """
        if not 1 <= step <= len(self.angle) or self.angle[step - 1] == 0.0 or sample >= self.end[step - 1]:
            return None
        begin, end = (time + (float(at[step - 1]) - sample) * sample_time for at in (self.start, self.end))
        return FootRoll(foot, begin, end, float(self.angle[step - 1]), self.toe)

    def pitch(self, schedule: Schedule) -> Array:
        """Pitch at every sample of the foot that swings or is the next to do so, shape (K,) [rad]."""
        values = np.zeros(len(schedule.phase_index))
        for start, end, angle in zip(self.start, self.end, self.angle, strict=True):
            samples = np.arange(int(start), int(end) + 1)
            values[samples] += [angle * bump((k - start) / (end - start))[0] for k in samples]
        return values


def roll_plan(schedule: Schedule, footsteps: FootstepPlan, angle: float, half_length: float) -> RollPlan:
    """Lay the rolls on the clock.

    Args:
        schedule: phases.
        footsteps: nominal footsteps.
        angle: greatest pitch [rad].
        half_length: of the sole [m].
    """
    start, end, angles = [], [], []
    for before, phase in zip(schedule.phases, schedule.phases[1:], strict=False):
        if phase.kind is not PhaseKind.SINGLE:
            continue
        ramp = np.count_nonzero(schedule.fraction_rate[before.start : before.end])
        start.append(phase.start - (1.0 - _BEGIN) * ramp)
        end.append(phase.start + _END * phase.samples)
        row = phase.step
        ahead = (footsteps.position[row] - footsteps.position[row - 1])[:2] @ frame_rotation(float(footsteps.yaw[row]))
        angles.append(angle if ahead[0] > _LEAST_STEP * half_length else 0.0)
    return RollPlan(np.array(start), np.array(end), np.array(angles), half_length)
