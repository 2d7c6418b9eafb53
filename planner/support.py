"""What the planner knows of its support; it changes only with the phase and with the footholds."""

from dataclasses import dataclass

import numpy as np

from planner.footsteps import FootstepPlan
from planner.frames import frame_rotation
from planner.polygon import convex_hull, sole_corners
from planner.stepper import Stepper
from planner.types import Array, Foot, Footstep, PhaseKind
from planner.zmp_reference import SupportTable, support_table


@dataclass(frozen=True, slots=True)
class Support:
    """The present support and the plan frame on it.

    Attributes:
        footsteps: the footsteps that it was made from.
        key: the rest of what it was made from: row, phase and freedom of the next footsteps.
        rotation: plan frame to world, shape (2, 2).
        origin: origin of the plan frame, shape (2,) [m].
        table: support points of the walk in the plan frame.
        heights: heights of the support points, shape (m,) [m].
        outer: support polygon of the planned soles, shape (v, 2) [m].
        inner: support polygon of the soles shrunk to the ZMP margin, shape (v, 2) [m].
        footholds: where the left and the right foot stand, or stood last.
    """

    footsteps: FootstepPlan
    key: tuple[object, ...]
    rotation: Array
    origin: Array
    table: SupportTable
    heights: Array
    outer: Array
    inner: Array
    footholds: tuple[Footstep, Footstep]


def present_support(last: Support | None, stepper: Stepper, half_size: Array, margin: float) -> Support:
    """The support of this tick, the last one when nothing has changed.

    Args:
        last: support of the tick before.
        stepper: clock and footholds.
        half_size: half of the sole's length and width, shape (2,) [m].
        margin: share of the sole in which the ZMP must stay [-].
    """
    steps, row, phase = stepper.footsteps, stepper.row, stepper.phase
    key = (row, phase.start, stepper.free)
    if last is not None and last.footsteps is steps and last.key == key:
        return last
    latest, before = steps.footstep(row), steps.footstep(row - 1)
    standing = [latest] if phase.kind is PhaseKind.SINGLE else [latest, before]
    outer, inner = (
        convex_hull(np.concatenate([sole_corners(foot, scale * half_size) for foot in standing]))
        for scale in (1.0, margin)
    )
    return Support(
        footsteps=steps,
        key=key,
        rotation=frame_rotation(latest.yaw),
        origin=latest.position[:2],
        table=support_table(steps, row, stepper.free, margin * half_size),
        heights=steps.support_points()[:, 2],
        outer=outer,
        inner=inner,
        footholds=(latest, before) if latest.foot is Foot.LEFT else (before, latest),
    )
