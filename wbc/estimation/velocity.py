"""The velocity of the CoM by forces and by feet of which each may stand or slide: a filter of several hypotheses.

Momentum goes on by the forces of the ground and the weight, c'' = Σ f / m + g. A sole that stands tells the velocity of
the CoM by joints and turning alone. Neither is sure: somebody may push the robot, and a sole may tip, slide or carry
nothing. So at each tick hypotheses are held against each other, of each combination:

- forces: they are all that acts; or a push, which lasts from tick to tick, moves the CoM as well; or the velocity is
  lost, and begins anew;
- each foot: it stands, or it slides.

A hypothesis is a Kalman filter of the tick. Its likelihood is that of the feet's velocities. The estimate is the mean
of all, and its covariance that of all, with how far they lie apart (generalised pseudo-Bayesian filter of first order:
Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 11.6.3). So two
feet that agree outweigh the forces, and forces outweigh one foot that is thrown about.
"""

from itertools import product

import numpy as np

from surefoot.wbc.types import Array

FORCE = (1.0, 1.0, 3.0)
"""Deviation of the acceleration by forces that torques of joints tell, along each axis [m/s^2].

Measured at 50 Hz on a robot of 35 kg in steps after pushes: 1.0, 0.7, 2.8.
"""

PUSH, PUSH_BEGINS, PUSH_LASTS = 7.5, 0.05, 0.75
"""Deviation of the acceleration by a push [m/s^2]; chances that one begins within a tick, and that it goes on [-]."""

LOST, LOST_CHANCE = 1.0, 1e-3
"""Deviation of a velocity that begins anew [m/s], and the chance of it in a tick [-]."""

SLIDES = (0.7, 0.7, 0.3)
"""Deviation of the velocity of a sole that slides, along each axis: it hardly leaves the ground [m/s]."""

FLIES = (2.0, 2.0, 2.0)
"""Deviation of the velocity of one that carries nothing, along each axis [m/s]."""

DOUBTED = 0.25
"""Deviation of a sole's velocity from which on it is as likely to slide as to stand [m/s]."""

LEAST_DOUBT = 1e-4
"""Chance that a sole slides that stands as well as one can [-]."""

_FEET = np.array(list(product((True, False), repeat=2)))
"""Feet that stand in each combination, left first, shape (4, 2)."""

_UNIT = np.eye(3)


class CentroidalVelocity:
    """The filter of the module's head.

    Args:
        velocity: of the CoM at first, in the world's axes, shape (3,) [m/s].
        deviation: of it [m/s].

    Attributes:
        mean: velocity of the CoM, in the world's axes, shape (3,) [m/s].
        covariance: of it, shape (3, 3) [m^2/s^2].
        pushed: chance that somebody pushes the robot [-].
        standing: chance of each foot that it stands, left first, shape (2,) [-].
    """

    def __init__(self, velocity: Array, deviation: float) -> None:
        self.mean, self.covariance = velocity.copy(), deviation**2 * _UNIT
        self.pushed, self.standing = 0.0, np.ones(2)

    def predict(self, acceleration: Array, time: float) -> None:
        """Go on by an acceleration that the forces say.

        Args:
            acceleration: Σ f / m + g, shape (3,) [m/s^2].
            time: for which it acted [s].
        """
        self.mean = self.mean + time * acceleration
        self.covariance = self.covariance + np.diag(np.square(np.multiply(time, FORCE)))

    def correct(self, velocities: Array, deviations: Array, bearing: Array, time: float) -> None:
        """Take what the feet say.

        Args:
            velocities: of the CoM if each foot stands, left first, shape (2, 3) [m/s].
            deviations: of these along each axis, shape (2, 3) [m/s].
            bearing: chance of each that the ground carries it, shape (2,) [-].
            time: since the prediction before this one, in which a push may have acted [s].
        """
        wide, chances = self._predictions(time)
        feet = self._chances(deviations, bearing)
        astray = np.where((bearing > 0.0)[:, None], SLIDES, FLIES)
        spread = np.square(deviations) + np.where(_FEET[:, :, None], 0.0, np.square(astray))
        mean = np.repeat(self.mean[None], len(wide) * len(_FEET), axis=0)
        covariance = np.repeat(self.covariance + wide[:, None, None] ** 2 * _UNIT, len(_FEET), axis=0)
        with np.errstate(divide="ignore"):
            likely = np.log(np.outer(chances, feet)).ravel()
        for foot in (0, 1):
            S = covariance + np.tile(spread[:, foot, :, None] * _UNIT, (len(wide), 1, 1))
            inverse, off = np.linalg.inv(S), velocities[foot] - mean
            K = covariance @ inverse
            likely -= 0.5 * (np.einsum("hi,hij,hj->h", off, inverse, off) + np.log(np.linalg.det(S)))
            mean = mean + np.einsum("hij,hj->hi", K, off)
            covariance = covariance - K @ covariance
        weight = np.exp(likely - likely.max())
        self._merge(weight / weight.sum(), mean, covariance)

    def _predictions(self, time: float) -> tuple[Array, Array]:
        """Deviations by which the forces lack something, and the chance of each, shape (3,) [m/s, -]."""
        pushed = PUSH_BEGINS * (1.0 - self.pushed) + PUSH_LASTS * self.pushed
        return np.array([0.0, PUSH * time, LOST]), np.array([1.0 - pushed - LOST_CHANCE, pushed, LOST_CHANCE])

    @staticmethod
    def _chances(deviations: Array, bearing: Array) -> Array:
        """Chance of each combination of standing feet, shape (4,) [-]."""
        doubt = (deviations[:, 0] / DOUBTED) ** 3
        stands = bearing * (1.0 - np.maximum(doubt / (1.0 + doubt), LEAST_DOUBT))
        chances: Array = np.where(_FEET, stands, 1.0 - stands).prod(axis=1)
        return chances

    def _merge(self, weight: Array, mean: Array, covariance: Array) -> None:
        """Take the mean of all hypotheses by their weights."""
        self.mean = weight @ mean
        apart = mean - self.mean
        self.covariance = np.einsum("h,hij->ij", weight, covariance) + (weight * apart.T) @ apart
        by = weight.reshape(-1, len(_FEET))
        self.pushed, self.standing = float(by[1:].sum()), by.sum(axis=0) @ _FEET
