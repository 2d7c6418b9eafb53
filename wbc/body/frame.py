"""Kinematics of a frame that is fixed to a body, out of what Pinocchio has of that body's joint."""

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import moving_columns
from surefoot.maths import algebra, linear
from surefoot.wbc.types import Array


class Frame:
    """A frame on a body: where it is, its Jacobian, its velocity, and its acceleration with v' = 0.

    Motions are local to the frame and classical. It writes into memory that is given, and Pinocchio's own placement.
    Columns of joints that do not move it stay as they are.

    Args:
        model: Pinocchio's.
        data: Pinocchio's; what is here reads and writes its memory.
        frame: its number.
        joints: columns of the joints' Jacobian, the values of `JointColumns`, shape (6, nv).
        jacobian: to be written, from v to linear and angular velocity, shape (6, nv).
        velocity: to be written, linear and angular, shape (6,) [m/s, rad/s].
        bias: to be written, linear and angular, shape (6,) [m/s^2, rad/s^2].
    """

    def __init__(
        self,
        model: pin.Model,
        data: pin.Data,
        frame: int,
        joints: Array,
        jacobian: Array,
        velocity: Array,
        bias: Array,
    ) -> None:
        joint, placement = model.frames[frame].parentJoint, model.frames[frame].placement
        # Views of Pinocchio's memory, which never moves.
        self.rotation, self.position = data.oMf[frame].rotation, data.oMf[frame].translation
        self._joint_rotation, self._joint_position = data.oMi[joint].rotation, data.oMi[joint].translation
        self._joint_velocity, self._joint_acceleration = data.v[joint].vector, data.a[joint].vector
        self._joint_jacobian = joints
        self._fixed_rotation, self._fixed_position = placement.rotation.copy(), placement.translation.copy()
        self._columns = np.array(moving_columns(model, joint), dtype=np.int64)
        self.jacobian, self.velocity, self.bias = jacobian, velocity, bias

    def place(self) -> None:
        """Write where it is, behind a computation that placed the joints."""
        algebra.compose(self._joint_rotation, self._fixed_rotation, self.rotation)
        lever = algebra.rotate(self._joint_rotation, algebra.vector(self._fixed_position))
        algebra.put(self.position, algebra.add(lever, algebra.vector(self._joint_position)))

    def update(self) -> None:
        """Write all, behind `Dynamics.all_terms`, which leaves in ``data.a`` the accelerations with v' = 0."""
        self.place()
        R, p = self._fixed_rotation, algebra.vector(self._fixed_position)
        v, w = algebra.see_motion(R, p, _linear(self._joint_velocity), _angular(self._joint_velocity))
        a, alpha = algebra.see_motion(R, p, _linear(self._joint_acceleration), _angular(self._joint_acceleration))
        _put(self.velocity, v, w)
        _put(self.bias, algebra.add(a, algebra.cross(w, v)), alpha)
        linear.see_columns(self.rotation, self.position, self._joint_jacobian, self._columns, self.jacobian)

    def shift(self, R: Array, origin: Array) -> None:
        """See its motion from elsewhere on the body: from a frame with rotation R and that origin in this one.

        The acceleration of that origin has ω x (ω x p) more.
        """
        p, spin = algebra.vector(origin), _angular(self.velocity)
        centripetal = algebra.cross(spin, algebra.cross(spin, p))
        linear.see_columns(R, origin, self.jacobian, self._columns, self.jacobian)
        v, w = algebra.see_motion(R, p, _linear(self.velocity), spin)
        a, alpha = algebra.see_motion(R, p, _linear(self.bias), _angular(self.bias))
        _put(self.velocity, v, w)
        _put(self.bias, algebra.add(a, algebra.rotate_back(R, centripetal)), alpha)


def _linear(motion: Array) -> algebra.Vector:
    return motion[0], motion[1], motion[2]


def _angular(motion: Array) -> algebra.Vector:
    return motion[3], motion[4], motion[5]


def _put(motion: Array, linear: algebra.Vector, angular: algebra.Vector) -> None:
    motion[0], motion[1], motion[2] = linear[0], linear[1], linear[2]
    motion[3], motion[4], motion[5] = angular[0], angular[1], angular[2]
