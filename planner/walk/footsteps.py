"""The sequence of footsteps: on level ground a step landed elsewhere shifts all that follow, on treads none."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import frame_rotation, wrap_angle
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import Array, FeetState, Foot, Footstep
from surefoot.planner.walk.gait import GaitParameters, support_rows
from surefoot.planner.walk.reach import Landing


@dataclass(frozen=True, slots=True)
class FootstepPlan:
    """Footholds of a whole walk in the world frame.

    Row 0 is the start foothold of the foot that moves first, row 1 that of the other foot (the stance foot of step 1),
    row i + 1 is footstep i. A row that has landed holds the measured foothold.

    Attributes:
        feet: which foot each row belongs to, length n + 2.
        position: sole centres, shape (n + 2, 3) [m].
        yaw: planned headings, unwrapped, shape (n + 2,) [rad]; landing errors do not enter, so heading does not drift.
        normal: unit normals of the ground, shape (n + 2, 3) [-].
        increment: nominal displacement from the row before, shape (n + 2, 2) [m].
        supports: rows between which each support point lies, shape (m, 2) (see `planner.walk.gait.support_rows`).
    """

    feet: tuple[Foot, ...]
    position: Array
    yaw: Array
    normal: Array
    increment: Array
    supports: NDArray[np.intp]

    @property
    def steps(self) -> int:
        """Number of steps n."""
        return len(self.feet) - 2

    def footstep(self, row: int) -> Footstep:
        """The foothold of a row."""
        return Footstep(self.feet[row], self.position[row], float(self.yaw[row]), self.normal[row])

    def landing(self, row: int) -> Landing:
        """Where the foot of a row lands nominally, seen from its stance foot, that of the row before."""
        ahead, left = self.increment[row] @ frame_rotation(float(self.yaw[row - 1]))
        beside = left if self.feet[row] is Foot.LEFT else -left
        return Landing(float(ahead), float(beside), float(self.yaw[row] - self.yaw[row - 1]))

    def moved(self, row: int, position: Array, terrain: Terrain) -> "FootstepPlan":
        """The plan with one foothold somewhere else and its successors at their nominal increments from it.

        Where footholds are not free the successors stay on the treads that were chosen for them.

        Args:
            row: the row that moves.
            position: its new sole centre in the world frame, shape (3,) [m].
            terrain: gives the heights of the shifted successors, or keeps them where they are.
        """
        moved = self.position.copy()
        moved[row] = position
        if not terrain.free_footholds:
            return replace(self, position=moved)
        following = position[:2] + np.cumsum(self.increment[row + 1 :], axis=0)
        moved[row + 1 :, :2] = following
        moved[row + 1 :, 2] = terrain.heights(following)
        if not terrain.has_edges:
            return replace(self, position=moved)
        normal = self.normal.copy()
        normal[row:] = terrain.normals(moved[row:, :2])
        return replace(self, position=moved, normal=normal)

    def support_points(self) -> Array:
        """Support points of the ZMP reference (see `Schedule`), shape (m, 3) [m]."""
        return np.asarray(self.between_rows(self.position))

    def between_rows(self, values: Array) -> Array:
        """What rows of values, shape (n + 2, k), are at the support points: means of two rows, shape (m, k)."""
        return np.asarray(0.5 * (values[self.supports[:, 0]] + values[self.supports[:, 1]]))


def plan_footsteps(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> FootstepPlan:
    """Footsteps of a gait from where the feet stand.

    The path starts midway between the feet with their mean heading, or where the terrain says. Each stride advances it
    by (`length`, `lateral`) along the mean of its old and new heading and turns it; the foot lands beside the path's
    new point, half the stride's width to its side. Where the width changes, the path first moves to lie half the new
    width beside the stance foot: so where a foot lands from its stance foot is a matter of the stride alone.

    Args:
        gait: the gait.
        feet: start feet in the world frame.
        terrain: gives heights and normals of the footsteps, and the start of the path where they belong on treads.
    """
    n, strides = gait.steps, gait.strides
    rows = tuple(gait.step_foot(i - 1) for i in range(n + 2))
    path, start_yaw = _path_start(feet, terrain)
    yaw = start_yaw + np.cumsum([0.0, 0.0, *(stride.turn for stride in strides)])
    width = gait.step_width
    position = np.empty((n + 2, 3))
    position[0], position[1] = feet.position[rows[0]], feet.position[rows[1]]
    for row, stride in enumerate(strides, 2):
        side = 0.5 if rows[row] is Foot.LEFT else -0.5
        path = path + frame_rotation(yaw[row - 1]) @ (0.0, side * (stride.width - width))
        path = path + frame_rotation(0.5 * (yaw[row - 1] + yaw[row])) @ (stride.length, stride.lateral)
        width = stride.width
        position[row, :2] = path + frame_rotation(yaw[row]) @ (0.0, side * width)
    position[2:, 2] = terrain.heights(position[2:, :2])
    increment = np.zeros((n + 2, 2))
    increment[1:] = np.diff(position[:, :2], axis=0)
    normal = terrain.normals(position[:, :2])
    return FootstepPlan(rows, position, yaw, normal, increment, support_rows(gait.walk))


def _path_start(feet: FeetState, terrain: Terrain) -> tuple[Array, float]:
    """Where the path starts, shape (2,) [m], and its heading there, unwrapped from the right foot's [rad]."""
    right = float(feet.yaw[Foot.RIGHT])
    if terrain.path_start is not None:
        x, y, yaw = terrain.path_start
        return np.array([x, y]), right + wrap_angle(yaw - right)
    middle = 0.5 * (feet.position[Foot.LEFT, :2] + feet.position[Foot.RIGHT, :2])
    return np.asarray(middle), right + 0.5 * wrap_angle(float(feet.yaw[Foot.LEFT]) - right)
