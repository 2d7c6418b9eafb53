"""Margin of the DCM in what can still be captured: with every step as planned, and with steps moved.

It is the N-step capturability of Koolen et al. (International Journal of Robotics Research 2012) for a body in the
middle of a step. Feet have a size, legs a span and a swing acceleration. Each axis is taken alone, so that all sets are
boxes. On one foot the DCM ξ goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}. The shortest cycle lasts T;
k = e^{-ωT}. Feet have the half size a, and each step lands between near and far beside the foot before. A body that has
just landed comes to rest over the m-th foot from now if its DCM lies in

    side k (1 - (-k)^m) / (1 + k) (near + far) / 2 ± (a + k (1 - k^m) / (1 - k) (far - near) / 2),

seen from the foot that has landed, with side = 1 where the next one is a left one and -1 where it is a right one;
forward near = -far. Before that the present step lands, at the best of some times, with the best CoP until then.
"""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.recovery.step_problem import StepProblem
from surefoot.planner.swing.leg_reach import ANYWHERE, LegReach
from surefoot.planner.swing.quintics import PEAK
from surefoot.planner.types import Array

EDGES = 4
"""Number of edges of a box: forward, left, backward and right, each as a distance from the stance foot [m]."""


def _edges(low: Array, high: Array) -> Array:
    """The edges of a box, shape (4,) [m]."""
    return np.concatenate((high, -low))


