"""Terrain as data: what the planner knows of the ground and what the simulator turns into geoms."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Box:
    """A solid box that feet may stand on.

    Attributes:
        center: box centre in the world frame, shape (3,) [m].
        half_size: half extents along the box axes, shape (3,) [m].
        rotation: box-to-world rotation matrix, shape (3, 3).
    """

    center: NDArray[np.float64]
    half_size: NDArray[np.float64]
    rotation: NDArray[np.float64]

    def top_height(self, x: float, y: float) -> float | None:
        """Height [m] of the top face above the world point (x, y), or None beside the box."""
        normal = self.rotation[:, 2]
        face = self.center + self.half_size[2] * normal
        z = face[2] - (normal[0] * (x - face[0]) + normal[1] * (y - face[1])) / normal[2]
        local = self.rotation.T @ (np.array([x, y, z]) - self.center)
        inside = abs(local[0]) <= self.half_size[0] and abs(local[1]) <= self.half_size[1]
        return float(z) if inside else None


@dataclass(frozen=True, slots=True)
class Terrain:
    """Ground plane at z = 0 with boxes on it.

    Attributes:
        boxes: solids on the plane; the highest top face under a point carries it.
        friction: Coulomb coefficient of every surface [-].
    """

    boxes: tuple[Box, ...] = ()
    friction: float = 0.8

    def height(self, x: float, y: float) -> float:
        """Ground height [m] at the world point (x, y)."""
        tops = [top for box in self.boxes if (top := box.top_height(x, y)) is not None]
        return max(tops, default=0.0)


def flat(friction: float = 0.8) -> Terrain:
    """The bare ground plane."""
    return Terrain(boxes=(), friction=friction)
