"""Where the soles are from the IMU, how encoder zeros move them, where the base is, and how a robot stands at first.

Of soles that lean (see `surefoot.wbc.leaning`) the place is that of the line on which they stand: it stays where it is
while they turn about it.
"""

import math
from collections.abc import Callable

import numpy as np
import pinocchio as pin

from surefoot.mimic import JointColumns
from surefoot.native.library import Bound, Library, library
from surefoot.values import dataclass
from surefoot.wbc.estimation.stand import AXES
from surefoot.wbc.leaning import line_centre
from surefoot.wbc.model import cross
from surefoot.wbc.types import Array

ROUNDS = 4
"""Rounds in which the attitude over soles that lean is found."""


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
        compiled: it as kernels take it; None for plain Python.
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
        self._columns = JointColumns(model, self._data)
        self._soles = tuple(model.getFrameId(name) for name in soles)
        self._placement = pin.SE3(np.array(mount.rotation), np.array(mount.position))
        self._carrier = model.getFrameId(mount.body) if mount.body else None
        self._behind = self._carrier is not None and model.frames[self._carrier].parentJoint != 1
        if self._carrier is not None:
            self._placement = model.frames[self._carrier].placement * self._placement
        parent = 1 if self._carrier is None else model.frames[self._carrier].parentJoint
        self._parent = parent
        turned = not np.allclose(self._placement.rotation, np.eye(3), rtol=0.0, atol=1e-12)
        self._to_imu = np.ascontiguousarray(self._placement.rotation.T) if turned else None
        self.chain = _between(model, parent, self._soles)
        self._q, self._v = pin.neutral(model), np.zeros(model.nv)
        self._imu_rotation, self._imu_position = self._placement.rotation.copy(), self._placement.translation.copy()
        self._mounting = np.zeros(AXES)
        self.position, self.rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self._jacobian = np.zeros((2, 6, len(self.chain) + AXES))
        self._jacobian[:, 3:, -AXES:] = np.eye(3)
        self._supporting = supporting(model, (*(model.frames[sole].parentJoint for sole in self._soles), parent))
        self.leaning, self._beside = leaning, np.zeros((2, 3))
        self.mass = float(sum(inertia.mass for inertia in model.inertias))
        # Which of its edges a leaning sole is on, only Python knows.
        kernels = library() if leaning is None else None
        self.compiled = self._bound(kernels) if kernels else None
        if kernels and self.compiled:
            self._place = kernels.bind("sensed_body_update", self.compiled)
            self._move = kernels.bind("sensed_body_jacobians", self.compiled)

    def _bound(self, kernels: Library) -> Bound:
        model, data, imu = self.model, self._data, self._data.oMi[self._parent]
        left, right = (sole_of(kernels, model, data, frame) for frame in self._soles)
        return kernels.fill(
            "SensedBody",
            joints=model.nv - 6,
            chain_count=len(self.chain),
            chain=self.chain,
            supporting=self._supporting,
            imu_joint_rotation_columns=imu.rotation.T,
            imu_joint_position=imu.translation,
            mount_rotation=np.ascontiguousarray(self._placement.rotation),
            mount_position=np.array(self._placement.translation),
            mounting=self._mounting,
            left=left,
            right=right,
            joint_jacobian_columns=self._columns.values.T,
            com=data.com[0],
            com_jacobian_columns=data.Jcom.T,
            imu_rotation=self._imu_rotation,
            imu_position=self._imu_position,
            position=self.position,
            rotation=self.rotation,
            jacobian=self._jacobian,
        )

    @property
    def mount(self) -> tuple[Array, Array] | None:
        """Orientation, shape (3, 3), and place, shape (3,) [m], of the IMU in the base; None where joints move it."""
        return None if self._behind else (self._placement.rotation, self._placement.translation)

    def known(self, joints: Array, offsets: Array) -> Array:
        """Angles that encoders say, shape (nj,), less what their zeros are known to be off [rad]."""
        known = joints.copy()
        known[self.chain] -= offsets[:-AXES]
        return known

    def update(self, joints: Array, attitude: Array, offsets: Array | None = None) -> None:
        """Take joint angles.

        Args:
            joints: shape (nj,) [rad].
            attitude: of the IMU in the world, by which soles that lean do so, shape (3, 3).
            offsets: what is known of those of the chain and of the mount, shape (m + 3,); None where nothing is [rad].
        """
        self._mounting[:] = 0.0 if offsets is None else offsets[-AXES:]
        self._q[7:] = joints if offsets is None else self.known(joints, offsets)
        pin.forwardKinematics(self.model, self._data, self._q)
        if self.compiled is not None:
            self._place()
            return
        imu = self._mounted(self._mounting)
        if self._behind:
            imu = self._data.oMi[self._parent] * imu
        self._imu_rotation[:], self._imu_position[:] = imu.rotation, imu.translation
        for k, frame in enumerate(self._soles):
            placed = imu.actInv(pin.updateFramePlacement(self.model, self._data, frame))
            self.position[k], self.rotation[k] = placed.translation, placed.rotation
            if self.leaning is not None:
                self._beside[k] = line_centre(k, np.zeros(3), attitude @ placed.rotation, self.leaning) @ attitude
                self.position[k] += self._beside[k]

    def _mounted(self, turn: Array) -> pin.SE3:
        """The IMU in what carries it, turned by that about its own axes, shape (3,) [rad]."""
        return pin.SE3(self._placement.rotation @ pin.exp3(turn), self._placement.translation)

    def offset_jacobians(self) -> Array:
        """From small turns of the joints of the chain, and of offsets of the mount, to those of the soles.

        An IMU that is turned further sees the soles turned back, as a joint at its origin would turn them.

        Returns:
            shape (2, 6, m + 3) [m/rad, -]. Both rows of the position and of the rotation vector are in the axes of the
            IMU. At the angles last taken; the next call writes over them.
        """
        pin.computeJointJacobians(self.model, self._data)
        self._columns.update()
        if self.compiled is not None:
            self._move()
            return self._jacobian
        carries, R = self._supporting[:2] - self._supporting[2], self._imu_rotation
        for k in (0, 1):
            # What carries both moves neither against the other, and what carries the IMU turns the sole the other way.
            moved = (carries[k] * self._motion(self._in_base(k)))[:, self.chain]
            self._jacobian[k, :3, :-AXES], self._jacobian[k, 3:, :-AXES] = R.T @ moved[:3], R.T @ moved[3:]
            self._jacobian[k, :3, -AXES:] = -pin.skew(self.position[k])
        return self._jacobian

    def _in_base(self, k: int) -> Array:
        """A sole's centre in the base's frame, shape (3,) [m]."""
        at: Array = self._imu_position + self._imu_rotation @ self.position[k]
        return at

    def _motion(self, at: Array) -> Array:
        """How joints move a point of the base's frame, shape (3,) [m], fixed to what they carry, shape (6, nj)."""
        J = self._columns.values[:, 6:]
        found: Array = np.vstack((J[:3] - pin.skew(at) @ J[3:], J[3:]))
        return found

    def com_jacobians(self, k: int) -> tuple[Array, Array, Array]:
        """The CoM from a sole, in axes of the IMU, after `offset_jacobians` at the same angles.

        Returns:
            its place from the sole's centre, shape (3,) [m]; that by the joints, shape (3, nj) [m/rad]; the same of the
            CoM from the floating base, shape (3, nj) [m/rad].
        """
        self.place_com()
        com, J, to_imu = self._data.com[0], self._data.Jcom[:, 6:], self._imu_rotation.T
        at = self._in_base(k)
        sole = self._supporting[k] * self._motion(at)[:3]
        return to_imu @ (com - at), to_imu @ (J - sole), to_imu @ J

    def place_com(self) -> None:
        """Let Pinocchio compute the CoM and its Jacobian, after `offset_jacobians`."""
        pin.jacobianCenterOfMass(self.model, self._data, False)

    def turning_inertia(self) -> tuple[float, float]:
        """What angular velocities make of moment of momentum about the CoM, at the angles last taken.

        Returns:
            that of the base about a horizontal axis, the greater one; the root sum of squares of all joints' [kg m^2].
        """
        A = pin.computeCentroidalMap(self.model, self._data, self._q)[3:5]
        return float(np.linalg.norm(A[:, 3:6], axis=1).max()), float(np.linalg.norm(A[:, 6:], axis=1).max())

    def turned_to_imu(self, turn: Array) -> Array | None:
        """A turn of the base in the axes of the IMU, shape (3,); None where joints are between them [rad/s]."""
        if self._behind:
            return None
        return turn if self._to_imu is None else np.asarray(self._to_imu @ turn)

    def base(
        self, R: Array, p: Array, v: Array, rate: Array, q: Array, qd: Array, mounting: Array
    ) -> tuple[Array, Array, Array]:
        """The base from the IMU: orientation (3, 3), position (3,) [m], velocity in its axes (6,) [m/s, rad/s].

        Args:
            R: orientation of the IMU in the world, shape (3, 3).
            p: its position in the world, shape (3,) [m].
            v: its velocity in world axes, shape (3,) [m/s].
            rate: its angular velocity in its own axes, shape (3,) [rad/s].
            q: joint angles, shape (nj,) [rad].
            qd: joint velocities, shape (nj,) [rad/s].
            mounting: offsets of the mount, shape (3,) [rad].
        """
        imu, turning, moving = self._mounted(mounting), np.zeros(3), np.zeros(3)
        if self._behind:
            self._q[7:], self._v[6:] = q, qd
            pin.forwardKinematics(self.model, self._data, self._q, self._v)
            imu = self._data.oMi[self._parent] * imu
            motion, turned = self._data.v[self._parent], self._data.oMi[self._parent].rotation
            turning = turned @ motion.angular
            moving = turned @ (motion.linear + cross(motion.angular, self._placement.translation))
        base, lever = R @ imu.rotation.T, imu.translation
        spin = imu.rotation @ rate - turning
        velocity = base.T @ v - cross(spin, lever) - moving
        return base, p - base @ lever, np.concatenate((velocity, spin))


