"""Where the soles are from the IMU, how encoder zeros move them, and where the base is from the IMU.

Of soles that lean (see `surefoot.wbc.leaning`) the place is that of the line on which they stand: it stays where it is
while they turn about it.
"""

import numpy as np
import pinocchio as pin

from surefoot.values import dataclass
from surefoot.wbc.leaning import line_centre
from surefoot.wbc.model import cross
from surefoot.wbc.types import Array

_LOCAL = pin.ReferenceFrame.LOCAL


@dataclass(frozen=True, slots=True)
class ImuMount:
    """Where the IMU is; the default is the frame of the floating base.

    Attributes:
        body: frame of the model that carries it; None for the floating base.
        position: of its origin in that frame, shape (3,) [m].
        rotation: of its axes to that frame, shape (3, 3).
    """

    body: str | None = None
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class SensedBody:
    """Kinematics of a robot as its IMU sees it.

    Args:
        model: with a free-flyer base.
        soles: names of the sole frames, left first.
        mount: of the IMU.
        leaning: half width of soles that lean with their shanks; None for others [m].

    Attributes:
        leaning: as given.
        chain: indices of the joints between the IMU and the soles, shape (m,).
        position: of the soles in the frame of the IMU, shape (2, 3) [m].
        rotation: of the soles to the frame of the IMU, shape (2, 3, 3).

    Raises:
        ValueError: there is no such frame.
    """

    def __init__(self, model: pin.Model, soles: tuple[str, str], mount: ImuMount, leaning: float | None = None) -> None:
        for name in (*soles, *((mount.body,) if mount.body else ())):
            if not model.existFrame(name):
                raise ValueError(f"robot '{model.name}' has no frame '{name}'")
        self.model, self._data = model, model.createData()
        self._soles = tuple(model.getFrameId(name) for name in soles)
        self._placement = pin.SE3(np.array(mount.rotation), np.array(mount.position))
        self._carrier = model.getFrameId(mount.body) if mount.body else None
        self._behind = self._carrier is not None and model.frames[self._carrier].parentJoint != 1
        if self._carrier is not None:
            self._placement = model.frames[self._carrier].placement * self._placement
        parent = 1 if self._carrier is None else model.frames[self._carrier].parentJoint
        self._parent = parent
        self._at_base = not self._behind and self._placement.isIdentity(1e-12)
        self.chain = _between(model, parent, self._soles)
        self._q, self._v = pin.neutral(model), np.zeros(model.nv)
        self._imu = self._placement
        self.position, self.rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self.leaning, self._beside = leaning, np.zeros((2, 3))
        self.mass = float(sum(inertia.mass for inertia in model.inertias))

    @property
    def mount(self) -> tuple[Array, Array] | None:
        """Orientation, shape (3, 3), and place, shape (3,) [m], of the IMU in the base; None where joints move it."""
        return None if self._behind else (self._placement.rotation, self._placement.translation)

    def update(self, joints: Array, attitude: Array) -> None:
        """Take joint angles.

        Args:
            joints: shape (nj,) [rad].
            attitude: of the IMU in the world, by which soles that lean do so, shape (3, 3).
        """
        self._q[7:] = joints
        pin.forwardKinematics(self.model, self._data, self._q)
        if self._behind:
            self._imu = self._data.oMi[self._parent] * self._placement
        for k, frame in enumerate(self._soles):
            placed = pin.updateFramePlacement(self.model, self._data, frame)
            if not self._at_base:
                placed = self._imu.actInv(placed)
            self.position[k], self.rotation[k] = placed.translation, placed.rotation
            if self.leaning is not None:
                self._beside[k] = line_centre(k, np.zeros(3), attitude @ placed.rotation, self.leaning) @ attitude
                self.position[k] += self._beside[k]

    def offset_jacobians(self) -> Array:
        """From small turns of the joints of the chain to those of the soles, shape (2, 6, m) [m/rad, -].

        Both rows of the position and of the rotation vector are in the axes of the IMU. At the angles last taken.
        """
        model, data = self.model, self._data
        pin.computeJointJacobians(model, data)
        columns = 6 + self.chain
        base = np.zeros((6, len(columns)))
        if self._behind:
            carrier = pin.getJointJacobian(model, data, self._parent, _LOCAL)[:, columns]
            base = self._placement.toActionMatrixInverse() @ carrier
        found = np.empty((2, 6, len(columns)))
        for k, frame in enumerate(self._soles):
            R, p = self.rotation[k], self.position[k]
            sole = pin.getFrameJacobian(model, data, frame, _LOCAL)[:, columns]
            # What turns the IMU turns the sole the other way about it.
            turned = R @ sole[3:]
            found[k, :3] = R @ sole[:3] - base[:3] + pin.skew(p) @ base[3:]
            found[k, 3:] = turned - base[3:]
            if self.leaning is not None:
                found[k, :3] -= pin.skew(self._beside[k]) @ turned
        return found

    def com_jacobians(self, k: int) -> tuple[Array, Array, Array]:
        """The CoM from a sole, in axes of the IMU, after `offset_jacobians` at the same angles.

        Returns:
            its place from the sole's centre, shape (3,) [m]; that by the joints, shape (3, nj) [m/rad]; the same of the
            CoM from the floating base, shape (3, nj) [m/rad].
        """
        model, data = self.model, self._data
        J = pin.jacobianCenterOfMass(model, data, self._q, False)[:, 6:]
        placed = self._data.oMf[self._soles[k]]
        moved = pin.getFrameJacobian(model, data, self._soles[k], _LOCAL)[:, 6:]
        sole, to_imu = placed.rotation @ moved[:3], self._imu.rotation.T
        at = placed.translation
        if self.leaning is not None:
            beside = self._imu.rotation @ self._beside[k]
            at, sole = at + beside, sole - pin.skew(beside) @ placed.rotation @ moved[3:]
        return to_imu @ (data.com[0] - at), to_imu @ (J - sole), to_imu @ J

    def turning_inertia(self) -> tuple[float, float]:
        """What angular velocities make of moment of momentum about the CoM, at the angles last taken.

        Returns:
            that of the base about a horizontal axis, the greater one; the root sum of squares of all joints' [kg m^2].
        """
        A = pin.computeCentroidalMap(self.model, self._data, self._q)[3:5]
        return float(np.linalg.norm(A[:, 3:6], axis=1).max()), float(np.linalg.norm(A[:, 6:], axis=1).max())

    def turned_to_imu(self, turn: Array) -> Array | None:
        """A turn of the base in the axes of the IMU, shape (3,); None where joints are between them [rad/s]."""
        if self._at_base:
            return turn
        return None if self._behind else np.asarray(self._placement.rotation.T @ turn)

    def base(self, R: Array, p: Array, v: Array, rate: Array, q: Array, qd: Array) -> tuple[Array, Array, Array]:
        """The base from the IMU: orientation (3, 3), position (3,) [m], velocity in its axes (6,) [m/s, rad/s].

        Args:
            R: orientation of the IMU in the world, shape (3, 3).
            p: its position in the world, shape (3,) [m].
            v: its velocity in world axes, shape (3,) [m/s].
            rate: its angular velocity in its own axes, shape (3,) [rad/s].
            q: joint angles, shape (nj,) [rad].
            qd: joint velocities, shape (nj,) [rad/s].
        """
        if self._at_base:
            return R, p, np.concatenate((v @ R, rate))
        imu, turning, moving = self._placement, np.zeros(3), np.zeros(3)
        if self._behind:
            self._q[7:], self._v[6:] = q, qd
            pin.forwardKinematics(self.model, self._data, self._q, self._v)
            imu = self._data.oMi[self._parent] * self._placement
            motion, turned = self._data.v[self._parent], self._data.oMi[self._parent].rotation
            turning = turned @ motion.angular
            moving = turned @ (motion.linear + cross(motion.angular, self._placement.translation))
        base, lever = R @ imu.rotation.T, imu.translation
        spin = imu.rotation @ rate - turning
        velocity = base.T @ v - cross(spin, lever) - moving
        return base, p - base @ lever, np.concatenate((velocity, spin))


def _between(model: pin.Model, carrier: int, soles: tuple[int, ...]) -> Array:
    """Indices of the joints on the ways from a joint to the soles."""
    up = set(_ancestors(model, carrier))
    found: set[int] = set()
    for sole in soles:
        found |= up ^ set(_ancestors(model, model.frames[sole].parentJoint))
    return np.array(sorted(model.idx_vs[joint] - 6 for joint in found), dtype=np.intp)


def _ancestors(model: pin.Model, joint: int) -> list[int]:
    way = []
    while joint > 1:
        way.append(joint)
        joint = model.parents[joint]
    return way
