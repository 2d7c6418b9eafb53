"""What acts on the robot beside gravity and the ground, and how heavy it is, from what its soles feel.

Momentum changes by forces alone: over a span T the contact forces F and moments M about the origin, a force f and a
moment about the CoM n from elsewhere, and the weight give, with the momentum p and the moment of momentum L about the
origin (of which masses all are the model's times one factor s)

    s m (g + Δv_z / T) = mean F_z,    f = s Δp / T - mean F,    n + c x f = s ΔL / T - mean M - s m c x g.

No acceleration is measured for that, and how the robot moves and stands does not matter. It is the momentum observer
of De Luca and Mattone (ICRA 2003), with means over spans and their medians in place of its low-pass. What lasts is told
from a push, which has done what it does when it is over and may be hard: of what is new only little counts.

Forces that sensors tell are late, and a low pass makes them later. They are held against momentum and CoM of the time
when they acted. Held against the momentum of now, forces of 4 ms ago told a moment of 8 N·m that nobody exerted, on a
robot of 33 kg at 0.8 m/s: what the feet push is far below the CoM.

Forces, moments and their rates below are the reference robot's (see `surefoot.similarity`). The span is that of
robots of any size: a push lasts as long for a small one.
"""

import math
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.compiled import CompiledTerms
from surefoot.wbc.model import RobotTerms, cross
from surefoot.wbc.types import GRAVITY, Array

SPAN = 0.02
"""Time over which forces are held against the change of momentum [s]."""

SPANS = 13
"""Spans whose median is what lasts: a push for less than half of them, 0.12 s, is not in it."""

LATEST = 3
"""Spans whose median is what acts now: what lasts counts no longer than that."""

KEPT = (4.0, 8.0)
"""Force [N] and moment about the CoM [N·m] of what lasts that are none, and from which on all of it counts; undisturbed
walks leave 1.2 N and 1.2 N·m."""

SUDDEN = (10.0, 20.0)
"""Likewise of what acts now; walking at 1 m/s leaves 8 N and 6 N·m."""

LASTING, ACTING = (1.0, 2.0), (4.0, 7.0)
"""Deviations of one span by which the limits of what lasts and of what acts now are wider, by the root of the sum
of squares, where the state is estimated; a median of 13 spans has a third of it, one of three two thirds [-]."""

BOUND = (40.0, 12.0)
"""No more force and moment counts of what acts now and has not lasted: it may be a push, soon over [N, N·m]."""

PUSH = (50.0, 60.0)
"""Force of the hardest of the latest spans which is still taken for one that will last, and which is a push, of which
nothing counts [N]: to lean into a push that is soon over felled small feet."""

WEIGHT = (0.01, 0.02)
"""Likewise of what the robot weighs more or less than its model, as a share of that; these leave 0.001 [-]."""

RATES = (1000.0, 1000.0, 2.0)
"""How fast force, moment and share of the weight may change [N/s, N·m/s, 1/s]."""

MOST = 0.8
"""Largest share of the weight by which the model's is set right [-]."""

LEAST_PRESS = 0.3
"""In less than this share of the weight on its soles, nearly in flight, no robot tells how heavy it is [-]."""

PAST = 64
"""Momenta that are remembered, for longer than wrenches of any sensors are late [ticks]."""

_ROWS = (2, 3, 1)
"""Numbers of an estimate: force x, y; moment x, y, z; share of the weight."""


