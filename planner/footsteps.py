"""The sequence of footsteps: on level ground a step landed elsewhere shifts all that follow, on treads none."""

from dataclasses import dataclass, replace

import numpy as np

from planner.frames import frame_rotation, wrap_angle
from planner.gait import GaitParameters
from planner.terrain import Terrain
from planner.types import Array, FeetState, Foot, Footstep


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
    """

    feet: tuple[Foot, ...]
    position: Array
    yaw: Array
    normal: Array
    increment: Array

    @property
    def steps(self) -> int:
        """Number of steps n."""
        return len(self.feet) - 2

    def footstep(self, row: int) -> Footstep:
        """The foothold of a row."""
        return Footstep(self.feet[row], self.position[row], float(self.yaw[row]), self.normal[row])

    def moved(self, row: int, position: Array, terrain: Terrain) -> "FootstepPlan":
        """The plan with one foothold somewhere else and its successors at their nominal increments from it.

        Where the ground has edges the successors stay on the treads that were chosen for them.

        Args:
            row: the row that moves.
            position: its new sole centre in the world frame, shape (3,) [m].
            terrain: gives the heights of the shifted successors, or keeps them where they are.
        """
        moved = self.position.copy()
        moved[row] = position
        if terrain.boxes:
            return replace(self, position=moved)
        following = position[:2] + np.cumsum(self.increment[row + 1 :], axis=0)
        moved[row + 1 :, :2] = following
        moved[row + 1 :, 2] = terrain.heights(following)
        return replace(self, position=moved)

    def support_points(self) -> Array:
        """Support points 0..n+1 of the ZMP reference (see `Schedule`), shape (n + 2, 3) [m]."""
        points = self.position.copy()
        points[0] = 0.5 * (self.position[0] + self.position[1])
        points[-1] = 0.5 * (self.position[-2] + self.position[-1])
        return points


def plan_footsteps(gait: GaitParameters, feet: FeetState, terrain: Terrain) -> FootstepPlan:
    """Footsteps of a gait from where the feet stand.

    The path starts midway between the feet with their mean heading. Step i advances it by (`step_length`,
    `lateral_step`) along the mean of its old and new heading and turns it by `turn`; the foot of step i lands beside
    the path's new point, half a step width to its side. The last step does not advance the path: it ends square.

    Args:
        gait: the gait.
        feet: start feet in the world frame.
        terrain: gives heights and normals of the footsteps.
    """
    n = gait.steps
    rows = tuple(gait.step_foot(i - 1) for i in range(n + 2))
    start_yaw = float(feet.yaw[Foot.RIGHT] + 0.5 * wrap_angle(feet.yaw[Foot.LEFT] - feet.yaw[Foot.RIGHT]))
    advance = np.minimum(np.arange(1, n + 1), max(n - 1, 0))
    yaw = start_yaw + gait.turn * np.concatenate(([0.0, 0.0], advance))
    path = np.array(0.5 * (feet.position[Foot.LEFT, :2] + feet.position[Foot.RIGHT, :2]))
    position = np.empty((n + 2, 3))
    position[0], position[1] = feet.position[rows[0]], feet.position[rows[1]]
    for row in range(2, n + 2):
        if row < n + 1:
            path = path + frame_rotation(0.5 * (yaw[row - 1] + yaw[row])) @ (gait.step_length, gait.lateral_step)
        side = 0.5 * gait.step_width * (1.0 if rows[row] is Foot.LEFT else -1.0)
        position[row, :2] = path + frame_rotation(yaw[row]) @ (0.0, side)
    position[2:, 2] = terrain.heights(position[2:, :2])
    increment = np.zeros((n + 2, 2))
    increment[1:] = np.diff(position[:, :2], axis=0)
    return FootstepPlan(rows, position, yaw, terrain.normals(position[:, :2]), increment)
