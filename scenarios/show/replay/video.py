"""A replay as a video: marks for MuJoCo's pictures, cameras, and the encoding."""

import itertools
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D

from surefoot.scenarios.errors import LogError, MissingExtraError, require
from surefoot.scenarios.log import read
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.palette import WHITE, Color
from surefoot.scenarios.run.skeleton import Progress
from surefoot.scenarios.show.console import ProgressLine
from surefoot.scenarios.show.replay.content import Array, Replay, ReplayWindow, Track
from surefoot.scenarios.show.replay.extract import extract
from surefoot.sim.gl import RenderingUnavailableError
from surefoot.sim.marks import Mark
from surefoot.sim.render import Camera, Image, Quality, render_frames

TRAIL_STEP, TRAIL_LENGTH = 3, 300
"""Frames between the points of a trail, and frames that it reaches back."""

TRAIL_RADIUS = 0.0025
OUTLINE_RADIUS = 0.004


def marks_of(replay: Replay, frame: int) -> Iterator[Mark]:
    """Everything beside the robot that a frame shows."""
    for track in replay.tracks:
        if track.shown(frame):
            yield from _mark(track, frame)
        if track.trail:
            path = track.path(slice(max(frame % TRAIL_STEP, frame - TRAIL_LENGTH), frame + 1, TRAIL_STEP))
            for ends in itertools.pairwise(path):
                yield Mark("line", track.color, TRAIL_RADIUS, np.stack(ends))
    for footprint in replay.footprints:
        if footprint.since <= replay.time[frame] + 1e-9:
            yield from _outline(footprint.color, OUTLINE_RADIUS, footprint.corners)


def _mark(track: Track, frame: int) -> Iterator[Mark]:
    vertices = track.vertices[frame]
    if track.kind == "outline":
        yield from _outline(track.color, track.size, vertices)
    else:
        yield Mark(track.kind, track.color, track.size, vertices)


def _outline(color: Color, size: float, vertices: Array) -> Iterator[Mark]:
    """Lines along the edges that have a length; two vertices make one line."""
    following = np.roll(vertices, -1, axis=0)
    for ends in np.stack([vertices, following], axis=1)[: len(vertices) if len(vertices) > 2 else 1]:
        if np.ptp(ends, axis=0).any():
            yield Mark("line", color, size, ends)


FRAME_RATE = 30.0
"""Frame rate of every video [Hz]."""

CAMERA = Camera(distance=2.7, azimuth=130.0, elevation=-12.0)
QUALITY = Quality(reflections=False)

CAMERAS = {
    "follow": CAMERA,
    "side": Camera(distance=2.7, azimuth=90.0, elevation=-5.0),
    "front": Camera(distance=2.7, azimuth=180.0, elevation=-8.0),
    "fixed": Camera(distance=2.7, azimuth=130.0, elevation=-15.0, tracking=False),
}
"""Cameras by name. A fixed one looks at the middle of the way, from so far that the robot is in sight all along it."""

WIDER = 0.75
"""Distance by which a fixed camera steps back for each metre of the way [-]."""

SLOWEST, FASTEST = 0.1, 10.0
SMALLEST, LARGEST = 64, 3840

CODEC = {"crf": "20", "preset": "veryfast"}
"""Constant quality that shows no artefacts, at a speed that does not matter beside the drawing."""


