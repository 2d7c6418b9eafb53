"""The angular velocity of the IMU from a noisy gyroscope, by a Kalman filter that hears what is planned."""

import math

import numpy as np

from surefoot.wbc.types import Array

IMPACT = 9.0
"""Square of the normalised innovation from which on the body was turned by what nobody planned, as by an impact [-]."""


class RateFilter:
    """Kalman filter of a random walk for each axis, driven by told angular accelerations.

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
        rate: now, bias included, shape (3,) [rad/s].
        deviation: standard deviation of it, the largest of the three axes [rad/s].
    """

    def __init__(self, rate: Array, period: float, density: float, unplanned: float) -> None:
        self._period, self._noise, self._more = period, density**2 / period, unplanned**2 * period
        self._rate, self._variance = rate.tolist(), [self._noise] * 3

    @property
    def rate(self) -> Array:
        """See the attributes."""
        return np.array(self._rate)

    @property
    def deviation(self) -> float:
        """See the attributes."""
        return math.sqrt(max(self._variance))

    def update(self, reading: Array, gained: Array | None, ticks: int) -> None:
        """Take a reading.

        Args:
            reading: of the gyroscope, shape (3,) [rad/s].
            gained: angular velocity that was planned to be gained since the reading before, shape (3,); None where
                nobody has told [rad/s].
            ticks: since the reading before.
        """
        if gained is None or self._noise == 0.0:
            self._rate, self._variance = reading.tolist(), [self._noise] * 3
            return
        noise, grown = self._noise, ticks * self._more
        for axis, (seen, more) in enumerate(zip(reading.tolist(), gained.tolist(), strict=True)):
            expected, variance = self._rate[axis] + more, self._variance[axis] + grown
            innovation = seen - expected
            square = innovation * innovation
            if square > IMPACT * (variance + noise):
                variance = square - noise
            gain = variance / (variance + noise)
            self._rate[axis], self._variance[axis] = expected + gain * innovation, gain * noise
