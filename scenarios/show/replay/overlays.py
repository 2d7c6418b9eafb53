"""What is drawn beside the robot: points of balance, footprints and forces."""

from collections.abc import Iterator

import numpy as np

from surefoot.scenarios import palette
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.body import level_corners, rotations, torso
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.verdict import scenario_of
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.replay.content import Array, Footprint, Track
from surefoot.scenarios.show.replay.poses import Frames

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
        _point("CoM", "measured", palette.COM, 0.035, com, trail=True),
        _point("CoM", "on the ground", palette.COM, 0.014, below),
        Track("CoM", "plumb line", "outline", palette.paler(palette.COM), 0.002, np.stack([com, below], axis=1)),
        _point("CoM", "planned", palette.COM_PLANNED, 0.025, planned["com"]),
        _point("DCM", "measured", palette.DCM, 0.014, _flat(dcm, ground), trail=True),
        _point("DCM", "planned", palette.DCM_PLANNED, 0.01, _flat(planned["dcm"], ground)),
        _point("ZMP", "measured", palette.ZMP, 0.014, zmp + np.array([0.0, 0.0, LIFT]), trail=True),
        _point("ZMP", "planned", palette.ZMP_PLANNED, 0.01, _flat(planned["zmp"], ground)),
        Track("Support polygon", "planned", "outline", palette.SUPPORT, 0.004, _support(run, frames)),
    )


def _point(layer: str, name: str, color: palette.Color, size: float, position: Array, trail: bool = False) -> Track:
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


def planned_footprints(run: RunView, frames: Frames) -> Iterator[Track]:
    """The next three footsteps as planned at each time."""
    if not run.has("/footsteps"):
        return
    channel = run.log["/footsteps"]
    rows = np.maximum(np.searchsorted(channel.time, frames.time + 1e-9, side="right") - 1, 0)
    poses, feet = channel.field("next")[rows], channel.field("next_foot")[rows]
    for foot in (0, 1):
        for ahead in range(poses.shape[1]):
            corners = _corners(run, poses[:, ahead])
            corners[feet[:, ahead] != foot] = np.nan
            name = f"{('left', 'right')[foot]}, {ahead + 1} ahead"
            yield Track("Planned footprints", name, "outline", palette.FOOTSTEP, 0.003, corners)


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
    ground = level_corners(poses, run.constants.foot_length, run.constants.foot_width)
    height = np.broadcast_to(poses[:, 2, None] + LIFT / 2, ground.shape[:2])
    return np.concatenate([ground, height[..., None]], axis=2)


CONTACT_SCALE = 0.0005
"""Length of a contact force's arrow [m/N]: 1000 N are 0.5 m."""

PUSH_SCALE = 0.002
"""Length of a push's arrow [m/N]: 200 N are 0.4 m."""

PUSH_SHOWN = 0.3
"""How long a push stays in sight after its end, since many last less than a frame [s]."""

LEAST_FORCE = 5.0
"""Weaker forces are not drawn [N]."""


def contact_forces(run: RunView, frames: Frames) -> Iterator[Track]:
    """Contact force on each sole, from its centre of pressure."""
    for foot, name in enumerate(("left", "right")):
        pose = run.soles[frames.rows, foot]
        to_world = rotations(pose[:, 3:])
        cop = run.field("/contact", f"cop_{name}")[frames.rows]
        tail = pose[:, :3] + np.einsum("nij,nj->ni", to_world[:, :, :2], cop)
        force = np.einsum("nij,nj->ni", to_world, run.field("/measurement", f"wrench_{name}")[frames.rows, :3])
        yield Track("Contact forces", name, "arrow", palette.FEET[foot], 0.012, _arrow(tail, force, CONTACT_SCALE))


def push(log: Log, run: RunView, frames: Frames, body_names: tuple[str, ...], body_com: Array) -> Track:
    """The strongest push of the last moments, with its head at the body it acts on.

    Args:
        log: tells which body the scenario pushes.
        run: the run.
        frames: what is shown.
        body_names: by body.
        body_com: centres of mass of the bodies, shape (n, bodies, 3) [m].
    """
    forces = run.field("/measurement", "external_force")
    force = forces[frames.strongest(np.linalg.norm(forces, axis=1), run.time, PUSH_SHOWN)]
    head = body_com[:, body_names.index(body)] if (body := _pushed_body(log, run)) in body_names else body_com[:, 0]
    arrow = _arrow(head - PUSH_SCALE * force, force, PUSH_SCALE)
    return Track("Pushes", "push", "arrow", palette.PUSH, 0.02, arrow)


def _pushed_body(log: Log, run: RunView) -> str:
    """Body that the pushes of the scenario act on; the torso when they name several or none."""
    try:
        bodies = {settings.body for settings in scenario_of(log).pushes}
    except LogError:
        bodies = set()
    named = next(iter(bodies)) if len(bodies) == 1 else None
    return named or torso(run.constants.roles)


def _arrow(tail: Array, force: Array, scale: float) -> Array:
    """Tails and heads, NaN for forces too weak to draw, shape (n, 2, 3) [m]."""
    arrow = np.stack([tail, tail + scale * force], axis=1)
    arrow[np.linalg.norm(force, axis=1) < LEAST_FORCE] = np.nan
    return arrow