@dataclass(frozen=True, slots=True)
class Film:
    """The settings of a video.

    Attributes:
        speed: of the video over that of the run.
        camera: that looks at the robot.
        size: width and height, both even, since H.264 halves them for the colours [px].
    """

    speed: float = 1.0
    camera: Camera = CAMERA
    size: tuple[int, int] = (1280, 720)

    @classmethod
    def of(cls, speed: float, camera: str, size: str) -> "Film":
        """Read what was asked for on a command line.

        Raises:
            LogError: it is no speed, camera or size.
        """
        if not SLOWEST <= speed <= FASTEST:
            raise LogError(f"--speed {speed:g}: give a number from {SLOWEST:g} to {FASTEST:g}, 1 for that of the run")
        width, cross, height = size.partition("x")
        if not (cross and width.isdecimal() and height.isdecimal()):
            raise LogError(f"--size {size}: give width and height in pixels, such as 1280x720")
        if any(side % 2 or not SMALLEST <= side <= LARGEST for side in (int(width), int(height))):
            raise LogError(f"--size {size}: give even numbers from {SMALLEST} to {LARGEST}, such as 1280x720")
        return cls(speed, _camera(camera), (int(width), int(height)))

    def window(self, window: ReplayWindow) -> ReplayWindow:
        """The window with as many frames per simulated second as the speed needs."""
        return replace(window, frame_rate=FRAME_RATE / self.speed)


def _camera(asked: str) -> Camera:
    """A camera by name, or one that follows by azimuth, elevation [deg] and distance [m]; or a LogError."""
    if asked in CAMERAS:
        return CAMERAS[asked]
    try:
        azimuth, elevation, distance = (float(number) for number in asked.split(","))
    except ValueError:
        known = f"choose {', '.join(CAMERAS)}, or azimuth,elevation,distance such as 130,-12,2.7"
        raise LogError(f"--camera {asked}: {known}") from None
    if not (abs(azimuth) <= 360.0 and abs(elevation) < 90.0 and 0.3 <= distance <= 100.0):
        raise LogError(
            f"--camera {asked}: azimuth goes from -360 to 360 and elevation from -89 to 89 degrees, "
            "distance from 0.3 to 100 m"
        )
    return Camera(distance, azimuth, elevation)


def write_video(
    log: Path, out: Path, window: ReplayWindow | None = None, film: Film | None = None, replace: bool = False
) -> None:
    """Write an mp4 file of a window of a log, with a progress line.

    Raises:
        MissingExtraError: PyAV or an off-screen OpenGL is not installed.
        LogError: the log cannot be read; the file exists or cannot be written.
    """
    film = film or Film()
    refuse_existing(out, replace)
    shown, begin = extract(read(log), film.window(window or ReplayWindow())), time.monotonic()
    av, length = require("av", "video", "video"), len(shown) / FRAME_RATE
    with ProgressLine(out.name) as line, write_whole(out, replace) as temporary:

        def note(frames: int) -> None:
            done = frames / FRAME_RATE
            line(Progress(done, length, "drawn", done / max(time.monotonic() - begin, 1e-9)))

        try:
            _encode(av, _pictures(shown, film), temporary, film.size, note)
        except RenderingUnavailableError as error:
            raise MissingExtraError(str(error)) from None


def _pictures(replay: Replay, film: Film) -> Iterator[Image]:
    marks = (marks_of(replay, frame) for frame in range(len(replay)))
    camera, look_at = stand(replay, film.camera)
    caption = Caption(replay, film.size, film.speed)
    drawn = render_frames(replay.mjcf, replay.configuration, film.size, camera, QUALITY, marks, look_at)
    for instant, picture in zip(replay.time.tolist(), drawn, strict=True):
        yield caption.drawn_on(picture, instant)


def stand(replay: Replay, camera: Camera) -> tuple[Camera, Array]:
    """A camera, at a distance from which it sees what it shall, and what it looks at by frame, shape (n, 3) [m]."""
    followed = replay.followed()
    if camera.tracking:
        return camera, followed
    middle = (followed.min(axis=0) + followed.max(axis=0)) / 2
    way = float(np.linalg.norm(np.ptp(followed, axis=0)))
    return replace(camera, distance=camera.distance + WIDER * way), np.broadcast_to(middle, followed.shape)


