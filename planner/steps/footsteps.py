"""The nominal path of a walk, and the footsteps that its strides make along it."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation, wrap_angle
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import Array, FeetState, Foot, Footstep, Twist


@dataclass(frozen=True, slots=True)
class Path:
    """The end so far of the nominal path of a walk.

    Each stride advances it by (x, y) along the mean of its old and new heading and turns it; the foot
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

    def advanced(self, stride: Twist, foot: Foot) -> tuple["Path", Array]:
        """The path after a stride, and where the foot lands that makes it, shape (2,) [m]."""
        turned, side = self.turned + stride.yaw, 0.5 if foot is Foot.LEFT else -0.5
        yaw = self.start_yaw + turned
        middle = self.middle + frame_rotation(self.yaw) @ (0.0, side * (stride.width - self.width))
        middle = middle + frame_rotation(0.5 * (self.yaw + yaw)) @ (stride.x, stride.y)
        place = middle + frame_rotation(yaw) @ (0.0, side * stride.width)
        return Path(middle, self.start_yaw, turned, stride.width), place


def start_footholds(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> tuple[Path, tuple[Footstep, Footstep]]:
    """The beginning of the path, and the two start feet, the one that moves first in front.

    It starts midway between the feet with their mean heading and their width, or where the terrain says; its heading is
    unwrapped from the right foot's.
    """
    (left, right), yaw = feet.position[[Foot.LEFT, Foot.RIGHT], :2], float(feet.yaw[Foot.RIGHT])
    turn = 0.5 * wrap_angle(float(feet.yaw[Foot.LEFT]) - yaw)
    path = Path(0.5 * (left + right), yaw + turn, 0.0, float((left - right) @ frame_rotation(yaw + turn)[:, 1]))
    if terrain.path_start is not None:
        x, y, heading = terrain.path_start
        path = Path(np.array((x, y)), yaw + wrap_angle(heading - yaw), 0.0, gait.step_width)
    rows = (gait.step_foot(-1), gait.step_foot(0))
    position = feet.position[list(rows)]
    normals = terrain.normals(position[:, :2])
    one, other = (Footstep(rows[n], position[n], path.yaw, normals[n]) for n in (0, 1))
    return path, (one, other)


def plan_footsteps(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> tuple[Footstep, ...]:
    """Footsteps of a whole gait from where the feet stand, as they are nominally planned, whenever they are taken.

    Args:
        gait: the gait.
        feet: start feet in the world frame.
        terrain: gives heights and normals of the footsteps, and the start of the path where they belong on treads.

    Returns:
        The start foothold of the foot that moves first, that of the other foot, and one for each step; headings are
        unwrapped.
    """
    path, start = start_footholds(gait, feet, terrain)
    placed = []
    for number, stride in enumerate(gait.strides, 1):
        foot = gait.step_foot(number)
        path, place = path.advanced(stride, foot)
        placed.append((foot, place, path.yaw))
    level = np.array([place for _, place, _ in placed]).reshape(-1, 2)
    grounds = zip(placed, terrain.heights(level), terrain.normals(level), strict=True)
    return *start, *(Footstep(foot, np.append(xy, z), yaw, normal) for (foot, xy, yaw), z, normal in grounds)
