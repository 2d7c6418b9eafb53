"""A slope as terrain: one inclined plane, before or behind level ground."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.ground.terrain import DEEPER, HALF_WIDTH, Box, Site, Terrain


@dataclass(frozen=True, slots=True)
class Slope:
    """An inclined plane, seen from where the walk starts on level ground.

    Attributes:
        angle: inclination, positive uphill [rad].
        start: distance from the start to its edge [m].
        length: of the plane along the slope [m].
        before: depth of the platform from which a descent starts, behind the start [m].
    """

    angle: float
    start: float
    length: float
    before: float

    def build(self, site: Site) -> Terrain:
        """The ground at a site; a slope that goes down starts on a platform and meets the ground plane at its end."""
        heading, rotation = sole_rotation(site.yaw, 0.0, 0.0), sole_rotation(site.yaw, -self.angle, 0.0)
        drop = max(0.0, -self.length * math.sin(self.angle))
        edge = heading @ (self.start, 0.0, 0.0) + (*site.origin, drop)
        half = np.array([0.5 * self.length, HALF_WIDTH, 0.5 * self.length * abs(math.tan(self.angle)) + DEEPER])
        boxes = [Box(edge + rotation @ (half[0], 0.0, -half[2]), half, rotation)]
        if drop > 0.0:
            depth = self.start + self.before
            center = edge - heading @ (0.5 * depth, 0.0, 0.5 * drop)
            boxes.append(Box(center, np.array([0.5 * depth, HALF_WIDTH, 0.5 * drop]), heading))
        return Terrain(tuple(boxes), site.friction, wide=True)
