"""What acts on the robot beside gravity and the ground, and how heavy it is, from what its soles feel.

Momentum changes by forces alone: over a span T the contact forces F and moments M about the origin, a force f and a
moment about the CoM n from elsewhere, and the weight give, with the momentum p and the moment of momentum L about the
origin (of which masses all are the model's times one factor s)

    s m (g + Δv_z / T) = mean F_z,    f = s Δp / T - mean F,    n + c x f = s ΔL / T - mean(M) - s m c x g.

No acceleration is measured for that, and how the robot moves and stands does not matter. (Momentum observer: De Luca
and Mattone, ICRA 2003; here over spans of some ticks in place of its low-pass, since pushes are to leave no trace.)
"""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.wbc.model import RobotTerms
from surefoot.wbc.types import GRAVITY, Array, ExternalLoad

SPAN = 0.02
"""Time over which forces are held against the change of momentum [s]."""

SPANS = 13
"""Spans of which the median is taken: a push for less than half of them, 0.12 s, is not lasting and leaves no trace."""

LATEST = 3
"""Spans whose median bounds that: what ceases shall be forgotten soon."""

FORCE = (4.0, 8.0)
"""Force below which there is none, and from which all of it counts [N]; undisturbed walks leave 1.2 N."""

MOMENT = (4.0, 8.0)
"""Likewise of its moment about the CoM [N·m]; undisturbed walks leave 1.2 N·m."""

WEIGHT = (0.01, 0.02)
"""Likewise of what the weight is more or less than the model's, as a share of that [-]; undisturbed ones leave 0.001."""

RATES = (1000.0, 1000.0, 2.0)
"""At most so fast force, moment and share of the weight change [N/s, N·m/s, 1/s]."""

MOST = 0.8
"""Largest share of the weight by which the model's is set right: forces beyond it are no mass that is carried [-]."""


class LoadObserver:
    """Estimates what lasts of an external force, and the true mass.

    Args:
        mass: the model's [kg].
        period: time between two updates [s].

    Attributes:
        load: as estimated.
    """

    def __init__(self, mass: float, period: float) -> None:
        self._mass, self._ticks = mass, max(1, round(SPAN / period))
        self._span = self._ticks * period
        self._felt, self._com = np.zeros(6), np.zeros(3)
        self._momentum: Array | None = None
        self._count = 0
        self._spans = np.empty((0, 6))
        none, full = np.repeat([FORCE, MOMENT, WEIGHT], (2, 3, 1), axis=0).T
        self._none, self._ramp = none, full - none
        self._most = np.repeat(RATES, (2, 3, 1)) * self._span
        self._estimate = np.zeros(6)
        self.load = ExternalLoad(np.zeros(3), np.zeros(3), 1.0)

    def update(self, terms: RobotTerms, wrench: Array) -> ExternalLoad:
        """The load as it is now known.

        Args:
            terms: of the state now.
            wrench: of the soles, in their frames, shape (2, 6) [N, N·m].
        """
        if self._momentum is None:
            self._momentum = self._moving(terms)
            return self.load
        self._felt += terms.sole_wrench_map @ wrench.ravel()
        self._com += terms.com
        self._count += 1
        if self._count == self._ticks:
            self._close(terms)
        return self.load

    def _moving(self, terms: RobotTerms) -> Array:
        """Momentum and moment of momentum about the origin, by the model's masses, shape (6,) [N·s, N·m·s]."""
        momentum = self._mass * terms.com_velocity
        return np.concatenate((momentum, terms.angular_momentum + _cross(terms.com, momentum)))

    def _close(self, terms: RobotTerms) -> None:
        """Hold the forces of a span against its change of momentum."""
        moving, last = self._moving(terms), self._momentum
        felt, com = self._felt / self._ticks, self._com / self._ticks
        change = (moving - last) / self._span
        self._momentum, self._count = moving, 0
        self._felt[:], self._com[:] = 0.0, 0.0
        weight = self._mass * GRAVITY
        pressing = change[2] + weight
        # Nearly in flight nobody knows how heavy a robot is.
        scale = felt[2] / pressing if pressing > 0.3 * weight else 1.0 + self._estimate[5]
        external = scale * change - felt
        external[3:] -= _cross(com, np.array([external[0], external[1], -scale * weight]))
        if math.isfinite(float(external.sum())):
            span = np.array([*external[:2], *external[3:], scale - 1.0])
            self._spans = np.concatenate((self._spans[-SPANS + 1 :], span[None]))
            self._follow()

    def _follow(self) -> None:
        """Let the load follow what lasts."""
        lasting, latest = np.median(self._spans, axis=0), np.median(self._spans[-LATEST:], axis=0)
        # It ceases at once.
        lasting[:5] = np.where(lasting * latest > 0.0, np.copysign(np.minimum(abs(lasting), abs(latest)), lasting), 0.0)[:5]
        lasting[:5] *= len(self._spans) == SPANS
        lasting *= np.clip((np.abs(lasting) - self._none) / self._ramp, 0.0, 1.0)
        lasting[5] = min(max(lasting[5], -MOST), MOST)
        self._estimate = self._estimate + np.clip(lasting - self._estimate, -self._most, self._most)
        x, y, *moment, share = self._estimate.tolist()
        self.load = ExternalLoad(np.array([x, y, 0.0]), np.array(moment), 1.0 + share)


def _cross(a: Array, b: Array) -> Array:
    """a x b; numpy's own costs ten times as much for one pair."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
