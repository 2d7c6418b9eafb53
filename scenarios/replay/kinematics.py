"""Poses of all bodies from logged configurations, by MuJoCo's own forward kinematics."""

import mujoco
import numpy as np

from models.convert import pinocchio_to_mujoco
from scenarios.constants import WORLD_FILE
from scenarios.errors import LogError
from scenarios.log import Log
from scenarios.replay.content import Array


def world_text(log: Log) -> str:
    """MJCF text of the world that was simulated.

    Raises:
        LogError: the log has none.
    """
    try:
        return log.attachments[WORLD_FILE].decode()
    except (KeyError, UnicodeDecodeError):
        raise LogError(f"{log.path}: holds no readable {WORLD_FILE}; replay needs a log of fidelity full") from None


def compile_world(log: Log) -> mujoco.MjModel:
    """Compile the world of a log.

    Raises:
        LogError: the log has no world, or it is damaged.
    """
    try:
        return mujoco.MjModel.from_xml_string(world_text(log))
    except ValueError as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{log.path}: {WORLD_FILE} is damaged, {reason}; replay needs an intact one") from None


def body_poses(model: mujoco.MjModel, configurations: Array) -> tuple[Array, Array]:
    """Poses of the bodies.

    Args:
        model: the world.
        configurations: in Pinocchio's convention, shape (n, nq).

    Returns:
        positions, shape (n, bodies, 3) [m], and quaternions w x y z, shape (n, bodies, 4).
    """
    data, rest = mujoco.MjData(model), np.zeros(model.nv)
    positions = np.empty((len(configurations), model.nbody, 3))
    quaternions = np.empty((len(configurations), model.nbody, 4))
    for q, position, quaternion in zip(configurations, positions, quaternions, strict=True):
        pinocchio_to_mujoco(q, rest, data.qpos, data.qvel)
        mujoco.mj_kinematics(model, data)
        position[:], quaternion[:] = data.xpos, data.xquat
    return positions, quaternions
