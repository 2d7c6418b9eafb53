"""Centre of pressure and ZMP from measured sole wrenches."""

import math

from surefoot.maths import algebra
from surefoot.wbc.types import Array

UNLOADED = 1.0
"""Normal force below which a centre of pressure has no meaning [N]."""

NOWHERE = math.nan
"""Coordinate of a point that there is not."""

_LEAST = UNLOADED
"""The same for the compiler, whose constants no other module can read."""


def centre_of_pressure(wrench: Array) -> tuple[float, float]:
    """Centre of pressure in the sole frame [m] of a sole wrench, shape (6,); NaN for an unloaded sole."""
    normal = wrench[2]
    if normal < _LEAST:
        return NOWHERE, NOWHERE
    return -wrench[4] / normal, wrench[3] / normal


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
    load, height = 0.0, 0.0
    for foot in range(2):
        force = algebra.rotate(sole_rotation[foot], algebra.row(wrench, foot))
        load += force[2]
        height += force[2] * sole_position[foot, 2]
    if load < _LEAST:
        load = NOWHERE
    height /= load
    moment_x, moment_y = 0.0, 0.0
    for foot in range(2):
        force = algebra.rotate(sole_rotation[foot], algebra.row(wrench, foot))
        torque = algebra.rotate(sole_rotation[foot], algebra.row(wrench, foot, 3))
        x, y, z = sole_position[foot, 0], sole_position[foot, 1], sole_position[foot, 2] - height
        moment_x += torque[0] + y * force[2] - z * force[1]
        moment_y += torque[1] + z * force[0] - x * force[2]
    return -moment_y / load, moment_x / load, height
