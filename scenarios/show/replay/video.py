"""A frame of a replay as marks for MuJoCo's pictures."""

import itertools
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.scenarios.output import write_whole
from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.replay.content import Array, MissingExtraError, Replay, Track, require
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


WIDTH, HEIGHT = 1280, 720

CAMERA = Camera(distance=2.7, azimuth=130.0, elevation=-12.0)
QUALITY = Quality(reflections=False)

CODEC = {"crf": "20", "preset": "veryfast"}
"""Constant quality that shows no artefacts, at a speed that does not matter beside the drawing."""

OnFrame = Callable[[int], None]


def write_video(replay: Replay, path: Path, on_frame: OnFrame | None = None, replace: bool = False) -> None:
    """Write an mp4 file that plays at the speed of the run.

    Args:
        replay: what to show; its frame rate is that of the video.
        path: of the file.
        on_frame: is told the number of each frame that is done.
        replace: an existing file.

    Raises:
        MissingExtraError: PyAV or an off-screen OpenGL is not installed.
        LogError: the file exists or cannot be written.
    """
    av = require("av", "video", "video")
    with write_whole(path, replace) as temporary:
        try:
            encode(av, _pictures(replay), temporary, replay.frame_rate, on_frame or (lambda _: None))
        except RenderingUnavailableError as error:
            raise MissingExtraError(str(error)) from None


def _pictures(replay: Replay) -> Iterable[Image]:
    marks = (marks_of(replay, frame) for frame in range(len(replay)))
    return render_frames(replay.mjcf, replay.configuration, WIDTH, HEIGHT, CAMERA, QUALITY, marks)


def encode(av: Any, pictures: Iterable[Image], path: Path, frame_rate: float, on_frame: OnFrame) -> None:
    """Encode pictures of one size, shape (height, width, 3), as H.264 in an mp4 file; `av` is PyAV."""
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"}) as container:
        stream = container.add_stream("libx264", rate=Fraction(frame_rate).limit_denominator(1000), options=CODEC)
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        for number, picture in enumerate(pictures, start=1):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            on_frame(number)
        container.mux(stream.encode())
