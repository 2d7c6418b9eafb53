"""A robot that is let down from a crane: its joints are held until both feet carry it."""

import numpy as np
import pinocchio as pin

from surefoot.joints import JointCommand
from surefoot.readings import Readings
from surefoot.scenarios.setup.robot.body import Body
from surefoot.sim.measurement import Measurement
from surefoot.similarity import GRAVITY, REFERENCE_SIZE, Similarity
from surefoot.wbc.body.statics import LEVER, standing_torque
from surefoot.wbc.types import Array

STIFFNESS, DAMPING = 3.0, 0.08
"""Torque of a joint that is held, as a share of its largest one, per angle [1/rad] and per speed of the reference robot
[s/rad]."""

APPROACH = 1.0
"""Time in which joints go to the posture from where they are found, of the reference robot [s]."""

LEAST, ENOUGH, SETTLED = 0.2, 0.75, 0.2
"""Share of the weight on each foot and on both, and for how long, of the reference robot, until the robot stands [-, -,
s]."""


class Landing:
    """Holds the start posture, and tells when both feet carry the robot.

    How hard the feet press is what force sensors say. Without them it is what the torques of the legs' joints, less
    those of their weights, press with.

    Args:
        body: the robot.
        posture: configuration to hold, shape (nq,).
        size: of the robot.
    """

    def __init__(self, body: Body, posture: Array, size: Similarity = REFERENCE_SIZE) -> None:
        self._body, self._model, self._data = body, body.model, body.model.createData()
        self._posture, self._size = posture[7:].copy(), size
        self._weight = GRAVITY * float(body.robot.mass)
        self._standing = standing_torque(body.model, body.frames, posture, LEVER * size.length)
        self._soles = [body.model.getFrameId(name) for name in body.frames.soles]
        self._from: Array | None = None
        self._given = np.zeros_like(self._posture)
        self._began = self._loaded_since = 0.0

    def hold(self, readings: Readings | Measurement) -> JointCommand | None:
        """Command of the joints until the next readings; None once the robot stands."""
        now = readings.time
        position, velocity, torque, wrench = _joints(readings)
        if self._from is None:
            self._from, self._began, self._loaded_since = position.copy(), now, now
        if np.isnan(torque).any():
            torque = self._given
        pressing = (self._pressing(position, torque) if wrench is None else wrench[:, 2]) / self._weight
        if pressing.min() < LEAST or pressing.sum() < ENOUGH:
            self._loaded_since = now
        elif now - self._loaded_since > SETTLED * self._size.time:
            return None
        share = min(1.0, (now - self._began) / (APPROACH * self._size.time))
        wanted = self._from + share * (self._posture - self._from)
        most = self._body.limits.torque
        pull = STIFFNESS * (wanted - position) - DAMPING * self._size.time * velocity
        carried = float(np.clip(pressing.sum(), 0.0, 1.0))
        self._given = np.clip(most * pull + carried * self._standing, -most, most)
        return JointCommand(self._given)

    def _pressing(self, position: Array, torque: Array) -> Array:
        """Normal forces on the soles by the joints' torques, shape (2,) [N]."""
        model, data = self._model, self._data
        q = np.concatenate((np.zeros(6), [1.0], position))
        weights = pin.computeGeneralizedGravity(model, data, q)[6:]
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        found = np.zeros(2)
        for k, sole in enumerate(self._soles):
            J = pin.getFrameJacobian(model, data, sole, pin.ReferenceFrame.LOCAL)[:, 6:]
            leg = np.flatnonzero(np.abs(J).sum(axis=0) * self._body.leg_joints)
            found[k] = np.linalg.lstsq(J[:, leg].T, (weights - torque)[leg], rcond=1e-3)[0][2]
        return found


def _joints(readings: Readings | Measurement) -> tuple[Array, Array, Array, Array | None]:
    """Angles, speeds and torques of the joints, shape (nj,) each, and wrenches of the soles if they are felt."""
    if isinstance(readings, Measurement):
        felt = None if np.isnan(readings.wrench).any() else readings.wrench
        return readings.joint_position, readings.joint_velocity, readings.joint_torque, felt
    position, speed = readings.joint_position.values, readings.joint_velocity
    velocity = np.zeros(len(position)) if speed is None else speed.values
    wrench = None if readings.wrench is None else readings.wrench.values
    return position, velocity, readings.joint_torque.values, wrench
