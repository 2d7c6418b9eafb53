"""The one place where the conventions of the two engines meet.

State of a robot with a free joint and nj revolute joints, joints in the same order:

===================  ==========================  ==========================
quantity             MuJoCo                      Pinocchio
===================  ==========================  ==========================
base orientation     quaternion w, x, y, z       quaternion x, y, z, w
base linear          world frame                 base frame
velocity
base angular         base frame                  base frame
velocity
base acceleration    d/dt of the above: world    spatial, base frame:
                     and base frame              Rᵀ p̈ - ω x v
===================  ==========================  ==========================

Positions have the shape (7 + nj,), velocities and accelerations (6 + nj,). Outputs are written in place; they may
not alias the inputs.

A joint that follows another one by an equality has a place in MuJoCo's arrays, which are longer then, and none in
Pinocchio's (see `surefoot.engines.mimic`). `Coordinates` knows which places are those of the nj joints.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra

if TYPE_CHECKING:
    from surefoot.engines.windowless import mujoco

Array = NDArray[np.float64]


def mujoco_to_pinocchio(qpos: Array, qvel: Array, q_out: Array, v_out: Array) -> None:
    """State from MuJoCo's into Pinocchio's convention."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    q_out[:] = qpos
    q_out[3], q_out[4], q_out[5], q_out[6] = x, y, z, w
    a, b, c = algebra.quaternion_rows(x, y, z, w)
    x, y, z = qvel[0], qvel[1], qvel[2]
    v_out[:] = qvel
    v_out[0] = a[0] * x + b[0] * y + c[0] * z
    v_out[1] = a[1] * x + b[1] * y + c[1] * z
    v_out[2] = a[2] * x + b[2] * y + c[2] * z


def pinocchio_to_mujoco(q: Array, v: Array, qpos_out: Array, qvel_out: Array) -> None:
    """State from Pinocchio's into MuJoCo's convention."""
    x, y, z, w = q[3:7].tolist()
    qpos_out[:] = q
    qpos_out[3:7] = (w, x, y, z)
    qvel_out[:] = v
    qvel_out[:3] = np.array(algebra.quaternion_rows(x, y, z, w)) @ v[:3]


