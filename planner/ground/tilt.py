"""Level ground that is truly tilted, but for where the robot starts."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.ground.terrain import DEEPER, Box, Site, Terrain
from surefoot.planner.types import Array

FAR = 50.0
"""Reach of the ground to each side, farther than any walk goes, for the reference robot [m]."""


@dataclass(frozen=True, slots=True)
class Tilt:
    """Two tilted faces, ahead of a level strip across the start and behind it.

    Along the line on which the walk starts, they are as high as the strip. To its sides they are higher or lower where
    the ground rolls.

    Attributes:
        pitch: angle by which it rises ahead [rad].
        roll: angle by which it rises to the left [rad].
        level: half length of the strip [m].
        far: how far the ground reaches to each side [m].
    """

    pitch: float
    roll: float
    level: float = 0.15
    far: float = FAR

    def build(self, site: Site) -> Terrain:
        """The ground at a site: the strip, then the face ahead and the one behind, above a plane that none reaches."""
        ahead, left = math.tan(self.pitch), math.tan(self.roll)
        heading = sole_rotation(site.yaw, 0.0, 0.0)
        x, normal = np.array([1.0, 0.0, ahead]), np.array([-ahead, -left, 1.0])
        x, normal = x / np.linalg.norm(x), normal / np.linalg.norm(normal)
        face = np.column_stack((x, np.cross(normal, x), normal))
        origin = np.append(site.origin, 0.0)
        boxes = [_slab(origin, heading, np.array([self.level, self.far]))]
        for side in (1.0, -1.0):
            top = np.array([side * self.level, 0.0, 0.0]) + 0.5 * side * self.far * x
            boxes.append(_slab(origin + heading @ top, heading @ face, np.array([0.5 * self.far, self.far])))
        lowest = self.far * (abs(ahead) + abs(left)) + DEEPER
        return Terrain(tuple(boxes), site.friction, plane=-lowest)


_THICK = 0.5
"""Thickness of a slab, so that no foot falls through it [m]."""


def _slab(top: Array, rotation: Array, half_size: Array) -> Box:
    """A box with the centre of its top face at a place."""
    return Box(top - 0.5 * _THICK * rotation[:, 2], np.append(half_size, 0.5 * _THICK), rotation)
