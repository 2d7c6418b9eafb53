"""The state of a robot that knows its attitude, its turning and its joints alone, by the feet that it stands on."""

import math

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.models.pinocchio import pinocchio_model
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.types import RobotState

Array = NDArray[np.float64]

STANDING = 0.002
"""Height over the lowest corner of the soles at which one counts e times less [m]."""

LEAST = 0.02
"""Share of the weight that a foot is taken to bear at least, so that it never counts for nothing [-]."""


class LegOdometry:
    """Estimates where the base is and how it moves, on level ground.

    The corners of the soles that are lowest, by the attitude that is given, stand still: the base moves against them.
    Each corner counts by how low it is, so that a foot that tips over stands on its edge. It counts by what its foot
    bears, too, by the torques of the joints a tick ago, so that a foot that comes down moving counts for little. The
    place drifts as feet slip, and is of no meaning but for how it changes.

    Args:
        walk: whose robot it is.

    Attributes:
        is_truth: never.
    """

    is_truth = False

    def __init__(self, walk: Walk) -> None:
        robot = walk.robot
        self._model = pinocchio_model(robot)
        self._data = self._model.createData()
        self._soles = [self._model.getFrameId(name) for name in robot.sole_sites]
        x, y = 0.5 * robot.sole_length, 0.5 * robot.sole_width
        self._corners = np.array([[sx * x, sy * y, 0.0] for sx in (1.0, -1.0) for sy in (1.0, -1.0)])
        self._stand: Array | None = None
        self._torques = TorqueWrench(self._model, robot.sole_sites, 1.0 / walk.rates.control, SensorNoise(), held=False)
        self._time, self._load = math.nan, np.array([0.5, 0.5])
        self._base = np.zeros(3)

    def estimate(self, measurement: Measurement) -> RobotState:
        """The state; of the measurement, place and speed of the base are not looked at."""
        q, v = measurement.q.copy(), measurement.v.copy()
        q[:3] = v[:3] = 0.0
        places, speeds = self._feet(q, v)
        share = np.exp((places[:, 2].min() - places[:, 2]) / STANDING) * np.repeat(self._load, len(self._corners))
        weight = share / share.sum()
        if self._stand is None:
            self._stand = places.copy()
        self._base = weight @ (self._stand - places)
        self._base[2] = -places[:, 2].min()
        q[:3] = self._base
        v[:3] = pin.Quaternion(q[3:7]).matrix().T @ -(weight @ speeds)
        held = share / share.max()
        self._stand += (1.0 - held)[:, None] * (places + self._base - self._stand)
        state = RobotState(q, v)
        self._weigh(state, measurement)
        return state

    def _weigh(self, state: RobotState, measurement: Measurement) -> None:
        """Find what share of the weight each foot bears."""
        passed = measurement.time - self._time
        self._time = measurement.time
        if passed > 0.0:
            force = np.clip(self._torques.update(state, measurement.joint_torque, passed)[:, 2], 0.0, None)
            self._load = (force + LEAST * force.sum() + 1e-6) / (force.sum() * (1.0 + 2.0 * LEAST) + 2e-6)

    def _feet(self, q: Array, v: Array) -> tuple[Array, Array]:
        """Places and speeds of the corners of both soles, seen from the base in the world's axes, shape (8, 3)."""
        pin.forwardKinematics(self._model, self._data, q, v)
        places, speeds = [], []
        for sole in self._soles:
            frame = pin.updateFramePlacement(self._model, self._data, sole)
            motion = pin.getFrameVelocity(self._model, self._data, sole, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
            arms = self._corners @ frame.rotation.T
            places.append(frame.translation + arms)
            speeds.append(motion.linear + np.cross(motion.angular, arms))
        return np.concatenate(places), np.concatenate(speeds)
