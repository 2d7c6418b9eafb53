"""Places of things of the estimate's world in the true one, so that its drift is no error of a walk."""

import numpy as np

from surefoot.planner.geometry.plane import yaw_rotations
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.digest import Array, Mask, Rows, RunView

_TOPIC = "/estimation"

PLACED: Reads = {_TOPIC: ("left_sole", "right_sole", "yaw_error")}
"""Fields that `to_truth` reads where they are; no metric needs them."""


def to_truth(run: RunView, points: Array, rows: Rows | None = None, right: Mask | None = None) -> Array:
    """Points of the estimate's world in the true one: as they are where the state is the truth.

    A foot takes the points to where it truly stands, and the error of the heading turns them about it.

    Args:
        run: the run.
        points: world, shape (n, 2 or 3) or (n, k, 2 or 3) [m].
        rows: control ticks that they are of; None for all.
        right: whether the right foot takes them or the left one, shape (n,); None for that which carries more.
    """
    if not run.has(_TOPIC):
        return points
    pick = slice(None) if rows is None else rows
    if right is None:
        force = run.field("/contact", "normal_force")[pick]
        right = force[:, 1] > force[:, 0]
    size = points.shape[-1]
    sole, true = (
        np.where(right[:, None], poses[1][pick][:, :size], poses[0][pick][:, :size])
        for poses in ([run.field(_TOPIC, f"{side}_sole") for side in ("left", "right")], [run.sole(0), run.sole(1)])
    )
    R = yaw_rotations(-run.field(_TOPIC, "yaw_error")[pick])[:, :size, :size]
    away = points.reshape(len(points), -1, size) - sole[:, None]
    moved = np.einsum("nij,nkj->nki", R, away) + true[:, None]
    return np.asarray(moved.reshape(points.shape))
