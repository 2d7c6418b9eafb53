"""The places of the soles from the IMU, their motion by encoder zeros, and the place of the base.

Of soles that lean (see `surefoot.wbc.body.leaning`) the place is that of the line on which they stand, of soles that
roll that of their edge: it stays where it is while they turn about it.
"""

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import JointColumns
from surefoot.maths import algebra, linear
from surefoot.maths.algebra import Vector
from surefoot.wbc.body.leaning import line_centre
from surefoot.wbc.estimation.footing import ImuMount
from surefoot.wbc.estimation.stand import AXES
from surefoot.wbc.types import Array


class Sole:
    """A sole in the base's frame, by the pose that Pinocchio has of its joint.

    Args:
        model: of the robot, with a free-flyer base.
        data: of Pinocchio, with the base in the world's frame.
        frame: number of the sole's.

    Attributes:
        rotation: to the base's axes, as last placed, shape (3, 3).
        position: of its centre, as last placed [m].
    """

    def __init__(self, model: pin.Model, data: pin.Data, frame: int) -> None:
        joint, placement = data.oMi[model.frames[frame].parentJoint], model.frames[frame].placement
        self._data, self._joint_rotation, self._joint_position = data, joint.rotation, joint.translation
        self._placed_rotation = np.ascontiguousarray(placement.rotation)
        self._placed_position = algebra.vector(np.array(placement.translation))
        self.rotation, self.position = np.zeros((3, 3)), (0.0, 0.0, 0.0)

    def place(self) -> None:
        """Take where its joint is now."""
        algebra.compose(self._joint_rotation, self._placed_rotation, self.rotation)
        offset = algebra.rotate(self._joint_rotation, self._placed_position)
        self.position = algebra.add(offset, algebra.vector(self._joint_position))


