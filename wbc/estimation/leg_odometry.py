"""The state of a robot that knows joints, their torques, attitude and turning alone, and how sure it is.

The corners of the soles that are lowest, by the attitude that is given, are where a foot stands. A foot that tips over
stands on its edge. How the base moves against them says how it moves in the world, unless the foot slides. A foot is
doubted by three things: its sole turns, which one that stands flat does not; its force lies flat, which friction holds
only so far; the other foot and the forces of both say something else, see `surefoot.wbc.estimation.velocity`.
"""

import math

import numpy as np
import pinocchio as pin

from surefoot.wbc.contact.external import SPAN
from surefoot.wbc.estimation.estimate import Deviation, Estimate
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.estimation.velocity import CentroidalVelocity
from surefoot.wbc.types import GRAVITY, Array, RobotState

STANDING = 0.002
"""Height over the lowest corner of the soles at which one counts e times less [m]."""

LEAST = 0.02
"""Share of the weight that a foot is taken to bear at least, so that it never counts for nothing [-]."""

BEARS = (0.04, 0.09)
"""Shares of the weight up to which the ground is not sure to carry a foot, and from which on it is [-]."""

HIGH = 0.01
"""Height of a foot over the lower one at which the ground hardly carries it: soles sink in by less [m]."""

STILL = 0.015
"""Deviation of the velocity of a sole that stands flat and still [m/s]."""

LEVER = 0.08
"""Lever by which a sole that turns may slide: most of the way from its middle to its toes [m]."""

DOWN = 0.02
"""Lever by which a sole that turns may go up and down: it does so about its lowest edge [m]."""

FLAT = 0.2
"""Deviation of the velocity of a sole whose level force is as great as the normal one; it grows with the square of
their ratio [m/s].

Where that was below 0.1, one sole in 5,000 slid by more than 0.3 m/s, and from 0.6 on a third of them (G1, 74,000
soles in tours).
"""

UNKNOWN = (0.3, 2e-3)
"""Changes of the base's velocities in a tick that nobody knows, linear and angular: the wrenches must do without the
former, since it is found by them [m/s, rad/s]."""

FIRST = 0.1
"""Deviation of the velocity before anything was held against it [m/s]."""