class LoadObserver:
    """Estimates what lasts of an external force, and the true mass.

    Args:
        mass: the model's [kg].
        period: time between two updates [s].
        size: of the robot.
        compiled: terms on which the kernel works; None for plain Python.

    Attributes:
        load: as estimated; `NO_LOAD` while there is none.
    """

    def __init__(
        self,
        mass: float,
        period: float,
        size: Similarity = REFERENCE_SIZE,
        compiled: CompiledTerms | None = None,
    ) -> None:
        self._mass, self._ticks = mass, max(1, round(SPAN / period))
        self._span = self._ticks * period
        self._felt, self._com = np.zeros(6), np.zeros(3)
        self._momentum: Array | None = None
        # Of each tick the CoM's velocity, the angular momentum about it, and the CoM.
        self._past: deque[Array] = deque(maxlen=PAST)
        self._age, self._period = 0.0, period
        self._count = 0 if compiled is None else -1
        self._spans = np.empty((0, sum(_ROWS)))
        self._most = np.repeat(size.times(RATES, "N/s, N·m/s, 1/s"), _ROWS) * self._span
        pull = np.repeat([size.factor("N"), size.factor("N·m")], _ROWS[:2])
        self._bound, self._push = np.repeat(BOUND, _ROWS[:2]) * pull, size.times(PUSH, "N")
        self._kept, self._sudden = (tuple(limit * pull for limit in limits) for limits in (KEPT, SUDDEN))
        self._estimate = np.zeros(sum(_ROWS))
        self._deviation = self._wide_for = (0.0, 0.0)
        self._late = False
        self._ramps = self._ramps_now()
        self.load = NO_LOAD
        self._wrench = np.zeros((2, 6))
        self._add: Callable[[], None] | None = None
        if compiled is not None:
            self._compile(compiled)

    def _compile(self, compiled: CompiledTerms) -> None:
        """Bind the kernels that do what `_moving` and `_end_span` do."""
        bind, self._knows = compiled.kernels.bind, np.ones(1, dtype=np.int64)
        self._limits = np.array(WEIGHT), np.array(self._kept), np.array(self._sudden)
        share_limits, kept, sudden = self._limits
        sums = compiled.kernels.fill(
            "LoadSums",
            terms=compiled.bound,
            wrench=self._wrench,
            felt=self._felt,
            com=self._com,
            past=np.zeros((PAST, 6)),
            past_count=PAST,
            newest=np.zeros(1, dtype=np.int64),
        )
        span = compiled.kernels.fill(
            "LoadSpan",
            sums=sums,
            weight=self._mass * GRAVITY,
            span=self._span,
            ticks=self._ticks,
            spans_count=SPANS,
            latest_count=LATEST,
            most_share=MOST,
            least_press=LEAST_PRESS,
            share_limits=share_limits,
            kept=kept,
            sudden=sudden,
            bound=self._bound,
            push=np.array(self._push, dtype=np.float64),
            most_change=self._most,
            known=self._knows,
            waits=np.zeros(1, dtype=np.int64),
            momentum=np.zeros(6),
            spans=np.zeros((SPANS, sum(_ROWS))),
            filled=np.zeros(1, dtype=np.int64),
            estimate=self._estimate,
        )
        self._begin, self._end = (bind(name, span) for name in ("load_moving", "load_span_end"))
        self._add = bind("load_sums_add", sums)

    def update(
        self, terms: RobotTerms, wrench: Array, deviation: tuple[float, float] = (0.0, 0.0), age: float = 0.0
    ) -> ExternalLoad:
        """The load as it is now known; call it once per control tick.

        Args:
            terms: of the state now.
            wrench: of the soles, in their frames, shape (2, 6) [N, N·m].
            deviation: of a force and a moment of one span by what state and wrenches are unsure of; limits are wider by
                multiples of it, and nothing is found where it is infinite [N, N·m].
            age: time since these wrenches acted [s].
        """
        self._age += age
        if self._add is not None:
            self._count += 1
            self._wrench[...] = wrench
            if 0 < self._count < self._ticks:
                self._add()
                return self.load
        self._deviation = deviation
        if self._add is not None:
            return self._turn_compiled()
        self._past.append(np.concatenate((terms.com_velocity, terms.angular_momentum, terms.com)))
        if self._momentum is None:
            self._momentum, self._age = self._moving(-1), 0.0
            return self.load
        self._felt += terms.sole_wrench_map.dot(wrench.ravel())
        self._com += terms.com
        self._count += 1
        if self._count == self._ticks:
            late = self._late_by()
            self._end_span(self._momentum, self._then(late), late * self._period)
        return self.load

    def _late_by(self) -> float:
        """Mean age of a span's wrenches [ticks]; the next span's begins at nothing."""
        late = self._age / (self._ticks * self._period)
        self._age = 0.0
        return max(0.0, min(late, PAST - 2.0))

    def _then(self, late: float) -> Array:
        """What `_moving` was so many ticks ago, or at the first one, shape (6,) [N·s, N·m·s]."""
        whole = min(int(late), len(self._past) - 1)
        younger, more = self._moving(-1 - whole), late - int(late)
        if not more:
            return younger
        return younger + more * (self._moving(max(-2 - whole, -len(self._past))) - younger)

    def _turn_compiled(self) -> ExternalLoad:
        """Begin the first span, or end one, by kernels, for the terms that they are bound to."""
        age, self._age = self._age, 0.0
        if self._count == 0:
            self._begin()
            return self.load
        self._count = 0
        if self._deviation != self._wide_for:
            self._wide_for = self._deviation
            self._knows[0] = self._known
            if self._known:
                for limits, now in zip(self._limits, self._limits_now(), strict=True):
                    limits[:] = now
        if self._end(age):
            self._tell()
        return self.load

    @property
    def _known(self) -> bool:
        """Whether anything is known: what comes before that says least, and must not count when the rest is known."""
        return math.isfinite(sum(self._deviation))

    def _limits_now(self) -> tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]:
        """Limits of the share of the weight, of what lasts, and of what acts, as wide as what is not known asks."""
        unsure, turning = self._deviation
        wider = np.repeat([unsure, turning], _ROWS[:2])
        share = _wider(WEIGHT, unsure / (self._mass * GRAVITY), LASTING)
        return share, _wider(self._kept, wider, LASTING), _wider(self._sudden, wider, ACTING)

    def _ramps_now(self) -> list[Any]:
        """The same as plain numbers: none and all of the share, and of each number of what lasts and of what acts."""
        return [np.transpose(limits).tolist() for limits in self._limits_now()]

    def _moving(self, at: int) -> Array:
        """Momentum and moment of momentum about the origin, by the model's masses, shape (6,) [N·s, N·m·s].

        Args:
            at: place in the past [ticks].
        """
        velocity, spin, com = self._past[at].reshape(3, 3)
        momentum = self._mass * velocity
        return np.concatenate((momentum, spin + cross(com, momentum)))

    def _end_span(self, before: Array, moving: Array, age: float) -> None:
        """Hold the forces of a span, of that age, against its change of momentum."""
        # Plain floats: at this size they are faster than arrays.
        felt, com = (self._felt / self._ticks).tolist(), self._com / self._ticks
        com -= 0.5 * age / self._mass * (before[:3] + moving[:3])
        change = ((moving - before) / self._span).tolist()
        self._momentum, self._count = moving, 0
        self._felt[:], self._com[:] = 0.0, 0.0
        weight = self._mass * GRAVITY
        pressing = change[2] + weight
        known = min(pressing, felt[2]) > LEAST_PRESS * weight
        scale = felt[2] / pressing if known else 1.0 + float(self._estimate[-1])
        x, y, _, *moment = (scale * rate - force for rate, force in zip(change, felt, strict=True))
        turning = cross(com, np.array([x, y, -scale * weight])).tolist()
        span = [x, y, *(n - t for n, t in zip(moment, turning, strict=True)), scale - 1.0]
        if math.isfinite(sum(span)):
            self._spans = np.concatenate((self._spans[1 - SPANS :], [span]))
            if not self._known:
                self._spans, self._late = self._spans[:0], True
            elif not self._late or len(self._spans) == SPANS:
                self._follow()

    def _follow(self) -> None:
        """Let the load follow what lasts."""
        if self._deviation != self._wide_for:
            self._wide_for, self._ramps = self._deviation, self._ramps_now()
        weight_limits, kept_limits, sudden_limits = self._ramps
        lasting, latest = _median(self._spans).tolist(), _median(self._spans[-LATEST:]).tolist()
        wanted = [0.0] * len(kept_limits)
        if len(self._spans) == SPANS:
            none, push = self._push
            # The span in which a push ends has only part of it.
            hardest = max(math.hypot(x, y) for x, y in self._spans[-LATEST:, :2].tolist())
            soft = min(max((push - hardest) / (push - none), 0.0), 1.0)
            for k, bound in enumerate(self._bound.tolist()):
                one, other = lasting[k], latest[k]
                both = min(abs(one), abs(other)) if one * other > 0.0 else 0.0
                kept = _ramp(math.copysign(both, other), *kept_limits[k])
                sudden = min(max(_ramp(other, *sudden_limits[k]), -bound), bound) * soft
                wanted[k] = sudden if abs(sudden) > abs(kept) else kept
        wanted.append(_ramp(min(max(lasting[-1], -MOST), MOST), *weight_limits))
        steps = zip(self._estimate.tolist(), wanted, self._most.tolist(), strict=True)
        self._estimate = np.array([now + min(max(then - now, -most), most) for now, then, most in steps])
        self._tell()

    def _tell(self) -> None:
        """The estimate as a load."""
        self.load, estimate = NO_LOAD, self._estimate.tolist()
        if any(estimate):
            x, y, *moment, more = estimate
            self.load = ExternalLoad(np.array([x, y, 0.0]), np.array(moment), 1.0 + more)


def _wider(limits: tuple[Any, ...], deviation: Any, times: tuple[float, float]) -> tuple[Any, ...]:
    """Limits that are wider by so many deviations: what disturbs and what is not known are independent."""
    return np.hypot(limits[0], times[0] * deviation), np.hypot(limits[1], times[1] * deviation)


def _ramp(value: float, none: float, full: float) -> float:
    """A value of which nothing counts up to the first limit, all from the second one on."""
    return value * min(max((abs(value) - none) / (full - none), 0.0), 1.0)


def _median(spans: Array) -> Array:
    """The median of each column; `numpy.median` takes ten times as long."""
    return np.asarray(np.sort(spans, axis=0)[len(spans) // 2])
