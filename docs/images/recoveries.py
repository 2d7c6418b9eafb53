"""Draw the animations of recoveries in docs/images, each from a run of its own.

    python docs/images/recoveries.py [NAME]...

Names are those of the files, by default all; they need off-screen OpenGL and take some ten seconds each.
"""

import argparse
import math
import tempfile
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from animate import palette
from PIL import Image

from surefoot.scenarios.log import Log, read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.replay.extract import Window, extract
from surefoot.scenarios.show.replay.video import QUALITY, marks_of
from surefoot.sim.render import Camera, render_frames

FOLDER = Path(__file__).parent
WIDTH, HEIGHT = 300, 240
EVERY = 3
"""Frames of the replay per picture."""

NATURAL = (
    "robot_options.foot_length=0.22",
    "robot_options.foot_width=0.11",
    "gait.single_support=0.5",
    "gait.double_support=0.12",
    "gait.com_height=0.95",
)
WALK = (*NATURAL, "gait.steps=6", "gait.step_length=0.36")
SIDE, FRONT, BEHIND = (
    Camera(distance=3.2, azimuth=azimuth, elevation=elevation)
    for azimuth, elevation in ((105.0, -10.0), (165.0, -12.0), (60.0, -18.0))
)


@dataclass(frozen=True, slots=True)
class Recovery:
    """A push that is survived.

    Attributes:
        scenario: what is run.
        keys: set in it.
        push: its keys.
        window: part of the run that is shown [s].
        camera: from where.
    """

    scenario: str
    keys: tuple[str, ...]
    push: str
    window: Window
    camera: Camera


def _push(impulse: float, degrees: float, when: str) -> str:
    return f"{{{when}, duration: 0.1, impulse: {impulse}, direction: {math.radians(degrees)}}}"


SWING = "step: 3, phase: single, fraction: 0.2"
RECOVERIES = {
    "recovery-forward.gif": Recovery("walk", WALK, _push(0.45, 0, SWING), Window(2.2, 4.6), SIDE),
    "recovery-crossing.gif": Recovery("walk", WALK, _push(0.27, -90, SWING), Window(2.2, 5.0), FRONT),
    "recovery-standing.gif": Recovery(
        "stand", (*NATURAL, "duration=4.0"), _push(0.5, 0, "time: 0.5"), Window(0.3, 3.0), SIDE
    ),
    "recovery-sideways.gif": Recovery(
        "stand", (*NATURAL, "duration=4.5"), _push(0.5, 90, "time: 0.5"), Window(0.3, 3.6), FRONT
    ),
    "recovery-stairs.gif": Recovery(
        "stairs-up", (), _push(0.2, 90, "step: 3, phase: single, fraction: 0.5"), Window(4.5, 6.7), BEHIND
    ),
    "recovery-lasting.gif": Recovery(
        "walk",
        WALK,
        "{step: 3, phase: single, fraction: 0.5, duration: 2.0, impulse: 0.8, direction: 1.5708}",
        Window(2.4, 5.4),
        FRONT,
    ),
}


def pictures(log: Log, recovery: Recovery) -> tuple[list[Image.Image], int]:
    """The pictures of a recovery in few colours, and how long each is shown [ms]."""
    replay = extract(log, recovery.window)
    marks = (list(marks_of(replay, frame)) for frame in range(len(replay)))
    size = 2 * WIDTH, 2 * HEIGHT
    drawn = render_frames(replay.mjcf, replay.configuration, *size, recovery.camera, QUALITY, marks)
    images = [
        Image.fromarray(picture).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
        for picture in islice(drawn, 0, None, EVERY)
    ]
    colors = palette(images)
    return [image.quantize(palette=colors, dither=Image.Dither.NONE) for image in images], round(
        1000 * EVERY / replay.frame_rate
    )


def main() -> None:
    """Draw those that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(RECOVERIES))
    for name in parser.parse_args().names or RECOVERIES:
        recovery = RECOVERIES[name]
        with tempfile.TemporaryDirectory() as folder:
            scenario = load(recovery.scenario, (*recovery.keys, f"pushes=[{recovery.push}]"))
            result = run_scenario(scenario, Path(folder))
            if result.verdict.metrics["fell"]:
                raise SystemExit(f"{name}: the robot fell")
            (first, *rest), period = pictures(read(result.log), recovery)
        first.save(FOLDER / name, save_all=True, append_images=rest, duration=period, loop=0, optimize=True)
        print(f"written: {FOLDER / name}")


if __name__ == "__main__":
    main()
