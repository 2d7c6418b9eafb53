"""ZMP planner: the reference of eq. zmpEquation over a window, linear in the next two footsteps."""

from dataclasses import dataclass

import numpy as np

from planner.footsteps import FootstepPlan
from planner.frames import frame_rotation
from planner.schedule import Schedule
from planner.types import Array


@dataclass(frozen=True, slots=True)
class SupportTable:
    """Support points (see `Schedule`) seen from the plan frame, with what each of them does to reference and box.

    Attributes:
        values: columns x, y [m], gain of the next two footstep shifts [-], box half sizes x, y [m], height [m];
            shape (m, 7).
        steps: difference to the next row, zero in the last one, shape (m, 7).
    """

    values: Array
    steps: Array


@dataclass(frozen=True, slots=True)
class ZmpReference:
    """ZMP reference and its box over a window, in the plan frame.

    reference(d) = point + gain @ d, where d holds the shifts of the next two footsteps from their nominal increments.

    Attributes:
        point: reference with nominal footsteps, shape (n, 2) [m].
        gain: sensitivity to the two shifts, the same on both axes, shape (n, 2) [-].
        half_size: half extents of the box around the reference that lies in the support polygon, shape (n, 2) [m].
        height: ground height under the reference, shape (n,) [m].
    """

    point: Array
    gain: Array
    half_size: Array
    height: Array


def support_table(plan: FootstepPlan, stance_row: int, free: tuple[bool, bool], half_size: Array) -> SupportTable:
    """Tabulate the support points in the plan frame (origin and planned heading of the stance row).

    The box of a point is the largest axis-aligned one, of the foot's proportions, inscribed in the foot turned by its
    heading in the plan frame; without turning it is the foot itself. A convex combination of two such boxes lies in
    the convex hull of the two feet, so the box that moves with the reference is legal throughout double support.

    Args:
        plan: footsteps.
        stance_row: row of the stance foot, or of the foot that landed last.
        free: whether the first and the second footstep after the stance row may be shifted.
        half_size: half extents of the (shrunk) foot, shape (2,) [m].
    """
    rows = np.arange(len(plan.feet))
    points = plan.support_points()
    rotation = frame_rotation(float(plan.yaw[stance_row]))
    values = np.empty((len(points), 7))
    values[:, :2] = (points[:, :2] - plan.position[stance_row, :2]) @ rotation
    shifted = np.where(rows[:, None] > stance_row + np.arange(2), np.array(free, dtype=np.float64), 0.0)
    values[:, 2:4] = plan.between_rows(shifted)
    values[:, 4:6] = plan.between_rows(_inscribed_boxes(plan.yaw - plan.yaw[stance_row], half_size))
    values[:, 6] = points[:, 2]
    steps = np.zeros_like(values)
    steps[:-1] = np.diff(values, axis=0)
    return SupportTable(values, steps)


def zmp_reference(schedule: Schedule, table: SupportTable, start: int, count: int) -> ZmpReference:
    """ZMP reference of a window: the stance foot in single support, linear to the next one in double support.

    Eq. zmpEquation in vector form: the paper's scalar S_L is f_{i+1} - f_i, and its t starts anew at each step.

    Args:
        schedule: phases of the walk.
        table: support points.
        start: first sample of the window.
        count: its length.
    """
    index = schedule.index[start : start + count]
    fraction = schedule.fraction[start : start + count]
    rows = table.values.take(index, axis=0) + fraction[:, None] * table.steps.take(index, axis=0)
    return ZmpReference(rows[:, :2], rows[:, 2:4], rows[:, 4:6], rows[:, 6])


def _inscribed_boxes(yaw: Array, half_size: Array) -> Array:
    c, s = np.abs(np.cos(yaw)), np.abs(np.sin(yaw))
    a, b = half_size
    scale = np.minimum(a / (a * c + b * s), b / (a * s + b * c))
    return np.asarray(scale[:, None] * half_size)
