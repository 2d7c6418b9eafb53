"""The angular velocity of the IMU from a noisy gyroscope, by a Kalman filter that hears what is planned."""

import math

import numpy as np

from surefoot.native.library import library
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
        rate: now, bias included, in an array that stays where it is, shape (3,) [rad/s].
        deviation: standard deviation of it, the largest of the three axes [rad/s].
    """

    def __init__(self, rate: Array, period: float, density: float, unplanned: float) -> None:
        self._noise, self._more = density**2 / period, unplanned**2 * period
        self.rate, self._seen, self._gained, self._variance = (np.array(rate) for _ in range(4))
        self._variance[:] = self._noise
        kernels = library()
        self._update = (
            None
            if kernels is None
            else kernels.bind(
                "rate_filter_update",
                noise=self._noise,
                more=self._more,
                impact=IMPACT,
                seen=self._seen,
                gained=self._gained,
                rate=self.rate,
                variance=self._variance,
            )
        )

    @property
    def deviation(self) -> float:
        """See the attributes."""
        return math.sqrt(max(self._variance.tolist()))

    def update(self, reading: Array, gained: Array | None, ticks: int) -> None:
        """Take a reading.

        Args:
            reading: of the gyroscope, shape (3,) [rad/s].
            gained: angular velocity that was planned to be gained since the reading before, shape (3,); None where
                nobody has told [rad/s].
            ticks: since the reading before.
        """
        if self._update is not None:
            self._seen[:] = reading
            if gained is not None:
                self._gained[:] = gained
            self._update(ticks, gained is not None)
        elif gained is None or self._noise == 0.0:
            self.rate[:], self._variance[:] = reading, self._noise
        else:
            expected, variance = self.rate + gained, self._variance + ticks * self._more
            square = (reading - expected) ** 2
            variance = np.where(square > IMPACT * (variance + self._noise), square - self._noise, variance)
            gain = variance / (variance + self._noise)
            self.rate[:], self._variance[:] = expected + gain * (reading - expected), gain * self._noise
