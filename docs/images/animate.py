"""Runs as animations: every third frame of a replay, drawn twice as large as needed."""

from dataclasses import dataclass

from PIL import Image

from surefoot.scenarios.log import Log
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.video import CAMERA, QUALITY, marks_of, stand
from surefoot.sim.render import Camera, render_frames

EVERY = 3
"""Frames of the replay per picture."""


@dataclass(frozen=True, slots=True)
class Shot:
    """The view of a run.

    Attributes:
        window: part of it [s].
        size: width and height of the pictures [px].
        camera: from where, as in a video.
        lower: how far the middle of the picture is under the base [m].
        marked: with the marks of a replay, or the robot alone.
    """

    window: ReplayWindow
    size: tuple[int, int]
    camera: Camera = CAMERA
    lower: float = 0.0
    marked: bool = True


WALK = Shot(ReplayWindow(4.8, 9.5), (480, 270))


def pictures(log: Log, shot: Shot) -> tuple[list[Image.Image], int]:
    """The pictures of a run, and how long each is shown [ms]."""
    replay = extract(log, shot.window)
    shown = range(0, len(replay), EVERY)
    camera, look_at = stand(replay, shot.camera)
    marks = (list(marks_of(replay, frame)) if shot.marked else [] for frame in shown)
    width, height = (2 * side for side in shot.size)
    moving, middle = replay.configuration[::EVERY], look_at[::EVERY] - (0.0, 0.0, shot.lower)
    drawn = render_frames(replay.mjcf, moving, (width, height), camera, QUALITY, marks, middle)
    images = [Image.fromarray(picture).resize(shot.size, Image.Resampling.LANCZOS) for picture in drawn]
    return images, round(1000 * EVERY / replay.frame_rate)
