"""Outlines of soles on the ground: planned ones, which may move, and taken ones, which stay."""

from collections.abc import Iterator

import numpy as np

from scenarios.metrics.view import RunView
from scenarios.replay import palette
from scenarios.replay.balance import LIFT
from scenarios.replay.content import Array, Footprint, Track
from scenarios.replay.frames import Frames


def planned_footprints(run: RunView, frames: Frames) -> Iterator[Track]:
    """The next three footsteps as planned at each time."""
    if not run.has("/footsteps"):
        return
    channel = run.log["/footsteps"]
    rows = np.maximum(np.searchsorted(channel.time, frames.time + 1e-9, side="right") - 1, 0)
    poses, feet = channel.field("next")[rows], channel.field("next_foot")[rows]
    for foot, color in enumerate(palette.FEET):
        for ahead in range(poses.shape[1]):
            corners = _corners(run, poses[:, ahead])
            corners[feet[:, ahead] != foot] = np.nan
            name = f"{('left', 'right')[foot]}, {ahead + 1} ahead"
            yield Track("Planned footprints", name, "outline", palette.paler(color, 0.3), 0.003, corners)


def taken_footprints(run: RunView, frames: Frames) -> Iterator[Footprint]:
    """Where the feet stood at first, and every touchdown until the last frame."""
    if run.has("/footsteps"):
        first = run.log["/footsteps"]
        for foot, name in enumerate(("current_left", "current_right")):
            corners = _corners(run, first.field(name)[:1])[0]
            yield Footprint(palette.FEET[foot], corners, float(first.time[0]))
    if run.has("/footstep"):
        taken = run.log["/footstep"]
        corners = _corners(run, taken.field("actual"))
        for time, foot, place in zip(taken.time.tolist(), taken.field("foot").tolist(), corners, strict=True):
            if time <= frames.time[-1] and np.isfinite(place).all():
                yield Footprint(palette.FEET[foot == 1], place, time)


def _corners(run: RunView, poses: Array) -> Array:
    """Corners of soles at x y z yaw of shape (n, 4), shape (n, 4, 3) [m]."""
    half = np.array([run.constants.foot_length, run.constants.foot_width]) / 2
    local = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * half
    cosine, sine = np.cos(poses[:, 3, None]), np.sin(poses[:, 3, None])
    x = poses[:, 0, None] + cosine * local[:, 0] - sine * local[:, 1]
    y = poses[:, 1, None] + sine * local[:, 0] + cosine * local[:, 1]
    return np.stack([x, y, np.broadcast_to(poses[:, 2, None] + LIFT / 2, x.shape)], axis=2)
