"""Plants without a body: the true variable-height pendulum, the paper's cart-table, and the feet that go with them."""

import math

import numpy as np

from surefoot.planner.geometry.plane import nearest_point, signed_distance
from surefoot.planner.model.dcm import dcm
from surefoot.planner.model.jerk import jerk_model
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.types import Array, FeetState


class Pendulum:
    """Point mass over a ZMP: x'' = λ (x - p) + F / m horizontally, eq. (1) with a push; its height is given.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last step, shape (2,) [m].

    Args:
        mass: [kg].
        position: at the start, shape (2,) [m].
        velocity: at the start, shape (2,) [m/s].
    """

    def __init__(self, mass: float, position: Array, velocity: Array) -> None:
        self._mass = mass
        self.position = np.array(position)
        self.velocity = np.array(velocity)
        self.zmp = np.array(position)

    def advance(self, duration: float, zmp_command: Array, support: Array, stiffness: float, force: Array) -> None:
        """Exact motion under constant ZMP, stiffness and force.

        Args:
            duration: [s].
            zmp_command: wanted ZMP, shape (2,) [m].
            support: real support polygon, anticlockwise, shape (v, 2) [m]; the ZMP is its point
                nearest to the wanted one.
            stiffness: λ [1/s^2].
            force: horizontal force, shape (2,) [N].
        """
        self.zmp = nearest_point(support, zmp_command)
        center = self.zmp - force / (self._mass * stiffness)
        w = math.sqrt(stiffness)
        c, s = math.cosh(w * duration), math.sinh(w * duration)
        offset, velocity = self.position - center, self.velocity
        self.position = center + c * offset + s / w * velocity
        self.velocity = w * s * offset + c * velocity

    def fallen(self, support: Array, omega: float, distance: float = 1.0) -> bool:
        """Return true if the DCM is farther from the support than any foot could reach.

        Args:
            support: support polygon, shape (v, 2) [m].
            omega: ω [1/s].
            distance: what counts as a fall [m].
        """
        here = dcm(self.position, self.velocity, omega)
        if not np.isfinite(here).all():
            return True
        gap = float(np.hypot(*(nearest_point(support, here) - here)))
        return signed_distance(support, here) < 0.0 and gap > distance


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

        A push changes the velocity by F/m dt. It does not change the acceleration, which is the integral of the jerk.
        So the ZMP does not show it, as a measured contact force would not.

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


class IdealFeet:
    """Feet that follow the planned swing and feel the ground exactly when planned.

    Args:
        feet: start feet.
    """

    def __init__(self, feet: FeetState) -> None:
        self.state = feet

    def follow(self, sampler: PlanSampler, time: float) -> None:
        """Move to where the plan has the feet at an instant [s], which may be the planned touchdown."""
        position, yaw = self.state.position.copy(), self.state.yaw.copy()
        swing = sampler.plan.swing
        if swing is not None:
            sole = swing.evaluate(min(time, swing.touchdown_time))[0]
            position[swing.foot], yaw[swing.foot] = sole[:3], sole[3]
        self.state = FeetState(position, yaw, sampler.sample(time).contacts)
