"""Stepping blocks as terrain: one under each footstep, higher or lower and tilted at random."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.ground.terrain import DEEPER, Box, Site, Terrain
from surefoot.planner.types import Array

LEVEL_STEPS = 2
"""Footsteps at the end of a block field that land on level blocks, as the start feet stand on such [-]."""


@dataclass(frozen=True, slots=True)
class Blocks:
    """Random stepping blocks, one under each footstep and a wide one under the start feet.

    Attributes:
        height: half range of the heights of their tops [m].
        angle: half range of their pitch and of their roll [rad].
        length: of a block along its footstep's heading [m].
        width: across it [m].
    """

    height: float
    angle: float
    length: float
    width: float

    @property
    def middle(self) -> float:
        """Mean height of the tops, at which the level blocks are: every corner is above the ground plane [m]."""
        return self.height + self._dip + DEEPER

    @property
    def depth(self) -> float:
        """Thickness of a block, which reaches into the ground [m]."""
        return (self.middle + self.height + self._dip + DEEPER) / math.cos(self.angle) ** 2

    @property
    def _dip(self) -> float:
        return 0.5 * (self.length + self.width) * math.sin(self.angle)

    def build(self, site: Site) -> Terrain:
        """The ground at a site; blocks have their tops' centres at footsteps, those of start and end are level."""
        first, second, *footsteps = site.footsteps()
        scatter = site.rng.uniform(-1.0, 1.0, (len(footsteps), 3)) * (self.height, self.angle, self.angle)
        scatter[-LEVEL_STEPS:] = 0.0
        half = 0.5 * np.array([self.length, self.width, self.depth])
        feet = np.array([first.position, second.position])[:, :2]
        across = np.array([0.0, 0.5 * float(np.linalg.norm(feet[1] - feet[0])), 0.0])
        boxes = [self._block(0.5 * (feet[0] + feet[1]), sole_rotation(first.yaw, 0.0, 0.0), half + across)]
        for step, (height, pitch, roll) in zip(footsteps, scatter, strict=True):
            rotation = sole_rotation(step.yaw, float(pitch), float(roll))
            boxes.append(self._block(step.position[:2], rotation, half, float(height)))
        return Terrain(tuple(boxes), site.friction)

    def _block(self, top: Array, rotation: Array, half_size: Array, height: float = 0.0) -> Box:
        """The block whose top has its centre above a point x, y and is higher than the level ones."""
        return Box(np.append(top, self.middle + height) - half_size[2] * rotation[:, 2], half_size, rotation)
