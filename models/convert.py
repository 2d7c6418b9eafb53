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
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Row = tuple[float, float, float]


def rotation(w: float, x: float, y: float, z: float) -> tuple[Row, Row, Row]:
    """Rows of the rotation matrix of a unit quaternion: of the base to the world."""
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def mujoco_to_pinocchio(qpos: Array, qvel: Array, q_out: Array, v_out: Array) -> None:
    """State from MuJoCo's into Pinocchio's convention."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    q_out[:] = qpos
    q_out[3], q_out[4], q_out[5], q_out[6] = x, y, z, w
    a, b, c = rotation(w, x, y, z)
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
    qvel_out[:3] = np.array(rotation(w, x, y, z)) @ v[:3]


def mujoco_acceleration_to_pinocchio(qpos: Array, qvel: Array, qacc: Array, a_out: Array) -> None:
    """Acceleration from MuJoCo's into Pinocchio's convention, at the state (qpos, qvel) of MuJoCo."""
    R = np.array(rotation(*qpos[3:7].tolist()))
    a_out[:] = qacc
    a_out[:3] = R.T @ qacc[:3] - np.cross(qvel[3:6], R.T @ qvel[:3])


def velocity_map(qpos: Array, nv: int) -> Array:
    """Matrix T with v_mujoco = T v_pinocchio, shape (nv, nv).

    Forces and matrices follow: τ_pinocchio = Tᵀ τ_mujoco, M_pinocchio = Tᵀ M_mujoco T, J_pinocchio = J_mujoco T.
    """
    T = np.eye(nv)
    T[:3, :3] = rotation(*qpos[3:7].tolist())
    return T
