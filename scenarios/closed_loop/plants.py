"""What the pendulum's loop drives: the true pendulum, or the paper's cart-table."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.cart_table import CartTable
from planner.pendulum import Pendulum
from planner.sampling import PlanSample, PlanSampler
from planner.types import GRAVITY
from scenarios.file.schema import PendulumSettings

Array = NDArray[np.float64]


class Plant(Protocol):
    """A point mass that follows plans.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last tick, shape (2,) [m].
    """

    position: Array
    velocity: Array
    zmp: Array

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan for a control tick.

        Args:
            sampler: of the plan.
            now: begin of the tick [s].
            period: its length [s].
            support: real support polygon, anticlockwise, shape (v, 2) [m].
            force: mean push during the tick, shape (2,) [N].
        """


class PendulumPlant(Pendulum):
    """The true pendulum under a low level that commands p = p_ref + k (ξ - ξ_ref), clipped to the real support.

    The low level knows the true state and believes the plan's height, as the whole-body controller does.

    Args:
        mass: true mass [kg].
        position: where it rests at the start, shape (2,) [m].
        height_error: believed minus true CoM height [m].
        feedback: k [-].
    """

    def __init__(self, mass: float, position: Array, height_error: float, feedback: float) -> None:
        super().__init__(mass, position, np.zeros(2))
        self._height_error, self._feedback = height_error, feedback

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`), held at what it says of the middle of the tick."""
        start, middle = sampler.sample(now), sampler.sample(now + 0.5 * period)
        error = self.position + self.velocity / start.omega - start.dcm
        command = middle.pendulum_zmp + self._feedback * error
        self.advance(period, command, support, true_stiffness(middle, self._height_error), force)


class CartTablePlant(CartTable):
    """The cart-table, which needs neither low level nor support.

    Args:
        mass: true mass [kg].
        position: where it rests at the start, shape (2,) [m].
        height_error: believed minus true CoM height [m].
    """

    def __init__(self, mass: float, position: Array, height_error: float) -> None:
        super().__init__(mass, position)
        self._height_error = height_error

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`); between two ticks the planned jerk is constant."""
        start, end = sampler.sample(now), sampler.sample(now + period)
        jerk = (end.com_acceleration[:2] - start.com_acceleration[:2]) / period
        self.advance(period, jerk, true_stiffness(end, self._height_error), force)


def plant(settings: PendulumSettings, mass: float, position: Array, height_error: float) -> Plant:
    """The plant that a scenario asks for; arguments as of the plants."""
    if settings.plant == "cart_table":
        return CartTablePlant(mass, position, height_error)
    return PendulumPlant(mass, position, height_error, settings.feedback)


def true_stiffness(sample: PlanSample, height_error: float) -> float:
    """λ = (g + z'') / (z - p_z) of the true CoM height, which is the believed one less its error [1/s^2]."""
    pressing = GRAVITY + float(sample.com_acceleration[2])
    return pressing / (pressing / sample.stiffness - height_error)
