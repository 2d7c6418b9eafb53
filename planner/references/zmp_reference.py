"""ZMP planner: the present support, and the ZMP reference over a window, linear in the next two footsteps."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra, linear
from surefoot.maths.polygon import convex_hull
from surefoot.planner.geometry.plane import CORNERS, frame_rotation, points_of_sole
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import Array, Foot, Footstep, PhaseKind


@dataclass(frozen=True)
class ZmpReference:
    """ZMP reference and its box over a window, in the plan frame.

    reference(d) = point + gain @ d, where d holds the shifts of the next two footsteps from their nominal increments.

    Attributes:
        point: reference with nominal footsteps, shape (n, 2) [m].
        gain: sensitivity to the two shifts, the same on both axes, shape (n, 2) [-].
        half_size: half extents of the box, which lies in the support polygon, shape (n, 2) [m].
        height: ground height under the reference, shape (n,) [m].
        middle: of the box, from the reference, shape (n, 2) [m]; zero where no foot rolls.
    """

    point: Array
    gain: Array
    half_size: Array
    height: Array
    middle: Array

    def part(self, samples: slice) -> "ZmpReference":
        """The reference over some of its samples."""
        return ZmpReference(
            self.point[samples],
            self.gain[samples],
            self.half_size[samples],
            self.height[samples],
            self.middle[samples],
        )

    def less(self, offset: Array) -> "ZmpReference":
        """The reference and its box less an offset at each sample, shape (n, 2) [m]."""
        return ZmpReference(self.point - offset, self.gain, self.half_size, self.height, self.middle)


Box = tuple[float, float]
"""Half sizes of a box [m]."""


def support_table(
    schedule: Schedule, landed: int, free: tuple[bool, bool], half_size: Array, stay: bool = False
) -> Array:
    """Tabulate the support points (see `PhaseSamples`) in the plan frame, that of the stance foot as planned.

    The box of a point is the largest axis-aligned one, of the foot's proportions, that lies in the foot at its heading
    in the plan frame. Without turning it is the foot itself. Between two feet it is as much wider as both together are.
    A convex combination of two such boxes lies in the convex hull of the two feet. So the box that moves with the
    reference is legal throughout double support.

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
    positions = schedule.positions
    yaws = schedule.yaws
    supports = schedule.supports
    stance = schedule.index(landed)
    table = np.zeros((2, len(supports), 7))
    values = table[0]
    _place_supports(positions, yaws, supports, stance, values)
    _move_supports(supports, stance, np.array(free, dtype=np.float64), stay, values)
    _box_supports(positions, yaws, supports, stance, half_size, values)
    table[1, : len(values) - 1] = values[1:] - values[: len(values) - 1]
    return table


def _place_supports(position: Array, yaw: Array, supports: NDArray[np.intp], stance: int, values: Array) -> None:
    """Place and height of support points, midway between two feet each."""
    c, s = math.cos(yaw[stance]), math.sin(yaw[stance])
    for row in range(supports.shape[0]):
        one, other = supports[row, 0], supports[row, 1]
        x = 0.5 * (position[one, 0] + position[other, 0]) - position[stance, 0]
        y = 0.5 * (position[one, 1] + position[other, 1]) - position[stance, 1]
        values[row, 0], values[row, 1] = x * c + y * s, y * c - x * s
        values[row, 6] = 0.5 * (position[one, 2] + position[other, 2])


def _move_supports(supports: NDArray[np.intp], stance: int, free: Array, stay: bool, values: Array) -> None:
    """Gain of the next two footstep shifts at support points."""
    for row in range(supports.shape[0]):
        for shift in range(2):
            gain, moved = 0.0, stance + 1 + shift
            for end in range(2):
                foot = supports[row, end]
                gain += free[shift] if (foot == moved if stay else foot >= moved) else 0.0
            values[row, 2 + shift] = 0.5 * gain


