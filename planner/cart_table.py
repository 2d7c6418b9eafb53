"""The paper's own plant: a cart on a table that executes the planned jerk exactly, whatever the feet allow."""

import numpy as np

from planner.kalman import jerk_model
from planner.types import Array


class CartTable:
    """Point mass under a commanded jerk; its ZMP x - x''/λ is an output and never bounded.

    So it cannot fall: what a pendulum would pay for with a fall is seen here only as a ZMP outside of the support.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        acceleration: shape (2,) [m/s^2].
        zmp: ZMP after the last step, shape (2,) [m].

    Args:
        mass: [kg].
        position: where it rests at the start, shape (2,) [m].
    """

    def __init__(self, mass: float, position: Array) -> None:
        self._mass = mass
        self.position = np.array(position)
        self.velocity, self.acceleration = np.zeros(2), np.zeros(2)
        self.zmp = np.array(position)

    def advance(self, duration: float, jerk: Array, stiffness: float, force: Array) -> None:
        """Exact motion under constant jerk and force.

        A push changes the velocity by F/m dt and not the acceleration, which is the jerk's integral; so the ZMP does
        not show it, as a measured contact force would not.

        Args:
            duration: [s].
            jerk: shape (2,) [m/s^3].
            stiffness: λ at the end of the step [1/s^2].
            force: horizontal force, shape (2,) [N].
        """
        a, b = jerk_model(duration)
        state = a @ np.stack((self.position, self.velocity, self.acceleration)) + np.outer(b, jerk)
        pushed = force / self._mass
        self.position = state[0] + 0.5 * duration**2 * pushed
        self.velocity = state[1] + duration * pushed
        self.acceleration = state[2]
        self.zmp = self.position - self.acceleration / stiffness
