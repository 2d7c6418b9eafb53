"""The two momentum tasks: they act on the sole forces, which the floating-base rows tie to the accelerations."""

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import BalanceGains, TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.balance import BalanceLaw, SupportRegion
from surefoot.wbc.tasks.law import TaskLaw
from surefoot.wbc.types import GRAVITY, Array


class CentreOfMass(TaskLaw):
    """CoM acceleration by the law of ``surefoot.wbc.tasks.balance``, from the forces: c'' = (Σ R_k f_k + f) / m - g.

    The force f is that of a lasting load (see ``RobotTerms.bear``).

    While a step catches the body its height counts for more. A leg that is swung hard turns the body; friction and CoP
    hold that only as far as the stance foot is pressed down. So it was cheap to jump, and no leg came down in time.
    """

    name, size = "CoM", 3

    def __init__(self, weights: TaskWeights, balance: BalanceGains, region: SupportRegion) -> None:
        """``region``: where the ZMP may lie; its owner keeps it up to date."""
        across = weights.com_horizontal, weights.com_horizontal
        self.weight = np.array([*across, weights.com_vertical])
        self.catching_weight = np.array([*across, weights.com_vertical_catching])
        self._balance, self._g = BalanceLaw(balance, region), GRAVITY

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``: (Σ R_k f_k) / m = c''_cmd + g - f / m."""
        m = terms.mass
        c_ddot = self._balance.acceleration(reference, terms._c, terms._c_dot)
        linear.scale_rows(rows, terms.nv, terms.wrench_unit / m, scale, terms._W, 0)
        target[0] = c_ddot[0] - terms._load_force[0] / m
        target[1] = c_ddot[1] - terms._load_force[1] / m
        target[2] = c_ddot[2] - terms._load_force[2] / m + self._g


class AngularMomentum(TaskLaw):
    """Decay of the angular momentum L about the CoM, per mass: L'/m = (Σ [(p_k - c) x R_k f_k + R_k τ_k] + n) / m.

    The moment n is that of a lasting load (see ``RobotTerms.bear``).
    Newton and Euler for the whole body (e.g. Orin, Goswami and Lee, Autonomous Robots 2013). With F and M the force and
    the moment about the world's origin it is (M - c x F) / m.
    """

    name, size = "angular momentum", 3

    def __init__(self, weights: TaskWeights, gains: TaskGains) -> None:
        self.weight, self.catching_weight = weights.angular_momentum, weights.angular_momentum_catching
        self._k = gains.angular_momentum

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``: (M + F x c) / m = -k L / m - n / m, with F and M by each number of the wrenches."""
        m, nv = terms.mass, terms.nv
        s = scale[0] * (terms.wrench_unit / m)
        c = algebra.scale(s, algebra.vector(terms._c))
        for j in range(12):
            F = (terms._W[0, j], terms._W[1, j], terms._W[2, j])
            M = (terms._W[3, j], terms._W[4, j], terms._W[5, j])
            turn = algebra.add(algebra.cross(F, c), algebra.scale(s, M))
            rows[0, nv + j], rows[1, nv + j], rows[2, nv + j] = turn[0], turn[1], turn[2]
        for i in range(3):
            target[i] = -self._k / terms.model_mass * terms._L[i] - terms._load_moment[i] / m
