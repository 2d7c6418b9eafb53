"""What is drawn beside the robot: points of balance, footprints and forces."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios import palette
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.body import level_corners, rotations, torso
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.verdict import agenda_of, scenario_of
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.logview import FOOT_NAMES
from surefoot.scenarios.show.replay.content import Array, Footprint, Frames, Track

LIFT = 0.004
"""How far marks on the ground are drawn above it [m]."""


@dataclass(frozen=True, slots=True)
class BalanceMarks:
    """Where the points of balance are, by frame.

    Attributes:
        com: true CoM, shape (n, 3) [m].
        dcm: shape (n, 2) [m].
        zmp: shape (n, 3) [m]; NaN in flight.
        planned_com: shape (n, 3) [m].
        planned_dcm: shape (n, 2) [m].
        planned_zmp: shape (n, 2) [m].
        polygon: vertices of the planned support polygon, shape (n, k, 2) [m].
        contacts: whether the left and the right foot shall stand, shape (n, 2).
        soles: of both feet, x y z first, shape (n, 2, 3 or more) [m].
    """

    com: Array
    dcm: Array
    zmp: Array
    planned_com: Array
    planned_dcm: Array
    planned_zmp: Array
    polygon: Array
    contacts: NDArray[np.bool_]
    soles: Array

    def tracks(self) -> tuple[Track, ...]:
        """CoM with its plumb line, DCM, ZMP and the planned support polygon."""
        com, ground = self.com, np.asarray(self.soles[:, :, 2].min(axis=1))
        below = _flat(com[:, :2], ground)
        return (
            _point("CoM", "measured", palette.COM, 0.035, com, trail=True),
            _point("CoM", "on the ground", palette.COM, 0.014, below),
            Track("CoM", "plumb line", "outline", palette.paler(palette.COM), 0.002, np.stack([com, below], axis=1)),
            _point("CoM", "planned", palette.COM_PLANNED, 0.025, self.planned_com),
            _point("DCM", "measured", palette.DCM, 0.014, _flat(self.dcm, ground), trail=True),
            _point("DCM", "planned", palette.DCM_PLANNED, 0.01, _flat(self.planned_dcm, ground)),
            _point("ZMP", "measured", palette.ZMP, 0.014, self.zmp + np.array([0.0, 0.0, LIFT]), trail=True),
            _point("ZMP", "planned", palette.ZMP_PLANNED, 0.01, _flat(self.planned_zmp, ground)),
            Track("Support polygon", "planned", "outline", palette.SUPPORT, 0.004, self._support()),
        )

    def _support(self) -> Array:
        """Vertices of the planned support polygon, each as high as the nearer sole, shape (n, k, 3) [m]."""
        soles = self.soles[:, :, :3]
        distance = np.linalg.norm(self.polygon[:, :, None, :] - soles[:, None, :, :2], axis=3)
        distance[np.broadcast_to(~self.contacts[:, None, :], distance.shape)] = np.inf
        nearer = distance.argmin(axis=2)
        height = np.take_along_axis(soles[:, :, 2], nearer, axis=1)
        return np.concatenate([self.polygon, height[..., None] + LIFT], axis=2)


def balance(run: RunView, frames: Frames) -> BalanceMarks:
    """The points of balance of a log."""
    rows = frames.rows
    return BalanceMarks(
        com=run.field("/truth", "com")[rows],
        dcm=run.field("/estimate", "dcm")[rows],
        zmp=run.field("/contact", "zmp")[rows],
        planned_com=run.field("/reference", "com")[rows],
        planned_dcm=run.field("/reference", "dcm")[rows],
        planned_zmp=run.field("/reference", "zmp")[rows],
        polygon=run.field("/reference", "support")[rows],
        contacts=run.field("/contact", "planned")[rows] != 0,
        soles=run.soles[rows],
    )


def _point(layer: str, name: str, color: palette.Color, size: float, position: Array, trail: bool = False) -> Track:
    return Track(layer, name, "point", color, size, position[:, None, :], trail)


def _flat(position: Array, height: Array) -> Array:
    """Points of the ground, shape (n, 3), at horizontal positions (n, 2) and heights (n,)."""
    return np.column_stack([position, height + LIFT])


SoleSize = tuple[float, float]
"""Length and width of a sole [m]."""


def planned_footprints(run: RunView, frames: Frames) -> Iterator[Track]:
    """The next three footsteps as planned at each time."""
    if not run.has("/footsteps"):
        return
    channel = run.log["/footsteps"]
    rows = np.maximum(np.searchsorted(channel.time, frames.time + 1e-9, side="right") - 1, 0)
    yield from footsteps_ahead(channel.field("next")[rows], channel.field("next_foot")[rows], _sole(run))


def footsteps_ahead(poses: Array, feet: Array, sole: SoleSize) -> Iterator[Track]:
    """Footsteps to come.

    Args:
        poses: x y z yaw, shape (n, k, 4) [m, rad].
        feet: 0 for the left one, 1 for the right one, another number for none, shape (n, k).
        sole: of the robot.
    """
    for foot in (0, 1):
        for ahead in range(poses.shape[1]):
            corners = sole_corners(poses[:, ahead], sole)
            corners[feet[:, ahead] != foot] = np.nan
            name = f"{FOOT_NAMES[foot]}, {ahead + 1} ahead"
            yield Track("Planned footprints", name, "outline", palette.FOOTSTEP, 0.003, corners)


def taken_footprints(run: RunView, frames: Frames) -> Iterator[Footprint]:
    """Where the feet stood at first, and every touchdown until the last frame."""
    if run.has("/footsteps"):
        first = run.log["/footsteps"]
        for foot, name in enumerate(("current_left", "current_right")):
            corners = sole_corners(first.field(name)[:1], _sole(run))[0]
            yield Footprint(palette.FEET[foot], corners, float(first.time[0]))
    if run.has("/footstep"):
        taken = run.log["/footstep"]
        corners = sole_corners(taken.field("actual"), _sole(run))
        for time, foot, place in zip(taken.time.tolist(), taken.field("foot").tolist(), corners, strict=True):
            if time <= frames.time[-1] and np.isfinite(place).all():
                yield Footprint(palette.FEET[foot == 1], place, time)


def _sole(run: RunView) -> SoleSize:
    return run.constants.foot_length, run.constants.foot_width


def sole_corners(poses: Array, sole: SoleSize) -> Array:
    """Corners of soles at x y z yaw of shape (n, 4), just above the ground, shape (n, 4, 3) [m]."""
    ground = level_corners(poses, *sole)
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
    rows = frames.rows
    cop = np.stack([run.field("/contact", f"cop_{side}")[rows] for side in FOOT_NAMES], axis=1)
    force = np.stack([run.field("/measurement", f"wrench_{side}")[rows, :3] for side in FOOT_NAMES], axis=1)
    return sole_forces(run.soles[rows], cop, force)


def sole_forces(soles: Array, cop: Array, force: Array) -> Iterator[Track]:
    """Forces on the soles.

    Args:
        soles: x y z qx qy qz qw, shape (n, 2, 7) [m].
        cop: centres of pressure in the sole frames, shape (n, 2, 2) [m].
        force: in the sole frames, shape (n, 2, 3) [N].
    """
    for foot, name in enumerate(FOOT_NAMES):
        to_world = rotations(soles[:, foot, 3:])
        tail = soles[:, foot, :3] + np.einsum("nij,nj->ni", to_world[:, :, :2], cop[:, foot])
        arrow = _arrow(tail, np.einsum("nij,nj->ni", to_world, force[:, foot]), CONTACT_SCALE)
        yield Track("Contact forces", name, "arrow", palette.FEET[foot], 0.012, arrow)


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
    return push_arrow(head, force)


def push_arrow(head: Array, force: Array) -> Track:
    """A push whose arrow ends where it acts, both of shape (n, 3) [m, N]."""
    return Track("Pushes", "push", "arrow", palette.PUSH, 0.02, _arrow(head - PUSH_SCALE * force, force, PUSH_SCALE))


def _pushed_body(log: Log, run: RunView) -> str:
    """Body that the pushes of the run act on; the torso when they act on several or on none that is known."""
    try:
        bodies = agenda_of(log, scenario_of(log)).bodies
    except LogError:
        bodies = ()
    return bodies[0] if len(bodies) == 1 else torso(run.constants.roles)


def _arrow(tail: Array, force: Array, scale: float) -> Array:
    """Tails and heads, NaN for forces too weak to draw, shape (n, 2, 3) [m]."""
    arrow = np.stack([tail, tail + scale * force], axis=1)
    arrow[np.linalg.norm(force, axis=1) < LEAST_FORCE] = np.nan
    return arrow
