"""Joint angles and velocities from encoders that are late, rounded and noisy."""

import math

import numpy as np

from surefoot.maths import linear
from surefoot.readings import Readings
from surefoot.wbc.types import Array

SHARPEST = 0.12
"""Highest bandwidth of the observer times the control period [-]."""

FINE = 1.1e-5
"""Encoder noise for which the bandwidth is given [rad]."""

KEPT = 64
"""Accelerations that are remembered [ticks]."""


class JointObserver:
    """Luenberger observer of a double integrator for each joint, critically damped, driven by decided accelerations.

    Between two readings the joints go on as decided, q' = q + v T + u T²/2 and v' = v + u T; a reading moves them by
    1 - θ² and (1 - θ)²/T of its difference, whose error has both poles at θ = exp(-2π f T) (Brammer and Siffling,
    "Kalman-Bucy filters", 1989, the α-β filter). A late reading corrects the state of its own instant, from which the
    state of now follows by what was decided since. Where encoders say a velocity, that is taken.

    Args:
        joints: number of joints.
        period: control period [s].
        bandwidth: f, for encoders of `FINE` [Hz].
        noise: of an encoder [rad].

    Attributes:
        position: now, in an array that stays where it is, shape (nj,) [rad].
        velocity: now, in an array that stays where it is, shape (nj,) [rad/s].
        bandwidth: that it has [Hz].
        rate_noise: standard deviation of a velocity by the encoders' noise, an α-β filter's of coefficients 1 - θ² and
            (1 - θ)² [rad/s].
    """

    def __init__(self, joints: int, period: float, bandwidth: float, noise: float) -> None:
        # Measured on walks: 80 Hz serve encoders of 1e-5 rad best, 30 to 40 Hz those of 1.5e-4 rad.
        frequency = bandwidth * min((FINE / noise) ** (1.0 / 3.0), 1.0) if noise > 0.0 else math.inf
        self.bandwidth = min(frequency, SHARPEST / period)
        theta = math.exp(-math.tau * self.bandwidth * period)
        self._period, self._moved, self._sped = period, 1.0 - theta * theta, (1.0 - theta) ** 2 / period
        a, b = self._moved, self._sped * period
        self.rate_noise = noise / period * math.sqrt(2.0 * b * b / (a * (4.0 - 2.0 * a - b)))
        self._accelerations, self._still = np.zeros((KEPT, joints)), np.zeros(joints)
        # The state at the instant of the last reading, and that of now.
        self._q, self._v = np.zeros(joints), np.zeros(joints)
        self._tick, self._at, self._count = -1, 0, 0
        self.position, self.velocity = np.zeros(joints), np.zeros(joints)
        self._q_now, self._v_now = self.position, self.velocity

    def drive(self, acceleration: Array) -> None:
        """Remember the joints' accelerations from this tick to the next, shape (nj,) [rad/s^2]."""
        self._accelerations[self._count % len(self._accelerations), :] = acceleration
        self._count += 1

    def update(self, readings: Readings) -> tuple[Array, Array]:
        """Angles and velocities now, shape (nj,) each [rad, rad/s]; the next call writes over them."""
        reading, speed = readings.joint_position, readings.joint_velocity
        self._tick += 1
        at = self._tick - round(reading.age / self._period)
        if speed is not None:
            self._take(at, reading.values, speed.values)
        elif self._tick == 0:
            self._take(at, reading.values, self._still)
        else:
            self._hear(at, reading.values, reading.fresh)
        self._q_now[:], self._v_now[:] = self._q, self._v
        for tick in range(self._at, self._tick):
            self._go_on(tick, self._q_now, self._v_now)
        return self.position, self.velocity

    def _take(self, at: int, position: Array, velocity: Array) -> None:
        """A state that is said, of a tick."""
        self._at = at
        self._q[:], self._v[:] = position, velocity

    def _hear(self, at: int, reading: Array, fresh: bool) -> None:
        """Correct the state of a tick by what encoders say of it, unless that is known already."""
        newer = fresh and at > self._at
        for tick in range(self._at, at):
            self._go_on(tick, self._q, self._v)
        self._at = max(self._at, at)
        if newer:
            for i in range(len(self._still)):
                miss = reading[i] - self._q[i]
                self._q[i] += self._moved * miss
                self._v[i] += self._sped * miss

    def _go_on(self, tick: int, q: Array, v: Array) -> None:
        """Go on by one period from a tick, with the decided accelerations."""
        back, T, kept = self._tick - tick, self._period, len(self._accelerations)
        known = back <= self._count and back <= kept
        u = self._accelerations[(self._count - back) % kept] if known else self._still
        linear.add_scaled(q, T, v)
        linear.add_scaled(q, 0.5 * T * T, u)
        linear.add_scaled(v, T, u)
