"""Quintic polynomials c_0 + c_1 t + ... + c_5 t^5 in plain numbers."""

from surefoot.maths.algebra import Vector

Quintic = tuple[float, float, float, float, float, float]
"""Coefficients of 1, t, ..., t^5."""


def value(c: Quintic, t: float) -> float:
    """Value at t."""
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))))


def slope(c: Quintic, t: float) -> float:
    """First derivative at t."""
    return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])))


def bend(c: Quintic, t: float) -> float:
    """Second derivative at t."""
    return 2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5]))


def between(start: Vector, end: Vector, t: float) -> Quintic:
    """The quintic from one position, velocity and acceleration to others in a time t [s]."""
    gap = end[0] - start[0] - t * start[1] - 0.5 * t * t * start[2]
    speed, turn = t * (end[1] - start[1] - t * start[2]), t * t * (end[2] - start[2])
    cubed = t * t * t  # a power of C's library may err in the last bit, and not alike on all machines
    return (
        start[0],
        start[1],
        0.5 * start[2],
        (10.0 * gap - 4.0 * speed + 0.5 * turn) / cubed,
        (-15.0 * gap + 7.0 * speed - turn) / (cubed * t),
        (6.0 * gap - 3.0 * speed + 0.5 * turn) / (cubed * t * t),
    )
