"""Meshes of links, small enough to stand inside a text: decimated ones to look at, convex hulls to touch with.

A CAD system's meshes have some hundred thousand triangles, of which a viewer needs a twentieth. Vertices in one cell of
a grid much finer than the triangles to be become one first: that closes seams between parts, drops what is too small to
be seen, and takes a fraction of the time. Quadric edge collapse (Garland and Heckbert, 1997) does the rest.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import coal
import fast_simplification
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from surefoot.models.types import Array, RobotError

Faces = NDArray[np.int64]
Triangles = tuple[Array, Faces]
"""Vertices, shape (n, 3) [m], and their indices in each triangle, counter-clockwise from outside, shape (m, 3)."""

GRID = 0.1
"""Side of the cells in which vertices become one, over the edge of the triangles to be [-]."""

_PACKED = 21
"""Bits of each of the three coordinates of a cell in one integer."""

_STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_STL_HEADER = 84


@dataclass(frozen=True, slots=True, eq=False)
class LinkMesh:
    """What a link looks like, or a part of it of one colour.

    Attributes:
        name: of the geometry object.
        joint: index of the joint that moves it.
        vertices: in the frame of that joint, shape (n, 3) [m].
        faces: vertices of each triangle, counter-clockwise from outside, shape (m, 3).
        rgba: colour and opacity, 0 to 1.
    """

    name: str
    joint: int
    vertices: Array
    faces: Faces
    rgba: tuple[float, float, float, float]


def loader() -> coal.MeshLoader:
    """For `pinocchio.buildGeomFromUrdf`: reads each file once, with the cheapest of bounding volumes."""
    return coal.CachedMeshLoader(coal.BV_AABB)


def links_meshes(
    geometry: pin.GeometryModel, most_faces: int, given: Mapping[str, Triangles] | None = None
) -> tuple[LinkMesh, ...]:
    """The meshes of a robot, with so few triangles that all together have about `most_faces` at most.

    Args:
        geometry: shapes of a robot; those that are no meshes are left out.
        most_faces: triangles of the whole robot.
        given: of meshes that are not in files, by the name of the geometry object and in its frame.

    Raises:
        RobotError: a file is missing or no mesh.
    """
    things = [thing for thing in geometry.geometryObjects if is_mesh(thing, given)]
    parts = [_placed(triangles(thing, given), thing.placement) for thing in things]
    areas = np.array([_area(part) for part in parts])
    if not areas.sum() > 0.0:
        return ()
    cell = GRID * np.sqrt(2.0 * areas.sum() / most_faces)
    coarse = [merged(part, cell) for part in parts]
    shares = _shares(np.array([len(faces) for _, faces in coarse]), np.sqrt(areas), most_faces)
    small = [_decimated(part, share) for part, share in zip(coarse, shares.tolist(), strict=True)]
    return tuple(
        LinkMesh(thing.name, thing.parentJoint, *part, colour(thing))
        for thing, part in zip(things, small, strict=True)
        if len(part[1])
    )


def is_mesh(thing: pin.GeometryObject, given: Mapping[str, Triangles] | None = None) -> bool:
    """Whether a shape is a mesh and no primitive."""
    return thing.name in (given or {}) or thing.geometry.getObjectType() == coal.OT_BVH


def triangles(thing: pin.GeometryObject, given: Mapping[str, Triangles] | None = None) -> Triangles:
    """All triangles of a mesh, in the frame of the object and with its scale.

    Raises:
        RobotError: its file is missing or no mesh.
    """
    if thing.name in (given or {}):
        return (given or {})[thing.name]
    path, scale = Path(thing.meshPath), np.asarray(thing.meshScale)
    try:
        vertices, faces = (_stl(path) if path.suffix.lower() == ".stl" else None) or _any_format(path)
    except (OSError, ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:200]
        raise RobotError(("model",), f"mesh {path} cannot be read, {reason}", "give a STL, OBJ or DAE file") from None
    return vertices * scale, faces if scale.prod() > 0.0 else faces[:, ::-1]


def colour(thing: pin.GeometryObject) -> tuple[float, float, float, float]:
    """Of the description, or else the first one in the mesh's file or beside it, or else the reader's grey."""
    red, green, blue, opacity = (round(float(part), 4) for part in thing.meshColor)
    own = None if thing.overrideMaterial else _colour_in_file(Path(thing.meshPath))
    return (*own, 1.0) if own else (red, green, blue, opacity)


def hull(vertices: Array, most: int) -> Triangles:
    """Convex hull of points; if it has too many corners, of those that make most of it.

    Args:
        vertices: shape (n, 3) [m].
        most: corners of the hull.

    Raises:
        RobotError: the points lie in a plane.
    """
    try:
        corners = vertices[ConvexHull(vertices).vertices]
        if len(corners) > most:
            corners = _outermost(corners, most)
        found = ConvexHull(corners)
    except (QhullError, ValueError):
        what = f"a mesh of {len(vertices)} vertices has no volume"
        raise RobotError(("model",), what, "give collision shapes with a thickness") from None
    a, b, c = corners[found.simplices].transpose(1, 0, 2)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    faces = found.simplices.astype(np.int64)
    faces[inward] = faces[inward][:, ::-1]
    return corners, faces


def merged(part: Triangles, cell: float) -> Triangles:
    """A mesh whose vertices in one cell of a grid are one, without what became of triangles inside a cell.

    Args:
        part: vertices and faces.
        cell: side of the cells [m].
    """
    vertices, faces = part
    low, extent = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max())
    cell = max(cell, extent / (2**_PACKED - 2))
    x, y, z = np.rint((vertices - low) / cell).astype(np.int64).T
    _, first, place = np.unique(x | y << _PACKED | z << 2 * _PACKED, return_index=True, return_inverse=True)
    a, b, c = renamed = place[faces].T
    return _used(vertices[first], renamed.T[(a != b) & (b != c) & (c != a)])


def _outermost(corners: Array, most: int) -> Array:
    """So many of the points that their hull is nearly that of all: time and again those farthest outside join it."""
    chosen = np.unique(np.concatenate((corners.argmin(axis=0), corners.argmax(axis=0))))
    chosen = np.union1d(chosen, [np.linalg.norm(corners - corners[chosen].mean(axis=0), axis=1).argmax()])
    while len(chosen) < most:
        found = ConvexHull(corners[chosen], qhull_options="QJ")
        outside = corners @ found.equations[:, :3].T + found.equations[:, 3]
        farthest = outside.argmax(axis=0)
        order = np.argsort(-outside.max(axis=0), kind="stable")
        new = [point for point in dict.fromkeys(farthest[order].tolist()) if point not in chosen]
        if not new:
            break
        chosen = np.union1d(chosen, new[: (most - len(chosen) + 1) // 2])
    farthest_out: Array = corners[chosen]
    return farthest_out


def _shares(wanted: NDArray[np.int_], weights: Array, most: int) -> NDArray[np.int64]:
    """Triangles for each mesh: by its weight, and what some do not need for the others; never more than it has."""
    share = np.zeros(len(wanted))
    hungry = np.ones(len(wanted), dtype=bool)
    while hungry.any():
        share[hungry] = weights[hungry] * (most - share[~hungry].sum()) / weights[hungry].sum()
        full = hungry & (share >= wanted)
        if not full.any():
            break
        share[full], hungry[full] = wanted[full], False
    return share.astype(np.int64)


def _decimated(part: Triangles, most: int) -> Triangles:
    vertices, faces = part
    if len(faces) <= most:
        return part
    size = float(np.ptp(vertices, axis=0).max())  # the thresholds of the library are for meshes of about unit size
    vertices, faces = fast_simplification.simplify(vertices / size, faces.astype(np.int32), target_count=max(most, 4))
    return _used(np.asarray(size * vertices, dtype=np.float64), np.asarray(faces, dtype=np.int64))


def _used(vertices: Array, faces: Faces) -> Triangles:
    """Without vertices of no triangle."""
    kept, renamed = np.unique(faces, return_inverse=True)
    return vertices[kept], renamed.reshape(faces.shape).astype(np.int64)


def _placed(part: Triangles, placement: pin.SE3) -> Triangles:
    vertices, faces = part
    return vertices @ placement.rotation.T + placement.translation, faces


def _area(part: Triangles) -> float:
    a, b, c = part[0][part[1]].transpose(1, 0, 2)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _stl(path: Path) -> Triangles | None:
    """Corners of the triangles of a binary STL file; None if it is of the textual kind."""
    data = path.read_bytes()
    if len(data) < _STL_HEADER or (len(data) - _STL_HEADER) % _STL.itemsize:
        return None
    corners = np.frombuffer(data, _STL, offset=_STL_HEADER)["corners"].reshape(-1, 3).astype(np.float64)
    return corners, np.arange(len(corners)).reshape(-1, 3)


def _any_format(path: Path) -> Triangles:
    """By the reader of Pinocchio's collision library."""
    shape = coal.MeshLoader(coal.BV_OBB).load(str(path), np.ones(3))
    faces = ((face[0], face[1], face[2]) for face in map(shape.tri_indices, range(shape.num_tris)))
    return np.array(shape.vertices()), np.array(list(faces), dtype=np.int64).reshape(-1, 3)


def _colour_in_file(path: Path) -> tuple[float, float, float] | None:
    """Diffuse colour of the first material of an OBJ or DAE."""
    patterns = {".obj": r"(?m)^\s*Kd\s+([^\n]+)", ".dae": r"<diffuse>\s*<color[^>]*>([^<]+)"}
    pattern = patterns.get(path.suffix.lower())
    file = path.with_suffix(".mtl") if path.suffix.lower() == ".obj" else path
    found = re.search(pattern, file.read_text(errors="replace")) if pattern and file.is_file() else None
    if found is None:
        return None
    red, green, blue = (min(max(float(part), 0.0), 1.0) for part in found[1].split()[:3])
    return red, green, blue
