"""Draw robots in docs/images, each from six steps of the scenario `walk-level`.

    python docs/images/gallery.py [ROBOT]...

By default those that come along; else their names, or robot files. It needs off-screen OpenGL and a minute for each.
"""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from animate import Shot, pictures
from sources import ROBOTS
from webp import save_webp

from surefoot.models import RobotOptions, describe
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.sim.render import Camera

FOLDER = Path(__file__).parent
SIZE = (320, 320)

DISTANCE, LOWER = 3.1, 0.15
"""Distances of the camera, and of the middle of the picture under the base, in lengths of the robot's leg [-]."""

STRIDES = (0, 4)
"""Footsteps between whose landings the robot is shown: two strides, after which it stands as before."""


def shot(log: Log, leg: float) -> Shot:
    """Two strides of a robot with a leg of this length [m], from half ahead."""
    begin, end = log["/footstep"].time[list(STRIDES)].tolist()
    camera = Camera(DISTANCE * leg, azimuth=130.0, elevation=-8.0)
    return Shot(ReplayWindow(begin, end), SIZE, camera, lower=LOWER * leg, marked=False)


def draw(name: str, log: Log) -> Path:
    """Draw a robot in colours of its own."""
    images, period = pictures(log, shot(log, describe(name, RobotOptions()).leg_length))
    path = FOLDER / f"robot-{Path(name).stem.lower()}.webp"
    save_webp(path, images, period)
    return path


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw those that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="ROBOT", help=", ".join(ROBOTS))
    for name in parser.parse_args(arguments).names or ROBOTS:
        with tempfile.TemporaryDirectory() as folder:
            result = run_scenario(load("walk", (f"robot={name}", "gait.steps=6")), Path(folder))
            if result.verdict.metrics["fell"]:
                raise SystemExit(f"{name}: the robot fell")
            print(f"written: {draw(name, read(result.log))}")


if __name__ == "__main__":
    main()
