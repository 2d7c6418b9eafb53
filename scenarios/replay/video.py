"""A replay as a video, drawn off screen by MuJoCo and encoded by PyAV."""

from collections.abc import Callable, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

from scenarios.replay.content import Replay
from scenarios.replay.extras import MissingExtraError, require
from scenarios.replay.files import write_whole
from scenarios.replay.marks import marks_of
from sim.gl import RenderingUnavailableError
from sim.render import Camera, Image, Quality, render_frames

WIDTH, HEIGHT = 1280, 720

CAMERA = Camera(distance=2.7, azimuth=130.0, elevation=-12.0)
QUALITY = Quality(reflections=False)

CODEC = {"crf": "20", "preset": "veryfast"}
"""Constant quality that shows no artefacts, at a speed that does not matter beside the drawing."""

OnFrame = Callable[[int], None]


def write_video(replay: Replay, path: Path, on_frame: OnFrame | None = None) -> None:
    """Write an mp4 file that plays at the speed of the run.

    Args:
        replay: what to show; its frame rate is that of the video.
        path: of the file.
        on_frame: is told the number of each frame that is done.

    Raises:
        MissingExtraError: PyAV or an off-screen OpenGL is not installed.
        LogError: the file cannot be written.
    """
    av = require("av", "video", "video")
    with write_whole(path) as temporary:
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
