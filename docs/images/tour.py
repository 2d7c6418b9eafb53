"""Draw docs/images/tour.webp: the G1 tour, with its punches as arrows.

    python docs/images/tour.py

It needs off-screen OpenGL and a minute.
"""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image
from webp import save_webp

from surefoot.planner.ground.terrain import flat
from surefoot.scenarios.palette import PUSH
from surefoot.scenarios.show.replay.video import QUALITY
from surefoot.sim.marks import Mark
from surefoot.sim.render import Camera, render_frames
from surefoot.sim.scene import world_mjcf
from surefoot.studies.tour.ride import Ride
from surefoot.studies.tour.rows import ROWS

PICTURE = Path(__file__).parent / "tour.webp"
ROW, SEED = "torque", 0
START, END, PERIOD = 9.8, 15.8, 0.08
"""Part of the tour that is shown, and the time from picture to picture [s]."""

SIZE, CAMERA, LOWER = (400, 320), Camera(distance=2.3, azimuth=150.0, elevation=-12.0), 0.1
SHOWN, LENGTH = 0.4, 0.001
"""Time for which a punch is shown, longer than it acts [s], and length of its arrow for each newton [m/N]."""


def main(_: Sequence[str] = ()) -> None:
    """Ride and draw."""
    ride = Ride(ROWS[ROW], SEED)
    every = round(PERIOD * ride.entrant.rate)
    configurations, marks = [], []
    for tick in range(math.ceil(END * ride.entrant.rate)):
        ride.step()
        time = ride.world.time
        if tick % every or time < START:
            continue
        configurations.append(ride.world.measure().q)
        punch = next((one for one in ride.tour.punches if one.time <= time < one.time + SHOWN), None)
        arrow = []
        if punch is not None:
            head = np.array(ride.world.data.xanchor[punch.joint + 1])
            tail = head - LENGTH * punch.force * ride.world.direction(punch)
            arrow = [Mark("arrow", PUSH, 0.02, np.stack([tail, head]))]
        marks.append(arrow)
    description = ride.walker.controller.walk.robot
    size = (2 * SIZE[0], 2 * SIZE[1])
    middle = [q[:3] - (0.0, 0.0, LOWER) for q in configurations]
    world = world_mjcf(description, flat(0.8), 0.001)
    drawn = render_frames(world, configurations, size, CAMERA, QUALITY, marks, middle)
    images = [Image.fromarray(picture).resize(SIZE, Image.Resampling.LANCZOS) for picture in drawn]
    save_webp(PICTURE, images, round(1000 * PERIOD))
    print(f"written: {PICTURE}")


if __name__ == "__main__":
    main()
