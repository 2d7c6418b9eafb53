"""Draw the pictures of the documentation from logs of real runs.

    pip install pillow
    surefoot run walk
    python docs/images/make.py runs/walk-0/log.mcap docs/images/walk.png

It needs off-screen OpenGL (see `sim.gl`). Poses at several times of one walk are drawn by one fixed camera, each twice
as large as needed, and laid over each other where they differ from the empty ground, the farthest first.
"""

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from surefoot.scenarios.log import Log, read
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.sim.render import Camera, render_frames

WIDTH, HEIGHT = 1280, 570
OVERSAMPLING = 2
FAR_AWAY = 300.0
"""Where the robot is sent to photograph the ground without it [m]."""


def poses(log: Log, times: list[float]) -> list[NDArray[np.float64]]:
    """Configurations at given times [s]."""
    truth = log["/truth"]
    rows = np.clip(np.searchsorted(truth.time, times), 0, len(truth) - 1)
    return list(truth.field("q")[rows])


def composite(log: Log, times: list[float], camera: Camera) -> Image.Image:
    """All poses in one picture; the middle one is what the camera looks at."""
    shown = poses(log, times)
    middle = shown[len(shown) // 2]
    gone, view = middle.copy(), np.deg2rad(camera.azimuth)
    gone[:2] -= FAR_AWAY * np.array([np.cos(view), np.sin(view)])
    size = (OVERSAMPLING * WIDTH, OVERSAMPLING * HEIGHT)
    frames = render_frames(log.attachments[WORLD_FILE].decode(), [middle, gone, *shown], *size, camera)
    _, ground, *images = frames
    picture = ground.copy()
    for image in images:
        differs = np.abs(image.astype(int) - ground.astype(int)).max(axis=2) > 3
        picture[differs] = image[differs]
    return Image.fromarray(picture).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def main() -> None:
    """Draw one picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument(
        "--times", type=float, nargs="+", default=[3.35, 5.1, 6.85, 8.6, 10.35], help="farthest first [s]"
    )
    parser.add_argument("--distance", type=float, default=3.9, help="of the camera [m]")
    parser.add_argument("--azimuth", type=float, default=114.0, help="of its view [deg]")
    parser.add_argument("--elevation", type=float, default=-7.0, help="of its view [deg]")
    options = parser.parse_args()
    camera = Camera(options.distance, options.azimuth, options.elevation, tracking=False)
    picture = composite(read(options.log), options.times, camera)
    picture.save(options.out, optimize=True)


if __name__ == "__main__":
    main()
