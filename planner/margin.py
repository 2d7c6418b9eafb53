"""How far the DCM is inside what can still be captured: with every step as planned, and with steps moved.

It is the N-step capturability of Koolen et al. (International Journal of Robotics Research 2012) for a body in the
middle of a step, with feet of a size, what legs span and how hard they swing; each axis alone, so that all sets are
boxes. On one foot the DCM goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}. With k = e^{-ωT} of the shortest cycle
T, feet of half size a and steps that land near to far beside each other, who has just landed comes to rest over the
m-th foot from now exactly from

    side k (1 - (-k)^m) / (1 + k) (near + far) / 2 ± (a + k (1 - k^m) / (1 - k) (far - near) / 2),

seen from the foot that has landed, with side = 1 where the next one is a left one and -1 where it is a right one;
forward near = -far. Before that the present step lands, at the best of some times, with the best CoP until then.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from surefoot.planner.model.dcm import viability_weights
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery import SHORTEST, Recovery, Situation
from surefoot.planner.references.window import Window
from surefoot.planner.types import Array
from surefoot.planner.walk.hurry import PEAK

_SINGLES = (0.0, 0.1, 0.2, 0.3, 0.45, 0.65, 1.0)
"""Times of single support that are looked at beside the present one, between the shortest and the longest [-]; close
where they are short, since there a swing's reach grows fast."""

_LONGER = 0.2
"""By how much it may last longer than now [s]."""

MOST_STEPS = 5
"""Steps after which another one adds nothing."""


def _edges(low: Array, high: Array) -> Array:
    """Forward, left, backward and right edges of boxes, as distances in these directions, shape (..., 4) [m]."""
    return np.concatenate((high, -low), axis=-1)


def planned_margin(dcm: Array, window: Window, sample_time: float, foot_margin: float) -> float:
    """How far the DCM is inside what the CoP captures with the steps as planned: Σ w (p ± a) of all that is in sight.

    Args:
        dcm: now in the plan frame, shape (2,) [m].
        window: references.
        sample_time: theirs [s].
        foot_margin: share of the feet that the boxes of the reference take [-].
    """
    weights, reference = viability_weights(window.stiffness, window.omega, sample_time), window.driving
    half = weights @ reference.half_size / foot_margin
    return float((half - np.abs(dcm - weights @ reference.point)).min())


@dataclass(slots=True)
class Amends:
    """What has been made of the next landing.

    Attributes:
        landed: number of the step before it.
        shift: from where it nominally is, world frame, shape (2,) [m].
        delay: how much later than nominally [s].
    """

    landed: int = 0
    shift: Array = field(default_factory=lambda: np.zeros(2))
    delay: float = 0.0

    def since(self, landed: int) -> "Amends":
        """These as long as no other step has landed."""
        return self if landed == self.landed else Amends(landed)


FALL, FALL_TICKS = 0.02, 5
"""How far outside what is captured the DCM is, for how many ticks on end, of who will fall [m, -]."""


class Alarm:
    """Knows a fall before it comes.

    Attributes:
        given: whether one is coming; it stays.
    """

    def __init__(self, length: float = 1.0) -> None:
        """``length``: size of the robot (see `surefoot.similarity`) [-]."""
        self.given, self._ticks, self._length = False, 0, length

    def update(self, margin: float) -> None:
        """Take the margin of a tick, with all that may be done [m]."""
        self._ticks = self._ticks + 1 if margin < -FALL * self._length else 0
        self.given |= self._ticks >= FALL_TICKS


