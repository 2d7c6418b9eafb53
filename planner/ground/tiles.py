"""Level ground that is not quite level: tiles about as large as a footstep, each a little higher or lower."""

import math
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.ground.terrain import DEEPER, Box, Site, Terrain
from surefoot.planner.types import Array
from surefoot.streams import Stream

TILE = 0.5
"""Side of a tile, as of a paving slab, for the reference robot [m]."""

AROUND = 2
"""Number of tiles that are laid around the one that a footstep is on, to each side [-]."""

_WINDOW = np.array(list(product(range(-AROUND, AROUND + 1), repeat=2)))

_MIDDLE = 2**31
"""Number of the tile at the origin, since streams of random numbers have no negative ones [-]."""


@dataclass(frozen=True, slots=True)
class Tiles:
    """Square tiles around the footsteps of a walk, on a plane as low as the lowest of them may be.

    They lie askew to the walk, so that soles land across their edges every way. Seed and place alone decide how high
    one is. So two gaits have the same ground, and a longer walk has the ground of the shorter one and more.

    Attributes:
        noise: half range of the heights about 0 [m].
        seed: of the heights, and of where the tiles lie and how they are turned.
        level: how far the level box at the start reaches beyond the centres of the feet [m].
        side: of a tile [m].
    """

    noise: float
    seed: int
    level: float = 0.15
    side: float = TILE

    def build(self, site: Site) -> Terrain:
        """The ground at a site; the feet start on a level box at height 0, and no tile under it is higher."""
        rotation, origin = self._grid(site)
        start = self._start(site)
        boxes = [start]
        for cell in self.cells(site):
            centre = origin + rotation[:2, :2] @ (self.side * (cell + 0.5))
            height = self.noise * (2.0 * float(self._random(*(cell + _MIDDLE))[0]) - 1.0)
            if start.top(centre[None])[1][0] > -math.sqrt(0.5) * self.side:
                height = -abs(height)
            boxes.append(self._box(centre, np.full(2, 0.5 * self.side), height, rotation))
        return Terrain(tuple(boxes), site.friction, plane=-self.noise)

    def cells(self, site: Site) -> NDArray[np.int64]:
        """Tiles of the grid that are laid, ordered, shape (n, 2)."""
        rotation, origin = self._grid(site)
        places = np.array([step.position[:2] for step in site.footsteps()])
        under = np.floor((places - origin) @ rotation[:2, :2] / self.side).astype(np.int64)
        return np.unique((under[:, None] + _WINDOW).reshape(-1, 2), axis=0)

    def _grid(self, site: Site) -> tuple[Array, Array]:
        """Axes of the grid, shape (3, 3), and one of its corners in the world, shape (2,) [m]."""
        turn, along, across = self._random()
        rotation = sole_rotation(site.yaw + 0.5 * math.pi * float(turn), 0.0, 0.0)
        return rotation, site.origin + rotation[:2, :2] @ (self.side * np.array([along, across]))

    def _start(self, site: Site) -> Box:
        first, second = (step.position[:2] for step in site.footsteps()[:2])
        half = np.array([self.level, self.level + 0.5 * float(np.linalg.norm(second - first))])
        return self._box(0.5 * (first + second), half, 0.0, sole_rotation(site.yaw, 0.0, 0.0))

    def _box(self, centre: Array, half_size: Array, top: float, rotation: Array) -> Box:
        """A box that reaches from below the plane to a height [m]."""
        bottom = -self.noise - DEEPER
        return Box(np.append(centre, 0.5 * (top + bottom)), np.append(half_size, 0.5 * (top - bottom)), rotation)

    def _random(self, *place: int) -> Array:
        """Three numbers from 0 to 1 that belong to the seed and a place."""
        return np.random.SeedSequence(self.seed, spawn_key=(Stream.TILES, *place)).generate_state(3) / 2.0**32
