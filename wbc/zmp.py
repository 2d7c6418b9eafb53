"""Centre of pressure and ZMP from measured sole wrenches; mostly plain floats, since they run at every control tick."""

import math

import numpy as np

from surefoot.wbc.types import Array

UNLOADED = 1.0
"""Normal force below which a centre of pressure has no meaning [N]."""


def centre_of_pressure(wrench: Array) -> tuple[float, float]:
    """Centre of pressure in the sole frame [m] of a sole wrench, shape (6,); NaN for an unloaded sole."""
    _, _, fz, tx, ty, _ = wrench.tolist()
    if fz < UNLOADED:
        return math.nan, math.nan
    return -ty / fz, tx / fz


def measured_zmp(wrench: Array, sole_position: Array, sole_rotation: Array) -> tuple[float, float, float]:
    """ZMP of all contact forces in the world frame.

    The point of the horizontal plane, at the soles' load-weighted height, about which the contact forces have no
    horizontal moment (Vukobratović and Borovac, 2004). With F the force and M the moment about the plane's origin:
    p_x = -M_y / F_z, p_y = M_x / F_z.

    Args:
        wrench: sole wrenches in the sole frames, shape (2, 6) [N, N·m].
        sole_position: sole centres in the world frame, shape (2, 3) [m].
        sole_rotation: sole orientations, shape (2, 3, 3).

    Returns:
        (x, y, z) [m]; NaN when the feet carry no load.
    """
    # World-frame force and torque of each sole as the columns of a (3, 2) matrix.
    left, right = np.matmul(sole_rotation, wrench.reshape(2, 2, 3).transpose(0, 2, 1)).tolist()
    (fx_l, tx_l), (fy_l, ty_l), (fz_l, _) = left
    (fx_r, tx_r), (fy_r, ty_r), (fz_r, _) = right
    force = fz_l + fz_r
    if force < UNLOADED:
        return math.nan, math.nan, math.nan
    (x_l, y_l, z_l), (x_r, y_r, z_r) = sole_position.tolist()
    height = (fz_l * z_l + fz_r * z_r) / force
    z_l, z_r = z_l - height, z_r - height
    moment_x = tx_l + y_l * fz_l - z_l * fy_l + tx_r + y_r * fz_r - z_r * fy_r
    moment_y = ty_l + z_l * fx_l - x_l * fz_l + ty_r + z_r * fx_r - x_r * fz_r
    return -moment_y / force, moment_x / force, height