class CaptureMargin:
    """The margin of the DCM in what steps that are adjusted capture.

    Args:
        legs: what they can do.
        parameters: of the planner.
        half_size: half of the sole's length and width, shape (2,) [m].

    Attributes:
        cycle: shortest time from a landing to the next one, in which a foot is swung as far as legs reach [s].
    """

    def __init__(self, legs: LegReach, parameters: PlannerParameters, half_size: Array) -> None:
        numbers = parameters.recovery
        near, far = np.array([-legs.stride, legs.near]), legs.allowed(1.0, ANYWHERE, False)[0, 1]
        swung = np.sqrt(PEAK * (far - near) / legs.acceleration * (0.5, 1.0)).max()
        self.cycle = numbers.least_double + max(numbers.least_single, parameters.touchdown_lead + float(swung))
        self._timing, self._shares = parameters.step_adaptation.timing, np.array(numbers.margin_times)
        self._least_double, self._least_single = numbers.least_double, numbers.least_single
        self._longer = numbers.longer
        self._half = _edges(-half_size, half_size)
        self._apart, self._middle = 0.5 * _edges(near - far, far - near), 0.5 * _edges(near + far, near + far)
        self._reach = StepReach(legs)
        self._captured, self._margins = np.zeros((numbers.most_steps, EDGES)), np.zeros(numbers.most_steps)
        self._ahead, self._spanned, self._near, self._over = (np.zeros(EDGES) for _ in range(4))

    def landed(self, growth: float, side: float, count: int) -> Array:
        """Edges of what one that has just landed captures, from its last foot, with 0, ... count - 1 steps more.

        Args:
            growth: e^{ωT} of a cycle [-].
            side: +1 where the next foot is a left one, -1 where it is a right one.
            count: of sets.

        Returns:
            Shape (4, count) [m].
        """
        self._make_room(count)
        self._land(growth, side, count)
        return np.array(self._captured)[:count].T

    def _make_room(self, steps: int) -> None:
        if steps > len(self._margins):
            self._captured, self._margins = np.zeros((steps, EDGES)), np.zeros(steps)

    def _land(self, growth: float, side: float, count: int) -> None:
        k = 1.0 / growth
        for m in range(count):
            power = math.pow(k, m)
            turned = -power if m % 2 else power
            wide = k / (1.0 - k) * (1.0 - power)
            off = side * k / (1.0 + k) * (1.0 - turned)
            for e in range(EDGES):
                self._captured[m, e] = self._half[e] + wide * self._apart[e] + off * self._middle[e]

    def margins(
        self, com: Array, dcm: Array, omega: float, step: StepProblem, steps: int, fixed: bool = False
    ) -> Array:
        """Margins of the DCM in what is captured within 1, ..., steps landings, shape (steps,) [m].

        The body rests over the last foot, after a single landing perhaps over its stance foot as well.

        Args:
            com: now, in the plan frame, shape (2,) [m].
            dcm: now in the plan frame, shape (2,) [m].
            omega: of the DCM now [1/s].
            step: as scheduled.
            steps: how many there are, at least 1.
            fixed: the present step is not moved any more.
        """
        self._make_room(steps)
        self._reach.see(step)
        self._com, self._dcm, self._omega = com, dcm, omega
        self._find(steps, fixed)
        return np.array(self._margins[:steps])

    def _find(self, steps: int, fixed: bool) -> None:
        """Set `_margins`: at the best of some times of double and single support."""
        step = self._reach
        cycle = min(self.cycle, step.cycle) if self._timing else step.cycle
        self._land(math.exp(self._omega * cycle), -step.side, steps)
        for m in range(steps):
            self._margins[m] = -algebra.INFINITY
        chosen = self._timing and not fixed
        least = min(step.single, max(self._least_single, step.shortest))
        most = step.single + self._longer
        for shorter in range(1 if chosen and step.double != 0.0 else 0, -1, -1):
            double = min(step.double, self._least_double) if shorter else step.double
            if chosen:
                for k in range(len(self._shares)):
                    self._catch(double, least + self._shares[k] * (most - least), steps, fixed)
            self._catch(double, step.single, steps, fixed)
        for m in range(1, steps):
            self._margins[m] = max(self._margins[m], self._margins[m - 1])

    def _catch(self, double: float, single: float, steps: int, fixed: bool) -> None:
        """Let `_margins` grow to what a landing at one time captures, in the best of its boxes."""
        grown, doubled = math.exp(self._omega * single), math.exp(self._omega * double)
        growth = doubled * grown if self._reach.double != 0.0 else grown
        shrunk = 1.0 / growth
        spread = 2.0 / (growth + shrunk)
        for box in range(1 if fixed else self._reach.boxes):
            self._limit(box, single, grown, doubled, fixed)
            for m in range(steps):
                least = algebra.INFINITY
                for e in range(EDGES):
                    captured = self._captured[m, e]
                    margin = self._ahead[e] + captured * shrunk
                    if not fixed:
                        margin = min(min(margin, self._spanned[e] + captured * spread), self._near[e])
                    if m == 0:
                        margin = max(margin, self._over[e])
                    least = min(least, margin)
                self._margins[m] = max(self._margins[m], least)

    def _limit(self, box: int, single: float, grown: float, doubled: float, fixed: bool) -> None:
        """Set how far each edge of what the landing foot captures lets the DCM be, before what that foot captures.

        DCM and CoM at the landing are linear in the DCM here: away + growth here, com + by here. The DCM is held by
        a landing at the place (`_ahead`), by legs that span the feet then (`_spanned`, `_near`), and by the stance foot
        without it (`_over`). Here `grown` and `doubled` are e^{ωT} of single and double support.
        """
        step = self._reach
        growth = doubled * grown if step.double != 0.0 else grown
        shrunk = 1.0 / growth
        spread, by = 2.0 / (growth + shrunk), 2.0 / max(growth - shrunk, 1e-9)
        for e in range(EDGES):
            axis = e % 2
            sign = 1.0 if e < 2 else -1.0
            half, here = self._half[e], sign * self._dcm[axis]
            away = (1.0 - grown) * half
            there = sign * self._com[axis] + 0.5 * (grown - 1.0) * away
            if step.double != 0.0:
                first = half + max(sign * step.at[axis], 0.0)
                there += 0.5 * (doubled - 1.0) * ((grown - 1.0) * away - (growth * grown - 1.0) * first)
                away += grown * (1.0 - doubled) * first
            under = there / growth + step.side * (sign * 0.5 * step.hip_width if axis else 0.0)
            if fixed:
                place = sign * step.place[axis]
            else:
                edge = step.high[box, axis] if e < 2 else -step.low[box, axis]
                place = min(edge, step.swung(axis, sign, single))
            self._ahead[e] = (place - away) * shrunk - here
            self._spanned[e] = (step.radius + under - away) * spread - here
            self._near[e] = (place + (step.radius - under)) * by - here
            self._over[e] = (half - away) * shrunk - here
