"""Joint limits as bounds on the joint accelerations of one tick."""

from dataclasses import dataclass

import numpy as np

from surefoot.similarity import quantity
from surefoot.wbc.types import Array


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits of the actuated joints, shape (nj,) each.

    Attributes:
        torque: largest absolute torque [N·m].
        velocity: no-load speed [rad/s].
        lower, upper: position range [rad].
        position_horizon: time constant with which a joint may approach its position limit [s].
        velocity_share: of the no-load speed that a joint may have; near it a motor has no torque left [-].
        velocity_horizon: time in which that must be met [s].
    """

    torque: Array
    velocity: Array
    lower: Array
    upper: Array
    position_horizon: float = quantity(0.04, "s")
    velocity_share: float = quantity(0.88, "-")
    velocity_horizon: float = quantity(0.02, "s")


class AccelerationBounds:
    """Bounds on q̈ that keep position and velocity of the joints inside their limits.

    Position: T² q̈ + 2 T q' + q >= q_min and its mirror image, a critically damped approach: a joint with
    q' >= -(q - q_min) / T keeps that property and never passes its limit. Near-straight knees hyperextend without this.
    Velocity: v + T_v q̈ within a share of the no-load speed. Where the two conflict the position bound wins, so that
    lower <= upper always.

    Attributes:
        reach_time: 2 T [s].
        position_rate, velocity_rate: 1 / T² [1/s^2] and 1 / T_v [1/s].
        positions: lower and upper ends of the ranges, shape (2, nj) [rad].
        velocities: lowest and highest, shape (2, nj) [rad/s].
    """

    def __init__(self, limits: JointLimits) -> None:
        self.reach_time = 2.0 * limits.position_horizon
        self.position_rate = 1.0 / limits.position_horizon**2
        self.velocity_rate = 1.0 / limits.velocity_horizon
        self.positions = self._positions = np.stack([limits.lower, limits.upper])
        fastest = limits.velocity_share * limits.velocity
        self.velocities = self._velocities = np.stack([-fastest, fastest])

    def write(self, position: Array, velocity: Array, lower: Array, upper: Array) -> None:
        """Write the bounds of a state into ``lower`` and ``upper``; shape (nj,) each."""
        for j in range(position.shape[0]):
            reach = velocity[j] * self.reach_time + position[j]
            lowest = (self._positions[0, j] - reach) * self.position_rate
            highest = (self._positions[1, j] - reach) * self.position_rate
            slowest = (self._velocities[0, j] - velocity[j]) * self.velocity_rate
            fastest = (self._velocities[1, j] - velocity[j]) * self.velocity_rate
            lower[j] = min(max(lowest, slowest), highest)
            upper[j] = max(min(highest, fastest), lowest)
