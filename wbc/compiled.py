"""What the compiled kernels of a controller share: the terms of its robot and the reference of a tick, in memory.

Each kernel is bound beside its plain counterpart, in the class of that name; see `surefoot.native`.
"""

from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.forces import ExternalLoad
from surefoot.mimic import moving_columns
from surefoot.native.library import Bound, Library
from surefoot.wbc.types import Array, WbcReference
from surefoot.wbc.zmp import UNLOADED

if TYPE_CHECKING:
    from surefoot.wbc.model import RobotTerms


class CompiledTerms:
    """Kernels that fill the arrays of a `RobotTerms` behind ``pin.computeAllTerms``.

    Args:
        kernels: the library.
        terms: whose arrays these are; Pinocchio's data never moves.
        soles: frames of the soles, as Pinocchio counts them.
        torso: that of the torso.
        torso_motion: where its Jacobian, velocity and bias go, linear and angular, shape (6, nv), (6,) and (6,).

    Attributes:
        kernels: the library.
        bound: the terms as other kernels take them.
        update: fills all arrays of the state that the terms' q and v hold; returns whether that is finite.
        place: fills those of `RobotTerms.place`, behind Pinocchio's computeCentroidalMomentum and ccrba.
    """

    def __init__(
        self,
        kernels: Library,
        terms: "RobotTerms",
        soles: tuple[int, int],
        torso: int,
        torso_motion: tuple[Array, Array, Array],
    ) -> None:
        self.kernels, self._data = kernels, terms.data
        self._mass, self._force, self._moment = np.array([terms.mass]), np.zeros(3), np.zeros(3)
        self._to_sole = np.zeros((2, 6, 6))
        own = {
            name: getattr(terms, name)
            for name in (
                "q", "v", "model_mass", "wrench_unit", "angular_momentum", "mass_matrix", "bias", "com", "com_velocity",
                "base_angular_velocity", "sole_position", "contact_position", "contact_rotation", "sole_jacobian",
                "sole_velocity", "sole_bias", "sole_wrench_map", "torso_jacobian", "torso_velocity", "torso_bias",
            )
        }  # fmt: skip
        self.bound = kernels.fill(
            "Terms",
            **own,
            nq=terms.model.nq,
            nv=terms.model.nv,
            mass=self._mass,
            load_force=self._force,
            load_moment=self._moment,
            joint_jacobian_columns=terms.columns.values,
            momentum=terms.data.h[0].vector,
            linear_momentum=terms.data.hg.linear,
            base_rotation_columns=terms.base_rotation,
            left=self._sole(terms, 0, soles[0]),
            right=self._sole(terms, 1, soles[1]),
            torso=self._frame(terms, torso, *torso_motion),
            to_sole=self._to_sole,
        )
        self.update, self.place = (kernels.bind(name, self.bound) for name in ("terms_update", "terms_place"))
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
        self._shift, self.unshift = (kernels.bind(name, self.bound) for name in ("terms_shift", "terms_unshift"))

    def bear(self, mass: float, load: ExternalLoad) -> None:
        """Let other kernels count with a load and the total mass [kg]."""
        self._mass[0] = mass
        self._force[:], self._moment[:] = load.force, load.moment

    def shift(self, k: int, forward: float, pitch: float) -> Array:
        """See `RobotTerms.shift_foot`, of a sole that does not lean."""
        self._shift(k, forward, pitch)
        to_sole: Array = self._to_sole[k].copy()
        return to_sole

    def feet(self, wrench: Array, toe: float) -> tuple[Array, Array, Array]:
        """Soles turned level, shape (2, 3) [m], their yaws, shape (2,) [rad], and the ZMP, shape (3,) [m].

        Args:
            wrench: sole wrenches in the sole frames, shape (2, 6) [N, N·m].
            toe: as of `RobotTerms.level_soles`; the soles do not lean.
        """
        self._wrench[...] = wrench
        self._see(toe)
        return self._level.copy(), self._yaw.copy(), self._zmp.copy()

    def pose(self, joint: int) -> tuple[Array, Array]:
        """Orientation, by columns, and position of a joint's body in the world, where Pinocchio keeps them."""
        placement = self._data.oMi[joint]
        return placement.rotation, placement.translation

    def _sole(self, terms: "RobotTerms", k: int, frame: int) -> Bound:
        motion = terms.sole_jacobian[k], terms.sole_velocity[k], terms.sole_bias[k]
        return self.kernels.fill(
            "Sole",
            frame=self._frame(terms, frame, *motion),
            position=terms.sole_position[k],
            rotation=terms.sole_rotation[k],
            pose=terms.sole_pose[k],
            contact_position=terms.contact_position[k],
            contact_rotation=terms.contact_rotation[k],
            wrench_map=terms.sole_wrench_map.reshape(-1)[6 * k :],
        )

    def _frame(self, terms: "RobotTerms", frame: int, jacobian: Array, velocity: Array, bias: Array) -> Bound:
        model, data = terms.model, terms.data
        joint, placement = model.frames[frame].parentJoint, model.frames[frame].placement
        columns = moving_columns(model, joint)
        return self.kernels.fill(
            "Frame",
            joint_rotation_columns=data.oMi[joint].rotation,
            joint_position=data.oMi[joint].translation,
            joint_velocity=data.v[joint].vector,
            joint_acceleration=data.a[joint].vector,
            placement_rotation=np.ascontiguousarray(placement.rotation),
            placement_position=placement.translation.copy(),
            supporting=len(columns),
            columns=np.array(columns, dtype=np.int64),
            rotation_columns=data.oMf[frame].rotation,
            position=data.oMf[frame].translation,
            jacobian=jacobian,
            velocity=velocity,
            bias=bias,
        )


_VECTORS = attrgetter(
    "com", "com_velocity", "com_acceleration", "zmp", "zmp_offset", "swing_position", "swing_velocity",
    "swing_acceleration", "swing_angular_velocity", "swing_angular_acceleration",
)  # fmt: skip
_NUMBERS = attrgetter("omega", "stiffness", "heading", "heading_rate")


class CompiledTick:
    """Terms and reference of a tick, on which the kernels of tasks and rows work.

    Args:
        terms: of the robot.

    Attributes:
        kernels: the library.
        terms: as kernels take them.
        reference: likewise.
        numbers: memory of that, as ``WbcReference.numbers``, shape (55,) [SI].
    """

    def __init__(self, terms: CompiledTerms) -> None:
        self.kernels, self.terms = terms.kernels, terms.bound
        self.reference, self.numbers = self.kernels.buffer("Reference")

    def refer(self, reference: WbcReference) -> None:
        """Take the reference of this tick, which no kernel has made."""
        r = reference
        rest = (*_NUMBERS(r), *r.load_share, *r.roll, r.swing_foot, r.rolling_foot, r.catching)
        parts = (*_VECTORS(r), r.swing_rotation.ravel(), r.ground_normal.ravel(), rest)
        np.concatenate(parts, out=self.numbers)

    def bench(self, scale: Array, rows: Array, target: Array) -> Bound:
        """Where a task writes: its rows, shape (size, n), and its target; ``scale`` as in ``Task.write``."""
        shared: dict[str, Any] = {"terms": self.terms, "reference": self.reference}
        return self.kernels.fill(
            "Bench", **shared, variables=rows.shape[1], scale=scale.reshape(-1), rows=rows, target=target
        )
