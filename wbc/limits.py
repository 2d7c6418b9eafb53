"""Joint limits as bounds on the joint accelerations of one tick."""

from dataclasses import dataclass

import numpy as np

from wbc.types import Array


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits of the actuated joints, shape (nj,) each.

    Attributes:
        torque: largest absolute torque [N·m].
        velocity: largest absolute velocity [rad/s].
        lower, upper: position range [rad].
        position_horizon: time in which the position limit must be met at constant deceleration [s].
        velocity_horizon: time in which the velocity limit must be met [s].
    """

    torque: Array
    velocity: Array
    lower: Array
    upper: Array
    position_horizon: float = 0.06
    velocity_horizon: float = 0.02

    def acceleration_bounds(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Bounds on q̈, shape (nj,) each, that keep position and velocity inside their limits.

        From q + T v + T² q̈ / 2 >= q_min and its mirror image; the velocity bound from v + T_v q̈. Where the two conflict the
        position bound wins, so that lower <= upper always. Near-straight knees hyperextend without this.
        """
        T, Tv = self.position_horizon, self.velocity_horizon
        scale = 2.0 / (T * T)
        reach = position + T * velocity
        position_lower = scale * (self.lower - reach)
        position_upper = scale * (self.upper - reach)
        lower = np.maximum(position_lower, (-self.velocity - velocity) / Tv)
        upper = np.minimum(position_upper, (self.velocity - velocity) / Tv)
        return np.minimum(lower, position_upper), np.maximum(upper, position_lower)
