"""Draw the animation of the documentation from the log of a real run.

    pip install pillow
    surefoot run walk
    python docs/images/animate.py runs/walk-0/log.mcap docs/images/walk.gif

It needs off-screen OpenGL (see `sim.gl`). Every third frame of a replay is drawn twice as large as needed.
"""

import argparse
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from surefoot.scenarios.log import read
from surefoot.scenarios.palette import COM, FEET, FOOTSTEP
from surefoot.scenarios.show.replay.content import Replay
from surefoot.scenarios.show.replay.extract import Window, extract
from surefoot.scenarios.show.replay.video import CAMERA, QUALITY, marks_of
from surefoot.sim.render import render_frames

WIDTH, HEIGHT = 480, 270
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


def main() -> None:
    """Draw one animation."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--start", type=float, default=4.8, help="[s]")
    parser.add_argument("--end", type=float, default=9.5, help="[s]")
    options = parser.parse_args()
    replay = extract(read(options.log), Window(options.start, options.end))
    images = pictures(replay)
    colors = palette(images)
    first, *rest = (image.quantize(palette=colors, dither=Image.Dither.NONE) for image in images)
    period = round(1000 * EVERY / replay.frame_rate)
    first.save(options.out, save_all=True, append_images=rest, duration=period, loop=0, optimize=True)


if __name__ == "__main__":
    main()
