"""A plan between its samples."""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.planner.geometry import quintic
from surefoot.planner.geometry.plane import shifted
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import POINT, PlanSample
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import Array, PhaseKind

OMEGA, STIFFNESS, LOAD, LINEAR, HEIGHT, SWING = 4, 5, 6, 7, 9, 10
"""Columns of an interval's table: ω, λ, load behind ZMP reference and offset; the CoM, its height, the swing foot [-].

Each is a function of time, whose coefficients of 1, t, ..., t^5 are the rows; they are in the order of a point.
"""

MOTIONS, RATES, BENDS, COLUMNS = 9, 16, 25, 34
"""Polynomials of CoM and swing foot; where their derivatives begin, first and second ones; all columns [-]."""

ROUNDING = 1e-6
"""An instant as near before a sample is that of the sample, since times are sums [samples]."""

_NO_SWING = np.zeros((6, 6))


class PlanSampler:
    """Evaluates a plan between its samples.

    The horizontal CoM is the exact cubic of the sample's jerk. Its height is the quintic through z, z' and z'' of both
    samples. ω, λ, ZMP reference, ZMP offset and load are linear. The polynomials of an interval are prepared when it is
    entered, and anew where the swing touches down within it. Otherwise its descent would go on to accelerate a foot
    that is to rest. Where a single support ends within an interval its foot is from then on planned to bear load. After
    the end of the horizon the last sample is held.

    Args:
        plan: the plan.

    Attributes:
        plan: the plan.
    """

    def __init__(self, plan: WalkPlan) -> None:
        self.plan = plan
        self._begin, self._length, self._last = plan.time, plan.sample_time, len(plan.jerk) - 1
        self._touchdown = math.inf if plan.swing is None else plan.swing.touchdown_time - TOUCHING
        single = plan.phase.kind is PhaseKind.SINGLE
        self._lands = plan.time + plan.phase.left - TOUCHING if single else math.inf
        self._table = np.zeros((6, COLUMNS))
        self._enter(0, plan.time >= self._touchdown)  # where it is asked first

    def sample(self, time: float) -> PlanSample:
        """References at an instant.

        Args:
            time: instant, not before the plan [s].
        """
        point = np.empty(POINT)
        return self._sampled(time, point, point)

    def tick(self, time: float, middle: float) -> tuple[PlanSample, PlanSample]:
        """The references at an instant, and what is to be done from there on over a time with that middle [s].

        That has the state of the instant, and all else of the middle; but of a swing that begins between them all.
        """
        points = np.empty((2, POINT))
        numbers = points
        now = self._sampled(time, points[0], numbers[0])
        until = self._sampled(middle, points[1], numbers[1])
        if until.swing_foot is now.swing_foot:
            numbers[1, LINEAR:BENDS] = numbers[0, LINEAR:BENDS]
        return now, until

    def _sampled(self, time: float, point: Array, numbers: Array) -> PlanSample:
        """A sample whose point is to be written; `numbers` is it again, as compiled code sees it."""
        self._go_to(time)
        self._evaluate(algebra.clamp(time - self._start, 0.0, self._length), numbers)
        contacts = self._contacts
        if time >= self._lands and self._entered == 0:
            contacts = (True, True)
        return PlanSample(time, point, contacts, self._swing_foot)

    def _go_to(self, time: float) -> None:
        """Enter the interval of an instant, with the swing foot landed or not."""
        interval = int((time - self._begin) / self._length + ROUNDING)
        interval, landed = min(max(interval, 0), self._last), time >= self._touchdown
        if interval != self._entered or landed != self._landed:
            self._enter(interval, landed)

    def _enter(self, i: int, landed: bool) -> None:
        """Prepare an interval: contacts, the foot that swings, and all functions of time."""
        plan = self.plan
        self._entered, self._landed, self._start = i, landed, self._begin + i * self._length
        left, right = plan.contacts[i].tolist()
        self._contacts, self._swing_foot = (left, right), None
        if plan.swing is not None and not self._contacts[plan.swing.foot]:
            self._swing_foot = plan.swing.foot
            self._fly(self._polynomials(plan.swing, landed))
        else:
            self._fly(_NO_SWING)
        self._line(0, _numbers(plan.zmp_reference), i)
        self._line(2, _numbers(plan.zmp_offset), i)
        self._line(OMEGA, _numbers(plan.omega)[:, None], i)
        self._line(STIFFNESS, _numbers(plan.stiffness)[:, None], i)
        self._line(LOAD, _numbers(plan.load_left)[:, None], i)
        motion = plan.com, plan.com_velocity, plan.com_acceleration, plan.jerk
        com, velocity, acceleration, jerk = map(_numbers, motion)
        self._move(com, velocity, acceleration, jerk, i)
        self._derive()

    def _polynomials(self, swing: SwingTrajectory, landed: bool) -> Array:
        """Polynomials of the swing foot in the time of the interval, shape (6, 6)."""
        since = max(self._start, swing.touchdown_time) if landed else self._start
        coefficients = swing.coefficients(since)
        return coefficients if since == self._start else shifted(coefficients, self._start - since)

    def _fly(self, polynomials: Array) -> None:
        """The swing foot."""
        for k in range(6):
            for i in range(6):
                self._table[k, SWING + i] = polynomials[k, i]

    def _line(self, column: int, values: Array, i: int) -> None:
        """Linear functions from columns of the table on, of values of shape (n, width)."""
        for axis in range(values.shape[1]):
            self._table[0, column + axis] = values[i, axis]
            self._table[1, column + axis] = (values[i + 1, axis] - values[i, axis]) / self._length

    def _move(self, com: Array, velocity: Array, acceleration: Array, jerk: Array, i: int) -> None:
        """The CoM: a cubic with the sample's jerk on each axis of the ground, and a quintic for the height."""
        for axis in range(2):
            self._table[0, LINEAR + axis] = com[i, axis]
            self._table[1, LINEAR + axis] = velocity[i, axis]
            self._table[2, LINEAR + axis] = 0.5 * acceleration[i, axis]
            self._table[3, LINEAR + axis] = jerk[i, axis] / 6.0
        here = com[i, 2], velocity[i, 2], acceleration[i, 2]
        there = com[i + 1, 2], velocity[i + 1, 2], acceleration[i + 1, 2]
        a, b, c, d, e, f = quintic.between(here, there, self._length)
        self._table[0, HEIGHT] = a
        self._table[1, HEIGHT] = b
        self._table[2, HEIGHT] = c
        self._table[3, HEIGHT] = d
        self._table[4, HEIGHT] = e
        self._table[5, HEIGHT] = f

    def _derive(self) -> None:
        """First and second derivatives of the polynomials."""
        for k in range(5):
            for i in range(MOTIONS):
                self._table[k, RATES + i] = (k + 1.0) * self._table[k + 1, LINEAR + i]
        for k in range(4):
            for i in range(MOTIONS):
                self._table[k, BENDS + i] = (k + 1.0) * self._table[k + 1, RATES + i]

    def _evaluate(self, t: float, point: Array) -> None:
        """All functions at a time of the interval, and behind them pendulum ZMP, ZMP and DCM."""
        linear.evaluate_polynomials(self._table, t, point)
        for axis in range(2):
            position, rate, bend = point[LINEAR + axis], point[RATES + axis], point[BENDS + axis]
            pendulum_zmp = position - bend / point[STIFFNESS]
            point[COLUMNS + axis], point[COLUMNS + 2 + axis] = pendulum_zmp, pendulum_zmp + point[2 + axis]
            point[COLUMNS + 4 + axis] = position + rate / point[OMEGA]


def _numbers(values: Array) -> Array:
    """An array of a plan, which may be of a planner that counts in other numbers."""
    return np.asarray(values, dtype=np.float64)
