"""Draw the animations of recoveries in docs/images, each from a run of its own.

    python docs/images/recoveries.py [NAME]...

Names are those of the files, by default all; they need off-screen OpenGL and take some ten seconds each.
"""

import argparse
import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from animate import Shot, pictures
from webp import save_webp

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.sim.render import Camera

FOLDER = Path(__file__).parent
SIZE, LOWER = (400, 320), 0.2
"""Sizes of a picture [px], and depth of its middle below the base [m]."""

NATURAL = (
    "robot_options.foot_length=0.22",
    "robot_options.foot_width=0.11",
    "gait.single_support=0.5",
    "gait.double_support=0.12",
    "gait.com_height=0.95",
)
WALK = (*NATURAL, "gait.steps=6", "gait.step_length=0.36")
SIDE, FRONT = (
    Camera(distance=2.8, azimuth=azimuth, elevation=elevation)
    for azimuth, elevation in ((105.0, -10.0), (165.0, -12.0))
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
    window: ReplayWindow
    camera: Camera


def _push(impulse: float, degrees: float, when: str) -> str:
    return f"{{{when}, duration: 0.1, impulse: {impulse}, direction: {math.radians(degrees)}}}"


SWING = "step: 3, phase: single, fraction: 0.2"
RECOVERIES = {
    "recovery-forward.webp": Recovery(
        "walk-level",
        (*WALK, "duration=6.0"),
        _push(0.785, 0, "step: 3, phase: single, fraction: 0.5"),
        ReplayWindow(2.4, 5.2),
        SIDE,
    ),
    "recovery-crossing.webp": Recovery("walk-level", WALK, _push(0.27, -90, SWING), ReplayWindow(2.2, 5.0), FRONT),
    "recovery-standing.webp": Recovery(
        "stand", (*NATURAL, "duration=4.0"), _push(0.5, 0, "time: 0.5"), ReplayWindow(0.3, 3.0), SIDE
    ),
    "recovery-sideways.webp": Recovery(
        "stand", (*NATURAL, "duration=4.5"), _push(0.5, 90, "time: 0.5"), ReplayWindow(0.3, 3.6), FRONT
    ),
    "recovery-stairs.webp": Recovery(
        "stairs-down", ("duration=17.0",), _push(0.2, -90, SWING), ReplayWindow(4.0, 7.6), FRONT
    ),
    "recovery-lasting.webp": Recovery(
        "walk-level",
        WALK,
        "{step: 3, phase: single, fraction: 0.5, duration: 2.0, impulse: 0.8, direction: 1.5708}",
        ReplayWindow(2.4, 5.4),
        FRONT,
    ),
}


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw those that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(RECOVERIES))
    for name in parser.parse_args(arguments).names or RECOVERIES:
        recovery = RECOVERIES[name]
        with tempfile.TemporaryDirectory() as folder:
            scenario = load(recovery.scenario, (*recovery.keys, f"pushes=[{recovery.push}]"))
            result = run_scenario(scenario, Path(folder))
            if result.verdict.metrics["fell"]:
                raise SystemExit(f"{name}: the robot fell")
            images, period = pictures(read(result.log), Shot(recovery.window, SIZE, recovery.camera, LOWER))
        save_webp(FOLDER / name, images, period)
        print(f"written: {FOLDER / name}")


if __name__ == "__main__":
    main()
