"""The reach of legs in one step of one duration: landing places, way of the swing, and lack of a way round.

The frame is the stance foot's: x ahead, y to the left. See `planner.swing.leg_reach` for the legs.
"""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.geometry import quintic
from surefoot.planner.recovery.step_problem import StepProblem
from surefoot.planner.swing import boxes, quintics
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import Array

PEAK, BRAKING, GAINING = quintics.PEAK, quintics.BRAKING, quintics.GAINING

BOXES = 3
"""Boxes in which a foot may land at most: beside its stance foot, and beyond it ahead and behind [-]."""

SHARES = 9
"""Shares of a swing's time at which its way is looked at, as close as a bent way needs [-]."""


class StepReach:
    """Legs and the step that lands next, in numbers.

    Args:
        legs: what they can do.
    """

    def __init__(self, legs: LegReach) -> None:
        self._legs, self._crosses = legs, legs.across is not None
        self.radius, self.hip_width, self.stride = legs.radius, legs.hip_width, legs.stride
        self._across = 0.0 if legs.across is None else legs.across
        self._lead, self._sample_time = legs.parameters.touchdown_lead, legs.parameters.sample_time
        self._acceleration = np.array(legs.acceleration, dtype=np.float64)
        self.low, self.high = np.zeros((BOXES, 2)), np.zeros((BOXES, 2))
        (self._rest, self._rest_bend), (self._moving, self._moving_bend), self._around = unit_ways()
        self._dearer = (SWING_SHARES * (1.0 - SWING_SHARES)) ** 5

    def see(self, step: StepProblem) -> None:
        """Look at a step, with legs turned as its foot will be."""
        legs = self._legs.turned(step.place.yaw)
        self.place, self.at, self.speed = step.nominal, step.swing[0], step.swing[1]
        self.side, self.near, self.clear = step.place.foot.side, legs.near, legs.clear
        self.double = step.double
        self.single = step.single
        self.cycle = step.cycle
        self.shortest = step.shortest
        self.last, self.adapted = step.last, step.adapted
        self.boxes = BOXES if step.crosses and self._crosses else 1
        extents = self.stride, self.hip_width, self.near, self.clear
        boxes.landing_boxes(self.low, self.high, extents, self._across, self.side, step.face, self.boxes)

    def is_empty(self, box: int) -> bool:
        """Return true if nothing is left of a box."""
        return bool(self.low[box, 0] > self.high[box, 0] or self.low[box, 1] > self.high[box, 1])

    def swing_time(self, single: float) -> float:
        """Time in which the foot swings of a single support, at whose end it has arrived [s]."""
        return max(single - self._lead, self._sample_time)

    def swung(self, axis: int, sign: float, single: float) -> float:
        """Distance along an axis, or against it, over which the foot can be swung in a single support [m].

        It may always be swung as hard as it nominally is.

        Args:
            axis: 0 forward, 1 sideways.
            sign: +1 along it, -1 against it.
            single: time left of it [s].
        """
        time, usual = self.swing_time(single), self.swing_time(self.single)
        at, speed = self.at[axis], self.speed[axis]
        nominal = PEAK * (self.place[axis] - at) / (usual * usual) - BRAKING * speed / usual
        hardest = max(self._acceleration[axis], abs(nominal))
        onward = sign * speed
        gained = (BRAKING if onward > 0.0 else GAINING) * onward
        return float(sign * at + (hardest * time * time + gained * time) / PEAK)

    def shortfall(self, single: float, x: float, y: float) -> float:
        """Way that the foot lacks of a place (x, y) since it has to pass around the stance leg [m].

        It is bent as that of the swing will be (see `planner.swing.leg_reach.around_stance_leg`), here at nine shares
        of its time, and lacks the share by which the hips cannot swing it so hard.
        """
        here = self.side * self.at[1] < 0.0
        crossing = self.at[0] if here else x if self.side * y < 0.0 else 0.0
        if crossing == 0.0:
            return 0.0
        time, beside = self.swing_time(single), self.side * self.near
        ahead = math.copysign(self.clear, crossing)
        way_x, way_y = x - self.at[0], y - self.at[1]
        onward_x, onward_y = self.speed[0] * time, self.speed[1] * time
        # The corner of the stance leg's box is passed at the share at which the way to it is bent least.
        met, best, dearest, astray_x, astray_y = False, 0, algebra.INFINITY, 0.0, 0.0
        for j in range(SHARES):
            passed_x = self.at[0] + way_x * self._rest[j] + onward_x * self._moving[j]
            passed_y = self.at[1] + way_y * self._rest[j] + onward_y * self._moving[j]
            met = met or (abs(passed_x) < self.clear and self.side * passed_y < self.near)
            off = algebra.square(ahead - passed_x) + algebra.square(beside - passed_y)
            if off / self._dearer[j] < dearest:
                dearest, best = off / self._dearer[j], j
                astray_x, astray_y = ahead - passed_x, beside - passed_y
        if not met:
            return 0.0
        hardest = 1.0
        for j in range(SHARES):
            round_x, round_y = astray_x * self._around[best, j], astray_y * self._around[best, j]
            bend_x = way_x * self._rest_bend[j] + onward_x * self._moving_bend[j] + round_x
            bend_y = way_y * self._rest_bend[j] + onward_y * self._moving_bend[j] + round_y
            hardest = max(hardest, abs(bend_x) / (time * time * self._acceleration[0]))
            hardest = max(hardest, abs(bend_y) / (time * time * self._acceleration[1]))
        return (1.0 - 1.0 / hardest) * math.hypot(way_x, way_y)


SWING_SHARES = np.linspace(0.1, 0.9, SHARES)
"""Shares of a swing's time at which its way around the stance leg is looked at [-]."""


def unit_ways() -> tuple[Array, Array, Array]:
    """Quintics to rest in a unit of time and their accelerations at `SWING_SHARES`, shape (2, 9) each.

    One goes a unit of way from rest, one has a unit of speed and goes none; of a way round by a unit at each of these
    shares the accelerations, shape (9, 9).
    """
    u, still = SWING_SHARES, (0.0, 0.0, 0.0)
    rest, moving = (
        np.array([[law(way, share) for share in u.tolist()] for law in (quintic.value, quintic.bend)])
        for way in (quintic.between(still, (1.0, 0.0, 0.0), 1.0), quintic.between((0.0, 1.0, 0.0), still, 1.0))
    )
    order = np.arange(6.0)
    factors = (order * (order - 1.0))[2:]
    around = []
    for share in u.tolist():
        since = np.where(u <= share, u, u - share)[:, None] ** order[:4] * factors
        before, after = quintics.detour(share, 1.0)
        around.append(np.where(u <= share, since @ before[2:], since @ after[2:]))
    return rest, moving, np.array(around)
