"""Centre of pressure and ZMP from measured sole wrenches; plain floats, since they run at every control tick."""

import math

from wbc.types import Array

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
    force = moment_x = moment_y = height = 0.0
    loads = []
    for w, p, R in zip(wrench.tolist(), sole_position.tolist(), sole_rotation.tolist(), strict=True):
        f = [r[0] * w[0] + r[1] * w[1] + r[2] * w[2] for r in R]
        t = [r[0] * w[3] + r[1] * w[4] + r[2] * w[5] for r in R]
        loads.append((f, t, p))
        force += f[2]
        height += f[2] * p[2]
    if force < UNLOADED:
        return math.nan, math.nan, math.nan
    height /= force
    for f, t, p in loads:
        lever = p[2] - height
        moment_x += t[0] + p[1] * f[2] - lever * f[1]
        moment_y += t[1] + lever * f[0] - p[0] * f[2]
    return -moment_y / force, moment_x / force, height