@dataclass(frozen=True, slots=True)
class Footing:
    """Soles on the ground.

    Attributes:
        position: sole centres in the world, left first, shape (2, 3) [m].
        yaw: headings of the soles, shape (2,) [rad].
        half_size: half of a sole's length and width [m].
        height: of the ground at x and y [m].
        normal: of the ground at x and y [m], a unit vector, shape (3,).
        leaning: half width of soles that lean with their shanks, of which position has the lines on which they stand;
            None for others [m].
    """

    position: Array
    yaw: Array
    half_size: tuple[float, float]
    height: Callable[[float, float], float]
    normal: Callable[[float, float], Array]
    leaning: float | None = None

    def normals(self) -> Array:
        """Of the ground under the soles, shape (2, 3)."""
        return np.stack([self.normal(*place[:2].tolist()) for place in self.position])

    def attitude(self, body: SensedBody, joints: Array) -> Array:
        """Orientation of the IMU in the world over level soles, shape (3, 3); the body is left at these joints.

        Args:
            body: kinematics of the robot.
            joints: their angles, shape (nj,) [rad].
        """
        body.update(joints, np.eye(3))
        level = [_level(float(yaw), normal) for yaw, normal in zip(self.yaw, self.normals(), strict=True)]
        turned = [level[k] @ body.rotation[k].T for k in (0, 1)]
        R: Array = turned[0] @ pin.exp3(0.5 * pin.log3(turned[0].T @ turned[1]))
        return R if self.leaning is None else self._leaning(body, joints, R, level)

    def _leaning(self, body: SensedBody, joints: Array, R: Array, level: list[Array]) -> Array:
        """Over soles that lean: their lines are level, and so is the way from one to the other; R is a first guess."""
        left, right = self.position
        apart = (left - right) / np.linalg.norm(left - right)
        for _ in range(ROUNDS):
            # Which edges are the lines follows from how the soles lean.
            body.update(joints, R)
            across = body.position[0] - body.position[1]
            seen = np.stack((body.rotation[0, :, 0], body.rotation[1, :, 0], across / np.linalg.norm(across)))
            U, _, V = np.linalg.svd(np.stack((level[0][:, 0], level[1][:, 0], apart)).T @ seen)
            R = U @ np.diag([1.0, 1.0, float(np.linalg.det(U @ V))]) @ V
        return R


