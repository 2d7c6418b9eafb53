"""The robot at several moments of one walk, in one picture.

Poses are drawn by one fixed camera, each twice as large as needed, and laid over each other where they differ from the
empty ground, the farthest first.
"""

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from surefoot.scenarios.log import Log
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.sim.render import Camera, render_frames

WIDTH, HEIGHT = 1280, 570
OVERSAMPLING = 2
TIMES = [3.35, 5.1, 6.85, 8.6, 10.35]
"""Times of the poses, the farthest first [s]."""

CAMERA = Camera(3.9, 114.0, -7.0, tracking=False)
FAR_AWAY = 300.0
"""Place to which the robot is sent to photograph the ground without it [m]."""


def poses(log: Log, times: list[float]) -> list[NDArray[np.float64]]:
    """Configurations at given times [s]."""
    truth = log["/truth"]
    rows = np.clip(np.searchsorted(truth.time, times), 0, len(truth) - 1)
    return list(truth.field("q")[rows])


def composite(log: Log) -> Image.Image:
    """All poses in one picture; the middle one is what the camera looks at."""
    shown, camera = poses(log, TIMES), CAMERA
    middle = shown[len(shown) // 2]
    gone, view = middle.copy(), np.deg2rad(camera.azimuth)
    gone[:2] -= FAR_AWAY * np.array([np.cos(view), np.sin(view)])
    size = (OVERSAMPLING * WIDTH, OVERSAMPLING * HEIGHT)
    frames = render_frames(log.attachments[WORLD_FILE].decode(), [middle, gone, *shown], size, camera)
    _, ground, *images = frames
    picture = ground.copy()
    for image in images:
        differs = np.abs(image.astype(int) - ground.astype(int)).max(axis=2) > 3
        picture[differs] = image[differs]
    return Image.fromarray(picture).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
