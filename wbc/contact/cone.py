"""The sole, and the 6-D contact wrench cone of a flat rectangle."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.wbc.types import Array

CONE_ROWS = 16

TOE_DEPTH = 0.003
"""Half length of the strip that stands for a toe or heel edge in its cone, and half width of that for a side edge [m].

Constants here are the reference robot's; see `surefoot.similarity`."""


@dataclass(frozen=True, slots=True)
class Sole:
    """The sole's contact.

    Attributes:
        half_length: half the sole's length [m].
        half_width: half its width [m].
        friction: Coulomb coefficient that the controller counts on [-].
        cop_share: share of the half sizes that the planned CoP may use [-].
    """

    half_length: float
    half_width: float
    friction: float
    cop_share: float = 0.9

    def cones(self, depth: float) -> tuple[Array, Array]:
        """Rows of the wrench cones of the sole and of an edge across it; the pyramid lies inside the circular cone.

        Args:
            depth: half length of the strip that stands for the edge [m].

        Returns:
            C of both, shape (16, 6) each [-, m], see `wrench_cone`.

        Raises:
            ValueError: the sole has no extent or no friction.
        """
        friction, width = self.friction / math.sqrt(2.0), self.cop_share * self.half_width
        return wrench_cone(self.cop_share * self.half_length, width, friction), wrench_cone(depth, width, friction)


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