def _level(yaw: float, up: Array) -> Array:
    """Orientation of a sole with a heading, flat on ground with a normal, shape (3, 3)."""
    ahead = np.array([math.cos(yaw), math.sin(yaw), 0.0])
    side = np.cross(up, ahead)
    side /= np.linalg.norm(side)
    return np.column_stack((np.cross(side, up), side, up))


def _between(model: pin.Model, carrier: int, soles: tuple[int, ...]) -> Array:
    """Indices of the joints on the ways from a joint to the soles."""
    up = set(_ancestors(model, carrier))
    found: set[int] = set()
    for sole in soles:
        found |= up ^ set(_ancestors(model, model.frames[sole].parentJoint))
    return np.array(sorted({model.idx_vs[joint] - 6 for joint in found}), dtype=np.intp)


def sole_of(kernels: Library, model: pin.Model, data: pin.Data, number: int) -> Bound:
    """A sole as kernels take it, by its frame."""
    frame = model.frames[number]
    joint = data.oMi[frame.parentJoint]
    return kernels.fill(
        "SensedSole",
        joint_rotation_columns=joint.rotation.T,
        joint_position=joint.translation,
        placement_rotation=np.ascontiguousarray(frame.placement.rotation),
        placement_position=np.array(frame.placement.translation),
    )


def supporting(model: pin.Model, carriers: tuple[int, ...]) -> Array:
    """Which joints carry what is on some joints: 1 or 0, shape (carriers, nj)."""
    found = np.zeros((len(carriers), model.nv - 6))
    for row, carrier in zip(found, carriers, strict=True):
        row[[model.idx_vs[joint] - 6 for joint in _ancestors(model, carrier)]] = 1.0
    return found


def _ancestors(model: pin.Model, joint: int) -> list[int]:
    way = []
    while joint > 1:
        way.append(joint)
        joint = model.parents[joint]
    return way
