"""ZMP planner: the present support, and the ZMP reference over a window, linear in the next two footsteps."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from surefoot.planner.geometry import CORNERS, frame_rotation, points_of_sole
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import Array, Foot, Footstep, PhaseKind
from surefoot.polygon import convex_hull
from surefoot.values import dataclass, maker


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

    def part(self, samples: slice) -> "ZmpReference":
        """The reference over some of its samples."""
        return ZmpReference(self.point[samples], self.gain[samples], self.half_size[samples], self.height[samples])


def support_table(
    schedule: Schedule, landed: int, free: tuple[bool, bool], half_size: Array, stay: bool = False
) -> Array:
    """Tabulate the support points (see `PhaseSamples`) in the plan frame, that of the stance foot as planned.

    The box of a point is the largest axis-aligned one, of the foot's proportions, inscribed in the foot turned by its
    heading in the plan frame; without turning it is the foot itself. Between two feet it is as much wider as both
    together are. A convex combination of two such boxes lies in the convex hull of the two feet, so the box that moves
    with the reference is legal throughout double support.

    Args:
        schedule: the steps in sight.
        landed: number of the step that landed last, whose foot is or will be the stance foot.
        free: whether the first and the second footstep after it may be shifted.
        half_size: half extents of the (shrunk) foot, shape (2,) [m].
        stay: footsteps stay where they are when the one before them is shifted.

    Returns:
        Columns x, y [m], gain of the next two footstep shifts [-], box half sizes x, y [m], height [m], and their
        differences to the next row, zero in the last one, shape (2, m, 7).
    """
    stance, points = schedule.index(landed), schedule.support_points
    position, yaw = schedule.positions, schedule.yaws
    rotation = frame_rotation(float(yaw[stance]))
    values = np.empty((len(points), 7))
    values[:, :2] = (points[:, :2] - position[stance, :2]) @ rotation
    moves, rows = np.equal if stay else np.greater_equal, np.arange(len(position))
    shifted = np.where(moves(rows[:, None], stance + np.arange(1, 3)), np.array(free, dtype=np.float64), 0.0)
    values[:, 2:4] = schedule.at_supports(shifted)
    values[:, 4:6] = schedule.at_supports(_inscribed_boxes(yaw - yaw[stance], half_size))
    one, other = schedule.supports.T
    between = one != other
    apart = (position[other[between], :2] - position[one[between], :2]) @ rotation
    values[between, 4:6] = _joint_boxes(values[between, 4:6], 0.5 * np.abs(apart))
    values[:, 6] = points[:, 2]
    return np.stack((values, np.diff(values, axis=0, append=values[-1:])))


def zmp_reference(samples: PhaseSamples, table: Array) -> ZmpReference:
    """ZMP reference of a window: the stance foot in single support, linear to the next one in double support.

    It is eq. (12) in vector form: the paper's scalar S_L is f_{i+1} - f_i, and its t starts anew at each step.

    Args:
        samples: the phases over the window.
        table: support points in sight, as of `support_table`.
    """
    index, (values, steps) = samples.index, table
    rows = values.take(index, axis=0) + samples.fraction[:, None] * steps.take(index, axis=0)
    return ZmpReference(rows[:, :2], rows[:, 2:4], rows[:, 4:6], rows[:, 6])


def _inscribed_boxes(yaw: Array, half_size: Array) -> Array:
    c, s = np.abs(np.cos(yaw)), np.abs(np.sin(yaw))
    a, b = half_size
    scale = np.minimum(a / (a * c + b * s), b / (a * s + b * c))
    return np.asarray(scale[:, None] * half_size)


def _joint_boxes(boxes: Array, apart: Array) -> Array:
    """Largest boxes midway between two feet, within the hull of both.

    A box of half sizes (a, b) that is moved by up to ±s (x, y), s in [0, 1], holds one of half sizes (a - s x, b + s y)
    between its extremes; s is that of the greatest area.

    Args:
        boxes: half sizes of those of one foot, shape (n, 2) [m].
        apart: half of the distance of the feet, shape (n, 2) [m].
    """
    (a, b), (x, y) = boxes.T, apart.T
    sideways = np.clip((a * y - b * x) / np.maximum(2.0 * x * y, 1e-12), 0.0, 1.0)
    ahead = np.clip((b * x - a * y) / np.maximum(2.0 * x * y, 1e-12), 0.0, 1.0)
    wide = np.column_stack((a - sideways * x, b + sideways * y))
    long = np.column_stack((a + ahead * x, b - ahead * y))
    return np.where((wide.prod(axis=1) >= long.prod(axis=1))[:, None], wide, long)


class SupportKey(NamedTuple):
    """What a support follows from in a walk: of two ticks with the same key it is the same, to the last digit.

    Attributes:
        schedule: the steps in sight.
        landed: number of the step that landed last.
        phase_start: begin of the phase on the clock [samples].
        free: whether the next two footsteps may be shifted.
    """

    schedule: Schedule
    landed: int
    phase_start: float
    free: tuple[bool, bool]


class Sole(NamedTuple):
    """Corners of a foot that stands, anticlockwise, shape (4, 2) each [m].

    Attributes:
        place: where it stands.
        outer: those of the sole.
        inner: those of the sole shrunk to the ZMP margin.
    """

    place: Footstep
    outer: Array
    inner: Array

    @classmethod
    def of(cls, place: Footstep, half_size: Array, margin: float) -> "Sole":
        """That of a foot, arguments as of `present_support`."""
        corners = points_of_sole(place, np.concatenate((CORNERS * half_size, CORNERS * (margin * half_size))))
        return cls(place, corners[:4], corners[4:])


def hull_of(corners: Array, *others: Array) -> Array:
    """Convex hull of the corners of one sole or several, as `convex_hull` tells it."""
    if others:
        return convex_hull(np.concatenate((corners, *others)))
    told = corners.tolist()
    first = told.index(min(told))
    return np.concatenate((corners[first:], corners[:first]))


def hulls_of(soles: tuple[Sole, ...]) -> tuple[Array, Array]:
    """Convex hulls of soles and of what of them is inside the ZMP margin, as `convex_hull` tells them."""
    return hull_of(*(sole.outer for sole in soles)), hull_of(*(sole.inner for sole in soles))


@dataclass(frozen=True, slots=True)
class Support:
    """The present support and the plan frame on it.

    Attributes:
        key: what it follows from.
        rotation: plan frame to world, shape (2, 2).
        origin: origin of the plan frame, shape (2,) [m].
        table: support points in sight, in the plan frame, shape (2, m, 7).
        heights: heights of the support points, shape (m,) [m].
        on_left: share of the weight on the left foot at the support points, shape (m,) [-].
        outer: support polygon of the planned soles, shape (v, 2) [m].
        inner: support polygon of the soles shrunk to the ZMP margin, shape (v, 2) [m].
        footholds: where the left and the right foot stand, or stood last.
        soles: those on which the robot stands.
    """

    key: SupportKey
    rotation: Array
    origin: Array
    table: Array
    heights: Array
    on_left: Array
    outer: Array
    inner: Array
    footholds: tuple[Footstep, Footstep]
    soles: tuple[Sole, ...]

    @property
    def frame(self) -> tuple[Array, Array]:
        """Rotation and origin of the plan frame."""
        return self.rotation, self.origin


_a_support = maker(Support)


def load_left(samples: PhaseSamples, support: Support) -> Array:
    """Planned share of the weight on the left foot over a window, shape (n,) [-]; it goes with the ZMP reference."""
    index, fraction, share = samples.index, samples.fraction, support.on_left
    return np.asarray((1.0 - fraction) * share[index] + fraction * share[np.minimum(index + 1, len(share) - 1)])


def present_support(
    last: Support | None,
    execution: Execution,
    half_size: Array,
    margin: float,
    room: tuple[float, float],
    tabulated: Callable[..., Array] = support_table,
    hulls: Callable[[tuple[Sole, ...]], tuple[Array, Array]] = hulls_of,
) -> Support:
    """The support of this tick, the last one while its key stays.

    Args:
        last: support of the tick before.
        execution: the steps in sight, and how far they have been made.
        half_size: half of the sole's length and width, shape (2,) [m].
        margin: share of the sole in which the ZMP must stay [-].
        room: what of the half size the ankles can bear, forward and sideways [m].
        tabulated: `support_table`, or a kernel in its place.
        hulls: `hulls_of`, likewise.
    """
    schedule, landed, phase = execution.schedule, execution.landed, execution.phase
    key = SupportKey(schedule, landed, phase.start, execution.free)
    if last is not None and last.key == key:
        return last
    latest, before = schedule.step(landed).place, schedule.step(landed - 1).place
    standing = (latest,) if phase.kind is PhaseKind.SINGLE else (latest, before)
    known = {} if last is None else {id(sole.place): sole for sole in last.soles}
    soles = tuple(known.get(id(place)) or Sole.of(place, half_size, margin) for place in standing)
    if last is not None and [*map(id, soles)] == [*map(id, last.soles)]:
        outer, inner = last.outer, last.inner
    else:
        outer, inner = hulls(soles)
    stay = not schedule.ground.terrain.footholds.follow
    table = tabulated(schedule, landed, key.free, np.minimum(margin * half_size, room), stay)
    return _a_support(
        key=key,
        rotation=frame_rotation(latest.yaw),
        origin=latest.position[:2],
        table=table,
        heights=table[0, :, 6],
        on_left=schedule.on_left,
        outer=outer,
        inner=inner,
        footholds=(latest, before) if latest.foot is Foot.LEFT else (before, latest),
        soles=soles,
    )