class Coordinates:
    """The independent joints of a robot in MuJoCo, and the joints that follow them.

    Args:
        model: of a robot, or of a world with one, whose first joint is its floating base. A joint follows another one
            that has no motor and a linear equality with it.

    Attributes:
        positions: places of the independent joints in `qpos`, shape (nj,); a slice where no joint follows.
        velocities: places of the independent joints in `qvel`, shape (nj,); a slice where no joint follows.
        size: numbers of a configuration in Pinocchio's convention, 7 + nj.
        followers: places of the joints that follow in `qpos`, shape (nf,).
        G: from MuJoCo's velocities of base and independent joints to all of them, shape (nv, 6 + nj); None where no
            joint follows.
    """

    def __init__(self, model: "mujoco.MjModel") -> None:
        self.positions: slice | NDArray[np.intp] = slice(7, None)
        self.velocities: slice | NDArray[np.intp] = slice(6, None)
        self.followers, self.size = np.zeros(0, dtype=np.intp), int(model.nq)
        self.G: Array | None = None
        self._leaders, self._ratio, self._offset = self.followers, np.zeros(0), np.zeros(0)
        if model.neq:
            self._follow(model)

    def _follow(self, model: "mujoco.MjModel") -> None:
        of_joints = (model.eq_type == _EQUALITY_OF_JOINTS) & (model.eq_obj2id >= 0)
        joints = np.flatnonzero(of_joints & ~np.isin(model.eq_obj1id, model.actuator_trnid[:, 0]))
        if not len(joints):
            return
        follower, leader = model.eq_obj1id[joints], model.eq_obj2id[joints]
        own = np.setdiff1d(np.arange(1, model.njnt), follower)
        self.positions, self.velocities = 6 + own, 5 + own
        self.followers, self._leaders, self.size = 6 + follower, 6 + leader, 7 + len(own)
        self._offset, self._ratio = model.eq_data[joints, 0], model.eq_data[joints, 1]
        self.G = G = np.zeros((model.nv, 6 + len(own)))
        G[np.concatenate((np.arange(6), self.velocities)), np.arange(6 + len(own))] = 1.0
        G[self.followers - 1] = self._ratio[:, None] * G[self._leaders - 1]

    def bend(self, angles: Array, qpos_out: Array) -> None:
        """Write the angles of the independent joints, shape (nj,), and of those that follow them [rad]."""
        qpos_out[self.positions] = angles
        if self.G is not None:
            qpos_out[self.followers] = self._ratio * qpos_out[self._leaders] + self._offset

    def apart(self, qpos: Array) -> Array:
        """Distance of each joint that follows from where it belongs, shape (nf,) [rad]."""
        apart: Array = qpos[self.followers] - self._ratio * qpos[self._leaders] - self._offset
        return apart

    def law_of(self, joint: int) -> tuple[int, float, float]:
        """Independent joint with which a joint of MuJoCo turns, itself or its leader: its number among them, k, b.

        The joint's angle is k times that of the independent one and b [-, rad].
        """
        place, ratio, offset = joint + 6, 1.0, 0.0
        if isinstance(self.positions, slice):
            return place - 7, ratio, offset
        for k in np.flatnonzero(self.followers == place):
            place, ratio, offset = self._leaders[k], float(self._ratio[k]), float(self._offset[k])
        return int(np.searchsorted(self.positions, place)), ratio, offset

    def to_mujoco(self, q: Array, v: Array, qpos_out: Array, qvel_out: Array) -> None:
        """State from Pinocchio's into MuJoCo's convention."""
        if self.G is None:
            pinocchio_to_mujoco(q, v, qpos_out, qvel_out)
            return
        short = np.zeros(len(q)), np.zeros(len(v))
        pinocchio_to_mujoco(q, v, *short)
        qpos_out[:7] = short[0][:7]
        self.bend(q[7:], qpos_out)
        qvel_out[:] = self.G @ short[1]

    def to_pinocchio(self, qpos: Array, qvel: Array, q_out: Array, v_out: Array) -> None:
        """State from MuJoCo's into Pinocchio's convention; the joints that follow are left away."""
        if self.G is not None:
            qpos = np.concatenate((qpos[:7], qpos[self.positions]))
            qvel = np.concatenate((qvel[:6], qvel[self.velocities]))
        mujoco_to_pinocchio(qpos, qvel, q_out, v_out)

    def inertia(self, model: "mujoco.MjModel") -> Array:
        """Inertia of each independent joint alone with all joints at zero, shape (nj,) [kg m^2]."""
        if self.G is None:
            found: Array = model.dof_M0[6:]
            return found
        from surefoot.engines.windowless import mujoco

        data, M = mujoco.MjData(model), np.zeros((model.nv, model.nv))
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        mujoco.mj_fullM(model, data, M)
        return np.asarray(np.diag(self.G.T @ M @ self.G)[6:])


_EQUALITY_OF_JOINTS = 2
"""MuJoCo's mjEQ_JOINT; a test holds it."""


def mujoco_acceleration_to_pinocchio(qpos: Array, qvel: Array, qacc: Array, a_out: Array) -> None:
    """Acceleration from MuJoCo's into Pinocchio's convention, at the state (qpos, qvel) of MuJoCo."""
    w, x, y, z = qpos[3:7].tolist()
    R = np.array(algebra.quaternion_rows(x, y, z, w))
    a_out[:] = qacc
    a_out[:3] = R.T @ qacc[:3] - np.cross(qvel[3:6], R.T @ qvel[:3])


def velocity_map(qpos: Array, nv: int) -> Array:
    """Matrix T with v_mujoco = T v_pinocchio, shape (nv, nv).

    Forces and matrices follow: τ_pinocchio = Tᵀ τ_mujoco, M_pinocchio = Tᵀ M_mujoco T, J_pinocchio = J_mujoco T.
    """
    w, x, y, z = qpos[3:7].tolist()
    T = np.eye(nv)
    T[:3, :3] = algebra.quaternion_rows(x, y, z, w)
    return T
