"""Triangles of the shapes of a world, as viewers without such shapes draw them."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surefoot.sim.measurement import Array
from surefoot.sim.shapes import Shape

Faces = NDArray[np.int64]
Triangles = tuple[Array, Faces]

CREASE = np.deg2rad(35.0)
"""Triangles that meet at a larger angle have an edge between them [rad]."""

SEGMENTS = 20
"""Around the axis of a lathed body; half as many from pole to pole."""


def merged(parts: list[Triangles]) -> Triangles:
    """Triangles of several shapes as those of one."""
    offsets = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    faces = [faces + offset for (_, faces), offset in zip(parts, offsets, strict=True)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def triangles(shape: Shape) -> Triangles:
    """The surface of a shape in its own axes: vertices, shape (n, 3) [m], and counter-clockwise faces, shape (m, 3)."""
    radius, _, half_length = shape.half_size
    if shape.mesh is not None:
        return creased(shape.mesh.vertices, shape.mesh.faces)
    match shape.kind:
        case "box":
            return box(shape.half_size)
        case "cylinder":
            return cylinder(radius, half_length)
        case "capsule":
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
    return merged([bottom, mantle, top])


def box(half_size: Array) -> Triangles:
    """Box about the origin with sharp edges; half sizes of shape (3,) [m]."""
    square = np.array([[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    # Cyclic permutations of the axes keep the orientation, so does a turn by half about x.
    half_turn = np.array([1.0, -1.0, -1.0])
    sides = [np.roll(square * flip, axis, axis=1) for axis in range(3) for flip in (np.ones(3), half_turn)]
    vertices, faces = merged([(side, faces) for side in sides])
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
