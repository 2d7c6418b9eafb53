"""What surrounds a replay in viser: the server, camera, light and ground."""

import contextlib
import io
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from scenarios.replay.content import Replay
from scenarios.replay.extras import require

if TYPE_CHECKING:
    import viser

LOCALHOST = "127.0.0.1"
"""A replay is for this machine alone."""

PORT = 8080
"""The first to try; viser takes the next free one."""

STEP_BACK = np.array([1.6, -1.9, 0.35])
"""From what the camera looks at to where it stands at first, for a robot that stays in place [m]."""

WIDER, WIDEST = 0.2, 1.6
"""Share by which the camera steps back for each metre that the robot walks [1/m], and the largest factor."""

LOOK_AT_HEIGHT = 0.7
"""Of what the camera looks at, over the ground [m]."""


@contextlib.contextmanager
def serving() -> "Iterator[viser.ViserServer]":
    """A server of viser on this machine for as long as the context lasts; it says nothing on standard output.

    Raises:
        MissingExtraError: viser is not installed.
    """
    viser = require("viser", "replay", "the replay in a browser")
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=LOCALHOST, port=PORT, verbose=False)
    try:
        yield server
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()


def set_stage(server: "viser.ViserServer", replay: Replay) -> None:
    """Set camera, light and ground."""
    scene, base = server.scene, replay.body_position[:, 1]
    scene.set_up_direction("+z")
    scene.world_axes.visible = False
    scene.configure_default_lights(cast_shadow=True)
    middle = (base.min(axis=0) + base.max(axis=0)) / 2
    middle[2] = replay.footprints[0].corners[0, 2] if replay.footprints else 0.0
    middle[2] += LOOK_AT_HEIGHT
    walked = float(np.linalg.norm(np.ptp(base[:, :2], axis=0)))
    server.initial_camera.look_at = middle
    server.initial_camera.position = middle + STEP_BACK * min(1.0 + WIDER * walked, WIDEST)
    server.initial_camera.fov = np.deg2rad(45.0)
    scene.add_grid(
        "/Ground", infinite_grid=True, cell_size=0.1, section_size=1.0, fade_distance=25.0,
        cell_color=(214, 218, 223), section_color=(165, 172, 180), plane_color=(238, 240, 242), plane_opacity=1.0,
        shadow_opacity=0.25, position=(0.0, 0.0, -0.002),
    )  # fmt: skip
