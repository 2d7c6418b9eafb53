"""The floating base, and with it the robot's whole state now, by the IMU that is fixed to it.

An IMU with the orientation R_b and the place r in the base, whose own orientation, place, velocity and angular velocity
are R, p, v and ω, has the base at

    R R_bᵀ,   p - R R_bᵀ r,   with the velocity   R_b Rᵀ v - (R_b ω) x r,   R_b ω   in its own axes.

Readings are late. What the base was planned to gain since, Δ, it has gained evenly: its way is T (velocity + Δ/2), with
its translation in the axes half way through the turn.
"""

import numpy as np

from surefoot import algebra, linear
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import Array, RobotState

FASTEST, FARTHEST = 300.0, 1e5
"""Speed, of base and joints together, and place beyond which an estimate has diverged [m/s, rad/s, m]."""


class FloatingBase:
    """The base of a robot whose IMU no joint moves against it.

    Args:
        stand: state of the filter, whose arrays stay where they are.
        mount: orientation of the IMU in the base, shape (3, 3), and its place there, shape (3,) [m].
        chain: joints of which the filter finds the zeros, shape (m,); the offsets after these are of the mount.
        rate: angular velocity of the IMU with its bias, in an array that stays likewise, shape (3,) [rad/s].
        joints: how many there are.

    Attributes:
        q: configuration, shape (7 + nj,) [m, -, rad].
        v: velocity, shape (6 + nj,) [m/s, rad/s].
    """

    def __init__(self, stand: Stand, mount: tuple[Array, Array], chain: Array, rate: Array, joints: int) -> None:
        self._stand, self._chain, self._rate = stand, chain, rate
        self._mount, self._lever = np.ascontiguousarray(mount[0]), np.array(mount[1])
        self._R, self._mounted, self._turn, self._half = (np.zeros((3, 3)) for _ in range(4))
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
        self._place()
        if gained is not None and late > 0.0:
            self._go_on(gained, late)
        self._join(position, velocity)
        return RobotState(self.q.copy(), self.v.copy()) if self._is_near() else None

    def _place(self) -> None:
        """The base at the time of the readings, its orientation in `_R`."""
        s, R, mounted, lever = self._stand, self._R, self._mounted, algebra.vector(self._lever)
        algebra.rotation_of(algebra.vector(s._offsets[len(self._chain) :]), self._turn)
        algebra.compose(self._mount, self._turn, mounted)
        linear.row_products(s._R, mounted, R)
        spin = algebra.rotate(mounted, algebra.subtract(algebra.vector(self._rate), algebra.vector(s._gyro_bias)))
        speed = algebra.rotate_back(R, algebra.row(s._columns, 0))
        algebra.put(self._q, algebra.subtract(algebra.row(s._columns, 1), algebra.rotate(R, lever)))
        algebra.put(self._v, algebra.subtract(speed, algebra.cross(spin, lever)))
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

    def _join(self, position: Array, velocity: Array) -> None:
        """Add the base's quaternion, and the joints: encoders less what their zeros are known to be off."""
        algebra.quaternion(self._R, self._q[3:])
        for i in range(len(position)):
            self._q[7 + i] = position[i]
            self._v[6 + i] = velocity[i]
        for i in range(len(self._chain)):
            self._q[7 + self._chain[i]] -= self._stand._offsets[i]

    def _is_near(self) -> bool:
        """Whether place and speed are those of a robot; nothing that is not finite is less than a number."""
        place = self._q[:7]
        return linear.dot(place, place) < self._farthest and linear.dot(self._v, self._v) < self._fastest
