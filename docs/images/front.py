"""Draw the moving picture of README.md: a walk that is pushed over its stance foot, crosses and goes on.

    python docs/images/front.py

It runs the walk, and needs off-screen OpenGL and a minute or two.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from animate import EVERY, Shot, pictures
from recoveries import NATURAL
from webp import save_webp

from surefoot.scenarios.log import Log, read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.sim.render import Camera

PICTURE = Path(__file__).parent / "front.webp"
RATE = 25.0
"""Pictures per second [Hz]; 40 ms each, a whole number as the format wants."""

KEYS = (*NATURAL, "gait.steps=9", "gait.step_length=0.36")
PUSH = "{step: 3, phase: single, fraction: 0.5, duration: 0.1, impulse: 0.5, direction: -1.5708}"
"""Push to the right while the left foot swings: it lands 12 cm beyond the right one."""

SHOT = Shot(
    ReplayWindow(1.7, 6.1, frame_rate=EVERY * RATE),
    (720, 405),
    Camera(distance=2.6, azimuth=165.0, elevation=-20.0),
    lower=0.12,
)
QUALITY = 58
"""Quality of WebP: the lowest at which thin marks keep their edges."""


def draw(log: Log) -> None:
    """Write the picture of a walk."""
    save_webp(PICTURE, *pictures(log, SHOT), quality=QUALITY, method=6)


def main(_: Sequence[str] = ()) -> None:
    """Walk and draw."""
    with tempfile.TemporaryDirectory() as folder:
        result = run_scenario(load("walk", (*KEYS, f"pushes=[{PUSH}]")), Path(folder))
        if result.verdict.metrics["fell"]:
            raise SystemExit("the robot fell")
        draw(read(result.log))
    print(f"written: {PICTURE}")


if __name__ == "__main__":
    main()
