"""Marks of balance: CoM, DCM and ZMP as they are and as planned, and the support polygon."""

import numpy as np

from scenarios.metrics.view import RunView
from scenarios.replay import palette
from scenarios.replay.content import Array, Color, Track
from scenarios.replay.frames import Frames

LIFT = 0.004
"""How far marks on the ground are drawn above it [m]."""


def balance_tracks(run: RunView, frames: Frames) -> tuple[Track, ...]:
    """CoM with its plumb line, DCM, ZMP and the planned support polygon."""
    rows = frames.rows
    com = run.field("/truth", "com")[rows]
    zmp = run.field("/contact", "zmp")[rows]
    ground = _ground(run, frames)
    below = _flat(com[:, :2], ground)
    dcm = run.field("/estimate", "dcm")[rows]
    planned = {name: run.field("/reference", name)[rows] for name in ("com", "dcm", "zmp")}
    return (
        _point("CoM", "measured", palette.ORANGE, 0.035, com, trail=True),
        _point("CoM", "on the ground", palette.ORANGE, 0.014, below),
        Track("CoM", "plumb line", "outline", palette.paler(palette.ORANGE), 0.002, np.stack([com, below], axis=1)),
        _point("CoM", "planned", palette.paler(palette.ORANGE), 0.025, planned["com"]),
        _point("DCM", "measured", palette.PURPLE, 0.014, _flat(dcm, ground), trail=True),
        _point("DCM", "planned", palette.paler(palette.PURPLE), 0.01, _flat(planned["dcm"], ground)),
        _point("ZMP", "measured", palette.VERMILION, 0.014, zmp + np.array([0.0, 0.0, LIFT]), trail=True),
        _point("ZMP", "planned", palette.paler(palette.VERMILION), 0.01, _flat(planned["zmp"], ground)),
        Track("Support polygon", "planned", "outline", palette.GREEN, 0.004, _support(run, frames)),
    )


def _point(layer: str, name: str, color: Color, size: float, position: Array, trail: bool = False) -> Track:
    return Track(layer, name, "point", color, size, position[:, None, :], trail)


def _flat(position: Array, height: Array) -> Array:
    """Points of the ground, shape (n, 3), at horizontal positions (n, 2) and heights (n,)."""
    return np.column_stack([position, height + LIFT])


def _ground(run: RunView, frames: Frames) -> Array:
    """Height of the lower foot, shape (n,) [m]."""
    return np.asarray(run.soles[frames.rows, :, 2].min(axis=1))


def _support(run: RunView, frames: Frames) -> Array:
    """Vertices of the planned support polygon, each as high as the nearer sole, shape (n, 8, 3) [m]."""
    polygon = run.field("/reference", "support")[frames.rows]
    soles = run.soles[frames.rows, :, :3]
    distance = np.linalg.norm(polygon[:, :, None, :] - soles[:, None, :, :2], axis=3)
    planned = run.field("/contact", "planned")[frames.rows] != 0
    distance[np.broadcast_to(~planned[:, None, :], distance.shape)] = np.inf
    nearer = distance.argmin(axis=2)
    height = np.take_along_axis(soles[:, :, 2], nearer, axis=1)
    return np.concatenate([polygon, height[..., None] + LIFT], axis=2)
