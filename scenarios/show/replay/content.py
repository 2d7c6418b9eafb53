"""The content of a replay, whatever shows it: frames, surfaces on bodies, footprints, and marks made of facts."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import level_corners, rotations
from surefoot.scenarios import palette
from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.logview import FOOT_NAMES

Array = NDArray[np.float64]

MarkKind = Literal["point", "arrow", "outline"]


@dataclass(frozen=True, slots=True)
class ReplayWindow:
    """The window of a run that is asked for.

    Attributes:
        start: first time, the log's if None [s].
        end: last time, the log's if None [s].
        frame_rate: frames per simulated second [Hz].
        most: frames; where there would be more, there are fewer per second. None for any number.
        beside: file of a motion that is drawn beside the robot; None for none.
    """

    start: float | None = None
    end: float | None = None
    frame_rate: float = 30.0
    most: int | None = None
    beside: Path | None = None


@dataclass(frozen=True, slots=True)
class Frames:
    """The ticks that are shown.

    Attributes:
        time: of each frame, shape (n,) [s].
        rows: of the control-rate channels, shape (n,).
        rate: frames per simulated second [Hz].
    """

    time: Array
    rows: NDArray[np.intp]
    rate: float

    def strongest(self, strength: Array, ticks: Array, seconds: float) -> NDArray[np.intp]:
        """Row of the greatest strength, by control tick, within some seconds before each frame, its own included."""
        first = np.minimum(np.searchsorted(ticks, self.time - seconds), self.rows)
        windows = zip(first.tolist(), self.rows.tolist(), strict=True)
        return np.array([begin + int(strength[begin : end + 1].argmax()) for begin, end in windows])


@dataclass(frozen=True, slots=True)
class Surface:
    """Triangles that move with a body.

    Attributes:
        body: index of the body; 0 is the world.
        color: of the surface.
        vertices: in the body's frame, shape (k, 3) [m].
        faces: indices of vertices, counter-clockwise from outside, shape (m, 3).
    """

    body: int
    color: Color
    vertices: Array
    faces: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Track:
    """A mark that moves.

    Attributes:
        layer: what it is switched on and off with.
        name: what it is, within the layer.
        kind: a point has one vertex, an arrow a tail and a head, an outline two or more in order and is closed.
        color: of the mark.
        size: radius of a point, of an arrow's shaft or of an outline's line [m].
        vertices: in the world by frame, NaN where there is nothing to show, shape (n, k, 3) [m].
        trail: whether its path is worth drawing.
    """

    layer: str
    name: str
    kind: MarkKind
    color: Color
    size: float
    vertices: Array
    trail: bool = False

    def shown(self, frame: int) -> bool:
        """Return true if there is something to show in a frame."""
        return bool(np.isfinite(self.vertices[frame]).all())

    def path(self, frames: slice) -> Array:
        """Path of a point, without the frames in which it was not shown, shape (k, 3) [m]."""
        points = self.vertices[frames, 0]
        return np.asarray(points[np.isfinite(points).all(axis=1)])


@dataclass(frozen=True, slots=True)
class Footprint:
    """The footprint of a sole that has been set down; it stays.

    Attributes:
        color: of the foot.
        corners: of the sole in the world, in order, shape (4, 3) [m].
        since: time of the touchdown [s].
    """

    color: Color
    corners: Array
    since: float


SWAY = 1.0
"""Over how long a camera that follows the robot takes the mean of where it is [s]."""


@dataclass(frozen=True, slots=True)
class Replay:
    """A stretch of a run at an even frame rate.

    Attributes:
        title: what is shown.
        frame_rate: of the content [Hz].
        time: simulated time of each frame, shape (n,) [s].
        configuration: of the robot by frame, in Pinocchio's convention, shape (n, nq).
        body_names: by body.
        body_position: origins of the bodies in the world by frame, shape (n, bodies, 3) [m].
        body_quaternion: w x y z by frame, shape (n, bodies, 4).
        surfaces: of the robot and of the terrain.
        tracks: marks that move.
        footprints: that were taken, in order of time.
        mjcf: text of the simulated world.
    """

    title: str
    frame_rate: float
    time: Array
    configuration: Array
    body_names: tuple[str, ...]
    body_position: Array
    body_quaternion: Array
    surfaces: tuple[Surface, ...]
    tracks: tuple[Track, ...]
    footprints: tuple[Footprint, ...]
    mjcf: str

    def __len__(self) -> int:
        return len(self.time)

    def legend(self) -> dict[str, Color]:
        """Colours of the marks that are ever shown, by name."""
        found: dict[str, Color] = {}
        for track in self.tracks:
            name = track.layer if track.layer != "Contact forces" else f"Force, {track.name}"
            if np.isfinite(track.vertices).all(axis=(1, 2)).any():
                found.setdefault(name, track.color)
        return found

    def followed(self) -> Array:
        """Point that a camera which follows the robot looks at: the base without its sway, shape (n, 3) [m]."""
        base, half = self.body_position[:, 1], round(SWAY * self.frame_rate / 2)
        padded = np.pad(base, ((half, half), (0, 0)), mode="edge")
        return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0).mean(axis=-1))


LIFT = 0.004
"""Height at which marks on the ground are drawn above it [m]."""

CONTACT_SCALE = 0.0005
"""Length of a contact force's arrow [m/N]: 1000 N are 0.5 m."""

PUSH_SCALE = 0.002
"""Length of a push's arrow [m/N]: 200 N are 0.4 m."""

PUSH_SHOWN = 0.3
"""Time for which a push stays in sight after its end, since many last less than a frame [s]."""

LEAST_FORCE = 5.0
"""Weaker forces are not drawn [N]."""

SoleSize = tuple[float, float]
"""Length and width of a sole [m]."""


