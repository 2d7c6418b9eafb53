"""Quantities of the log that follow from others, for many ticks at once: cheaper than one by one."""

import numpy as np
from numpy.typing import NDArray

from wbc.zmp import UNLOADED

Array = NDArray[np.float64]


def contact_points(wrench: Array, position: Array, rotation: Array) -> tuple[Array, Array]:
    """ZMP and centres of pressure; the definitions are those of `wbc.zmp`.

    Args:
        wrench: sole wrenches in the sole frames, shape (n, 2, 6) [N, N·m].
        position: sole centres in the world frame, shape (n, 2, 3) [m].
        rotation: sole orientations, shape (n, 2, 3, 3).

    Returns:
        the ZMP in the world frame, shape (n, 3), and the centres of pressure in the sole frames, shape (n, 2, 2) [m];
        NaN where there is no load.
    """
    columns = wrench.reshape(-1, 2, 2, 3).swapaxes(2, 3)
    world = rotation @ columns
    force, torque = world[..., 0], world[..., 1]
    fz = force[..., 2]
    total = fz.sum(axis=1)
    load = np.where(total < UNLOADED, np.nan, total)
    height = (fz * position[..., 2]).sum(axis=1) / load
    lever = position[..., 2] - height[:, None]
    moment_x = (torque[..., 0] + position[..., 1] * fz - lever * force[..., 1]).sum(axis=1)
    moment_y = (torque[..., 1] + lever * force[..., 0] - position[..., 0] * fz).sum(axis=1)
    normal = np.where(wrench[..., 2] < UNLOADED, np.nan, wrench[..., 2])
    cop = np.stack((-wrench[..., 4] / normal, wrench[..., 3] / normal), axis=2)
    return np.stack((-moment_y / load, moment_x / load, height), axis=1), cop
