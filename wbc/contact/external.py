"""External forces beside gravity and the ground, and the robot's weight, from what its soles feel.

Momentum changes by forces alone: over a span T the contact forces F and moments M about the origin, a force f and a
moment about the CoM n from elsewhere, and the weight give, with the momentum p and the moment of momentum L about the
origin (of which masses all are the model's times one factor s)

    s m (g + Δv_z / T) = mean F_z,    f = s Δp / T - mean F,    n + c x f = s ΔL / T - mean M - s m c x g.

No acceleration is measured for that, and how the robot moves and stands does not matter. It is the momentum observer
of De Luca and Mattone (ICRA 2003), with means over spans and their medians in place of its low-pass. A lasting force
is distinguished from a push, which is over once it has acted and may be hard: of what is new only little counts.

Forces that sensors tell are late, and a low pass makes them later. They are held against momentum and CoM of the time
when they acted. Held against the momentum of now, forces of 4 ms ago showed a moment of 8 N·m that nobody exerted, on a
robot of 33 kg at 0.8 m/s: what the feet push is far below the CoM.

Forces, moments and their rates below are the reference robot's (see `surefoot.similarity`). The span is that of
robots of any size: a push lasts as long for a small one.
"""

import math

import numpy as np

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.maths import algebra
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.body.model import RobotTerms
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
"""Force [N] and moment [N·m] of what acts now that are none, and from which on all of it counts.

Walking at 1 m/s leaves 8 N and 6 N·m.
"""

LASTING, ACTING = (1.0, 2.0), (4.0, 7.0)
"""Deviations of one span that widen the limits of what lasts and of what acts now, where the state is estimated [-].
They are added by the root of the sum of squares. A median of 13 spans has a third of one span's deviation, a median of
three has two thirds."""

BOUND = (40.0, 12.0)
"""No more force and moment counts of what acts now and has not lasted: it may be a push, soon over [N, N·m]."""

PUSH = (50.0, 60.0)
"""Force of the hardest of the latest spans up to which it counts as lasting, and from which on it is a push and does
not count [N]. A robot with small feet fell when it leaned into a push that was soon over."""

WEIGHT = (0.01, 0.02)
"""Share by which the robot weighs more or less than its model that is none, and from which on all of it counts [-].

Undisturbed walks leave 0.001.
"""

RATES = (1000.0, 1000.0, 2.0)
"""Fastest change of force, moment and share of the weight [N/s, N·m/s, 1/s]."""

MOST = 0.8
"""Largest share of the weight by which the model's is set right [-]."""

LEAST_PRESS = 0.3
"""In less than this share of the weight on its soles, nearly in flight, no robot tells how heavy it is [-]."""

PAST = 64
"""Momenta that are remembered, for longer than wrenches of any sensors are late [ticks]."""

_ROWS = (2, 3, 1)
"""Numbers of an estimate: force x, y; moment x, y, z; share of the weight."""

_PULLS = 5
"""All of these but the last one."""


