"""What acts on the robot beside gravity and the ground, and how heavy it is, from what its soles feel.

Momentum changes by forces alone: over a span T the contact forces F and moments M about the origin, a force f and a
moment about the CoM n from elsewhere, and the weight give, with the momentum p and the moment of momentum L about the
origin (of which masses all are the model's times one factor s)

    s m (g + Δv_z / T) = mean F_z,    f = s Δp / T - mean F,    n + c x f = s ΔL / T - mean M - s m c x g.

No acceleration is measured for that, and how the robot moves and stands does not matter. It is the momentum observer
of De Luca and Mattone (ICRA 2003), with means over spans and their median in place of its low-pass: a push, however
hard, is to leave no trace, since what it has done is in the CoM's velocity already.
"""

import math

import numpy as np

from surefoot.wbc.model import RobotTerms, cross
from surefoot.wbc.types import GRAVITY, NO_LOAD, Array, ExternalLoad

SPAN = 0.02
"""Time over which forces are held against the change of momentum [s]."""

SPANS = 13
"""Spans of which the median lasts: a push for less than half of them, 0.12 s, leaves no trace."""

LATEST = 3
"""Spans whose median bounds that: what ceases is to be forgotten at once."""

FORCE = (4.0, 8.0)
"""Force below which there is none, and from which all of it counts [N]; undisturbed walks leave 1.2 N."""

MOMENT = (4.0, 8.0)
"""Likewise of its moment about the CoM [N·m]; undisturbed walks leave 1.2 N·m."""

WEIGHT = (0.01, 0.02)
"""Likewise of what the robot weighs more or less than its model, as a share of that [-]; they leave 0.001."""

RATES = (1000.0, 1000.0, 2.0)
"""How fast force, moment and share of the weight may change [N/s, N·m/s, 1/s]."""

MOST = 0.8
"""Largest share of the weight by which the model's is set right [-]."""

LEAST_PRESS = 0.3
"""In less than this share of the weight on its soles, nearly in flight, no robot tells how heavy it is [-]."""

_ROWS = (2, 3, 1)
"""Numbers of an estimate: force x, y; moment x, y, z; share of the weight."""


class LoadObserver:
    """Estimates what lasts of an external force, and the true mass.

    Args:
        mass: the model's [kg].
        period: time between two updates [s].

    Attributes:
        load: as estimated; `NO_LOAD` while there is none.
    """

    def __init__(self, mass: float, period: float) -> None:
        self._mass, self._ticks = mass, max(1, round(SPAN / period))
        self._span = self._ticks * period
        self._felt, self._com = np.zeros(6), np.zeros(3)
        self._momentum: Array | None = None
        self._count = 0
        self._spans = np.empty((0, sum(_ROWS)))
        self._none, full = np.repeat([FORCE, MOMENT, WEIGHT], _ROWS, axis=0).T
        self._ramp, self._most = full - self._none, np.repeat(RATES, _ROWS) * self._span
        self._estimate = np.zeros(sum(_ROWS))
        self.load = NO_LOAD

    def update(self, terms: RobotTerms, wrench: Array) -> ExternalLoad:
        """The load as it is now known; call it once per control tick.

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
            self._end_span(self._momentum, self._moving(terms))
        return self.load

    def _moving(self, terms: RobotTerms) -> Array:
        """Momentum and moment of momentum about the origin, by the model's masses, shape (6,) [N·s, N·m·s]."""
        momentum = self._mass * terms.com_velocity
        return np.concatenate((momentum, terms.angular_momentum + cross(terms.com, momentum)))

    def _end_span(self, before: Array, moving: Array) -> None:
        """Hold the forces of a span against its change of momentum."""
        felt, com, change = self._felt / self._ticks, self._com / self._ticks, (moving - before) / self._span
        self._momentum, self._count = moving, 0
        self._felt[:], self._com[:] = 0.0, 0.0
        weight = self._mass * GRAVITY
        pressing = float(change[2]) + weight
        known = min(pressing, float(felt[2])) > LEAST_PRESS * weight
        scale = float(felt[2]) / pressing if known else 1.0 + float(self._estimate[-1])
        x, y, _, *moment = (scale * change - felt).tolist()
        turning = cross(com, np.array([x, y, -scale * weight])).tolist()
        span = [x, y, *(n - t for n, t in zip(moment, turning, strict=True)), scale - 1.0]
        if math.isfinite(sum(span)):
            self._spans = np.concatenate((self._spans[1 - SPANS :], [span]))
            self._follow()

    def _follow(self) -> None:
        """Let the load follow what lasts."""
        lasting, latest = _median(self._spans), _median(self._spans[-LATEST:])
        bounded = np.where(
            lasting * latest > 0.0, np.copysign(np.minimum(np.abs(lasting), np.abs(latest)), lasting), 0.0
        )
        # A weight does not cease, and is wanted from the first span on.
        lasting[:-1] = bounded[:-1] if len(self._spans) == SPANS else 0.0
        lasting[-1] = min(max(lasting[-1], -MOST), MOST)
        lasting *= np.clip((np.abs(lasting) - self._none) / self._ramp, 0.0, 1.0)
        self._estimate = self._estimate + np.clip(lasting - self._estimate, -self._most, self._most)
        x, y, *moment, share = self._estimate.tolist()
        none = not self._estimate.any()
        self.load = NO_LOAD if none else ExternalLoad(np.array([x, y, 0.0]), np.array(moment), 1.0 + share)


def _median(spans: Array) -> Array:
    """The median of each column; `numpy.median` takes ten times as long."""
    return np.asarray(np.sort(spans, axis=0)[len(spans) // 2])