@dataclass(frozen=True, slots=True)
class Facts:
    """The facts that marks are made of, by frame, from a log or from a run that goes on.

    Attributes:
        com: true CoM, shape (n, 3) [m].
        dcm: shape (n, 2) [m].
        zmp: shape (n, 3) [m]; NaN in flight.
        planned_com: shape (n, 3) [m].
        planned_dcm: shape (n, 2) [m].
        planned_zmp: shape (n, 2) [m].
        polygon: vertices of the planned support polygon, shape (n, k, 2) [m].
        contacts: whether the left and the right foot shall stand, shape (n, 2).
        soles: x y z qx qy qz qw of both feet, shape (n, 2, 7) [m].
        cop: centres of pressure in the sole frames, shape (n, 2, 2) [m].
        force: on the soles in their frames, shape (n, 2, 3) [N].
        ahead: x y z yaw of the footsteps to come, shape (n, k, 4) [m, rad].
        ahead_foot: 0 for the left one, 1 for the right one, another number for none, shape (n, k).
        push: force, shape (n, 3) [N].
        pushed: where it acts, shape (n, 3) [m].
        sole: of the robot.
    """

    com: Array
    dcm: Array
    zmp: Array
    planned_com: Array
    planned_dcm: Array
    planned_zmp: Array
    polygon: Array
    contacts: NDArray[np.bool_]
    soles: Array
    cop: Array
    force: Array
    ahead: Array
    ahead_foot: Array
    push: Array
    pushed: Array
    sole: SoleSize


def tracks(facts: Facts) -> Iterator[Track]:
    """Every mark that moves."""
    yield from _balance(facts)
    for foot, name in enumerate(FOOT_NAMES):
        for ahead in range(facts.ahead.shape[1]):
            corners = sole_corners(facts.ahead[:, ahead], facts.sole)
            corners[facts.ahead_foot[:, ahead] != foot] = np.nan
            place = f"{name}, {ahead + 1} ahead"
            yield Track("Planned footprints", place, "outline", palette.FOOTSTEP, 0.003, corners)
    for foot, name in enumerate(FOOT_NAMES):
        to_world = rotations(facts.soles[:, foot, 3:])
        tail = facts.soles[:, foot, :3] + np.einsum("nij,nj->ni", to_world[:, :, :2], facts.cop[:, foot])
        arrow = _arrow(tail, np.einsum("nij,nj->ni", to_world, facts.force[:, foot]), CONTACT_SCALE)
        yield Track("Contact forces", name, "arrow", palette.FEET[foot], 0.012, arrow)
    arrow = _arrow(facts.pushed - PUSH_SCALE * facts.push, facts.push, PUSH_SCALE)  # which ends where it acts
    yield Track("Pushes", "push", "arrow", palette.PUSH, 0.02, arrow)


def _balance(facts: Facts) -> Iterator[Track]:
    """CoM with its plumb line, DCM, ZMP and the planned support polygon."""
    com, ground = facts.com, np.asarray(facts.soles[:, :, 2].min(axis=1))
    below = _flat(com[:, :2], ground)
    yield _point("CoM", "measured", palette.COM, 0.035, com, trail=True)
    yield _point("CoM", "on the ground", palette.COM, 0.014, below)
    yield Track("CoM", "plumb line", "outline", palette.paler(palette.COM), 0.002, np.stack([com, below], axis=1))
    yield _point("CoM", "planned", palette.COM_PLANNED, 0.025, facts.planned_com)
    yield _point("DCM", "measured", palette.DCM, 0.014, _flat(facts.dcm, ground), trail=True)
    yield _point("DCM", "planned", palette.DCM_PLANNED, 0.01, _flat(facts.planned_dcm, ground))
    yield _point("ZMP", "measured", palette.ZMP, 0.014, facts.zmp + np.array([0.0, 0.0, LIFT]), trail=True)
    yield _point("ZMP", "planned", palette.ZMP_PLANNED, 0.01, _flat(facts.planned_zmp, ground))
    yield Track("Support polygon", "planned", "outline", palette.SUPPORT, 0.004, _support(facts))


def _support(facts: Facts) -> Array:
    """Vertices of the planned support polygon, each as high as the nearer sole that stands, shape (n, k, 3) [m]."""
    soles = facts.soles[:, :, :3]
    distance = np.linalg.norm(facts.polygon[:, :, None, :] - soles[:, None, :, :2], axis=3)
    distance[np.broadcast_to(~facts.contacts[:, None, :], distance.shape)] = np.inf
    height = np.take_along_axis(soles[:, :, 2], distance.argmin(axis=2), axis=1)
    return np.concatenate([facts.polygon, height[..., None] + LIFT], axis=2)


def _point(layer: str, name: str, color: Color, size: float, position: Array, trail: bool = False) -> Track:
    return Track(layer, name, "point", color, size, position[:, None, :], trail)


def _flat(position: Array, height: Array) -> Array:
    """Points of the ground, shape (n, 3), at horizontal positions (n, 2) and heights (n,)."""
    return np.column_stack([position, height + LIFT])


def sole_corners(poses: Array, sole: SoleSize) -> Array:
    """Corners of soles at x y z yaw of shape (n, 4), just above the ground, shape (n, 4, 3) [m]."""
    ground = level_corners(poses, *sole)
    height = np.broadcast_to(poses[:, 2, None] + LIFT / 2, ground.shape[:2])
    return np.concatenate([ground, height[..., None]], axis=2)


def _arrow(tail: Array, force: Array, scale: float) -> Array:
    """Tails and heads, NaN for forces too weak to draw, shape (n, 2, 3) [m]."""
    arrow = np.stack([tail, tail + scale * force], axis=1)
    arrow[np.linalg.norm(force, axis=1) < LEAST_FORCE] = np.nan
    return arrow