def _box_supports(
    position: Array, yaw: Array, supports: NDArray[np.intp], stance: int, half_size: Array, values: Array
) -> None:
    """Half sizes of the boxes at support points."""
    c, s = math.cos(yaw[stance]), math.sin(yaw[stance])
    for row in range(supports.shape[0]):
        one, other = supports[row, 0], supports[row, 1]
        first = inscribed_box(half_size[0], half_size[1], yaw[one] - yaw[stance])
        second = inscribed_box(half_size[0], half_size[1], yaw[other] - yaw[stance])
        box = (0.5 * (first[0] + second[0]), 0.5 * (first[1] + second[1]))
        if one != other:
            x, y = position[other, 0] - position[one, 0], position[other, 1] - position[one, 1]
            box = joint_box(box, 0.5 * abs(x * c + y * s), 0.5 * abs(y * c - x * s))
        values[row, 4], values[row, 5] = box[0], box[1]


def inscribed_box(a: float, b: float, yaw: float) -> Box:
    """Half sizes of the largest box of a foot's proportions, a and b [m], in that foot turned by a yaw [rad]."""
    c, s = abs(math.cos(yaw)), abs(math.sin(yaw))
    scale = min(a / (a * c + b * s), b / (a * s + b * c))
    return scale * a, scale * b


def joint_box(box: Box, x: float, y: float) -> Box:
    """The largest box midway between two feet, within the hull of both.

    A box of half sizes (a, b) that is moved by up to ±s (x, y), s in [0, 1], holds one of half sizes (a - s x, b + s y)
    between its extremes; s is that of the greatest area.

    Args:
        box: half sizes of that of one foot [m].
        x: half of the distance of the feet along the box's first side [m].
        y: along its second one [m].
    """
    a, b, most = box[0], box[1], max(2.0 * x * y, 1e-12)
    sideways = algebra.clamp((a * y - b * x) / most, 0.0, 1.0)
    ahead = algebra.clamp((b * x - a * y) / most, 0.0, 1.0)
    wide = (a - sideways * x, b + sideways * y)
    long = (a + ahead * x, b - ahead * y)
    return wide if wide[0] * wide[1] >= long[0] * long[1] else long


def zmp_reference(samples: PhaseSamples, table: Array) -> ZmpReference:
    """ZMP reference of a window: the stance foot in single support, linear to the next one in double support.

    It is eq. (12) in vector form: the paper's scalar S_L is f_{i+1} - f_i, and its t starts anew at each step.

    Args:
        samples: the phases over the window.
        table: support points in sight, made by `support_table`.
    """
    n = len(samples.clock)
    reference = ZmpReference(np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2)), np.empty(n), np.zeros((n, 2)))
    _refer(samples, table, reference.point, reference.gain, reference.half_size, reference.height)
    return reference


def _refer(samples: PhaseSamples, table: Array, point: Array, gain: Array, half_size: Array, height: Array) -> None:
    index, fraction = samples.index, samples.fraction
    for k in range(height.shape[0]):
        i, share = index[k], fraction[k]
        for axis in range(2):
            point[k, axis] = table[0, i, axis] + share * table[1, i, axis]
            gain[k, axis] = table[0, i, 2 + axis] + share * table[1, i, 2 + axis]
            half_size[k, axis] = table[0, i, 4 + axis] + share * table[1, i, 4 + axis]
        height[k] = table[0, i, 6] + share * table[1, i, 6]


class SupportKey(NamedTuple):
    """The values that fix a support in a walk: of two ticks with the same key it is the same, to the last digit.

    Attributes:
        schedule: the steps in sight.
        landed: number of the step that landed last.
        phase_start: begin of the phase on the clock [samples].
        free: whether the next two footsteps may be shifted.
        edges: on which the feet stand, left first; see `Phase.edges`.
    """

    schedule: Schedule
    landed: int
    phase_start: float
    free: tuple[bool, bool]
    edges: tuple[int, int] = (0, 0)


