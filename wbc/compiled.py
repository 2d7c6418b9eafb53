"""What kernels that are not in Python yet are told of a controller: the terms of its robot, in memory."""

from typing import TYPE_CHECKING

import numpy as np

from surefoot.native.library import Bound, Library
from surefoot.wbc.types import Array
from surefoot.wbc.zmp import UNLOADED

if TYPE_CHECKING:
    from surefoot.wbc.model import RobotTerms
    from surefoot.wbc.tasks.stack import TaskStack

_SHARED = (
    "nv", "model_mass", "wrench_unit", "angular_momentum", "bias", "com", "com_velocity", "sole_position",
    "sole_rotation", "sole_wrench_map",
)  # fmt: skip


class CompiledTerms:
    """The arrays of a `RobotTerms` as kernels take them.

    Args:
        kernels: the library.
        terms: whose arrays these are.

    Attributes:
        kernels: the library.
        bound: the terms as other kernels take them.
    """

    def __init__(self, kernels: Library, terms: "RobotTerms") -> None:
        self.kernels = kernels
        self.bound = kernels.fill("Terms", **{name: getattr(terms, name) for name in _SHARED})
        self._wrench, self._level, self._yaw, self._zmp = np.zeros((2, 6)), np.zeros((2, 3)), np.zeros(2), np.zeros(3)
        self._see = kernels.bind(
            "feet_see",
            terms=self.bound,
            unloaded=UNLOADED,
            wrench=self._wrench,
            level=self._level,
            yaw=self._yaw,
            zmp=self._zmp,
        )

    def feet(self, wrench: Array, toe: float) -> tuple[Array, Array, Array]:
        """Soles turned level, shape (2, 3) [m], their yaws, shape (2,) [rad], and the ZMP, shape (3,) [m].

        Args:
            wrench: sole wrenches in the sole frames, shape (2, 6) [N, N·m].
            toe: as of `RobotTerms.level_soles`; the soles do not lean.
        """
        self._wrench[...] = wrench
        self._see(toe)
        return self._level.copy(), self._yaw.copy(), self._zmp.copy()

    def stack(self, tasks: "TaskStack") -> Bound:
        """Rows and targets of tasks as kernels take them."""
        rows, target = tasks.rows, tasks.target
        return self.kernels.fill(
            "Stack", variables=rows.shape[1], rows_count=len(target), rows=rows, target=target, unscale=tasks.unscale
        )
