"""From a log to what a replay shows of it: which frames, where the bodies are in them, and what they look like."""

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from surefoot.models.convert import pinocchio_to_mujoco
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import Color
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.show.replay.content import Array, Frames, Replay, ReplayWindow, Surface
from surefoot.scenarios.show.replay.overlays import (
    balance,
    contact_forces,
    planned_footprints,
    push,
    taken_footprints,
)
from surefoot.sim.shapes import Shape, drawn_shapes


def choose_frames(run: RunView, window: ReplayWindow) -> Frames:
    """Frames of a window, without those in which the robot's state is not finite.

    Raises:
        LogError: the window holds no tick of the log.
    """
    if len(run.time) == 0:
        raise LogError(f"{run.log.path}: ends before the first control tick; there is nothing to replay")
    ticks = run.time
    first, last = float(ticks[0]), float(ticks[-1])
    start = first if window.start is None else max(window.start, first)
    end = last if window.end is None else min(window.end, last)
    if not start <= end:
        asked = " ".join(f"{word} {t:g} s" for word, t in (("from", window.start), ("to", window.end)) if t is not None)
        raise LogError(f"{run.log.path}: nothing {asked}; the log goes from {first:g} s to {last:g} s")
    # Only frames with a tick of their own, so that one damaged time stamp does not make hours of them.
    numbers = np.unique(
        np.floor((ticks[(ticks >= start - 1e-9) & (ticks <= end + 1e-9)] - start) * window.frame_rate + 1e-6)
    )
    if not len(numbers):
        raise LogError(f"{run.log.path}: no control tick from {start:g} s to {end:g} s; choose another part")
    time = start + numbers / window.frame_rate
    rows = np.maximum(np.searchsorted(ticks, time + 1e-9, side="right") - 1, 0)
    sound = np.isfinite(run.field("/truth", "q")[rows]).all(axis=1)
    if not sound.any():
        raise LogError(f"{run.log.path}: the robot's state is never finite; there is nothing to replay")
    return Frames(time[sound], rows[sound])


def world_text(log: Log) -> str:
    """MJCF text of the world that was simulated.

    Raises:
        LogError: the log has none.
    """
    try:
        return log.attachments[WORLD_FILE].decode()
    except (KeyError, UnicodeDecodeError):
        raise LogError(f"{log.path}: holds no readable {WORLD_FILE}; replay needs a log of fidelity full") from None


def compile_world(log: Log) -> mujoco.MjModel:
    """Compile the world of a log.

    Raises:
        LogError: the log has no world, or it is damaged.
    """
    try:
        return mujoco.MjModel.from_xml_string(world_text(log))
    except ValueError as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{log.path}: {WORLD_FILE} is damaged, {reason}; replay needs an intact one") from None


def body_poses(model: mujoco.MjModel, configurations: Array) -> tuple[Array, Array]:
    """Poses of the bodies.

    Args:
        model: the world.
        configurations: in Pinocchio's convention, shape (n, nq).

    Returns:
        positions, shape (n, bodies, 3) [m], and quaternions w x y z, shape (n, bodies, 4).
    """
    data, rest = mujoco.MjData(model), np.zeros(model.nv)
    positions = np.empty((len(configurations), model.nbody, 3))
    quaternions = np.empty((len(configurations), model.nbody, 4))
    for q, position, quaternion in zip(configurations, positions, quaternions, strict=True):
        pinocchio_to_mujoco(q, rest, data.qpos, data.qvel)
        mujoco.mj_kinematics(model, data)
        position[:], quaternion[:] = data.xpos, data.xquat
    return positions, quaternions


def extract(log: Log, window: ReplayWindow | None = None) -> Replay:
    """Read what there is to show.

    Args:
        log: of a run in full physics, also a truncated one.
        window: what part of it; all by default.

    Raises:
        LogError: the log does not describe such a run, or has nothing in that window.
    """
    run = RunView(log)
    if run.constants.fidelity == "pendulum":
        raise LogError(f"{log.path}: a pendulum has no body to replay; run the scenario with fidelity full")
    model = compile_world(log)
    log.load("/truth", "/measurement", "/estimate", "/contact", "/reference")
    frames = choose_frames(run, window or ReplayWindow())
    configurations = run.field("/truth", "q")[frames.rows]
    if configurations.shape[1] != model.nq:
        raise LogError(f"{log.path}: /truth and world.xml are of different robots; replay needs an intact log")
    position, quaternion = body_poses(model, configurations)
    names = tuple(model.body(body).name for body in range(model.nbody))
    com = position + Rotation.from_quat(quaternion, scalar_first=True).apply(
        np.broadcast_to(model.body_ipos, position.shape)
    )
    return Replay(
        title=run.constants.scenario,
        frame_rate=(window or ReplayWindow()).frame_rate,
        time=frames.time,
        configuration=configurations,
        body_names=names,
        body_position=position,
        body_quaternion=quaternion,
        surfaces=surfaces(model),
        tracks=(
            *balance(run, frames).tracks(),
            *planned_footprints(run, frames),
            *contact_forces(run, frames),
            push(log, run, frames, names, com),
        ),
        footprints=tuple(taken_footprints(run, frames)),
        mjcf=world_text(log),
    )


