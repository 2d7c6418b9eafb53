"""A walk as an animation: every third frame of a replay, drawn twice as large as needed."""

from itertools import islice

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import COM, FEET, FOOTSTEP
from surefoot.scenarios.show.replay.content import Replay
from surefoot.scenarios.show.replay.extract import Window, extract
from surefoot.scenarios.show.replay.video import CAMERA, QUALITY, marks_of
from surefoot.sim.render import render_frames

WIDTH, HEIGHT = 480, 270
EVERY = 3
"""Frames of the replay per picture."""

WINDOW = Window(4.8, 9.5)
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


def pictures(replay: Replay) -> list[Image.Image]:
    """The pictures of a replay."""
    marks = (list(marks_of(replay, frame)) for frame in range(len(replay)))
    drawn = render_frames(replay.mjcf, replay.configuration, 2 * WIDTH, 2 * HEIGHT, CAMERA, QUALITY, marks)
    return [
        Image.fromarray(picture).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
        for picture in islice(drawn, 0, None, EVERY)
    ]


def palette(images: list[Image.Image]) -> Image.Image:
    """Colours for all pictures: half of them for the few vivid pixels, and those of thin marks on grey ground."""
    pixels: NDArray[np.uint8] = np.concatenate([np.asarray(image).reshape(-1, 3) for image in images[::5]])
    vivid = np.ptp(pixels.astype(int), axis=1) > VIVID
    halves = [Image.fromarray(some[None]).quantize(COLORS // 2) for some in (pixels[~vivid], pixels[vivid])]
    colors = [half.getpalette()[: 3 * (COLORS // 2)] for half in halves]
    found = Image.new("P", (1, 1))
    found.putpalette(colors[0] + colors[1] + [round(255 * part) for mark in MARKS for part in mark])
    return found


def frames(log: Log) -> tuple[list[Image.Image], int]:
    """The pictures of the animation in few colours, and how long each is shown [ms]."""
    replay = extract(log, WINDOW)
    images = pictures(replay)
    colors = palette(images)
    return [image.quantize(palette=colors, dither=Image.Dither.NONE) for image in images], round(
        1000 * EVERY / replay.frame_rate
    )
