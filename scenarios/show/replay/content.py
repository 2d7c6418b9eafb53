"""What a replay shows, independent of what shows it: frames, surfaces on bodies, marks that move, footprints."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.palette import Color

Array = NDArray[np.float64]

MarkKind = Literal["point", "arrow", "outline"]


@dataclass(frozen=True, slots=True)
class ReplayWindow:
    """What is asked for of a run.

    Attributes:
        start: first time, the log's if None [s].
        end: last time, the log's if None [s].
        frame_rate: frames per simulated second [Hz].
    """

    start: float | None = None
    end: float | None = None
    frame_rate: float = 30.0


@dataclass(frozen=True, slots=True)
class Frames:
    """Which ticks are shown.

    Attributes:
        time: of each frame, shape (n,) [s].
        rows: of the control-rate channels, shape (n,).
    """

    time: Array
    rows: NDArray[np.intp]

    def strongest(self, strength: Array, ticks: Array, seconds: float) -> NDArray[np.intp]:
        """Row of the largest value within some seconds before each frame, the frame's own included.

        Args:
            strength: by control tick.
            ticks: time of the control ticks [s].
            seconds: how far to look back [s].
        """
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
        """Whether there is something to show in a frame."""
        return bool(np.isfinite(self.vertices[frame]).all())

    def path(self, frames: slice) -> Array:
        """Where a point has been, without the frames in which it was not shown, shape (k, 3) [m]."""
        points = self.vertices[frames, 0]
        return np.asarray(points[np.isfinite(points).all(axis=1)])


@dataclass(frozen=True, slots=True)
class Footprint:
    """Where a sole has been set down; it stays.

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
        """What a camera that follows the robot looks at: the base without the sway of its steps, shape (n, 3) [m]."""
        base, half = self.body_position[:, 1], round(SWAY * self.frame_rate / 2)
        padded = np.pad(base, ((half, half), (0, 0)), mode="edge")
        return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0).mean(axis=-1))
