"""The angular velocity of the IMU from a noisy gyroscope, by a Kalman filter that hears what is planned."""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.wbc.types import Array

IMPACT = 9.0
"""Square of the normalised innovation from which on the body was turned by what nobody planned, as by an impact [-]."""


class RateFilter:
    """Kalman filter of a random walk for each axis, driven by decided angular accelerations.

    Between two readings ω' = ω + α T, whose variance grows by s² T of what the plan lacks; a reading z of a gyroscope
    with the density d has the variance d²/T of a mean over T. With the innovation y = z - ω of variance S = P + d²/T,

        ω' = ω + P/S y,   P' = (1 - P/S) P,

    and where y² > 9 S, P = y² - d²/T first: a jump is followed at once, and the filter is unsure for some ticks after
    it (the prior follows its innovation, as in Jazwinski, "Adaptive filtering", Automatica 1969). The gain follows from
    the two densities; nothing else is chosen. The bias of the gyroscope is part of ω, and is subtracted after.

    Args:
        rate: first reading, shape (3,) [rad/s].
        period: control period [s].
        density: of the gyroscope's noise [rad/s/√Hz].
        unplanned: s, of what the plan lacks, with the root of the time [rad/s/√s].

    Attributes:
        rate: now, bias included, in an array that stays where it is, shape (3,) [rad/s].
        deviation: standard deviation of it, the largest of the three axes [rad/s].
    """

    def __init__(self, rate: Array, period: float, density: float, unplanned: float) -> None:
        self._noise, self._more = density**2 / period, unplanned**2 * period
        self.rate = self._rate = np.array(rate, dtype=float)
        self._variance = np.full(3, self._noise)

    @property
    def deviation(self) -> float:
        """See the attributes."""
        return math.sqrt(max(self._variance[0], self._variance[1], self._variance[2]))

    def update(self, reading: Array, gained: Array | None, ticks: int) -> None:
        """Take a reading.

        Args:
            reading: of the gyroscope, shape (3,) [rad/s].
            gained: angular velocity that was planned to be gained since the reading before, shape (3,); None where
                nobody has decided [rad/s].
            ticks: since the reading before.
        """
        for i in range(3):
            if gained is None or self._noise == 0.0:
                self._rate[i], self._variance[i] = reading[i], self._noise
            else:
                self._take(i, reading[i], gained[i], ticks)

    def _take(self, i: int, z: float, gained: float, ticks: int) -> None:
        """Take the reading z of an axis."""
        expected = self._rate[i] + gained
        y = z - expected
        P = self._variance[i] + ticks * self._more
        if algebra.square(y) > IMPACT * (P + self._noise):
            P = algebra.square(y) - self._noise
        gain = P / (P + self._noise)
        self._rate[i] = expected + gain * y
        self._variance[i] = gain * self._noise
