"""Shapes of links as triangles: meshes as they are, boxes, cylinders, spheres and the like as hulls of some points."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from surefoot.models.robot_file.mesh_file import colour_in_file, read_mesh, up_axis_in_file
from surefoot.models.robot_file.meshes import Faces, hull
from surefoot.models.robot_file.paths import is_file, resolve
from surefoot.models.types import Array, RobotError

Colour = tuple[float, float, float, float]

MOST_TRIANGLES = 2_500_000
"""Most triangles of all shapes of a robot, what is drawn and what touches."""

GREY: Colour = (0.7, 0.7, 0.72, 1.0)
_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_AROUND = np.arange(24) * (math.tau / 24)


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape that is fixed to a link.

    Attributes:
        link: frame to which it is fixed.
        vertices: in that frame, shape (n, 3) [m].
        faces: corners of triangles, outward, shape (m, 3).
        rgba: colour.
    """

    link: str
    vertices: Array
    faces: Faces
    rgba: Colour = GREY


def require_moderate(shapes: Sequence[Shape]) -> None:
    """Refuse more triangles than memory should hold.

    Raises:
        RobotError: there are too many.
    """
    if sum(len(shape.faces) for shape in shapes) > MOST_TRIANGLES:
        what = f"the meshes up to link '{shapes[-1].link}' have more than {MOST_TRIANGLES} triangles"
        raise RobotError(("model",), what, "give coarser ones")


def solid(link: str, points: Array, placement: pin.SE3, rgba: Colour = GREY) -> Shape:
    """The convex hull of points that are given in a frame of their own; what has no volume has no faces."""
    if np.ptp(points, axis=0).min() == 0.0:
        return Shape(link, placed(points, placement), np.zeros((0, 3), dtype=np.int64), rgba)
    vertices, faces = hull(points, len(points))
    return Shape(link, placed(vertices, placement), faces, rgba)


def placed(points: Array, placement: pin.SE3) -> Array:
    """Points of one frame in another, shape (n, 3) [m]."""
    return np.asarray(points @ placement.rotation.T + placement.translation)


def box(x: float, y: float, z: float) -> Array:
    """Corners of a box with these full lengths."""
    return np.asarray(_CORNERS * np.array([x, y, z]) / 2)


