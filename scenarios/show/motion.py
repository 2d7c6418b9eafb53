"""A walk as a motion for those who train by imitation: from a log to their files.

An npz file has the names that the trainers of whole-body tracking read (whole_body_tracking of BeyondMimic, mjlab), and
those of joints and bodies beside them. A csv file has the rows of Unitree's retargeted LAFAN1 motions, which the same
trainers convert.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Coordinates
from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.record.provenance import RunConstants
from surefoot.scenarios.show.replay.extract import world
from surefoot.scenarios.show.replay.reference import FPS, MOST_FPS, WXYZ

Array = NDArray[np.float64]

SAME = 1e-5
"""Instants that are as close as this share of a tick are the same [-]."""


@dataclass(frozen=True, slots=True)
class Sampled:
    """A log at the instants of the frames.

    Attributes:
        time: of the frames, shape (n,) [s].
        q: configurations in Pinocchio's convention, shape (n, 7 + nj).
        v: velocities, shape (n, 6 + nj).
        contact: whether the left and the right sole bear, shape (n, 2).
    """

    time: Array
    q: Array
    v: Array
    contact: NDArray[np.bool_]


def sampled(log: Log, fps: float, start: float | None = None, end: float | None = None) -> Sampled:
    """Sample the true motion of a log at an even rate, between ticks by interpolation.

    Args:
        log: of full physics.
        fps: frames per second [Hz].
        start: time of the first frame at the earliest, that of the log if None [s].
        end: time of the last frame at the latest, that of the log's end if None [s].

    Raises:
        LogError: it has no such motion, or has gaps that are longer than a frame.
    """
    if not 0.0 < fps <= MOST_FPS:
        raise LogError(f"--fps {fps:g}: give a number of frames per second up to {MOST_FPS:g}")
    log.require("a motion", "/truth", "/contact")
    found = log.gather({"/truth": ("q", "v"), "/contact": ("felt",)}, start, end)
    truth, contact = found["/truth"], found["/contact"]
    ticks, q, v = np.asarray(truth.time), np.asarray(truth.field("q")), np.asarray(truth.field("v"))
    if len(ticks) < 2:
        first, last = log.time_range()
        raise LogError(f"{log.path}: no two ticks in that time; the log is from {first:.3f} s to {last:.3f} s")
    if not np.isfinite(q).all():
        at = ticks[np.flatnonzero(~np.isfinite(q).all(axis=1))[0]]
        raise LogError(f"{log.path}: the state is not finite at {at:.3f} s; give --to before that")
    gaps = np.diff(ticks)
    if gaps.max() > (1.0 + SAME) / fps:
        at = ticks[int(gaps.argmax())]
        right = f"give --fps {1.0 / gaps.max():.3g} or less, or --from and --to beside it"
        raise LogError(f"{log.path}: nothing is logged for {gaps.max():.3g} s after {at:.3f} s; {right}")
    count = 1 + math.floor((ticks[-1] - ticks[0]) * fps + SAME)
    times = ticks[0] + np.arange(count) / fps
    rows, share = _places(ticks, times)
    moved = _between(q, rows, share)
    moved[:, 3:7] = _turned(q, rows, share)
    felt = np.asarray(contact.field("felt"))[_places(np.asarray(contact.time), times)[0]] != 0
    return Sampled(times, moved, _between(v, rows, share), felt)


def _places(ticks: Array, times: Array) -> tuple[NDArray[np.intp], Array]:
    """The last tick before each instant, and how far towards the next one it is [-]."""
    tick = float(np.diff(ticks).min())
    rows = np.clip(np.searchsorted(ticks, times + SAME * tick, side="right") - 1, 0, len(ticks) - 1)
    following = np.minimum(rows + 1, len(ticks) - 1)
    share = (times - ticks[rows]) / np.where(following > rows, ticks[following] - ticks[rows], 1.0)
    share[np.abs(share) < SAME] = 0.0
    return rows, np.clip(share, 0.0, 1.0)


def _between(values: Array, rows: NDArray[np.intp], share: Array) -> Array:
    """Values between two ticks, shape (n, k)."""
    one, other = values[rows], values[np.minimum(rows + 1, len(values) - 1)]
    found: Array = one + share[:, None] * (other - one)
    return found


def _turned(q: Array, rows: NDArray[np.intp], share: Array) -> Array:
    """Quaternions x y z w between two ticks, along the chord of the shorter way, shape (n, 4)."""
    one, other = q[rows, 3:7], q[np.minimum(rows + 1, len(q) - 1), 3:7]
    same = np.where((one * other).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    found = one + share[:, None] * (same * other - one)
    between: Array = np.where(share[:, None] > 0.0, found / np.linalg.norm(found, axis=1, keepdims=True), one)
    return between


@dataclass(frozen=True, slots=True)
class Bodies:
    """The bodies of a robot along a motion, in the world, its base first.

    Attributes:
        names: length b.
        position: of their frames, shape (n, b, 3) [m].
        quaternion: w x y z, shape (n, b, 4).
        velocity: of their frames' origins, shape (n, b, 3) [m/s].
        angular_velocity: shape (n, b, 3) [rad/s].
    """

    names: tuple[str, ...]
    position: Array
    quaternion: Array
    velocity: Array
    angular_velocity: Array


def bodies_of(model: mujoco.MjModel, q: Array, v: Array) -> Bodies:
    """The bodies of the robot of a world, by MuJoCo's kinematics.

    Args:
        model: of the world; its first body is the base.
        q: configurations in Pinocchio's convention, shape (n, 7 + nj).
        v: velocities, shape (n, 6 + nj).
    """
    data, own = mujoco.MjData(model), np.flatnonzero(model.body_rootid == 1)
    coordinates, count = Coordinates(model), len(q)
    position, quaternion, moved = np.empty((count, len(own), 3)), np.empty((count, len(own), 4)), np.zeros(6)
    velocity, spin = np.empty((count, len(own), 3)), np.empty((count, len(own), 3))
    for frame in range(count):
        coordinates.to_mujoco(q[frame], v[frame], data.qpos, data.qvel)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        position[frame], quaternion[frame] = data.xpos[own], data.xquat[own]
        for index, body in enumerate(own.tolist()):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, moved, 0)
            spin[frame, index], velocity[frame, index] = moved[:3], moved[3:]
    names = tuple(model.body(body).name for body in own.tolist())
    return Bodies(names, position, quaternion, velocity, spin)


def write_motion(
    log: Log,
    out: Path,
    fps: float | None = None,
    joints: Sequence[str] | None = None,
    start: float | None = None,
    end: float | None = None,
    replace: bool = False,
) -> Sampled:
    """Write the true motion of a log for trainers, in the layout that the file's name says.

    Args:
        log: of full physics.
        out: file whose name ends in .npz or .csv.
        fps: frames per second, those of `FPS` if None [Hz].
        joints: that are written, in this order; all of the robot in its own if None.
        start: time of the first frame at the earliest [s].
        end: time of the last frame at the latest [s].
        replace: whether an existing file is replaced.

    Returns:
        what is written.

    Raises:
        LogError: the log has no such motion, or has gaps that are longer than a frame; a joint is not the robot's; the
            kind of file is unknown, or it exists or cannot be written.
    """
    kind = out.suffix.lower()
    if kind not in FPS:
        raise LogError(f"{out}: unknown kind of file '{out.suffix}'; end its name in {' or '.join(FPS)}")
    refuse_existing(out, replace)
    constants = RunConstants.from_metadata(log.metadata, str(log.path))
    if constants.fidelity == "pendulum":
        raise LogError(f"{log.path}: a pendulum has no joints; run the scenario with fidelity full")
    names = constants.joint_names
    chosen = names if joints is None else tuple(joints)
    for name in chosen:
        if name not in names:
            raise LogError(f"{log.path}: its robot has no joint '{name}'; {nearest(name, names)}")
    _, model = world(log)
    rate = FPS[kind] if fps is None else fps
    found = sampled(log, rate, start, end)
    if found.q.shape[1] != Coordinates(model).size:
        raise LogError(f"{log.path}: /truth and world.xml are of different robots; give an intact log")
    at = [names.index(name) for name in chosen]
    with write_whole(out, replace) as temporary:
        if kind == ".csv":
            rows = np.hstack((found.q[:, :7], found.q[:, 7:][:, at]))
            np.savetxt(temporary, rows, fmt="%.9g", delimiter=",")
        else:
            table: dict[str, Any] = _table(found, bodies_of(model, found.q, found.v), chosen, at, rate)
            with temporary.open("wb") as file:
                np.savez(file, **table)
    return found


FEET = ("left", "right")
"""In the order of contacts."""


def _table(found: Sampled, bodies: Bodies, joints: Sequence[str], at: Sequence[int], fps: float) -> dict[str, Any]:
    """Arrays of an npz file by name; numbers of a motion in single precision, as trainers have them."""
    motion = {
        "root_pos": found.q[:, :3],
        "root_quat": found.q[:, 3:7][:, WXYZ],
        "joint_pos": found.q[:, 7:][:, at],
        "joint_vel": found.v[:, 6:][:, at],
        "body_pos_w": bodies.position,
        "body_quat_w": bodies.quaternion,
        "body_lin_vel_w": bodies.velocity,
        "body_ang_vel_w": bodies.angular_velocity,
    }
    return {
        "fps": np.array([int(fps) if fps == int(fps) else fps]),
        "joint_names": np.array(joints),
        "body_names": np.array(bodies.names),
        **{name: values.astype(np.float32) for name, values in motion.items()},
        "contacts": found.contact,
        "contact_names": np.array(FEET),
    }
