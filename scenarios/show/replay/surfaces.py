"""Triangles of what MuJoCo draws: spheres, ellipsoids, capsules and cylinders turned on a lathe, boxes, meshes."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.replay.content import Array, Surface
from surefoot.sim.shapes import Shape, drawn_shapes

Faces = NDArray[np.int64]
Triangles = tuple[Array, Faces]

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
        return shape.mesh.vertices, shape.mesh.faces
    if shape.kind == "box":
        return box(shape.half_size)
    if shape.kind == "cylinder":
        return cylinder(radius, half_length)
    if shape.kind == "capsule":
        return capsule(radius, half_length)
    return ellipsoid(shape.half_size)


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