def ellipsoid(a: float, b: float, c: float) -> Array:
    """Points of an ellipsoid with these semi-axes along x, y and z; poles and equator among them."""
    rings = [_ring(math.cos(v), math.sin(v)) for v in np.linspace(-math.pi / 2, math.pi / 2, 13)[1:-1]]
    unit = np.concatenate((*rings, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    return np.asarray(unit * np.array([a, b, c]))


def cylinder(radius: float, length: float) -> Array:
    """Points of a cylinder along z."""
    return np.concatenate([_ring(radius, half) for half in (-length / 2, length / 2)])


def capsule(radius: float, length: float) -> Array:
    """Points of a capsule along z, with its length between the centres of its caps."""
    ball = ellipsoid(radius, radius, radius)
    shift = np.array([0.0, 0.0, length / 2])
    return np.concatenate((ball[ball[:, 2] >= 0] + shift, ball[ball[:, 2] <= 0] - shift))


def _ring(radius: float, height: float) -> Array:
    flat = np.full_like(_AROUND, height)
    return np.column_stack((radius * np.cos(_AROUND), radius * np.sin(_AROUND), flat))


@dataclass(frozen=True, slots=True)
class Remarks:
    """The remarks on shapes while they are read.

    Attributes:
        notes: what was taken in another way than it is written.
        left_out: what is not drawn.
    """

    notes: list[str]
    left_out: list[str]

    def missing(self, kind: str, faults: Sequence[RobotError]) -> None:
        """Note meshes of a kind, visual or collision, that are missing or cannot be read, by the first of them."""
        if not faults:
            return
        more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
        said = f"{faults[0].what}{more} ({faults[0].right})"
        if kind == "visual":
            self.left_out.append(f"left out: {said}: what has no visual mesh is not drawn")
        else:
            self.notes.append(f"{said}: what has no collision mesh touches by what is drawn")

    def turned(self, kind: str, axes: Mapping[Path, str]) -> None:
        """Note Collada files that say another axis than z is up."""
        if axes:
            file, axis = next(iter(axes.items()))
            more = f" and {len(axes) - 1} more" if len(axes) > 1 else ""
            what = f"{kind} meshes have the axes of their links, whatever is up in {file.name}{more} (it says {axis})"
            self.notes.append(f"{what}, as RViz and Pinocchio read them")


def urdf_shapes(
    root: ElementTree.Element, path: Path, kind: str, remarks: Remarks, drawn: Sequence[Shape] | None = None
) -> tuple[Shape, ...]:
    """Shapes of all links.

    Args:
        root: of the URDF.
        path: of the URDF.
        kind: visual or collision.
        remarks: gets a note on links whose meshes are missing and not needed.
        drawn: by which links touch where a mesh is missing; None where physics needs no mesh.

    Raises:
        RobotError: a mesh that physics needs is missing or cannot be read.
    """
    colours = {
        name: rgba for material in root.iter("material") if (name := material.get("name")) and (rgba := _rgba(material))
    }
    found: list[Shape] = []
    instead = None if drawn is None else {shape.link for shape in drawn}
    missing: list[RobotError] = []
    axes: dict[Path, str] = {}
    for link in root.findall("link"):
        name = link.get("name", "")
        for element in link.findall(kind):
            geometry = element.find("geometry")
            if geometry is None or not len(geometry):
                continue
            material = element.find("material")
            rgba = None
            if material is not None:
                rgba = _rgba(material) or colours.get(material.get("name", ""))
            try:
                found += _urdf_shape(name, geometry[0], _origin(element), rgba, path, axes)
            except RobotError as error:
                fault = RobotError(error.key, f"link '{name}' of {path}: {error.what}", error.right)
                if instead is not None and name not in instead:
                    raise fault from None
                missing.append(fault)
            require_moderate((*(drawn or ()), *found))
    remarks.missing(kind, missing)
    remarks.turned(kind, axes)
    return tuple(found)


def _urdf_shape(
    link: str, thing: ElementTree.Element, origin: pin.SE3, rgba: Colour | None, path: Path, axes: dict[Path, str]
) -> list[Shape]:
    if thing.tag == "mesh":
        reference = thing.get("filename", "")
        place = resolve(reference, path.parent, "mesh")
        if not is_file(place):
            what = f"mesh {reference} is not there"
            raise RobotError(("model",), what, f"put it at {place}, or correct the reference")
        vertices, faces = read_mesh(place)
        scale = _floats(thing.get("scale"), (1.0, 1.0, 1.0))
        if not scale.all():
            raise RobotError(("model",), f"mesh {reference} has the scale '{thing.get('scale')}'", "give none of 0")
        if axis := up_axis_in_file(place):
            axes[place] = axis
        faces = faces if np.prod(scale) > 0 else faces[:, ::-1]
        colour = colour_in_file(place) if rgba is None else None
        rgba = (*colour, 1.0) if colour else rgba or GREY
        return [Shape(link, placed(vertices * scale, origin), faces, rgba)]
    size = {name: float(value) for name, value in thing.attrib.items() if name in ("radius", "length")}
    makers = {
        "box": lambda: box(*_floats(thing.get("size"), (0.0, 0.0, 0.0))),
        "sphere": lambda: ellipsoid(*[size["radius"]] * 3),
        "cylinder": lambda: cylinder(size["radius"], size["length"]),
        "capsule": lambda: capsule(size["radius"], size["length"]),
    }
    if thing.tag not in makers:
        right = f"give one of mesh, {', '.join(makers)}"
        raise RobotError(("model",), f"a shape is a '{thing.tag}'", right)
    return [solid(link, makers[thing.tag](), origin, rgba or GREY)]


def _rgba(material: ElementTree.Element) -> Colour | None:
    colour = material.find("color")
    if colour is None:
        return None
    r, g, b, a = _floats(colour.get("rgba"), GREY)
    return float(r), float(g), float(b), float(a)


def _origin(element: ElementTree.Element) -> pin.SE3:
    origin = element.find("origin")
    if origin is None:
        return pin.SE3.Identity()
    zero = (0.0, 0.0, 0.0)
    return pin.SE3(pin.rpy.rpyToMatrix(_floats(origin.get("rpy"), zero)), _floats(origin.get("xyz"), zero))


def _floats(text: str | None, otherwise: tuple[float, ...]) -> Array:
    return np.array([float(part) for part in text.split()] if text else otherwise)