Sole = tuple[Array, Array]
"""Corners of a foot that stands, and of its sole shrunk to the ZMP margin, anticlockwise, shape (4, 2) each [m]."""


_STRIP = 0.02
"""Share of the sole's length that stands for an edge of it, which has none [-]."""


def sole_of(place: Footstep, half_size: Array, margin: float, edge: int = 0) -> Sole:
    """The sole of a foot that carries the robot, or its edge alone, see `Edge`."""
    outer, inner = CORNERS * half_size, CORNERS * (margin * half_size)
    if edge:
        ahead = edge * (1.0 - _STRIP) * half_size[0]
        outer, inner = (each * (_STRIP, 1.0) + (ahead, 0.0) for each in (outer, inner))
    corners = points_of_sole(place, np.concatenate((outer, inner)))
    return corners[:4], corners[4:]


def hull_of(corners: Array, *others: Array) -> Array:
    """Convex hull of the corners of one sole or several, as `convex_hull` tells it."""
    if others:
        return convex_hull(np.concatenate((corners, *others)))
    listed = corners.tolist()
    first = listed.index(min(listed))
    return np.concatenate((corners[first:], corners[:first]))


def hulls_of(soles: list[Sole]) -> tuple[Array, Array]:
    """Convex hulls of soles and of what of them is inside the ZMP margin, as `convex_hull` tells them."""
    outer, inner = zip(*soles, strict=True)
    return hull_of(*outer), hull_of(*inner)


@dataclass(frozen=True)
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
        increment: displacements of the next two footsteps, in the plan frame, zero where none comes, shape (2, 2) [m].
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
    increment: Array

    @property
    def frame(self) -> tuple[Array, Array]:
        """Rotation and origin of the plan frame."""
        return self.rotation, self.origin


def load_left(samples: PhaseSamples, on_left: Array) -> Array:
    """Planned share of the weight on the left foot over a window, shape (n,) [-]; it goes with the ZMP reference.

    Args:
        samples: the phases over the window.
        on_left: that share at the support points in sight, shape (m,) [-].
    """
    load = np.empty(len(samples.clock))
    _share_load(samples, on_left, load)
    return load


def _share_load(samples: PhaseSamples, on_left: Array, load: Array) -> None:
    index, fraction, last = samples.index, samples.fraction, on_left.shape[0] - 1
    for k in range(load.shape[0]):
        i, share = index[k], fraction[k]
        load[k] = (1.0 - share) * on_left[i] + share * on_left[min(i + 1, last)]


@dataclass(frozen=True)
class EdgeContact:
    """The contact of a foot that rolls in a phase: an edge of its sole.

    Attributes:
        phase: its number among those of the window.
        start: begin of the contact [samples].
        end: of the contact [samples].
        on_left: true for the left foot.
        along: from the sole's centre to the edge, along the heading of the stance foot [m].
        aside: from the sole's centre to the edge, to the left of that heading [m].
    """

    phase: int
    start: float
    end: float
    on_left: bool
    along: float
    aside: float


