"""Metrics of the walk: falls, steps, speed, feet and posture."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import sole_corners
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.types import Foot, Footstep
from surefoot.scenarios.judge.digest import Array, Mask, RunView

FALLEN_HEIGHT = 0.6
"""Share of the nominal CoM height above the feet below which a robot has fallen."""

FALLEN_TILT = np.deg2rad(60.0)
"""Torso tilt beyond which a robot has fallen [rad]."""

LOST_DISTANCE = 1.0
"""Distance of a pendulum's DCM from its ZMP beyond which no foot could catch it: it has fallen [m]."""

_CLEARANCE_TICKS = 5
"""Every how many control ticks the clearance of a swing is looked at."""

STILL_SPEED = 0.02
"""CoM speed of a robot that stands still [m/s]."""


def fall_time(run: RunView) -> float | None:
    """First time at which the robot has fallen [s].

    A body: its CoM is low over the lower foot, its torso lies, or more than its feet touches. A pendulum: its DCM is
    out of reach of any foot. A cart-table never falls.
    """
    fallen = np.flatnonzero(_lost(run) if run.constants.fidelity == "pendulum" else _lying(run))
    return float(run.time[fallen[0]]) if len(fallen) else None


def fell(run: RunView) -> bool:
    """Whether the robot fell."""
    return fall_time(run) is not None


def duration(run: RunView) -> float:
    """Simulated time [s]."""
    return float(run.time[-1] - run.time[0]) + 1 / run.constants.control_rate


def steps_planned(run: RunView) -> int:
    """Footsteps asked for."""
    return run.constants.steps_planned


def steps_taken(run: RunView) -> int:
    """Touchdowns before a fall."""
    if "/footstep" not in run.log:
        return 0
    end = fall_time(run)
    times = run.log["/footstep"].time
    return len(times) if end is None else int(np.count_nonzero(times < end))


def standing_time_final(run: RunView) -> float:
    """How long the run ends with the CoM still and both feet loaded [s]."""
    moving = np.flatnonzero(~_still(run))
    first = moving[-1] + 1 if len(moving) else 0
    return (run.ticks - int(first)) / run.constants.control_rate


def standing_time_between(run: RunView) -> float:
    """Longest time between two steps with the CoM still and both feet loaded, 0 when the walk never stops [s]."""
    return (
        max((end - start for start, end in runs_of(_still(run)[run.walking])), default=0) / run.constants.control_rate
    )


def footstep_error_max(run: RunView) -> float | None:
    """Largest distance of a sole at touchdown from its footstep as last planned [m]."""
    steps = run.log["/footstep"]
    errors = np.linalg.norm(steps.field("actual")[:, :3] - steps.field("planned")[:, :3], axis=1)
    return float(errors.max())


def stair_edge_margin_min(run: RunView) -> float | None:
    """Least distance of a landed sole's corner from the edge of its tread, negative beyond it [m]."""
    terrain = _terrain(run)
    if not terrain.boxes:
        return None
    half_size = 0.5 * np.array([run.constants.foot_length, run.constants.foot_width])
    landed = run.log["/footstep"].field("actual")
    normals = terrain.normals(landed[:, :2])
    soles = [Footstep(Foot.LEFT, pose[:3], float(pose[3]), up) for pose, up in zip(landed, normals, strict=True)]
    corners = np.array([sole_corners(sole, half_size) for sole in soles])
    return float(terrain.edge_margins(landed[:, :2], corners).min())


def swing_clearance_min(run: RunView) -> float | None:
    """Least height of a swing sole's corner over the ground, but for the first and last quarter of each swing [m]."""
    stance, least = run.field("/reference", "stance"), []
    for foot in range(2):
        for start, end in runs_of(run.single_support & (stance == 1 - foot)):
            edge = (end - start) // 4
            least.append(_clearance(run, run.soles[start + edge : end - edge : _CLEARANCE_TICKS, foot]))
    return min(least, default=None)


def _clearance(run: RunView, poses: Array) -> float:
    """Least height of the corners of soles with these poses, shape (n, 7), over the ground [m]."""
    along, across = 0.5 * run.constants.foot_length, 0.5 * run.constants.foot_width
    corners = np.array([[a, b, 0.0] for a in (along, -along) for b in (across, -across)])
    points = poses[:, None, :3] + np.einsum("nij,kj->nki", _rotations(poses[:, 3:]), corners)
    flat = points.reshape(-1, 3)
    return float((flat[:, 2] - _terrain(run).heights(flat[:, :2])).min(initial=np.inf))


def _rotations(quaternions: Array) -> Array:
    """Rotation matrices of quaternions x y z w, shape (n, 3, 3)."""
    x, y, z, w = quaternions.T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def _terrain(run: RunView) -> Terrain:
    """The true ground."""
    boxes = [np.array(numbers) for numbers in run.constants.boxes]
    return Terrain(tuple(Box(n[:3], n[3:6], n[6:].reshape(3, 3)) for n in boxes))


@dataclass(frozen=True, slots=True)
class Slip:
    """How far a sole moved during a stance.

    Attributes:
        foot: 0 left, 1 right.
        start: tick at which the stance began.
        tick: tick at which the sole was farthest from where it began.
        distance: horizontal distance then [m].
    """

    foot: int
    start: int
    tick: int
    distance: float


