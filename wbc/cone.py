"""The 6-D contact wrench cone of a flat rectangular sole."""

import numpy as np

from surefoot.wbc.types import Array

CONE_ROWS = 16


def wrench_cone(half_length: float, half_width: float, friction: float) -> Array:
    """Rows ``C`` of the cone ``C w <= 0`` of wrenches that a rectangular sole can transmit without slip or tilt.

    Caron, Pham and Nakamura, "Stability of surface contacts for humanoid robots: closed-form formulae of the contact
    wrench cone for rectangular support areas", ICRA 2015, eqs. (8) to (12): Coulomb friction (inner pyramid), CoP
    inside the sole and the yaw moment that friction can hold at that CoP. Together the rows imply fz >= 0.

    Args:
        half_length: half of the sole along its x axis [m].
        half_width: half of the sole along its y axis [m].
        friction: coefficient of the pyramid [-]; pass μ/√2 to stay inside the circular cone of μ.

    Returns:
        C, shape (16, 6), acting on ``[fx, fy, fz, tx, ty, tz]`` at the sole centre in the sole frame.

    Raises:
        ValueError: if a dimension or the friction is not positive.
    """
    if min(half_length, half_width, friction) <= 0.0:
        raise ValueError(
            f"wrench cone of a sole {half_length} m x {half_width} m with friction {friction}: "
            "all three must be positive"
        )
    X, Y, mu = half_length, half_width, friction
    rows = [[sx, 0, -mu, 0, 0, 0] for sx in (1, -1)]
    rows += [[0, sy, -mu, 0, 0, 0] for sy in (1, -1)]
    rows += [[0, 0, -Y, sx, 0, 0] for sx in (1, -1)]
    rows += [[0, 0, -X, 0, sy, 0] for sy in (1, -1)]
    # |τz - (bilinear CoP term)| bounded: the four sign patterns of τz_min <= τz and of τz <= τz_max.
    for sx in (1, -1):
        for sy in (1, -1):
            rows.append([sx * Y, sy * X, -mu * (X + Y), -sx * mu, -sy * mu, -1])
            rows.append([sx * Y, sy * X, -mu * (X + Y), sx * mu, sy * mu, 1])
    return np.array(rows, dtype=np.float64)