class LoadObserver:
    """Estimates what lasts of an external force, and the true mass.

    Args:
        mass: the model's [kg].
        period: time between two updates [s].
        size: of the robot.

    Attributes:
        load: as estimated; `NO_LOAD` while there is none.
        found: force, moment and share of the weight in the last span, shape (6,) [N, N·m, -].
    """

    def __init__(self, mass: float, period: float, size: Similarity = REFERENCE_SIZE) -> None:
        self._mass, self._weight, self._ticks = mass, mass * GRAVITY, max(1, round(SPAN / period))
        self._span = self._ticks * period
        self._age, self._count, self._begun = 0.0, 0, False
        # Sums over a span, and the momentum at its beginning.
        self._felt, self._com, self._momentum = np.zeros(6), np.zeros(3), np.zeros(6)
        # Momenta of past ticks, the last one in a row of its own, in turn.
        self._past, self._newest = np.zeros((PAST, 6)), 0
        self._spans, self._filled, self._waits = np.zeros((SPANS, sum(_ROWS))), 0, False
        self._most_change = np.repeat(size.times(RATES, "N/s, N·m/s, 1/s"), _ROWS) * self._span
        pull = np.repeat([size.factor("N"), size.factor("N·m")], _ROWS[:2])
        self._bound, self._push = np.repeat(BOUND, _ROWS[:2]) * pull, np.array(size.times(PUSH, "N"))
        self._kept, self._sudden = (np.multiply.outer(KEPT, pull), np.multiply.outer(SUDDEN, pull))
        self._share, self._lasting_wide, self._acting_wide = np.array(WEIGHT), np.array(LASTING), np.array(ACTING)
        self._estimate, self._wanted, self._sorted = np.zeros(sum(_ROWS)), np.zeros(sum(_ROWS)), np.zeros(SPANS)
        self._now, self._change, self._deviation = np.zeros(6), np.zeros(6), np.zeros(_PULLS)
        self.found, self.load, self._given = np.zeros(sum(_ROWS)), NO_LOAD, np.zeros((2, 6))
        # The same memory.
        self._found, self._wrench = self.found, self._given.reshape(12)

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
        self._note(terms)
        if not self._begun:
            self._begin()
            return self.load
        self._given[...] = wrench
        self._feel(terms)
        self._count += 1
        if self._count == self._ticks:
            self._count = 0
            self._end(deviation[0], deviation[1])
        return self.load

    def _note(self, terms: RobotTerms) -> None:
        """Remember momentum and moment of momentum about the origin, by the model's masses [N·s, N·m·s]."""
        self._newest = (self._newest + 1) % len(self._past)
        past = self._past[self._newest]
        for i in range(3):
            past[i] = self._mass * terms._c_dot[i]
        turning = algebra.cross(algebra.vector(terms._c), algebra.vector(past))
        algebra.put(past[3:], algebra.add(algebra.vector(terms._L), turning))

    def _begin(self) -> None:
        """Let the past be as it is now, where the first span begins."""
        self._begun, self._age = True, 0.0
        self._momentum[:] = self._past[self._newest]
        for k in range(len(self._past)):
            self._past[k] = self._momentum

    def _feel(self, terms: RobotTerms) -> None:
        """Add force and moment about the origin that the soles feel, and the CoM."""
        for i in range(6):
            felt = 0.0
            for j in range(12):
                felt += terms._W[i, j] * self._wrench[j]
            self._felt[i] += felt
        for i in range(3):
            self._com[i] += terms._c[i]

    def _end(self, deviation: float, turning: float) -> None:
        """End a span, whose load has that deviation of its force and moment [N, N·m]."""
        is_found, is_known = self._balance(self._late()), math.isfinite(deviation) and math.isfinite(turning)
        # What comes before it is known would say least, and must not count.
        if not is_known:
            self._waits, self._filled = True, 0
        if is_found and is_known and not (self._waits and self._filled < SPANS):
            for i in range(_PULLS):
                self._deviation[i] = deviation if i < 2 else turning
            self._follow(deviation / self._weight)
            self._tell()

    def _late(self) -> float:
        """Mean age of the span's wrenches [ticks]; the next span's begins at nothing."""
        late = self._age / self._span
        self._age = 0.0
        return max(0.0, min(late, len(self._past) - 2.0))

    def _balance(self, late: float) -> bool:
        """Hold the forces of a span, late by so many ticks, against its change of momentum; whether it found a load."""
        self._see(late)
        now = self._now
        before = self._momentum
        change = self._change
        found = self._found
        # By how much the CoM was farther back when the forces acted, in the time of a momentum.
        back = 0.5 * late * self._span / (self._ticks * self._mass)
        for i in range(3):
            self._com[i] = self._com[i] / self._ticks - back * (before[i] + now[i])
        for i in range(6):
            self._felt[i] /= self._ticks
            change[i] = (now[i] - before[i]) / self._span
            before[i] = now[i]
        felt, least = self._felt, LEAST_PRESS * self._weight
        pressing = change[2] + self._weight
        is_pressed = pressing > least and felt[2] > least
        scale = felt[2] / pressing if is_pressed else 1.0 + self._estimate[_PULLS]
        x, y = scale * change[0] - felt[0], scale * change[1] - felt[1]
        turning = algebra.cross(algebra.vector(self._com), (x, y, -scale * self._weight))
        found[0], found[1], found[5] = x, y, scale - 1.0
        found[2] = scale * change[3] - felt[3] - turning[0]
        found[3] = scale * change[4] - felt[4] - turning[1]
        found[4] = scale * change[5] - felt[5] - turning[2]
        self._felt[:] = 0.0
        self._com[:] = 0.0
        for i in range(len(found)):
            if not math.isfinite(found[i]):
                return False
        self._keep()
        return True

    def _see(self, late: float) -> None:
        """Momenta as they were when the forces acted, so many ticks ago."""
        whole, count = int(late), len(self._past)
        younger = self._past[(self._newest + count - whole) % count]
        older = self._past[(self._newest + count - whole - 1) % count]
        for i in range(6):
            self._now[i] = younger[i] + (late - whole) * (older[i] - younger[i])

    def _keep(self) -> None:
        """Keep what a span found, in the place of the oldest one."""
        if self._filled == SPANS:
            for k in range(1, SPANS):
                self._spans[k - 1] = self._spans[k]
        else:
            self._filled += 1
        self._spans[self._filled - 1] = self._found

    def _follow(self, uncertainty: float) -> None:
        """Let the load follow what lasts, where the share of the weight has that deviation."""
        calm, wanted = self._calm(), self._wanted
        wanted[:] = 0.0
        for i in range(_PULLS if self._filled == SPANS else 0):
            lasting, latest, deviation = self._median(i, SPANS), self._median(i, LATEST), self._deviation[i]
            least = min(abs(lasting), abs(latest)) if lasting * latest > 0.0 else 0.0
            kept = _ramp(math.copysign(least, latest), self._kept[:, i], deviation, self._lasting_wide)
            sudden = _ramp(latest, self._sudden[:, i], deviation, self._acting_wide)
            sudden = algebra.clamp(sudden, -self._bound[i], self._bound[i]) * calm
            wanted[i] = sudden if abs(sudden) > abs(kept) else kept
        share = algebra.clamp(self._median(_PULLS, SPANS), -MOST, MOST)
        wanted[_PULLS] = _ramp(share, self._share, uncertainty, self._lasting_wide)
        for i in range(len(wanted)):
            most = self._most_change[i]
            self._estimate[i] += algebra.clamp(wanted[i] - self._estimate[i], -most, most)

    def _calm(self) -> float:
        """Distance of the latest spans from a push: of the one in which a push ends only a part is in it."""
        none, full, hardest = self._push[0], self._push[1], 0.0
        for k in range(max(self._filled - LATEST, 0), self._filled):
            hardest = max(hardest, math.hypot(self._spans[k, 0], self._spans[k, 1]))
        return algebra.clamp((full - hardest) / (full - none), 0.0, 1.0)

    def _median(self, number: int, count: int) -> float:
        """Median of a number of the estimate over the last spans, by insertion."""
        count = min(count, self._filled)
        for k in range(count):
            value, place = self._spans[self._filled - count + k, number], k
            while place > 0 and self._sorted[place - 1] > value:
                self._sorted[place] = self._sorted[place - 1]
                place -= 1
            self._sorted[place] = value
        middle: float = self._sorted[count // 2]
        return middle

    def _tell(self) -> None:
        """The estimate as a load."""
        x, y, *moment, more = np.asarray(self._estimate).tolist()
        is_any = any((x, y, *moment, more))
        self.load = ExternalLoad(np.array([x, y, 0.0]), np.array(moment), 1.0 + more) if is_any else NO_LOAD


def _ramp(value: float, limits: Array, deviation: float, times: Array) -> float:
    """A value of which nothing counts up to the first limit, all from the second one on.

    Limits are wider by so many deviations: what disturbs and what is not known are independent.
    """
    none, full = math.hypot(limits[0], times[0] * deviation), math.hypot(limits[1], times[1] * deviation)
    return value * algebra.clamp((abs(value) - none) / (full - none), 0.0, 1.0)