class Reserve:
    """What steps that are moved capture.

    Args:
        recovery: what may be done about a step.
        parameters: of the planner.
        half_size: half of the sole's length and width, shape (2,) [m].

    Attributes:
        cycle: shortest time from a landing to the next one, in which a foot is swung as far as legs reach [s].
    """

    def __init__(self, recovery: Recovery, parameters: PlannerParameters, half_size: Array) -> None:
        legs = recovery.legs
        near, far = np.array([-2.0 * legs.radius, legs.near]), legs.boxes(1.0)[0][1]
        swung = np.sqrt(PEAK * (far - near) / legs.acceleration * (0.5, 1.0)).max()
        self._time = time = parameters.size.time
        shortest = SHORTEST["single"] * time
        self.cycle = SHORTEST["double"] * time + max(shortest, parameters.touchdown_lead + float(swung))
        self._recovery, self._radius = recovery, legs.radius
        # Columns of four edges each.
        self._half = _edges(-half_size, half_size)[:, None]
        self._hip = _edges(*2 * (np.array([0.0, 0.5 * legs.hip_width]),))[:, None]
        self._apart = 0.5 * _edges(near - far, far - near)[:, None]
        self._middle = 0.5 * _edges(near + far, near + far)[:, None]

    def landed(self, growth: float, side: float, count: int) -> Array:
        """Edges of what one that has just landed captures, from its last foot, with 0, ... count - 1 steps more.

        Args:
            growth: e^{ωT} of a cycle [-].
            side: +1 where the next foot is a left one, -1 where it is a right one.
            count: of sets.

        Returns:
            Shape (4, count) [m].
        """
        k, steps = 1.0 / growth, np.arange(float(count))
        wide, off = k / (1.0 - k) * (1.0 - k**steps), side * k / (1.0 + k) * (1.0 - (-k) ** steps)
        return np.asarray(self._half + wide * self._apart + off * self._middle)

    def margins(self, now: Situation, steps: int, fixed: bool = False) -> Array:
        """How far the DCM is inside what is captured within 1, ... steps landings, shape (steps,) [m].

        The body rests over the last foot, after a single landing perhaps over its stance foot as well.

        Args:
            now: the situation.
            steps: how many there are, at least 1.
            fixed: the present step is not moved any more.
        """
        omega, half, timing = float(now.omega[0]), self._half, self._recovery.timing
        (x, y), (com_x, com_y) = now.dcm.tolist(), now.com.tolist()
        here, com = np.array(((x, y, -x, -y), (com_x, com_y, -com_x, -com_y)))[..., None]
        doubles, singles = self._times(now, fixed)
        single = np.exp(omega * singles)
        # DCM and CoM at the landing are linear in the DCM here: dcm + growth here, com + by here.
        growth, dcm = single, (1.0 - single) * half
        com = com + 0.5 * (single - 1.0) * dcm
        if now.double:
            double, both = np.exp(omega * doubles), _edges(np.minimum(now.swing[0], 0.0), np.maximum(now.swing[0], 0.0))
            first, growth = half + both[:, None], double * single
            com = com + 0.5 * (double - 1.0) * ((single - 1.0) * dcm - (growth * single - 1.0) * first)
            dcm = dcm + single * (1.0 - double) * first
        com, shrunk = com / growth, 1.0 / growth
        cycle = min(self.cycle, now.cycle) if timing else now.cycle
        captured = self.landed(math.exp(omega * cycle), -now.side, steps)[:, None]
        places, alone = self._places(now, singles, fixed), ((half - dcm) * shrunk - here)[:, :, None]
        ahead = (((places - dcm[:, :, None]) * shrunk[:, None]) - here[:, :, None])[..., None]
        ahead = ahead + (captured * shrunk[:, None])[:, :, None]
        if not fixed:
            spread = 2.0 / (growth + shrunk)
            under = com + now.side * self._hip
            spanned = ((self._radius + under - dcm) * spread - here)[..., None] + captured * spread[:, None]
            by = 2.0 / np.maximum(growth - shrunk, 1e-9)
            near = (places + (self._radius - under)[:, :, None]) * by[:, None] - here[:, :, None]
            ahead = np.minimum(np.minimum(ahead, spanned[:, :, None]), near[..., None])
        ahead[..., 0] = np.maximum(ahead[..., 0], alone)
        return np.asarray(np.maximum.accumulate(ahead.min(axis=0).reshape(-1, steps).max(axis=0)))

    def _times(self, now: Situation, fixed: bool) -> tuple[Array, Array]:
        """Pairs of times of double and single support, the present one last, shape (n,) each [s]."""
        if fixed or not self._recovery.timing:
            return np.array([now.double]), np.array([now.single])
        shortest, longer = SHORTEST["single"] * self._time, _LONGER * self._time
        least, most = min(now.single, max(shortest, now.shortest)), now.single + longer
        singles = [least + share * (most - least) for share in _SINGLES] + [now.single]
        if not now.double:
            return np.zeros(len(singles)), np.array(singles)
        doubles = (min(now.double, SHORTEST["double"] * self._time), now.double)
        return np.repeat(doubles, len(singles)), np.array(2 * singles)

    def _places(self, now: Situation, singles: Array, fixed: bool) -> Array:
        """Edges of where the step may land in times, shape (4, n, boxes) [m]."""
        if fixed:
            return _edges(now.nominal, now.nominal)[:, None, None]
        room = _edges(*(now.nominal + now.room))[:, None, None]
        boxes = np.stack([_edges(*box) for box in self._recovery.boxes(now)], axis=1)[:, None]
        return np.minimum(np.minimum(boxes, room), self._recovery.haste.edges(now.foot, singles)[..., None])
