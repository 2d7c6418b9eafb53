"""The velocity to a place that a policy is commanded: the law of the benchmark, by the numbers of a contract."""

import math

from surefoot.planner.geometry.plane import wrap_angle
from surefoot.planner.types import Twist
from surefoot.scenarios.policy.contract import CommandRange, Contract, Places
from surefoot.studies.tour.walker import Goal

STILL = Twist()
"""The velocity of standing."""


class Steering:
    """Turns the way to a place into a velocity; near the place it stands, until it is pushed off.

    Args:
        contract: of the policy that is steered.
    """

    def __init__(self, contract: Contract) -> None:
        self._law: Places = contract.places
        own = CommandRange(v_x=self._law.v_x, v_y=self._law.v_y, yaw_rate=self._law.yaw_rate)
        both = zip(_pairs(own), _pairs(contract.command), strict=True)
        self._ranges = tuple(mine or trained for mine, trained in both)
        self._slot, self._there, self._turned = -1, False, False

    def velocity(self, goal: Goal, time: float) -> Twist:
        """The velocity that the policy is commanded.

        Args:
            goal: where to go.
            time: since the tour began [s].
        """
        law, (x, y), turn = self._law, goal.way, goal.turn
        distance = math.hypot(x, y)
        if goal.slot != self._slot:
            self._slot, self._there, self._turned = goal.slot, False, False
        self._there = distance <= law.near[1] if self._there else distance < law.near[0]
        self._turned = abs(turn) <= law.turned[1] if self._turned else abs(turn) < law.turned[0]
        if time < law.waits:
            return STILL
        v_x, v_y = (0.0, 0.0) if self._there else self._level(x, y, distance)
        share = self._facing(distance)
        if share > 0.0:
            turn = float(wrap_angle(turn + share * wrap_angle(math.atan2(y, x) - turn)))
        rate = 0.0 if self._turned and not share else self._cut(2, law.turn_gain * turn)
        return Twist(v_x, v_y, rate)

    def _level(self, x: float, y: float, distance: float) -> tuple[float, float]:
        """Forward and to the left [m/s]."""
        law = self._law
        speed = law.gain * distance if law.speed is None else min(law.gain * distance, law.speed)
        v_x, v_y = (self._cut(axis, speed * part / distance) for axis, part in enumerate((x, y)))
        if law.keeps_speed and (v_x or v_y):
            longer = speed / math.hypot(v_x, v_y)
            v_x, v_y = self._cut(0, longer * v_x), self._cut(1, longer * v_y)
        return v_x, v_y

    def _facing(self, distance: float) -> float:
        """Share of the way from the heading that is asked for to where it goes, in which it looks [-]."""
        if self._law.faces is None or self._there:
            return 0.0
        near, far = self._law.faces
        return min(max((distance - near) / (far - near), 0.0), 1.0)

    def _cut(self, axis: int, value: float) -> float:
        bounds = self._ranges[axis]
        return value if bounds is None else min(max(value, bounds[0]), bounds[1])


def _pairs(ranges: CommandRange) -> tuple[tuple[float, float] | None, ...]:
    return ranges.v_x, ranges.v_y, ranges.yaw_rate
