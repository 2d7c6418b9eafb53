"""The floating base, and with it the robot's whole state, by the IMU.

An IMU with the orientation R_b and the place r in the base, whose own orientation, place, velocity and angular velocity
are R, p, v and ω, and which joints turn by ω_b and move by v_b against the base, has the base at

    R R_bᵀ,   p - R R_bᵀ r,   with the velocity   R_b Rᵀ v - (R_b ω - ω_b) x r - v_b,   R_b ω - ω_b   in its own axes.

Readings are late. What the base was planned to gain since, Δ, it has gained evenly: its way is T (velocity + Δ/2), with
its translation in the axes half way through the turn.
"""

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.maths.algebra import Vector
from surefoot.wbc.estimation.kinematics import SensedBody
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import Array, RobotState

FASTEST, FARTHEST = 300.0, 1e5
"""Speed, of base and joints together, and place beyond which an estimate has diverged [m/s, rad/s, m]."""


class FloatingBase:
    """The base of a robot, by the IMU and the joints.

    Args:
        stand: state of the filter, whose arrays stay where they are.
        body: kinematics of the robot.
        rate: angular velocity of the IMU with its bias, in an array that stays where it is, shape (3,) [rad/s].

    Attributes:
        q: configuration, shape (7 + nj,) [m, -, rad].
        v: velocity, shape (6 + nj,) [m/s, rad/s].
    """

    def __init__(self, stand: Stand, body: SensedBody, rate: Array) -> None:
        self._stand = stand
        self._body = body
        self._chain = body.chain
        self._rate = rate
        self._R, self._turn, self._half = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
        joints = body.model.nv - 6
        self.q, self.v = np.zeros(7 + joints), np.zeros(6 + joints)
        self._q, self._v = self.q, self.v
        self._farthest, self._fastest = FARTHEST * FARTHEST, FASTEST * FASTEST

    def state(self, position: Array, velocity: Array, gained: Array | None, late: float) -> RobotState | None:
        """State of the robot now; None of one that has diverged.

        Args:
            position: of the joints by their encoders, shape (nj,) [rad].
            velocity: of the joints, shape (nj,) [rad/s].
            gained: what the base was planned to gain since the readings, shape (6,) [m/s, rad/s]; None of new ones.
            late: how old they are [s].
        """
        self._place(position, velocity, algebra.row(self._stand._columns, 0), algebra.vector(self._rate))
        if gained is not None and late > 0.0:
            self._go_on(gained, late)
        algebra.quaternion(self._R, self._q[3:])
        return RobotState(self.q.copy(), self.v.copy()) if self._is_near() else None

    def seen(self, position: Array, velocity: Array, v: Vector, rate: Vector) -> RobotState:
        """State of the robot at another time, with what the filter knows of places.

        Args:
            position: of the joints by their encoders, shape (nj,) [rad].
            velocity: of the joints, shape (nj,) [rad/s].
            v: velocity of the IMU in the world [m/s].
            rate: its angular velocity with its bias, in its own axes [rad/s].
        """
        self._place(position, velocity, v, rate)
        algebra.quaternion(self._R, self._q[3:])
        return RobotState(self.q.copy(), self.v.copy())

    def _place(self, position: Array, velocity: Array, v: Vector, rate: Vector) -> None:
        """The joints, whose encoders' zeros are known to be off, and the base, its orientation in `_R`."""
        s, body, m = self._stand, self._body, len(self._chain)
        self._q[7:] = position
        self._v[6:] = velocity
        for i in range(m):
            self._q[7 + self._chain[i]] -= s._offsets[i]
        body.carry(self._q[7:], self._v[6:], algebra.vector(s._offsets[m:]))
        linear.row_products(s._R, body.carried, self._R)
        own = algebra.rotate(body.carried, algebra.subtract(rate, algebra.vector(s._gyro_bias)))
        spin = algebra.subtract(own, body.turning)
        speed = algebra.subtract(algebra.rotate_back(self._R, v), algebra.cross(spin, body.lever))
        algebra.put(self._q, algebra.subtract(algebra.row(s._columns, 1), algebra.rotate(self._R, body.lever)))
        algebra.put(self._v, algebra.subtract(speed, body.moving))
        algebra.put(self._v[3:], spin)

    def _go_on(self, gained: Array, late: float) -> None:
        """The base after its readings, by what it was planned to gain."""
        R, half = self._R, self._half
        speed, spin = algebra.vector(self._v), algebra.vector(self._v[3:])
        faster, turned = algebra.vector(gained), algebra.vector(gained[3:])
        way = algebra.scale(late, algebra.add(speed, algebra.scale(0.5, faster)))
        turn = algebra.scale(late, algebra.add(spin, algebra.scale(0.5, turned)))
        algebra.rotation_of(algebra.scale(0.5, turn), self._turn)
        algebra.compose(R, self._turn, half)
        algebra.compose(half, self._turn, R)
        algebra.put(self._q, algebra.add(algebra.vector(self._q), algebra.rotate(half, way)))
        algebra.put(self._v, algebra.add(speed, faster))
        algebra.put(self._v[3:], algebra.add(spin, turned))

    def _is_near(self) -> bool:
        """Return true if place and speed are those of a robot; nothing that is not finite is less than a number."""
        place = self._q[:7]
        return linear.dot(place, place) < self._farthest and linear.dot(self._v, self._v) < self._fastest
