"""The two momentum tasks: they act on the sole forces, which the floating-base rows tie to the accelerations."""

from collections.abc import Callable

import numpy as np

from surefoot.native.library import Bound
from surefoot.wbc.balance import SupportRegion, com_acceleration
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.parameters import BalanceGains
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.task import Vector
from surefoot.wbc.types import GRAVITY, Array, WbcReference


class CentreOfMass:
    """CoM acceleration by the law of ``surefoot.wbc.balance``, from the forces: c'' = (Σ R_k f_k + f) / m - g.

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
        self._balance, self._region = balance, region

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        per_mass = scale * (terms.wrench_unit / terms.mass)
        np.multiply(terms.sole_wrench_map[:3], per_mass, out=rows[:, -12:])
        x, y, z = com_acceleration(reference, terms.com, terms.com_velocity, self._region, self._balance)
        fx, fy, fz = terms.load.force.tolist()
        return x - fx / terms.mass, y - fy / terms.mass, z + GRAVITY - fz / terms.mass

    def compiled(self, tick: CompiledTick, bench: Bound) -> Callable[[], None]:
        """See ``CompiledTask.compiled``."""
        gains, region = self._balance, self._region
        return tick.kernels.bind(
            "task_centre_of_mass",
            bench=bench,
            edges=region.edges,
            edge_count=region.edge_count,
            beyond=gains.beyond_catching,
            dcm=gains.dcm,
            height_stiffness=gains.height_stiffness,
            height_damping=gains.height_damping,
            gravity=GRAVITY,
        )


class AngularMomentum:
    """Decay of the angular momentum L about the CoM, per mass: L'/m = (Σ [(p_k - c) x R_k f_k + R_k τ_k] + n) / m.

    The moment n is that of a lasting load (see ``RobotTerms.bear``).
    Newton and Euler for the whole body (e.g. Orin, Goswami and Lee, Autonomous Robots 2013). With F and M the force and
    the moment about the world's origin it is (M - c x F) / m.
    """

    name, size = "angular momentum", 3

    def __init__(self, weights: TaskWeights, gains: TaskGains) -> None:
        self.weight, self.catching_weight = weights.angular_momentum, weights.angular_momentum_catching
        self._decay = gains.angular_momentum
        self._about_com = np.zeros((3, 6))
        self._flat = self._about_com.reshape(-1)

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        per_mass = float(scale[0, 0]) * (terms.wrench_unit / terms.mass)
        x, y, z = terms.com.tolist()
        x, y, z = per_mass * x, per_mass * y, per_mass * z
        # One by one: an array of eighteen numbers takes twice as long.
        about = self._flat
        about[1], about[2], about[6], about[8], about[12], about[13] = z, -y, -z, x, y, -x
        about[3] = about[10] = about[17] = per_mass
        np.matmul(self._about_com, terms.sole_wrench_map, out=rows[:, -12:])
        decay, mass = -self._decay / terms.model_mass, terms.mass
        lx, ly, lz = terms.angular_momentum.tolist()
        nx, ny, nz = terms.load.moment.tolist()
        return decay * lx - nx / mass, decay * ly - ny / mass, decay * lz - nz / mass

    def compiled(self, tick: CompiledTick, bench: Bound) -> Callable[[], None]:
        """See ``CompiledTask.compiled``."""
        return tick.kernels.bind("task_angular_momentum", bench=bench, decay=self._decay)
