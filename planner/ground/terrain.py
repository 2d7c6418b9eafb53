"""Terrain as data: what the planner knows of the ground and what the simulator turns into geoms."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import CORNERS, frame_rotation
from surefoot.planner.ground.footholds import Footholds
from surefoot.planner.types import Array, Footstep

HALF_WIDTH = 1.0
"""Half of the lateral extent of stairs and slopes [m]."""

DEEPER = 0.05
"""Least depth of tilted solids below the ground plane, and least height of the lowest blocks above it [m]."""

_FREE, _FACES = Footholds(follow=True), Footholds(follow=False)


@dataclass(frozen=True, slots=True)
class Box:
    """A solid box that feet may stand on.

    Attributes:
        center: box centre in the world frame, shape (3,) [m].
        half_size: half extents along the box axes, shape (3,) [m].
        rotation: box-to-world rotation matrix, shape (3, 3) [-].
        friction: Coulomb coefficient of its surface; None for that of the terrain [-].
    """

    center: Array
    half_size: Array
    rotation: Array
    friction: float | None = None

    def top(self, points: Array) -> tuple[Array, Array]:
        """The plane of the top face above or below world points.

        Args:
            points: x, y in the world frame, shape (k, 2) [m].

        Returns:
            Heights of the plane, shape (k,) [m]; distances of the points on it from the face's nearest edge, positive
            on the face, shape (k,) [m].
        """
        normal = self.rotation[:, 2]
        face = self.center + self.half_size[2] * normal
        z = face[2] - (points - face[:2]) @ normal[:2] / normal[2]
        local = (np.column_stack((points, z)) - self.center) @ self.rotation[:, :2]
        return z, np.min(self.half_size[:2] - np.abs(local), axis=1)

    def touched(self, soles: Array, half: Array) -> NDArray[np.bool_]:
        """Mark the soles with a part over it: rectangles on the ground are apart if an axis of one of them parts them.

        Args:
            soles: places and headings, shape (n, 3) [m, rad].
            half: half length and width of a sole, shape (2,) [m].

        Returns:
            Shape (n,) [-].
        """
        centre, size, axes = self.center[:2], self.half_size[:2], self.rotation[:2, :2].T
        c, s = np.cos(soles[:, 2]), np.sin(soles[:, 2])
        own = np.stack([np.stack([c, s], -1), np.stack([-s, c], -1)], axis=1)
        between = centre - soles[:, :2]
        across = np.abs(own @ axes.T)  # of each axis of the sole along each of the box
        apart_by_sole = np.abs(np.einsum("nij,nj->ni", own, between)) > half + across @ size
        apart_by_box = np.abs(between @ axes.T) > size + np.einsum("nij,i->nj", across, half)
        return np.asarray(~(apart_by_sole.any(axis=1) | apart_by_box.any(axis=1)))


@dataclass(frozen=True, slots=True)
class Terrain:
    """A level ground plane with boxes on it.

    Attributes:
        boxes: solids on the plane; the highest top face under a point carries it.
        friction: Coulomb coefficient of every surface [-].
        path_start: x, y [m] and heading [rad] from which footsteps are laid, wherever exactly the feet stand; None
            where any other place is as good.
        wide: whether its faces are so wide that a footstep may be moved anywhere in reach, and its successors with it.
        plane: height of the ground plane wherever no box is [m]; the start may be on a box that is higher.
    """

    boxes: tuple[Box, ...] = ()
    friction: float = 0.8
    path_start: tuple[float, float, float] | None = None
    wide: bool = False
    plane: float = 0.0

    @property
    def has_edges(self) -> bool:
        """True if there is anything that a swing foot may have to clear."""
        return bool(self.boxes)

    @property
    def footholds(self) -> Footholds:
        """The freedom of footsteps: they were chosen for its faces unless these are wide, or there are none."""
        return _FREE if self.wide or not self.boxes else _FACES

    def height(self, x: float, y: float) -> float:
        """Ground height [m] at the world point (x, y)."""
        return float(self.heights(np.array([[x, y]]))[0])

    def heights(self, points: Array) -> Array:
        """Ground heights at world points x, y, shape (k, 2) [m]; shape (k,) [m]."""
        highest = np.empty(len(points))
        highest.fill(self.plane)  # numpy.full takes longer
        for box in self.boxes:
            top, inside = box.top(points)
            highest = np.where(inside >= 0.0, np.maximum(highest, top), highest)
        return highest

    def normal(self, x: float, y: float) -> Array:
        """Unit normal of the ground at the world point (x, y), shape (3,) [-]."""
        return np.asarray(self.normals(np.array([[x, y]]))[0])

    def normals(self, points: Array) -> Array:
        """Unit normals of the faces that carry world points x, y, shape (k, 2) [m]; shape (k, 3) [-]."""
        normals = np.zeros((len(points), 3))
        normals[:, 2] = 1.0
        if not self.boxes:
            return normals
        highest = np.full(len(points), self.plane)
        for box in self.boxes:
            top, inside = box.top(points)
            carrying = (inside >= 0.0) & (top > highest)
            highest[carrying] = top[carrying]
            normals[carrying] = box.rotation[:, 2]
        return normals

    def edge_margins(self, centers: Array, corners: Array) -> Array:
        """Least distance of each sole's corners from the edge of the face that carries the sole's centre.

        Negative when a corner is beyond the edge: it hangs over, or stands in a riser. On the ground plane the edges
        are those of the boxes around; without any the distance is infinite.

        Args:
            centers: centres of soles in the world frame, x, y, shape (n, 2) [m].
            corners: their corners, shape (n, k, 2) [m].

        Returns:
            Shape (n,) [m].
        """
        points, shape = corners.reshape(-1, 2), corners.shape[:2]
        highest, margins = np.full(len(centers), self.plane), np.full(len(centers), np.inf)
        for box in self.boxes:
            height, inside = box.top(centers)
            corner_inside = box.top(points)[1].reshape(shape)
            on_plane = (highest == self.plane) & (inside < 0.0)
            margins[on_plane] = np.minimum(margins, -corner_inside.max(axis=1))[on_plane]
            carrying = (inside >= 0.0) & (height > highest)
            highest[carrying] = height[carrying]
            margins[carrying] = corner_inside.min(axis=1)[carrying]
        return margins

    def carries(self, soles: Array, half: Array, number: int) -> bool:
        """Return true if a sole has a part over a box that other ground does not bury there.

        Args:
            soles: places and headings, shape (n, 3) [m, rad].
            half: half length and width of a sole, shape (2,) [m].
            number: of the box.
        """
        box = self.boxes[number]
        over = soles[box.touched(soles, half)]
        ahead = np.stack([np.cos(over[:, 2]), np.sin(over[:, 2])], axis=-1)
        left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
        points = over[:, None, :2] + (_PATCH * half) @ np.stack([ahead, left], axis=1)
        top, inside = box.top(points.reshape(-1, 2))
        under = self.heights(points.reshape(-1, 2)) > top + _ABOVE
        within, free = (mask.reshape(-1, len(_PATCH)) for mask in (inside >= 0.0, (inside >= 0.0) & ~under))
        # A corner of the box between the points counts as free.
        return bool((free.any(axis=1) | ~within.any(axis=1)).any())

    def free_area(self, position: Array, yaw: float, half_size: Array, length: float = 1.0) -> Array:
        """Room of a sole on the face that carries it, ahead and to the left of where it was to land.

        Args:
            position: where it was to, shape (3,) [m].
            yaw: its heading [rad].
            half_size: half of its length and width, shape (2,) [m].
            length: size of the robot (see `surefoot.similarity`) [-].

        Returns:
            Least and greatest way, shape (2, 2) [m]; without bounds where footsteps may land anywhere.
        """
        if self.footholds.follow:
            return np.array([[-np.inf] * 2, [np.inf] * 2])
        axes, ways, kept = frame_rotation(yaw).T, length * _WAYS, length * _KEPT
        moved = position[:2] + (np.vstack((-axes, axes))[:, None] * ways[:, None]).reshape(-1, 2)
        soles = moved[:, None] + (half_size * CORNERS) @ axes
        level = position[2] - (moved - position[:2]) @ (normal := self.normal(*position[:2]))[:2] / normal[2]
        off = (self.edge_margins(moved, soles) < kept) | (np.abs(self.heights(moved) - level) > kept)
        # A shank leans over its foot: beyond it nothing may rise so near.
        beyond = (soles.reshape(4, -1, 2) + length * _SHANK * np.vstack((-axes, axes))[:, None]).reshape(-1, 2)
        off |= (self.heights(beyond).reshape(len(moved), -1) - level[:, None] > kept).any(axis=1)
        first = np.argmax(np.column_stack((off.reshape(4, -1), np.ones(4, dtype=np.bool_))), axis=1)
        way = np.append(0.0, ways)[first].reshape(2, 2)
        return np.array([-way[0], way[1]])


_WAYS = 0.01 * np.arange(1.0, 81.0)
"""Ways by which a sole might be moved on its face, of the reference robot as all lengths here [m]."""

_PATCH = np.stack(np.meshgrid(np.linspace(-1.0, 1.0, 9), np.linspace(-1.0, 1.0, 5)), axis=-1).reshape(-1, 2)
"""Points of a sole at which the ground under it is looked at, in its half sizes [-]."""

_ABOVE = 1e-6
"""Height by which other ground lies above a box that it buries [m]."""

_SHANK = 0.04
"""Way beyond a sole in which the ground must not rise for it to be moved there [m]."""

_KEPT = 0.01
"""Distance from the edges of its face that it keeps then, and from another face in height [m]."""


def flat(friction: float = 0.8) -> Terrain:
    """The bare ground plane, with a friction [-]."""
    return Terrain(boxes=(), friction=friction)


def _unknown() -> tuple[Footstep, ...]:
    raise ParameterError(("terrain", "footsteps"), "this ground is laid under footsteps", "give its site the footsteps")


@dataclass(frozen=True, slots=True)
class Site:
    """The place where ground is built, and the walk for which it is.

    Attributes:
        origin: start of the walk in the world frame, x, y, shape (2,) [m].
        yaw: heading of the walk [rad].
        friction: Coulomb coefficient of every surface [-].
        footsteps: gives start feet and footsteps, heights do not matter; asked by ground that is laid under them.
        rng: draws what is random.
    """

    origin: Array
    yaw: float
    friction: float
    footsteps: Callable[[], tuple[Footstep, ...]] = _unknown
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
