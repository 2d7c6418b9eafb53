"""Draw the moving picture of README.md: a walk on straight legs that is pushed to its side, steps there and goes on.

    python docs/images/front.py

It runs the walk, and needs off-screen OpenGL and a minute or two.
"""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from animate import EVERY, Shot, pictures
from PIL import Image, ImageDraw, ImageFont
from webp import save_webp

from surefoot.scenarios.log import Log, read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.sim.render import Camera

PICTURE = Path(__file__).parent / "front.webp"
RATE = 25.0
"""Pictures per second [Hz]; 40 ms each, a whole number as the format wants."""

IMPULSE, TIME = 0.5, 3.6
"""Impulse of the push to the right over the robot's mass [N·s/kg], and its begin [s]."""

KEYS = (
    "robot_options.foot_length=0.22",
    "robot_options.foot_width=0.11",
    "gait={speed: 0.8, steps: 11}",
    f"pushes=[{{time: {TIME}, duration: 0.1, impulse: {IMPULSE}, direction: -1.5708}}]",
    "criteria={fell: false}",
)

BEGIN, END = 1.9, 6.4
"""The part of the run that is shown [s]."""

SHOT = Shot(
    ReplayWindow(BEGIN, END, frame_rate=EVERY * RATE),
    (720, 405),
    Camera(distance=2.7, azimuth=135.0, elevation=-10.0),
    lower=0.14,
)
QUALITY = 58
"""Quality of WebP: the lowest at which thin marks keep their edges."""

SHOWN, AT, SIZE = 1.0, (16, 14), 26
"""Time for which the strength of the push is shown [s], and its place and size in the picture [px]."""


def captioned(images: Sequence[Image.Image]) -> Iterator[Image.Image]:
    """The pictures with the strength of the push in those that follow it."""
    font = ImageFont.load_default(size=SIZE)
    for k, image in enumerate(images):
        if 0.0 <= BEGIN + k / RATE - TIME < SHOWN:
            ImageDraw.Draw(image).text(AT, f"push: {IMPULSE:g} N\u00b7s/kg", fill="black", font=font)
        yield image


def draw(log: Log) -> None:
    """Write the picture of a walk."""
    images, lasting = pictures(log, SHOT)
    save_webp(PICTURE, list(captioned(images)), lasting, quality=QUALITY, method=6)


def main(_: Sequence[str] = ()) -> None:
    """Walk and draw."""
    with tempfile.TemporaryDirectory() as folder:
        result = run_scenario(load("walk", KEYS), Path(folder))
        if result.verdict.metrics["fell"]:
            raise SystemExit("the robot fell")
        draw(read(result.log))
    print(f"written: {PICTURE}")


if __name__ == "__main__":
    main()