def _encode(
    av: Any, pictures: Iterable[Image], path: Path, size: tuple[int, int], on_frame: Callable[[int], None]
) -> None:
    """Encode pictures of one size, shape (height, width, 3), as H.264 in an mp4 file; `av` is PyAV."""
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"}) as container:
        stream = container.add_stream("libx264", rate=Fraction(FRAME_RATE), options=CODEC)
        (stream.width, stream.height), stream.pix_fmt = size, "yuv420p"
        for number, picture in enumerate(pictures, start=1):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            on_frame(number)
        container.mux(stream.encode())


_LINES, _LEAST = 45.0, 8.0
"""Lines of text in the height, or in two thirds of the width if that is less; the size of the smallest letters [px]."""

_ONE_ROW = 75.0
"""Letters' sizes in the width of a picture in which the whole legend has room beside each other."""

_PLATE: dict[str, Any] = {"facecolor": WHITE, "alpha": 0.7, "linewidth": 0, "boxstyle": "square,pad=0.3"}


class Caption:
    """Writes onto the pictures of one video."""

    def __init__(self, replay: Replay, size: tuple[int, int], speed: float) -> None:
        """Draw what stays, on pictures of a size [px], at a speed over that of the run."""
        self._size, self._text = size, max(min(size[1], 2 * size[0] / 3) / _LINES, _LEAST)
        still = self._sheet()
        still.text(*self._corner(0.0), replay.title, ha="left", va="top", fontsize=1.2 * self._text, bbox=_PLATE)
        marks = [Line2D([], [], marker="o", linestyle="", color=c, label=name) for name, c in replay.legend().items()]
        if marks:
            self._legend(still, marks)
        self._still, self._speed = _drawn(still), "" if speed == 1.0 else f"  {speed:g}x"
        self._moving = self._sheet()
        look: dict[str, Any] = {
            "ha": "right",
            "va": "top",
            "fontsize": 1.2 * self._text,
            "family": "monospace",
            "bbox": _PLATE,
        }
        self._clock = self._moving.text(*self._corner(1.0), "", **look)

    def drawn_on(self, picture: Image, time: float) -> Image:
        """A picture with what is written on it, at a time of the run [s]; shape (height, width, 3)."""
        self._clock.set_text(f"{time:7.3f} s{self._speed}")
        for sheet in (self._still, _drawn(self._moving)):
            rows = np.flatnonzero(sheet[..., 3].any(axis=1))
            written = slice(rows[0], rows[-1] + 1) if len(rows) else slice(0)
            share = sheet[written, :, 3:].astype(np.float32) / 255.0
            picture[written] = (1.0 - share) * picture[written] + share * sheet[written, :, :3]
        return picture

    def _sheet(self) -> Figure:
        """An empty figure of which a point is a pixel."""
        width, height = self._size
        figure = Figure(figsize=(width / 72.0, height / 72.0), dpi=72, facecolor="none")
        FigureCanvasAgg(figure)
        return figure

    def _corner(self, side: float) -> tuple[float, float]:
        width, height = self._size
        inset = self._text
        return (inset + side * (width - 2 * inset)) / width, 1.0 - inset / height

    def _legend(self, figure: Figure, marks: list[Line2D]) -> None:
        plate: dict[str, Any] = {"facecolor": WHITE, "edgecolor": "none", "framealpha": 0.7, "fancybox": False}
        spaces: dict[str, Any] = {"borderaxespad": 1.0, "borderpad": 0.3, "handletextpad": 0.0, "columnspacing": 0.8}
        columns = len(marks) if self._size[0] > _ONE_ROW * self._text else 4
        look = {"markerscale": self._text / 12.0, "prop": FontProperties(size=0.85 * self._text), **plate, **spaces}
        figure.legend(handles=marks, loc="lower left", ncols=columns, **look)


def _drawn(figure: Figure) -> Image:
    """Red, green, blue and opacity of a figure, shape (height, width, 4)."""
    canvas: Any = figure.canvas  # of matplotlib's untyped part
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()).copy()
