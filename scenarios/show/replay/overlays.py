"""What is drawn beside the robot: points of balance, footprints and forces."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios import palette
from surefoot.scenarios.judge.body import level_corners, rotations
from surefoot.scenarios.show.logview import FOOT_NAMES
from surefoot.scenarios.show.replay.content import Array, Track

LIFT = 0.004
"""How far marks on the ground are drawn above it [m]."""

CONTACT_SCALE = 0.0005
"""Length of a contact force's arrow [m/N]: 1000 N are 0.5 m."""

PUSH_SCALE = 0.002
"""Length of a push's arrow [m/N]: 200 N are 0.4 m."""

PUSH_SHOWN = 0.3
"""How long a push stays in sight after its end, since many last less than a frame [s]."""

LEAST_FORCE = 5.0
"""Weaker forces are not drawn [N]."""

SoleSize = tuple[float, float]
"""Length and width of a sole [m]."""


@dataclass(frozen=True, slots=True)
class Facts:
    """What the marks tell, by frame, whether it comes from a log or from a run that goes on.

    Attributes:
        com: true CoM, shape (n, 3) [m].
        dcm: shape (n, 2) [m].
        zmp: shape (n, 3) [m]; NaN in flight.
        planned_com: shape (n, 3) [m].
        planned_dcm: shape (n, 2) [m].
        planned_zmp: shape (n, 2) [m].
        polygon: vertices of the planned support polygon, shape (n, k, 2) [m].
        contacts: whether the left and the right foot shall stand, shape (n, 2).
        soles: x y z qx qy qz qw of both feet, shape (n, 2, 7) [m].
        cop: centres of pressure in the sole frames, shape (n, 2, 2) [m].
        force: on the soles in their frames, shape (n, 2, 3) [N].
        ahead: x y z yaw of the footsteps to come, shape (n, k, 4) [m, rad].
        ahead_foot: 0 for the left one, 1 for the right one, another number for none, shape (n, k).
        push: force, shape (n, 3) [N].
        pushed: where it acts, shape (n, 3) [m].
        sole: of the robot.
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
    cop: Array
    force: Array
    ahead: Array
    ahead_foot: Array
    push: Array
    pushed: Array
    sole: SoleSize


def tracks(facts: Facts) -> Iterator[Track]:
    """Every mark that moves."""
    yield from _balance(facts)
    for foot, name in enumerate(FOOT_NAMES):
        for ahead in range(facts.ahead.shape[1]):
            corners = sole_corners(facts.ahead[:, ahead], facts.sole)
            corners[facts.ahead_foot[:, ahead] != foot] = np.nan
            place = f"{name}, {ahead + 1} ahead"
            yield Track("Planned footprints", place, "outline", palette.FOOTSTEP, 0.003, corners)
    for foot, name in enumerate(FOOT_NAMES):
        to_world = rotations(facts.soles[:, foot, 3:])
        tail = facts.soles[:, foot, :3] + np.einsum("nij,nj->ni", to_world[:, :, :2], facts.cop[:, foot])
        arrow = _arrow(tail, np.einsum("nij,nj->ni", to_world, facts.force[:, foot]), CONTACT_SCALE)
        yield Track("Contact forces", name, "arrow", palette.FEET[foot], 0.012, arrow)
    arrow = _arrow(facts.pushed - PUSH_SCALE * facts.push, facts.push, PUSH_SCALE)  # which ends where it acts
    yield Track("Pushes", "push", "arrow", palette.PUSH, 0.02, arrow)


def _balance(facts: Facts) -> Iterator[Track]:
    """CoM with its plumb line, DCM, ZMP and the planned support polygon."""
    com, ground = facts.com, np.asarray(facts.soles[:, :, 2].min(axis=1))
    below = _flat(com[:, :2], ground)
    yield _point("CoM", "measured", palette.COM, 0.035, com, trail=True)
    yield _point("CoM", "on the ground", palette.COM, 0.014, below)
    yield Track("CoM", "plumb line", "outline", palette.paler(palette.COM), 0.002, np.stack([com, below], axis=1))
    yield _point("CoM", "planned", palette.COM_PLANNED, 0.025, facts.planned_com)
    yield _point("DCM", "measured", palette.DCM, 0.014, _flat(facts.dcm, ground), trail=True)
    yield _point("DCM", "planned", palette.DCM_PLANNED, 0.01, _flat(facts.planned_dcm, ground))
    yield _point("ZMP", "measured", palette.ZMP, 0.014, facts.zmp + np.array([0.0, 0.0, LIFT]), trail=True)
    yield _point("ZMP", "planned", palette.ZMP_PLANNED, 0.01, _flat(facts.planned_zmp, ground))
    yield Track("Support polygon", "planned", "outline", palette.SUPPORT, 0.004, _support(facts))


def _support(facts: Facts) -> Array:
    """Vertices of the planned support polygon, each as high as the nearer sole that stands, shape (n, k, 3) [m]."""
    soles = facts.soles[:, :, :3]
    distance = np.linalg.norm(facts.polygon[:, :, None, :] - soles[:, None, :, :2], axis=3)
    distance[np.broadcast_to(~facts.contacts[:, None, :], distance.shape)] = np.inf
    height = np.take_along_axis(soles[:, :, 2], distance.argmin(axis=2), axis=1)
    return np.concatenate([facts.polygon, height[..., None] + LIFT], axis=2)


def _point(layer: str, name: str, color: palette.Color, size: float, position: Array, trail: bool = False) -> Track:
    return Track(layer, name, "point", color, size, position[:, None, :], trail)


def _flat(position: Array, height: Array) -> Array:
    """Points of the ground, shape (n, 3), at horizontal positions (n, 2) and heights (n,)."""
    return np.column_stack([position, height + LIFT])


def sole_corners(poses: Array, sole: SoleSize) -> Array:
    """Corners of soles at x y z yaw of shape (n, 4), just above the ground, shape (n, 4, 3) [m]."""
    ground = level_corners(poses, *sole)
    height = np.broadcast_to(poses[:, 2, None] + LIFT / 2, ground.shape[:2])
    return np.concatenate([ground, height[..., None]], axis=2)


def _arrow(tail: Array, force: Array, scale: float) -> Array:
    """Tails and heads, NaN for forces too weak to draw, shape (n, 2, 3) [m]."""
    arrow = np.stack([tail, tail + scale * force], axis=1)
    arrow[np.linalg.norm(force, axis=1) < LEAST_FORCE] = np.nan
    return arrow
