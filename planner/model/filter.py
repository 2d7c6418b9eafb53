"""Kalman filter of the planner's state: the jerk-driven CoM seen through its position, its velocity and the ZMP."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.model.jerk import jerk_model
from surefoot.planner.types import Array
from surefoot.similarity import quantity

DESIGN_SAMPLE = 0.02
"""Sample time for which the process noise is given [s]."""

ZMP_ONLY = (True, False, False)
"""The sensors of the paper's filter; see `CentroidalFilter` for what they cannot see."""


@dataclass(frozen=True, slots=True)
class FilterNoise:
    """Standard deviations that a filter counts on.

    The defaults of the process are small against those of the sensors, since position and acceleration come from the
    model. Corrections of the low level and pushes, which no model knows, enter as a change of velocity.

    Attributes:
        zmp: of the measured ZMP; large, since it also holds what the point mass has not got [m].
        com: of the measured CoM [m].
        com_velocity: of its measured velocity [m/s].
        process: of what a sample adds to position, velocity and acceleration beside the planned jerk [m, m/s, m/s^2].
        sample_time: of that sample [s].
    """

    zmp: float = quantity(0.01, "m")
    com: float = quantity(0.002, "m")
    com_velocity: float = quantity(0.01, "m/s")
    process: tuple[float, float, float] = quantity((1e-5, 1e-3, 1e-2), "m, m/s, m/s^2")
    sample_time: float = quantity(DESIGN_SAMPLE, "s")


def sensor_model(stiffness: float) -> Array:
    """C of ZMP, CoM and CoM velocity, shape (3, 3); its first row is that of eq. (4).

    The ZMP is y = x - x''/λ; the paper prints -ω² for -1/ω².

    Args:
        stiffness: λ [1/s^2].
    """
    return np.array([[1.0, 0.0, -1.0 / stiffness], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


class CentroidalFilter:
    """Kalman filter of x, x', x'' of both horizontal axes, which share one covariance.

    The model is the paper's, in which the CoM executes the planned jerk and the ZMP is its output. That suffices for
    the cart-table; there a filter of the ZMP alone (`ZMP_ONLY`) works. For the real pendulum x'' = λ (x - p) the ZMP is
    the *input*: with jerk λ (x' - p'), C = [1, 0, -1/λ] has the unobservable mode (1, ω, ω²), which is the DCM and
    grows with e^{ωt}. Such a filter then only counts on the jerk that it believes to have been done, and whatever it
    is wrong by stays wrong. CoM position and velocity make every mode observable.

    Attributes:
        mean: estimate of x, x', x'', shape (3, 2) [m, m/s, m/s^2].
        covariance: of one axis, shape (3, 3).
        innovation: of the last update, what the measurement said beyond the prediction: νᵀ S⁻¹ ν of each axis, shape
            (2,), None before it; of a consistent filter its mean is the number of sensors [-].

    Args:
        sample_time: T [s].
        noise: what it counts on.
        mean: prior of x, x', x'', shape (3, 2).
        deviation: standard deviations of the prior, shape (3,).
        sensors: which of ZMP, CoM and CoM velocity it uses.
    """

    def __init__(
        self,
        sample_time: float,
        noise: FilterNoise,
        mean: Array,
        deviation: tuple[float, float, float],
        sensors: tuple[bool, bool, bool] = (True, True, True),
    ) -> None:
        self._transition, self._input = jerk_model(sample_time)
        self._process = np.diag(np.square(noise.process)) * (sample_time / noise.sample_time)
        self._variance = np.square([noise.zmp, noise.com, noise.com_velocity])
        self._sensors: NDArray[np.bool_] = np.array(sensors)
        self.mean = np.array(mean)
        self.covariance = np.diag(np.square(deviation))
        self.innovation: Array | None = None

    def predict(self, jerk: Array) -> None:
        """Go on by one sample.

        Args:
            jerk: planned CoM jerk of the sample, shape (2,) [m/s^3].
        """
        a = self._transition
        self.mean = a @ self.mean + np.outer(self._input, jerk)
        self.covariance = a @ self.covariance @ a.T + self._process

    def update(self, zmp: Array, com: Array, com_velocity: Array, stiffness: float) -> None:
        """Take a measurement; in Joseph's form, which keeps the covariance symmetric and positive semidefinite.

        Args:
            zmp: ZMP, less what moves it beside the pendulum, shape (2,) [m]; not finite when there is none.
            com: CoM position, shape (2,) [m].
            com_velocity: shape (2,) [m/s].
            stiffness: λ now [1/s^2].
        """
        measured = np.stack((zmp, com, com_velocity))
        used = self._sensors & np.isfinite(measured).all(axis=1)
        if not used.any():
            return
        c, r = sensor_model(stiffness)[used], np.diag(self._variance[used])
        beyond, spread = measured[used] - c @ self.mean, c @ self.covariance @ c.T + r
        gain = np.linalg.solve(spread, c @ self.covariance).T
        rest = np.eye(3) - gain @ c
        self.mean = self.mean + gain @ beyond
        covariance = rest @ self.covariance @ rest.T + gain @ r @ gain.T
        self.covariance = 0.5 * (covariance + covariance.T)
        self.innovation = np.asarray(np.sum(beyond * np.linalg.solve(spread, beyond), axis=0))
