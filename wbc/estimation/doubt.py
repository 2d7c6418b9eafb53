"""How sure an estimate is: standard deviations of what planner and controller use, by the covariance of the filter."""

import math
from collections.abc import Callable

import numpy as np
import pinocchio as pin

from surefoot.native.library import library
from surefoot.wbc.estimation.contact import SoleContact
from surefoot.wbc.estimation.estimate import Deviation
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.kinematics import SensedBody
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.stand import AXES, OFFSETS, POSITION, TURN, VELOCITY
from surefoot.wbc.external import SPAN
from surefoot.wbc.types import GRAVITY, Array

LASTS = 3.0
"""By how much more counts what does not change from span to span: no median takes it out, as it does noise [-]."""


class Doubt:
    """Standard deviations of an estimate.

    Args:
        body: kinematics of the robot.
        sensors: noise of the sensors.
        rate_noise: standard deviation of a joint's velocity [rad/s].
    """

    def __init__(self, body: SensedBody, sensors: SensorNoise, rate_noise: float) -> None:
        self._body, self._sensors, self._rate_noise = body, sensors, rate_noise
        self._weight = GRAVITY * body.mass
        self._turning: tuple[float, float] | None = None
        self._lever, self._variance = np.zeros(3), np.zeros(11)
        self._tell: Callable[[int, float], None] | None = None
        self._of: InvariantFilter | None = None

    def deviation(self, filter_: InvariantFilter, contact: SoleContact, gyro: float, J: Array) -> Deviation:
        """Deviations now.

        Args:
            filter_: of the state.
            contact: of the soles.
            gyro: standard deviation of the angular velocity [rad/s].
            J: Jacobians of the soles, as of `SensedBody.offset_jacobians`.
        """
        force = contact.wrench[:, 2]
        stance = int(force[1] > force[0])
        if filter_ is not self._of:
            self._of, self._tell = filter_, self._compiled(filter_)
        if self._tell is None:
            lever, variance = self._plain(filter_, stance, gyro, J)
        else:
            self._body.place_com()
            self._tell(stance, gyro)
            lever, variance = self._lever, self._variance
        deviation = np.sqrt(variance)
        com, heights, apart, tilt = deviation[:3], deviation[3:5], deviation.item(5), deviation[6:8]
        speed, up = deviation[8:], float(lever @ filter_.stand.R[2])
        load = self._of_load(float(speed[:2].max()), float(com[:2].max()), float(tilt.max()), up, gyro, contact)
        return Deviation(com, speed, tilt, heights, apart, *load)

    def _compiled(self, filter_: InvariantFilter) -> Callable[[int, float], None] | None:
        kernels, body, s = library(), self._body.compiled, filter_.stand
        if kernels is None or body is None:
            return None
        tell: Callable[[int, float], None] = kernels.bind(
            "doubt_tell",
            body=body,
            covariance=kernels.fill(
                "Covariance", filter=kernels.fill("Filter", size=len(filter_.P), R=s.R, columns=s.columns), P=filter_.P
            ),
            encoder_offset=self._sensors.encoder_offset,
            rate_noise=self._rate_noise,
            rows=np.zeros((8, len(filter_.P))),
            lever=self._lever,
            variance=self._variance,
        )
        return tell

    def _plain(self, filter_: InvariantFilter, stance: int, gyro: float, J: Array) -> tuple[Array, Array]:
        """Lever of the CoM from the stance sole in axes of the IMU, and variances of what `deviation` says.

        Of the CoM, the soles' heights, one over the other, the base's tilt and the CoM velocity, shape (11,).
        """
        body, sensors, s, P = self._body, self._sensors, filter_.stand, filter_.P
        lever, by_joints, moving = body.com_jacobians(stance)
        by_joints = s.R @ by_joints
        rows = np.zeros((8, len(P)))
        rows[:3, TURN] = -pin.skew(s.R @ lever)
        rows[:3, OFFSETS] = np.hstack((-by_joints[:, body.chain], s.R @ pin.skew(lever)))
        for k in (0, 1):
            rows[3 + k, TURN] = -pin.skew(s.R @ body.position[k] + s.p)[2]
            rows[3 + k, POSITION.stop - 1] = 1.0
            rows[3 + k, OFFSETS] = -s.R[2] @ J[k, :3]
        rows[5] = rows[3] - rows[4]
        rows[6:, TURN], rows[6:, -AXES:] = np.eye(3)[:2], -s.R[:2]
        place = np.maximum(np.einsum("ij,jk,ik->i", rows, P, rows), 0.0)
        by_joints[:, body.chain] = 0.0
        place[:3] += (by_joints**2).sum(axis=1) * sensors.encoder_offset**2
        arm = s.R @ (body.position[stance] + lever)
        # A turn about an axis moves the CoM as far as it is beside that.
        turned = (float(arm @ arm) - arm**2) * gyro**2
        moved = ((s.R @ moving) ** 2).sum(axis=1) * self._rate_noise**2
        return lever, np.concatenate((place, np.diagonal(P)[VELOCITY] + moved + turned))

    def _of_load(
        self, speed: float, com: float, tilt: float, height: float, gyro: float, contact: SoleContact
    ) -> tuple[float, float]:
        """Deviations of the force and the moment that the load observer sees within its span."""
        if self._turning is None:
            self._turning = self._body.turning_inertia()
        whole, joints = self._turning
        force, moment = contact.deviation
        bias = LASTS * math.sqrt(2.0) * contact.bias
        # Momentum and moment of momentum are held at both ends of a span.
        twice = math.sqrt(2.0) / SPAN
        shaken = self._body.mass * twice * speed
        spun = twice * math.hypot(whole * gyro, joints * self._rate_noise)
        leaning = LASTS * self._weight * tilt
        wrong = LASTS * self._weight * com
        return (
            math.hypot(shaken, force, leaning, bias),
            math.hypot(spun, moment, force * height, wrong, leaning * height, bias * height),
        )
