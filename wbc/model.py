"""The Pinocchio terms of one state, computed once and shared by every task, contact and limit."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from wbc.types import GRAVITY, Array


@dataclass(frozen=True, slots=True)
class BodyFrames:
    """Names of the frames that the controller steers.

    Attributes:
        soles: frames at the centres of the soles, (left, right), x forward and z up.
        torso: frame of the torso.
    """

    soles: tuple[str, str]
    torso: str


class RobotTerms:
    """Dynamics, centroidal quantities and frame kinematics of the current state.

    The pelvis is the floating base. Frame Jacobians, velocities and bias accelerations are local to their frame and classical
    (what an accelerometer at the frame would add to gravity), so that one sole Jacobian serves the contact constraint,
    the swing task and the map from sole wrenches to generalised forces.

    Attributes:
        mass: total mass [kg].
        mass_matrix: M, shape (nv, nv).
        bias: Coriolis, centrifugal and gravity terms h, shape (nv,).
        com, com_velocity, angular_momentum: centroidal state in the world frame, shape (3,) each.
        base_rotation, torso_rotation: orientation in the world, shape (3, 3).
        sole_position: shape (2, 3); sole_rotation: shape (2, 3, 3); sole_pose: x y z qx qy qz qw, shape (2, 7).
        sole_jacobian: shape (2, 6, nv); sole_velocity, sole_bias: shape (2, 6).
        torso_jacobian: angular rows, shape (3, nv); torso_velocity, torso_bias: shape (3,).
    """

    def __init__(self, model: pin.Model, frames: BodyFrames) -> None:
        """Allocate all terms.

        Raises:
            ValueError: if a frame does not exist or the model's gravity is not ``GRAVITY`` downwards.
        """
        if not np.allclose(model.gravity.linear, [0.0, 0.0, -GRAVITY], atol=1e-12):
            raise ValueError(f"gravity of model '{model.name}' is {model.gravity.linear}; it must be [0, 0, -{GRAVITY}]")
        self.model = model
        self.data = model.createData()
        self._soles = tuple(_frame_id(model, name) for name in frames.soles)
        self._torso = _frame_id(model, frames.torso)
        self.mass = float(sum(inertia.mass for inertia in model.inertias))
        nv = model.nv
        self.mass_matrix = np.zeros((nv, nv))
        self.bias = np.zeros(nv)
        self.com, self.com_velocity, self.angular_momentum = np.zeros(3), np.zeros(3), np.zeros(3)
        self.base_rotation, self.torso_rotation = np.eye(3), np.eye(3)
        self.base_angular_velocity = np.zeros(3)
        self.sole_position, self.sole_rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self.sole_pose = np.zeros((2, 7))
        self.sole_jacobian = np.zeros((2, 6, nv))
        self.sole_velocity, self.sole_bias = np.zeros((2, 6)), np.zeros((2, 6))
        self.torso_jacobian = np.zeros((3, nv))
        self.torso_velocity, self.torso_bias = np.zeros(3), np.zeros(3)

    def update(self, q: Array, v: Array) -> None:
        """Compute every term at configuration q, shape (nq,), and velocity v, shape (nv,)."""
        model, data = self.model, self.data
        # Leaves in data.a the velocity-product accelerations, those of zero generalised acceleration.
        pin.computeAllTerms(model, data, q, v)
        self.mass_matrix[:] = data.M
        self.bias[:] = data.nle
        self.com[:] = data.com[0]
        momentum = data.hg.vector
        np.divide(momentum[:3], self.mass, out=self.com_velocity)
        self.angular_momentum[:] = momentum[3:]
        self._update_soles()
        self._update_trunk(v)

    def _update_soles(self) -> None:
        model, data = self.model, self.data
        for k, frame in enumerate(self._soles):
            placement = pin.updateFramePlacement(model, data, frame)
            self.sole_position[k] = placement.translation
            self.sole_rotation[k] = placement.rotation
            self.sole_pose[k] = pin.SE3ToXYZQUAT(placement)
            self.sole_jacobian[k] = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL)
            self.sole_velocity[k] = pin.getFrameVelocity(model, data, frame, pin.ReferenceFrame.LOCAL).vector
            self.sole_bias[k] = pin.getFrameClassicalAcceleration(
                model, data, frame, pin.ReferenceFrame.LOCAL
            ).vector

    def _update_trunk(self, v: Array) -> None:
        model, data, frame = self.model, self.data, self._torso
        self.base_rotation[:] = data.oMi[1].rotation
        self.base_angular_velocity[:] = v[3:6]
        self.torso_rotation[:] = pin.updateFramePlacement(model, data, frame).rotation
        self.torso_jacobian[:] = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL)[3:]
        self.torso_velocity[:] = pin.getFrameVelocity(model, data, frame, pin.ReferenceFrame.LOCAL).angular
        self.torso_bias[:] = pin.getFrameAcceleration(model, data, frame, pin.ReferenceFrame.LOCAL).angular


def _frame_id(model: pin.Model, name: str) -> int:
    if not model.existFrame(name):
        raise ValueError(f"robot '{model.name}' has no frame '{name}'")
    return int(model.getFrameId(name))
