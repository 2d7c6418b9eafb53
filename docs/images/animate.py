"""Runs as animations: every third frame of a replay, drawn twice as large as needed, in few colours."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import COM, FEET, FOOTSTEP
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.video import CAMERA, QUALITY, marks_of, stand
from surefoot.sim.render import Camera, render_frames

EVERY = 3
"""Frames of the replay per picture."""

COLORS = 128
VIVID = 60
"""Difference between the largest and the smallest channel above which a colour must be in the palette."""

GROUND = 0.6
"""Lightness of the ground."""

MARKS = [
    tuple(share * part + (1.0 - share) * GROUND for part in color)
    for color in (COM, *FEET, FOOTSTEP)
    for share in (1.0, 0.7, 0.4)
]
"""Colours of thin marks, which the smoothing of edges mixes with the ground's grey."""


@dataclass(frozen=True, slots=True)
class Shot:
    """How a run is shown.

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
    """The pictures of a run in all colours, and how long each is shown [ms]."""
    replay = extract(log, shot.window)
    shown = range(0, len(replay), EVERY)
    camera, look_at = stand(replay, shot.camera)
    marks = (list(marks_of(replay, frame)) if shot.marked else [] for frame in shown)
    width, height = (2 * side for side in shot.size)
    moving, middle = replay.configuration[::EVERY], look_at[::EVERY] - (0.0, 0.0, shot.lower)
    drawn = render_frames(replay.mjcf, moving, (width, height), camera, QUALITY, marks, middle)
    images = [Image.fromarray(picture).resize(shot.size, Image.Resampling.LANCZOS) for picture in drawn]
    return images, round(1000 * EVERY / replay.frame_rate)


def palette(images: Sequence[Image.Image]) -> Image.Image:
    """Colours for all pictures: half of them for the few vivid pixels, and those of thin marks on grey ground."""
    pixels: NDArray[np.uint8] = np.concatenate([np.asarray(image).reshape(-1, 3) for image in images[::5]])
    vivid = np.ptp(pixels.astype(int), axis=1) > VIVID
    halves = [Image.fromarray(some[None]).quantize(COLORS // 2) for some in (pixels[~vivid], pixels[vivid])]
    colors = [half.getpalette()[: 3 * (COLORS // 2)] for half in halves]
    found = Image.new("P", (1, 1))
    found.putpalette(colors[0] + colors[1] + [round(255 * part) for mark in MARKS for part in mark])
    return found


def save(path: Path, images: Sequence[Image.Image], period: int, colors: Image.Image, **options: Any) -> None:
    """Write pictures in the colours of a palette, shown for a period each [ms], as an animation without end."""
    first, *rest = (image.quantize(palette=colors, dither=Image.Dither.NONE) for image in images)
    first.save(path, save_all=True, append_images=rest, duration=period, loop=0, optimize=True, **options)