class LegOdometry:
    """Estimates where the base is and how it moves, on level ground.

    The place drifts as feet slip, and is of no meaning but for how it changes.

    Args:
        model: of the robot, with a free-flyer base.
        soles: names of the sole frames, left first.
        half_size: half of a sole's length and width [m].
        period: control period [s].
    """

    def __init__(self, model: pin.Model, soles: tuple[str, str], half_size: tuple[float, float], period: float) -> None:
        self._model, self._data = model, model.createData()
        self._soles = [model.getFrameId(name) for name in soles]
        x, y = half_size
        self._corners = np.array([[sx * x, sy * y, 0.0] for sx in (1.0, -1.0) for sy in (1.0, -1.0)])
        self._mass = float(sum(inertia.mass for inertia in model.inertias))
        self._torques = TorqueWrench(model, soles, period, SensorNoise(), base=UNKNOWN)
        self._velocity: CentroidalVelocity | None = None
        self._stand = np.zeros((8, 3))
        self._time, self._forces = math.nan, np.tile((0.0, 0.0, 0.5 * self._mass * GRAVITY), (2, 1))
        self._bore = np.full(2, 0.5)
        self._moving = np.zeros(3)

    def sense(self, time: float, q: Array, v: Array, torque: Array) -> Estimate:
        """The estimate of a tick.

        Args:
            time: of it [s].
            q: configuration, of which the place of the base is not looked at, shape (7 + nj,) [m, -, rad].
            v: velocity, of which that of the base is not looked at, shape (6 + nj,) [m/s, rad/s].
            torque: of the joints until now, shape (nj,) [N·m].
        """
        q, v = q.copy(), v.copy()
        q[:3] = v[:3] = 0.0
        places, speeds, rotations, turning = self._feet(q, v)
        com = pin.centerOfMass(self._model, self._data, q, v, False)
        against, height = self._data.vcom[0].copy(), float(com[2] - places[:, 2].min())
        R = pin.Quaternion(q[3:7]).matrix()
        passed = 0.0 if math.isnan(self._time) else time - self._time
        self._time = time
        if passed > 0.0:
            v[:3] = R.T @ self._moving
            wrench = self._torques.update(RobotState(q, v), torque, passed)
            self._forces = np.stack([rotations[k] @ wrench[k, :3] for k in (0, 1)])
        share = self._shares(places)
        if self._velocity is None:
            self._velocity, self._stand = CentroidalVelocity(against - share @ speeds, FIRST), places.copy()
        velocity = self._velocity
        if passed > 0.0:
            self._follow(velocity, passed, against, places, speeds, turning)
        self._moving = velocity.mean - against
        v[:3] = R.T @ self._moving
        q[:3] = self._place(places, share)
        return Estimate(RobotState(q, v), deviation=self._deviation(velocity, height))

    def _feet(self, q: Array, v: Array) -> tuple[Array, Array, list[Array], Array]:
        """Corners of both soles from the base in the world's axes, places and speeds, shape (8, 3); how soles turn.

        Of these the orientations, and the sizes of the angular velocities, shape (2,) [rad/s].
        """
        pin.forwardKinematics(self._model, self._data, q, v)
        places, speeds, rotations, turning = [], [], [], np.zeros(2)
        for k, sole in enumerate(self._soles):
            frame = pin.updateFramePlacement(self._model, self._data, sole)
            motion = pin.getFrameVelocity(self._model, self._data, sole, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
            arms = self._corners @ frame.rotation.T
            places.append(frame.translation + arms)
            speeds.append(motion.linear + np.cross(motion.angular, arms))
            rotations.append(frame.rotation.copy())
            turning[k] = np.linalg.norm(motion.angular)
        return np.concatenate(places), np.concatenate(speeds), rotations, turning

    def _shares(self, places: Array) -> Array:
        """Shares by which corners stand: of what their foot bears, and by how low they are, shape (8,) [-]."""
        force = np.clip(self._forces[:, 2], 0.0, None)
        load = (force + LEAST * force.sum() + 1e-6) / (force.sum() * (1.0 + 2.0 * LEAST) + 2e-6)
        share = np.exp((places[:, 2].min() - places[:, 2]) / STANDING) * np.repeat(load, len(self._corners))
        shares: Array = share / share.sum()
        return shares

    def _follow(
        self,
        velocity: CentroidalVelocity,
        passed: float,
        against: Array,
        places: Array,
        speeds: Array,
        turning: Array,
    ) -> None:
        """Let the velocity of the CoM follow forces and feet.

        Args:
            velocity: that follows.
            passed: since the tick before [s].
            against: velocity of the CoM against the base, in the world's axes, shape (3,) [m/s].
            places: of the soles' corners from the base, shape (8, 3) [m].
            speeds: of these, shape (8, 3) [m/s].
            turning: angular velocity of each sole, shape (2,) [rad/s].
        """
        forces, weight = self._forces, self._mass * GRAVITY
        velocity.predict(forces.sum(axis=0) / self._mass - (0.0, 0.0, GRAVITY), passed)
        lowest = _lowest(places.reshape(2, -1, 3)[:, :, 2])
        by_feet = against - np.einsum("kc,kci->ki", lowest, speeds.reshape(2, -1, 3))
        share = forces[:, 2] / weight
        # A foot that is thrown about carries again in the next tick.
        bears, self._bore = np.maximum(share, self._bore), share
        bearing = np.clip((bears - BEARS[0]) / (BEARS[1] - BEARS[0]), 0.0, 1.0)
        low = places.reshape(2, -1, 3)[:, :, 2].min(axis=1)
        bearing = bearing * np.exp(-(((low - low.min()) / HIGH) ** 2))
        flat = np.linalg.norm(forces[:, :2], axis=1) / (weight * np.maximum(share, BEARS[0]))
        level = np.sqrt(STILL**2 + (LEVER * turning) ** 2 + (FLAT * np.minimum(flat, 1.0) ** 2) ** 2)
        upright = np.hypot(STILL, DOWN * turning)
        velocity.correct(by_feet, np.stack((level, level, upright), axis=1), bearing, passed)

    def _place(self, places: Array, share: Array) -> Array:
        """Place of the base, shape (3,) [m]; corners that stand keep theirs, others go with it."""
        place: Array = share @ (self._stand - places)
        place[2] = -places[:, 2].min()
        held = share / share.max()
        self._stand += (1.0 - held)[:, None] * (places + place - self._stand)
        return place

    def _deviation(self, velocity: CentroidalVelocity, height: float) -> Deviation:
        """Deviations of an estimate with the CoM so high over the ground [m]: joints tell all but the velocity."""
        speed = np.sqrt(np.diag(velocity.covariance))
        # Momentum is held at both ends of the load observer's span.
        force = math.sqrt(2.0) * self._mass * float(np.hypot(*speed[:2])) / SPAN
        return Deviation(np.zeros(3), speed, np.zeros(2), np.zeros(2), 0.0, force, height * force)


def _lowest(heights: Array) -> Array:
    """Shares of the corners of each sole by how low they are, of heights of shape (2, n) [-, m]."""
    share = np.exp((heights.min(axis=1, keepdims=True) - heights) / STANDING)
    shares: Array = share / share.sum(axis=1, keepdims=True)
    return shares
