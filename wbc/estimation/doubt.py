"""Standard deviations of the estimates that planner and controller use, by the covariance of the filter."""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.maths.algebra import Vector
from surefoot.wbc.contact.external import SPAN
from surefoot.wbc.estimation import stand
from surefoot.wbc.estimation.contact import SoleContact
from surefoot.wbc.estimation.estimate import Deviation
from surefoot.wbc.estimation.kinematics import SensedBody
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import GRAVITY, Array

LASTS = 3.0
"""Weight of what does not change from span to span: no median takes it out, as it does noise [-]."""


class Doubt:
    """Standard deviations of an estimate.

    An estimate is linear in the error ξ of the filter, whose covariance is P: it has the variance r' P r for the row r
    that it makes of ξ. A turn ξ_R moves a point x by ξ_R x, and an offset moves it as its joint does, the other way.

    Args:
        body: kinematics of the robot.
        sensors: noise of the sensors.
        rate_noise: standard deviation of a joint's velocity [rad/s].
        state: of the filter, whose arrays stay where they are.
        P: covariance of its error, in an array that stays where it is, shape (n, n).

    Attributes:
        lever: the CoM from the stance sole's centre, in axes of the IMU, as last looked at [m].
    """

    def __init__(self, body: SensedBody, sensors: SensorNoise, rate_noise: float, state: Stand, P: Array) -> None:
        self._body, self._rate_noise, self._encoder_offset = body, rate_noise, sensors.encoder_offset
        self._weight = GRAVITY * body.mass
        self._turning: tuple[float, float] | None = None
        self._R, self._columns, self._P = state.R, state.columns, P
        self._position, self._jacobian, self._to_world = body.position, body.jacobian, np.zeros((3, 3))
        self._joints, self._chain, self._rows = body.model.nv - 6, body.chain, np.zeros((8, len(P)))
        self.lever = self._by_others = self._by_rates = (0.0, 0.0, 0.0)
        self._variances = np.zeros(11)
        self._variance = self._variances

    def deviation(self, contact: SoleContact, gyro: float) -> Deviation:
        """Deviations now, after `SensedBody.offset_jacobians` at the same angles.

        Args:
            contact: of the soles.
            gyro: standard deviation of the angular velocity [rad/s].
        """
        self.look(1 if contact.wrench[1, 2] > contact.wrench[0, 2] else 0, gyro)
        deviation = np.sqrt(self._variances)
        com = deviation[:3]
        heights = deviation[3:5]
        apart = deviation.item(5)
        tilt = deviation[6:8]
        speed, up = deviation[8:], algebra.inner(self.lever, algebra.row(self._R, 2))
        load = self._of_load(float(speed[:2].max()), float(com[:2].max()), float(tilt.max()), up, gyro, contact)
        return Deviation(com, speed, tilt, heights, apart, *load)

    def look(self, stance: int, gyro: float) -> Array:
        """Variances of the CoM, the soles' heights, one over the other, the base's tilt and the CoM velocity.

        Args:
            stance: sole from which the CoM is seen.
            gyro: standard deviation of the angular velocity [rad/s].

        Returns:
            shape (11,); the next call writes over them.
        """
        self._body.place_com()
        self._rows[:] = 0.0
        self._of_joints(stance)
        arm = algebra.rotate(self._R, self.lever)
        self._of_com(arm)
        self._of_heights()
        self._of_tilt()
        for a in range(8):
            found = linear.quadratic(self._P, self._rows[a])
            self._variance[a] = found if found > 0.0 else 0.0
        reach = algebra.add(algebra.rotate(self._R, algebra.row(self._position, stance)), arm)
        self._add_noise(reach, gyro)
        return self._variances

    def _of_joints(self, stance: int) -> None:
        """Lever of the CoM, and how joints move it: those of the chain by the filter's offsets, others by their own."""
        body = self._body
        body.to_world(self._R, self._to_world)
        at = body.in_base(stance)
        self.lever = body.com_from(at)
        self._by_others = self._by_rates = (0.0, 0.0, 0.0)
        c = 0
        for j in range(self._joints):
            moved = body.com_by(j)
            own = algebra.subtract(moved, algebra.scale(body.carries(j, stance), body.moved_by(j, at)))
            by = algebra.rotate(self._to_world, own)
            rate = algebra.rotate(self._to_world, moved)
            self._by_rates = algebra.add(self._by_rates, algebra.squares(rate))
            if c < len(self._chain) and self._chain[c] == j:
                algebra.put_column(self._rows, stand.OFFSETS_AT + c, algebra.scale(-1.0, by))
                c += 1
            else:
                self._by_others = algebra.add(self._by_others, algebra.squares(by))

    def _of_com(self, arm: Vector) -> None:
        """Rows of the CoM over the stance sole: less the cross product with its arm, and the mount's offsets."""
        x, y, z = arm
        algebra.put_row(self._rows, 0, (0.0, z, -y), stand.TURN_AT)
        algebra.put_row(self._rows, 1, (-z, 0.0, x), stand.TURN_AT)
        algebra.put_row(self._rows, 2, (y, -x, 0.0), stand.TURN_AT)
        for i in range(3):
            turned = algebra.cross(algebra.row(self._R, i), self.lever)
            algebra.put_row(self._rows, i, turned, stand.OFFSETS_AT + len(self._chain))

    def _of_heights(self) -> None:
        """Rows of the soles' heights, and of one over the other."""
        for k in range(2):
            foot = algebra.rotate(self._R, algebra.row(self._position, k))
            x, y, _ = algebra.add(foot, algebra.row(self._columns, 1))
            algebra.put_row(self._rows, 3 + k, (y, -x, 0.0), stand.TURN_AT)
            self._rows[3 + k, stand.POSITION_AT + 2] = 1.0
            for c in range(len(self._chain) + 3):
                by = algebra.column(self._jacobian[k], c)
                self._rows[3 + k, stand.OFFSETS_AT + c] = -algebra.inner(algebra.row(self._R, 2), by)
        for i in range(self._rows.shape[1]):
            self._rows[5, i] = self._rows[3, i] - self._rows[4, i]

    def _of_tilt(self) -> None:
        """Rows of the base's roll and pitch, which are those of the IMU less the mount's offsets."""
        mount = stand.OFFSETS_AT + len(self._chain)
        self._rows[6, stand.TURN_AT] = self._rows[7, stand.TURN_AT + 1] = 1.0
        algebra.put_row(self._rows, 6, algebra.scale(-1.0, algebra.row(self._R, 0)), mount)
        algebra.put_row(self._rows, 7, algebra.scale(-1.0, algebra.row(self._R, 1)), mount)

    def _add_noise(self, reach: Vector, gyro: float) -> None:
        """Add what no state of the filter tells, of a CoM at that place from the IMU [m]."""
        far, squares = algebra.inner(reach, reach), algebra.squares(reach)
        # A turn about an axis moves the CoM as far as it is beside that.
        beside = algebra.subtract((far, far, far), squares)
        offsets = algebra.scale(algebra.square(self._encoder_offset), self._by_others)
        rates = algebra.scale(algebra.square(self._rate_noise), self._by_rates)
        turns = algebra.scale(algebra.square(gyro), beside)
        v = stand.VELOCITY_AT
        speed = (self._P[v, v], self._P[v + 1, v + 1], self._P[v + 2, v + 2])
        place = algebra.add(algebra.vector(self._variance), offsets)
        algebra.put(self._variance, place)
        algebra.put(self._variance[8:], algebra.add(algebra.add(speed, rates), turns))

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