def stance_slips(run: RunView) -> list[Slip]:
    """The slip of every stance, planned and felt.

    A foot that rolls moves its sole's centre but not its toe edge, so that of the two counts which moved less.
    """
    contact = (run.field("/contact", "planned") != 0) & (run.field("/contact", "felt") != 0)
    centre, slips = run.soles[..., :2], []
    x, y, z, w = np.moveaxis(run.soles[..., 3:], -1, 0)
    forward = np.stack((1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)), axis=-1)
    toe = centre + 0.5 * run.constants.foot_length * forward
    for foot in range(2):
        for start, end in runs_of(contact[:, foot]):
            moved = [np.linalg.norm(at[start:end, foot] - at[start, foot], axis=1) for at in (centre, toe)]
            distance = np.minimum(*moved)
            farthest = int(np.argmax(distance))
            slips.append(Slip(foot, start, start + farthest, float(distance[farthest])))
    return slips


def foot_slip_max(run: RunView) -> float | None:
    """Largest horizontal distance of a sole from where its stance began, over all stances [m]."""
    return max((slip.distance for slip in stance_slips(run)), default=None)


def self_contact_time(run: RunView) -> float:
    """How long the robot touched itself, before a fall [s]."""
    fallen = fall_time(run)
    touching = run.field("/truth", "self_contact") != 0
    if fallen is not None:
        touching = touching & (run.time < fallen)
    return float(np.count_nonzero(touching) / run.constants.control_rate)


def knee_flexion(run: RunView) -> Array:
    """Mean flexion of the knees at each tick, shape (n,) [rad]."""
    knees = [i for i, name in enumerate(run.constants.joint_names) if "knee" in name]
    return np.asarray(np.abs(run.field("/measurement", "joint_position")[:, knees]).mean(axis=1))


def knee_angle_mean(run: RunView) -> float | None:
    """Mean flexion of both knees while walking, or over the whole run when no foot was lifted [rad]."""
    if not any("knee" in name for name in run.constants.joint_names):
        return None
    return float(np.mean(run.reduced(knee_flexion)[run.walking if run.walking.stop else slice(None)]))


def speed_mean(run: RunView) -> float | None:
    """Horizontal way of the CoM from the first lift-off to the last touchdown over the time it took [m/s]."""
    if not run.walking.stop:
        return None
    com = run.field("/truth", "com")[run.walking, :2]
    time = run.time[run.walking]
    return float(np.linalg.norm(com[-1] - com[0]) / (time[-1] - time[0])) if len(time) > 1 else None


def path_length(run: RunView) -> float:
    """Length of the way from one middle of the feet to the next, over all touchdowns [m]."""
    if not run.has("/footstep"):
        return 0.0
    touchdowns, _ = run.rows_at("/truth", run.log["/footstep"].time_ns)
    middles = _middles(run)[np.minimum(np.concatenate(([0], touchdowns)), run.ticks - 1)]
    return float(np.linalg.norm(np.diff(middles, axis=0), axis=1).sum())


def displacement(run: RunView) -> list[float]:
    """Way of the feet's middle from start to end, ahead and to the left in the start heading [m]."""
    middles, yaw = _middles(run), float(_heading(run)[0])
    x, y = middles[-1] - middles[0]
    c, s = np.cos(yaw), np.sin(yaw)
    return [float(c * x + s * y), float(c * y - s * x)]


def heading_change(run: RunView) -> float:
    """Change of the feet's mean heading from start to end, whole turns counted, left positive [rad]."""
    heading = _heading(run)
    return float(heading[-1] - heading[0])


def com_height_range(run: RunView) -> float:
    """Highest minus lowest CoM [m]."""
    return float(np.ptp(run.field("/truth", "com")[:, 2]))


def _still(run: RunView) -> Mask:
    speed = np.linalg.norm(run.field("/truth", "com_velocity"), axis=1)
    return np.asarray((speed < STILL_SPEED) & (run.field("/contact", "felt") != 0).all(axis=1))


def _middles(run: RunView) -> Array:
    """Middle of both soles at each tick, shape (n, 2) [m]."""
    return np.asarray(run.soles[:, :, :2].mean(axis=1))


def _heading(run: RunView) -> Array:
    """Mean heading of both soles at each tick, without jumps, shape (n,) [rad]."""
    left, right = np.unwrap(run.sole_yaw, axis=0).T
    apart = (left[0] - right[0] + np.pi) // (2.0 * np.pi) * 2.0 * np.pi
    return np.asarray(0.5 * (left - apart + right))


def _lying(run: RunView) -> Mask:
    height = run.field("/truth", "com")[:, 2] - run.soles[:, :, 2].min(axis=1)
    low = height < FALLEN_HEIGHT * run.constants.com_height
    lying = run.field("/truth", "torso_tilt") > FALLEN_TILT
    touching = run.field("/truth", "nonfoot_contact") != 0
    return np.asarray(low | lying | touching)


def _lost(run: RunView) -> Mask:
    if run.constants.plant == "cart_table" or not run.has("/contact", "/reference"):
        return np.zeros(run.ticks, dtype=np.bool_)
    omega = run.field("/reference", "omega")[:, None]
    dcm = run.field("/truth", "com")[:, :2] + run.field("/truth", "com_velocity")[:, :2] / omega
    return np.asarray(np.linalg.norm(dcm - run.field("/contact", "zmp")[:, :2], axis=1) > LOST_DISTANCE)


def runs_of(mask: Mask) -> list[tuple[int, int]]:
    """Begin and end of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