def on_edges(reference: ZmpReference, samples: PhaseSamples, support: Support, count: int) -> ZmpReference:
    """The reference with its box on what is down of feet that roll; the same one where none does.

    A foot that rolls stands on an edge of its half length a ahead or behind, with no length. So its box is around
    ±a, without a length. A convex combination of the boxes of two feet lies in the hull of both: with a share of
    the weight s on a foot that rolls, the middle is at ±s a, and the length is less by s. The reference goes evenly
    from foot to foot meanwhile; where it is not in that box, the box reaches to it.

    Args:
        reference: of a window, for flat feet.
        samples: the phases over the window.
        support: what carries the robot, whose table the reference was made by.
        count: samples in which a ZMP is planned; later boxes tell what feet can do at all.
    """
    if not any([phase.rolls for phase in samples.phases]):
        return reference
    half_size, middle = reference.half_size.copy(), np.zeros_like(reference.point)
    load, schedule = load_left(samples, support.on_left)[:count], support.key.schedule
    ahead, heading = float(schedule.ground.half_size[0]), schedule.step(support.key.landed).place.yaw
    for number, phase in enumerate(samples.phases):
        for roll in phase.rolls:
            step = schedule.step(phase.step)
            if step.place.foot is not roll.foot:
                step = schedule.step(phase.step - 1)
            turned, edge = step.place.yaw - heading, math.copysign(ahead, roll.angle)
            along, aside, on_left = edge * math.cos(turned), edge * math.sin(turned), roll.foot is Foot.LEFT
            edge_contact = EdgeContact(number, roll.start, roll.end, on_left, along, aside)
            _roll(samples, edge_contact, load, reference.half_size, half_size, middle)
    _reach(middle, half_size)
    return ZmpReference(reference.point, reference.gain, half_size, reference.height, middle)


def _roll(
    samples: PhaseSamples, contact: EdgeContact, load: Array, whole: Array, half_size: Array, middle: Array
) -> None:
    """Take the boxes of a foot that rolls to its edge."""
    which, clock = samples.which, samples.clock
    for k in range(load.shape[0]):
        if which[k] == contact.phase and contact.start < clock[k] < contact.end:
            share = load[k] if contact.on_left else 1.0 - load[k]
            middle[k, 0] += share * contact.along
            middle[k, 1] += share * contact.aside
            half_size[k, 0] = max(0.0, half_size[k, 0] - share * whole[k, 0])


def _reach(middle: Array, half_size: Array) -> None:
    """Let boxes reach to their references."""
    for k in range(middle.shape[0]):
        for axis in range(2):
            beyond = abs(middle[k, axis]) - half_size[k, axis]
            if beyond > 0.0:
                half_size[k, axis] += 0.5 * beyond
                middle[k, axis] -= math.copysign(0.5 * beyond, middle[k, axis])


def _increments(schedule: Schedule, landed: int, rotation: Array) -> Array:
    """Increments of a `Support`, by the plan frame's rotation to the world."""
    increment, before = np.zeros((2, 2)), schedule.step(landed).place.position
    for n, step in enumerate(schedule.after(landed)[:2]):
        linear.product((step.place.position - before)[None, :2], rotation, increment[n : n + 1])
        before = step.place.position
    return increment


def present_support(key: SupportKey, phase: PhaseKind, margin: float, room: tuple[float, float]) -> Support:
    """The support of this tick.

    Args:
        key: what it follows from.
        phase: the kind of phase now.
        margin: share of the sole in which the ZMP must stay [-].
        room: what of the half size the ankles can bear, forward and sideways [m].
    """
    schedule, landed, ground = key.schedule, key.landed, key.schedule.ground
    latest, before = schedule.step(landed).place, schedule.step(landed - 1).place
    standing = (latest,) if phase is PhaseKind.SINGLE else (latest, before)
    # Between two feet the reference leaves a sole and comes to one over its edge, a moment before it rolls or after.
    edges = key.edges if phase is PhaseKind.SINGLE else (0, 0)
    outer, inner = hulls_of([sole_of(place, ground.half_size, margin, edges[place.foot]) for place in standing])
    rotation, stay = frame_rotation(latest.yaw), not ground.terrain.footholds.follow
    table = support_table(schedule, landed, key.free, np.minimum(margin * ground.half_size, room), stay)
    return Support(
        key=key,
        rotation=rotation,
        origin=latest.position[:2],
        table=table,
        heights=table[0, :, 6],
        on_left=schedule.on_left,
        outer=outer,
        inner=inner,
        footholds=(latest, before) if latest.foot is Foot.LEFT else (before, latest),
        increment=_increments(schedule, landed, rotation),
    )
