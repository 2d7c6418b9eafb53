"""Joint angles and velocities from encoders that are late, rounded and noisy."""

import math
from collections.abc import Callable

import numpy as np

from surefoot.native.library import Library, library
from surefoot.readings import Readings
from surefoot.wbc.types import Array

SHARPEST = 0.12
"""Highest bandwidth of the observer times the control period [-]."""

FINE = 1.1e-5
"""Encoder noise for which the bandwidth is told [rad]."""

KEPT = 64
"""Accelerations that are remembered [ticks]."""

_TOLD = 2
"""Place of their number in the clock of the kernel."""


class JointObserver:
    """Luenberger observer of a double integrator for each joint, critically damped, driven by told accelerations.

    Between two readings the joints go on as told, q' = q + v T + u T²/2 and v' = v + u T; a reading moves them by
    1 - θ² and (1 - θ)²/T of its difference, whose error has both poles at θ = exp(-2π f T) (Brammer and Siffling,
    "Kalman-Bucy filters", 1989, the α-β filter). A late reading corrects the state of its own instant, from which the
    state of now follows by what was told since. Where encoders say a velocity, that is taken.

    Args:
        joints: number of joints.
        period: control period [s].
        bandwidth: f, for encoders of `FINE` [Hz].
        noise: of an encoder [rad].

    Attributes:
        bandwidth: that it has [Hz].
        rate_noise: standard deviation of a velocity by the encoders' noise, an α-β filter's of coefficients 1 - θ² and
            (1 - θ)² [rad/s].
    """

    def __init__(self, joints: int, period: float, bandwidth: float, noise: float) -> None:
        # Measured on walks: 80 Hz serve encoders of 1e-5 rad best, 30 to 40 Hz those of 1.5e-4 rad.
        frequency = bandwidth * min((FINE / noise) ** (1.0 / 3.0), 1.0) if noise > 0.0 else math.inf
        self.bandwidth = min(frequency, SHARPEST / period)
        self._period, theta = period, math.exp(-math.tau * self.bandwidth * period)
        self._moved, self._sped = 1.0 - theta * theta, (1.0 - theta) ** 2 / period
        a, b = self._moved, self._sped * period
        self.rate_noise = noise / period * math.sqrt(2.0 * b * b / (a * (4.0 - 2.0 * a - b)))
        self._told, self._still = np.zeros((KEPT, joints)), np.zeros(joints)
        self._position, self._velocity = np.zeros(joints), np.zeros(joints)
        self._tick, self._at, self._count = -1, 0, 0
        self._now = np.zeros(joints), np.zeros(joints)
        kernels = library()
        self._update = self._compiled(kernels) if kernels else None

    def _compiled(self, kernels: Library) -> Callable[[int, bool, bool], None]:
        self._reading, self._speed = np.zeros_like(self._still), np.zeros_like(self._still)
        self._clock = np.array([self._tick, self._at, self._count])
        update: Callable[[int, bool, bool], None] = kernels.bind(
            "joint_observer_update",
            joints=len(self._still),
            kept=KEPT,
            period=self._period,
            moved=self._moved,
            sped=self._sped,
            clock=self._clock,
            told=self._told,
            reading=self._reading,
            speed=self._speed,
            position=self._position,
            velocity=self._velocity,
            now_position=self._now[0],
            now_velocity=self._now[1],
        )
        return update

    def told(self, acceleration: Array) -> None:
        """Remember the joints' accelerations from this tick to the next, shape (nj,) [rad/s^2]."""
        self._told[self._count % KEPT] = acceleration
        self._count += 1
        if self._update is not None:
            self._clock[_TOLD] = self._count

    def update(self, readings: Readings) -> tuple[Array, Array]:
        """Angles and velocities now, shape (nj,) each [rad, rad/s]; the next call may write over them."""
        self._tick += 1
        reading, speed = readings.joint_position, readings.joint_velocity
        late = round(reading.age / self._period)
        if self._update is not None:
            self._reading[:] = reading.values
            if speed is not None:
                self._speed[:] = speed.values
            self._update(late, reading.fresh, speed is not None)
            return self._now
        if self._tick == 0 or speed is not None:
            self._at = self._tick - late
            self._position[:], self._velocity[:] = reading.values, 0.0 if speed is None else speed.values
        else:
            fresh = reading.fresh and self._tick - late > self._at
            for at in range(self._at, self._tick - late):
                self._go_on(at, self._position, self._velocity)
            self._at = max(self._at, self._tick - late)
            if fresh:
                miss = reading.values - self._position
                self._position += self._moved * miss
                self._velocity += self._sped * miss
        self._now = position, velocity = self._position.copy(), self._velocity.copy()
        for at in range(self._at, self._tick):
            self._go_on(at, position, velocity)
        return self._now

    def _go_on(self, at: int, position: Array, velocity: Array) -> None:
        """By one period from a tick on, as told."""
        back, T = self._tick - at, self._period
        u = self._told[(self._count - back) % KEPT] if back <= min(self._count, KEPT) else self._still
        position += T * velocity + (0.5 * T * T) * u
        velocity += T * u
