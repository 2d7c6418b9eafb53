"""The sequence of footsteps: on level ground a step landed elsewhere shifts all that follow, on treads none."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import frame_rotation, wrap_angle
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import Array, FeetState, Foot, Footstep
from surefoot.planner.walk.gait import GaitParameters, Stride


@dataclass(frozen=True, slots=True)
class Path:
    """Where the nominal path of a walk has come to.

    Each stride advances it by (`length`, `lateral`) along the mean of its old and new heading and turns it; the foot
    lands beside the path's new point, half the stride's width to its side. Where the width changes, the path first
    moves to lie half the new width beside the stance foot: so where a foot lands from its stance foot is a matter of
    the stride alone.

    Attributes:
        middle: its last point, shape (2,) [m].
        start_yaw: heading at its start [rad].
        turned: since then [rad].
        width: of the last stride [m].
    """

    middle: Array
    start_yaw: float
    turned: float
    width: float

    @property
    def yaw(self) -> float:
        """Its heading now [rad]."""
        return self.start_yaw + self.turned

    def advanced(self, stride: Stride, foot: Foot) -> tuple["Path", Array]:
        """The path after a stride, and where the foot lands that makes it, shape (2,) [m]."""
        turned, side = self.turned + stride.turn, 0.5 if foot is Foot.LEFT else -0.5
        yaw = self.start_yaw + turned
        middle = self.middle + frame_rotation(self.yaw) @ (0.0, side * (stride.width - self.width))
        middle = middle + frame_rotation(0.5 * (self.yaw + yaw)) @ (stride.length, stride.lateral)
        place = middle + frame_rotation(yaw) @ (0.0, side * stride.width)
        return Path(middle, self.start_yaw, turned, stride.width), place

    @classmethod
    def begin(cls, feet: FeetState, terrain: Terrain, width: float) -> "Path":
        """It starts midway between the feet with their mean heading, or where the terrain says.

        Its heading is unwrapped from the right foot's.
        """
        right = float(feet.yaw[Foot.RIGHT])
        if terrain.path_start is not None:
            x, y, yaw = terrain.path_start
            return cls(np.array([x, y]), right + wrap_angle(yaw - right), 0.0, width)
        middle = 0.5 * (feet.position[Foot.LEFT, :2] + feet.position[Foot.RIGHT, :2])
        yaw = right + 0.5 * wrap_angle(float(feet.yaw[Foot.LEFT]) - right)
        return cls(np.asarray(middle), yaw, 0.0, width)


@dataclass(frozen=True, slots=True)
class FootstepPlan:
    """Footholds of a walk, or of the part of it that is in sight, in the world frame.

    Of a whole walk, row 0 is the start foothold of the foot that moves first, row 1 that of the other foot (the stance
    foot of step 1), row i + 1 is footstep i; a part begins at row `first`. A row that has landed holds the measured
    foothold.

    Attributes:
        feet: which foot each row belongs to, length n.
        position: sole centres, shape (n, 3) [m].
        yaw: planned headings, unwrapped, shape (n,) [rad]; landing errors do not enter, so heading does not drift.
        normal: unit normals of the ground, shape (n, 3) [-].
        supports: rows between which each support point of the ZMP reference lies, shape (m, 2): two feet where the
            robot stands, and one, given twice, while it stands on that.
        first: row of the walk that its first one is.
        first_support: support point of the walk that its first one is.
        shift: where the footsteps to come lie from their nominal places, shape (2,) [m].
    """

    feet: tuple[Foot, ...]
    position: Array
    yaw: Array
    normal: Array
    supports: NDArray[np.intp]
    first: int = 0
    first_support: int = 0
    shift: Array = field(default_factory=lambda: np.zeros(2))

    @property
    def steps(self) -> int:
        """Number of steps of the walk up to the last row."""
        return self.first + len(self.feet) - 2

    def footstep(self, row: int) -> Footstep:
        """The foothold of a row."""
        return Footstep(self.feet[row], self.position[row], float(self.yaw[row]), self.normal[row])

    def moved(self, row: int, position: Array, terrain: Terrain) -> "FootstepPlan":
        """The plan with one foothold somewhere else and its successors shifted by as much.

        Where footholds are not free the successors stay on the treads that were chosen for them.

        Args:
            row: the row that moves.
            position: its new sole centre in the world frame, shape (3,) [m].
            terrain: gives the heights of the shifted successors, or keeps them where they are.
        """
        moved, normal, shift = self.position.copy(), self.normal, self.shift
        moved[row] = position
        if terrain.free_footholds:
            way = position[:2] - self.position[row, :2]
            shift = shift + way
            moved[row + 1 :, :2] += way
            moved[row + 1 :, 2] = terrain.heights(moved[row + 1 :, :2])
            normal = np.concatenate((normal[:row], terrain.normals(moved[row:, :2])))
        return replace(self, position=moved, normal=normal, shift=shift)

    def followed(self, place: Footstep) -> "FootstepPlan":
        """The plan with one more footstep."""
        return replace(
            self,
            feet=(*self.feet, place.foot),
            position=np.concatenate((self.position, place.position[None])),
            yaw=np.append(self.yaw, place.yaw),
            normal=np.concatenate((self.normal, place.normal[None])),
        )

    def supported(self, row: int, other: int) -> "FootstepPlan":
        """The plan with one more support point, between two rows of the walk."""
        point = np.array([[row - self.first, other - self.first]])
        return replace(self, supports=np.concatenate((self.supports, point)))

    def swapped(self) -> "FootstepPlan":
        """The plan with its last two rows in the other order."""
        order = np.arange(len(self.feet))
        order[-2:] = order[:-3:-1]
        feet = tuple(self.feet[row] for row in order)
        arrays = {name: getattr(self, name)[order] for name in ("position", "yaw", "normal")}
        return replace(self, feet=feet, supports=order[self.supports], **arrays)

    def since(self, row: int, support: int) -> "FootstepPlan":
        """What of the plan begins at a row and a support point of the walk, or what there is from there on."""
        rows, points = max(row - self.first, 0), max(support - self.first_support, 0)
        supports, first, first_support = self.supports[points:] - rows, self.first + rows, self.first_support + points
        return replace(self._part(slice(rows, None)), supports=supports, first=first, first_support=first_support)

    def until(self, row: int, support: int) -> "FootstepPlan":
        """What of the plan ends with a row and a support point of the walk."""
        supports = self.supports[: support + 1 - self.first_support]
        return replace(self._part(slice(row + 1 - self.first)), supports=supports)

    def _part(self, rows: slice) -> "FootstepPlan":
        arrays = {name: getattr(self, name)[rows] for name in ("feet", "position", "yaw", "normal")}
        return replace(self, **arrays)

    def support_points(self) -> Array:
        """Support points of the ZMP reference (see `planner.walk.queue`), shape (m, 3) [m]."""
        return np.asarray(self.between_rows(self.position))

    def between_rows(self, values: Array) -> Array:
        """What rows of values, shape (n, k), are at the support points: means of two rows, shape (m, k)."""
        return np.asarray(0.5 * (values[self.supports[:, 0]] + values[self.supports[:, 1]]))


def start_footholds(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> tuple[Path, FootstepPlan]:
    """Where the path begins; the two start feet, the one that moves first in front, with the support point between."""
    path = Path.begin(feet, terrain, gait.step_width)
    rows = (gait.step_foot(-1), gait.step_foot(0))
    position = feet.position[list(rows)]
    return path, FootstepPlan(
        rows, position, np.full(2, path.yaw), terrain.normals(position[:, :2]), np.array([[0, 1]])
    )


def plan_footsteps(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> FootstepPlan:
    """Footsteps of a whole gait from where the feet stand, whenever they are taken: without support points of steps.

    Args:
        gait: the gait.
        feet: start feet in the world frame.
        terrain: gives heights and normals of the footsteps, and the start of the path where they belong on treads.
    """
    path, start = start_footholds(gait, feet, terrain)
    rows, yaw, places = list(start.feet), start.yaw.tolist(), list(start.position[:, :2])
    for number, stride in enumerate(gait.strides, 1):
        rows.append(gait.step_foot(number))
        path, place = path.advanced(stride, rows[-1])
        places.append(place)
        yaw.append(path.yaw)
    level = np.array(places)
    position = np.column_stack((level, terrain.heights(level)))
    position[:2] = start.position
    return replace(start, feet=tuple(rows), position=position, yaw=np.array(yaw), normal=terrain.normals(level))