class SensedBody:
    """Kinematics of a robot as its IMU sees it.

    Args:
        model: with a free-flyer base.
        soles: names of the sole frames, left first.
        mount: of the IMU.
        leaning: half width of soles that lean with their shanks; None for others [m].

    Attributes:
        leaning: as given.
        mass: of the robot [kg].
        chain: indices of the joints between the IMU and the soles, shape (m,).
        position: of the soles' places in the frame of the IMU, shape (2, 3) [m].
        rotation: of the soles to the frame of the IMU, shape (2, 3, 3).
        jacobian: as last asked for, see `offset_jacobians`.
        ahead: the point of each sole that is its place, ahead of its centre, in an array to be written, shape (2,) [m].
        behind: whether joints are between the base and the IMU.
        carried: orientation of the IMU in the base, by `carry`, shape (3, 3).
        lever: its place there [m].
        turning: its angular velocity against the base by `carry`, in axes of the base [rad/s].
        moving: its velocity [m/s].

    Raises:
        ValueError: there is no such frame.
    """

    def __init__(self, model: pin.Model, soles: tuple[str, str], mount: ImuMount, leaning: float | None = None) -> None:
        for name in (*soles, *((mount.body,) if mount.body else ())):
            if not model.existFrame(name):
                raise ValueError(f"robot '{model.name}' has no frame '{name}'")
        self.model, self._data, self.leaning = model, model.createData(), leaning
        self._columns = JointColumns(model, self._data)
        self.mass = float(sum(inertia.mass for inertia in model.inertias))
        frames = [model.getFrameId(name) for name in soles]
        self._left, self._right = (Sole(model, self._data, frame) for frame in frames)
        self._mount_imu(model, mount)
        self._find_chain(model, [model.frames[frame].parentJoint for frame in frames])
        self._q, self._v = pin.neutral(model), np.zeros(model.nv)
        self._angles, self._speeds = self._q[7:], self._v[6:]
        self.position, self.rotation, self.ahead = np.zeros((2, 3)), np.zeros((2, 3, 3)), np.zeros(2)
        self._position, self._rotation, self._ahead = self.position, self.rotation, self.ahead
        self.jacobian = self._jacobian = np.zeros((2, 6, len(self.chain) + AXES))
        self.jacobian[:, 3:, -AXES:] = np.eye(3)
        data = self._data
        self._joint_jacobian, self._com_jacobian, self._com = self._columns.values, data.Jcom, data.com[0]

    def _mount_imu(self, model: pin.Model, mount: ImuMount) -> None:
        placed, parent = pin.SE3(np.array(mount.rotation), np.array(mount.position)), 1
        if mount.body:
            frame = model.frames[model.getFrameId(mount.body)]
            placed, parent = frame.placement * placed, frame.parentJoint
        self._parent, self.behind = parent, parent != 1
        joint = self._data.oMi[parent]
        self._joint_rotation, self._joint_position = joint.rotation, joint.translation
        self._mount_rotation = np.ascontiguousarray(placed.rotation)
        self._mount_position = algebra.vector(np.array(placed.translation))
        self._imu_rotation, self._imu_position = self._mount_rotation.copy(), self._mount_position
        self._turn, self._mounted, self.carried = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
        self.lever, self.turning, self.moving = self._mount_position, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)

    def _find_chain(self, model: pin.Model, carriers: list[int]) -> None:
        self.chain = self._chain = _between(model, self._parent, carriers)
        self._supporting = supporting(model, (*carriers, self._parent))

    def update(self, joints: Array, attitude: Array, offsets: Array | None = None) -> None:
        """Take joint angles.

        Args:
            joints: shape (nj,) [rad].
            attitude: of the IMU in the world, by which soles that lean do so, shape (3, 3).
            offsets: what is known of those of the chain and of the mount, shape (m + 3,); None where nothing is [rad].
        """
        turn = (0.0, 0.0, 0.0)
        self._angles[:] = joints
        if offsets is not None:
            m = len(self._chain)
            for c in range(m):
                self._angles[self._chain[c]] -= offsets[c]
            turn = algebra.vector(offsets[m:])
        pin.forwardKinematics(self.model, self._data, self._q)
        self._place_imu(turn)
        self._place_sole(0, self._left)
        self._place_sole(1, self._right)
        if self.leaning is not None:
            self._lean(attitude, self.leaning)

    def _place_imu(self, turn: Vector) -> None:
        """The IMU in the base, turned by that about its own axes [rad]."""
        algebra.rotation_of(turn, self._turn)
        algebra.compose(self._mount_rotation, self._turn, self._mounted)
        algebra.compose(self._joint_rotation, self._mounted, self._imu_rotation)
        arm = algebra.rotate(self._joint_rotation, self._mount_position)
        self._imu_position = algebra.add(arm, algebra.vector(self._joint_position))

    def _place_sole(self, k: int, sole: Sole) -> None:
        """A sole in the frame of the IMU."""
        sole.place()
        apart = algebra.subtract(sole.position, self._imu_position)
        if self._ahead[k] != 0.0:
            apart = algebra.add(apart, algebra.scale(self._ahead[k], algebra.column(sole.rotation, 0)))
        algebra.put_row(self._position, k, algebra.rotate_back(self._imu_rotation, apart))
        algebra.compose_back(self._imu_rotation, sole.rotation, self._rotation[k])

    def _lean(self, attitude: Array, half_width: float) -> None:
        """Take the lines of the soles for their places."""
        for k in (0, 1):
            beside = line_centre(k, np.zeros(3), attitude @ self.rotation[k], half_width)
            self.position[k] += beside @ attitude

    def offset_jacobians(self) -> Array:
        """From small turns of the joints of the chain, and of offsets of the mount, to those of the soles.

        An IMU that is turned further sees the soles turned back, as a joint at its origin would turn them.

        Returns:
            shape (2, 6, m + 3) [m/rad, -]. Both rows of the position and of the rotation vector are in the axes of the
            IMU. At the angles last taken; the next call writes over them.
        """
        pin.computeJointJacobians(self.model, self._data)
        self._columns.update()
        for k in range(2):
            self._by_joints(k)
            self._by_mount(k)
        return self.jacobian

    def _by_joints(self, k: int) -> None:
        """Columns of the chain's joints in the Jacobian of a sole."""
        at = self.in_base(k)
        for c in range(len(self._chain)):
            j = self._chain[c]
            # What carries both moves neither against the other, and what carries the IMU turns the sole the other way.
            carries = self._supporting[k, j] - self._supporting[2, j]
            moved = algebra.scale(carries, self._to_imu(self.moved_by(j, at)))
            turned = algebra.scale(carries, self._to_imu(self._axis(j)))
            self._jacobian[k, 0, c], self._jacobian[k, 1, c], self._jacobian[k, 2, c] = moved
            self._jacobian[k, 3, c], self._jacobian[k, 4, c], self._jacobian[k, 5, c] = turned

    def _by_mount(self, k: int) -> None:
        """Columns of the mount's offsets: less the cross product with the sole's place; turns are turns."""
        J, m = self._jacobian[k], len(self._chain)
        x, y, z = algebra.row(self._position, k)
        algebra.put_row(J, 0, (0.0, z, -y), m)
        algebra.put_row(J, 1, (-z, 0.0, x), m)
        algebra.put_row(J, 2, (y, -x, 0.0), m)

    def in_base(self, k: int) -> Vector:
        """A sole's place in the base's frame [m]."""
        return algebra.add(algebra.rotate(self._imu_rotation, algebra.row(self._position, k)), self._imu_position)

    def moved_by(self, joint: int, at: Vector) -> Vector:
        """Velocity by a joint of a point of the base's frame [m] that is fixed to what the joint carries [m/rad]."""
        c = 6 + joint
        along = self._joint_jacobian[0, c], self._joint_jacobian[1, c], self._joint_jacobian[2, c]
        return algebra.add(algebra.cross(self._axis(joint), at), along)

    def _axis(self, joint: int) -> Vector:
        """Axis of a joint, about which it turns what it carries."""
        c = 6 + joint
        return self._joint_jacobian[3, c], self._joint_jacobian[4, c], self._joint_jacobian[5, c]

    def _to_imu(self, a: Vector) -> Vector:
        """A vector of the base's frame in the axes of the IMU."""
        return algebra.rotate_back(self._imu_rotation, a)

    def place_com(self) -> None:
        """Let Pinocchio compute the CoM and its Jacobian, after `offset_jacobians`."""
        pin.jacobianCenterOfMass(self.model, self._data, False)

    def com_from(self, at: Vector) -> Vector:
        """The CoM from a point of the base's frame [m], in axes of the IMU, as last placed."""
        apart = algebra.subtract(algebra.vector(self._com), at)
        return algebra.rotate_back(self._imu_rotation, apart)

    def com_by(self, joint: int) -> Vector:
        """Velocity of the CoM against the base by a joint, as last placed [m/rad]."""
        return algebra.column(self._com_jacobian, 6 + joint)

    def carries(self, joint: int, k: int) -> float:
        """1 where a joint carries a sole, 0 else."""
        carries: float = self._supporting[k, joint]
        return carries

    def to_world(self, R: Array, out: Array) -> None:
        """Write the orientation of the base in the world, by that of the IMU, R, into an array, shape (3, 3) each."""
        for i in range(3):
            for j in range(3):
                out[i, j] = linear.rows_dot(R, i, self._imu_rotation, j)

    def turning_inertia(self) -> tuple[float, float]:
        """Inertias that turn angular velocities into moment of momentum about the CoM, at the angles last taken.

        Returns:
            that of the base about a horizontal axis, the greater one; the root sum of squares of all joints' [kg m^2].
        """
        A = pin.computeCentroidalMap(self.model, self._data, self._q)[3:5]
        return float(np.linalg.norm(A[:, 3:6], axis=1).max()), float(np.linalg.norm(A[:, 6:], axis=1).max())

    def turned_to_imu(self, turn: Vector) -> Vector:
        """A turn of the base in the axes of an IMU that no joint parts from it [rad/s]."""
        return algebra.rotate_back(self._mount_rotation, turn)

    def carry(self, q: Array, v: Array, turn: Vector) -> None:
        """Find where the IMU is in the base, and how joints move it there: `carried`, `lever`, `turning`, `moving`.

        Args:
            q: joint angles, shape (nj,) [rad].
            v: joint velocities, shape (nj,) [rad/s].
            turn: offsets of the mount [rad].
        """
        algebra.rotation_of(turn, self._turn)
        if not self.behind:
            algebra.compose(self._mount_rotation, self._turn, self.carried)
            return
        self._angles[:] = q
        self._speeds[:] = v
        pin.forwardKinematics(self.model, self._data, self._q, self._v)
        motion, R, arm = self._data.v[self._parent], self._joint_rotation, self._mount_position
        algebra.compose(self._mount_rotation, self._turn, self._mounted)
        algebra.compose(R, self._mounted, self.carried)
        self.lever = algebra.add(algebra.rotate(R, arm), algebra.vector(self._joint_position))
        spin = algebra.vector(motion.angular)
        self.turning = algebra.rotate(R, spin)
        self.moving = algebra.rotate(R, algebra.add(algebra.vector(motion.linear), algebra.cross(spin, arm)))


def _between(model: pin.Model, carrier: int, carriers: list[int]) -> Array:
    """Indices of the joints on the ways from a joint to others."""
    up = set(_ancestors(model, carrier))
    found: set[int] = set()
    for joint in carriers:
        found |= up ^ set(_ancestors(model, joint))
    return np.array(sorted({model.idx_vs[joint] - 6 for joint in found}), dtype=np.intp)


def supporting(model: pin.Model, carriers: tuple[int, ...]) -> Array:
    """Mark the joints that carry what is on some joints: 1 or 0, shape (carriers, nj)."""
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