Faces = NDArray[np.int64]
Triangles = tuple[Array, Faces]

CREASE = np.deg2rad(35.0)
"""Triangles that meet at a larger angle have an edge between them [rad]."""

SEGMENTS = 20
"""Around the axis of a lathed body; half as many from pole to pole."""


def surfaces(model: mujoco.MjModel) -> tuple[Surface, ...]:
    """Every visible geom but the endless ground, geoms of one body and one colour merged."""
    groups: dict[tuple[int, Color], list[Triangles]] = {}
    for shape in drawn_shapes(model):
        groups.setdefault((shape.body, shape.color[:3]), []).append(_placed(shape))
    return tuple(Surface(body, color, *_merged(parts)) for (body, color), parts in groups.items())


def _placed(shape: Shape) -> Triangles:
    """Triangles of a shape in the frame of its body."""
    vertices, faces = _triangles(shape)
    return vertices @ shape.rotation.T + shape.position, faces


def _merged(parts: list[Triangles]) -> Triangles:
    offsets = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    faces = [faces + offset for (_, faces), offset in zip(parts, offsets, strict=True)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def _triangles(shape: Shape) -> Triangles:
    radius, _, half_length = shape.half_size
    if shape.mesh is not None:
        return creased(shape.mesh.vertices, shape.mesh.faces)
    if shape.kind == "box":
        return box(shape.half_size)
    if shape.kind == "cylinder":
        return cylinder(radius, half_length)
    if shape.kind == "capsule":
        return capsule(radius, half_length)
    return ellipsoid(shape.half_size)


def creased(vertices: Array, faces: Faces) -> Triangles:
    """A mesh with the vertices of its sharp edges once for each side, where a viewer's smooth shading then ends."""
    a, b, c = vertices[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    one, other = order[:-1][same] // 3, order[1:][same] // 3
    smooth = np.einsum("ij,ij->i", normals[one], normals[other]) > np.cos(CREASE)
    links = coo_array((smooth[smooth], (one[smooth], other[smooth])), shape=(len(faces), len(faces)))
    _, side = connected_components(links, directed=False)
    corners = np.stack([faces, np.broadcast_to(side[:, None], faces.shape)], axis=2).reshape(-1, 2)
    kept, places = np.unique(corners, axis=0, return_inverse=True)
    return vertices[kept[:, 0]], places.reshape(faces.shape)


def ellipsoid(radii: Array) -> Triangles:
    """Ellipsoid about the origin with these half axes, shape (3,) [m]."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, SEGMENTS // 2 + 1)
    vertices, faces = _lathe(np.cos(angle), np.sin(angle))
    return vertices * radii, faces


def capsule(radius: float, half_length: float) -> Triangles:
    """Capsule along z; the half length is that of its straight part [m]."""
    angle = np.linspace(0, np.pi / 2, SEGMENTS // 4 + 1)
    r, z = radius * np.cos(angle), radius * np.sin(angle) + half_length
    return _lathe(np.concatenate([r[::-1], r]), np.concatenate([-z[::-1], z]))


def cylinder(radius: float, half_length: float) -> Triangles:
    """Cylinder along z; caps and mantle share no vertices, so that the edges are sharp."""
    ends = np.array([-half_length, half_length])
    bottom = _lathe(np.array([0.0, radius]), ends[[0, 0]])
    mantle = _lathe(np.array([radius, radius]), ends)
    top = _lathe(np.array([radius, 0.0]), ends[[1, 1]])
    return _merged([bottom, mantle, top])


def box(half_size: Array) -> Triangles:
    """Box about the origin with sharp edges; half sizes of shape (3,) [m]."""
    square = np.array([[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    # Cyclic permutations of the axes keep the orientation, so does a turn by half about x.
    half_turn = np.array([1.0, -1.0, -1.0])
    sides = [np.roll(square * flip, axis, axis=1) for axis in range(3) for flip in (np.ones(3), half_turn)]
    vertices, faces = _merged([(side, faces) for side in sides])
    return vertices * half_size, faces


def _lathe(radius: Array, height: Array) -> Triangles:
    """Turn a profile, given from the bottom to the top, about the z axis."""
    angle = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
    x, y = np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))
    vertices = np.stack([x, y, np.broadcast_to(height[:, None], x.shape)], axis=2).reshape(-1, 3)
    ring = np.arange((len(radius) - 1) * SEGMENTS).reshape(-1, SEGMENTS)
    beside, above, both = np.roll(ring, -1, axis=1), ring + SEGMENTS, np.roll(ring, -1, axis=1) + SEGMENTS
    faces = np.stack([ring, beside, both, ring, both, above], axis=2).reshape(-1, 3)
    corners = vertices[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return vertices, faces[area > 1e-12]
