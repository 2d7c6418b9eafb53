"""Stairs as terrain: one box per tread, laid along a heading."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.ground.terrain import HALF_WIDTH, Box, Site, Terrain


class Direction(Enum):
    """The direction in which a staircase goes."""

    UP = "up"
    DOWN = "down"
    UP_DOWN = "up_down"


@dataclass(frozen=True, slots=True)
class Stairs:
    """A staircase, seen from where the walk starts.

    Attributes:
        riser: height of a step [m].
        tread: depth of a step [m].
        count: number of risers on the way up, or on the way down, or on each of the two ways [-].
        direction: which way they go.
        start: distance from the start to the first riser [m].
        landing: depth of the landing between the way up and the way down [m].
        beyond: depth of the platform that the stairs end on, or of the one that they start from [m].
    """

    riser: float
    tread: float
    count: int
    direction: Direction
    start: float
    landing: float
    beyond: float

    def levels(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Edges between the levels along the way, ascending, shape (n + 1,), and their heights, shape (n,) [m]."""
        up, down = list(range(1, self.count + 1)), list(range(self.count - 1, 0, -1))
        treads = [self.tread] * (self.count - 1)
        if self.direction is Direction.DOWN:
            first, heights, depths = -self.beyond, [self.count, *down], [self.start + self.beyond, *treads]
        elif self.direction is Direction.UP:
            first, heights, depths = self.start, up, [*treads, self.beyond]
        else:
            first, heights, depths = self.start, [*up, *down], [*treads, self.landing, *treads]
        return np.cumsum([first, *depths], dtype=np.float64), self.riser * np.array(heights, dtype=np.float64)

    def build(self, site: Site) -> Terrain:
        """The ground at a site; one that goes down starts on its highest platform."""
        rotation = np.eye(3)
        rotation[:2, :2] = frame_rotation(site.yaw)
        edges, heights = self.levels()
        boxes = []
        for begin, end, height in zip(edges[:-1], edges[1:], heights, strict=True):
            center = rotation @ (0.5 * (begin + end), 0.0, 0.5 * height)
            center[:2] += site.origin
            boxes.append(Box(center, np.array([0.5 * (end - begin), HALF_WIDTH, 0.5 * height]), rotation))
        return Terrain(tuple(boxes), site.friction, (float(site.origin[0]), float(site.origin[1]), site.yaw))
