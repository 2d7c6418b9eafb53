"""A URDF or MJCF as a Pinocchio model with a floating base, its shapes, and the files that it is made of."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from surefoot.models.robot_file.base import base_frame, base_note, based_on, held_by, moved
from surefoot.models.robot_file.bindings import Binding, Follower
from surefoot.models.robot_file.document import Node, number
from surefoot.models.robot_file.files import Document
from surefoot.models.robot_file.magnitudes import Part, check_parts
from surefoot.models.robot_file.quantities import INERTIA, LENGTH, MASS
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.shapes import Remarks, Shape, urdf_shapes
from surefoot.models.robot_file.sift import absent_notes
from surefoot.models.robot_file.urdf import kinematics
from surefoot.models.robot_file.urdf_schema import absent_of
from surefoot.models.types import Array, RobotError

ROOT = "floating base\n"
"""Name of the joint of the floating base, which no name of a model is, since those can be printed."""

SITES = ("imu", "left_sole", "right_sole")
"""Sites of every description."""

RESERVED = ("world", "universe")
"""Names that the engines give to what stands still."""

_REPAIR = 1e-4
"""Least second moment of a repaired inertia over their sum [-]."""


@dataclass(slots=True)
class Source:
    """A model as its file has it.

    Attributes:
        model: joint 1 is the floating base.
        visual: what is drawn.
        collision: what touches.
        followers: joints that others move, by name.
        bindings: what else binds joints to each other.
        notes: what was altered while reading.
        left_out: elements of the file that the robot has not, each line beginning with "left out: ".
        parts: its links, as the file has them.
        held: joints that hold the base in the world, which the model does not have any more.
    """

    model: pin.Model
    visual: tuple[Shape, ...]
    collision: tuple[Shape, ...]
    followers: Mapping[str, Follower] = field(default_factory=dict)
    bindings: tuple[Binding, ...] = ()
    notes: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    parts: tuple[Part, ...] = ()
    held: tuple[str, ...] = ()


def read_source(file: RobotFile, document: Document) -> Source:
    """Make a model of Pinocchio and shapes of the document of a robot file.

    Raises:
        RobotError: no engine takes it, or it is physically impossible.
    """
    path = document.path
    if document.mjcf is None:
        source = _read_urdf(file, document)
    else:
        from surefoot.models.robot_file.mujoco_source import read_mjcf

        source = read_mjcf(file, path, document.mjcf)
    source = _freed(source)
    _check_parts(source.model, path)
    held = check_parts(source.model, source.parts, source.visual, source.collision, str(path))
    source.visual = held.drawn
    source.left_out += held.left_out
    source.notes += held.notes
    return source


def _freed(source: Source) -> Source:
    """Without the joints between the world and the base, which its floating base replaces."""
    model, chain = source.model, held_by(source.model)
    joint = chain[-1] if chain else 1
    masses = {part.link: part.mass for part in source.parts}
    base, held = base_frame(model, joint, masses), (*source.held, *(model.names[one] for one in chain))
    if held:
        data = model.createData()
        pin.computeSubtreeMasses(model, data)
        source.notes.append(base_note(held, data.mass[1] - data.mass[joint]))
    if not moved(model, joint, base):
        return source
    model = based_on(model, joint, base)
    links = {frame.name for frame in model.frames if frame.type == pin.FrameType.BODY}
    visual, collision = (
        tuple(shape for shape in shapes if shape.link in links) for shapes in (source.visual, source.collision)
    )
    parts = tuple(part for part in source.parts if part.link in links)
    return replace(source, model=model, visual=visual, collision=collision, parts=parts)


def _read_urdf(file: RobotFile, document: Document) -> Source:
    root, path, source_notes = document.root, document.path, list[str]()
    left_out = list(absent_notes(absent_of(root)))
    followers = dict(_mended_joints(root, source_notes))
    parts = tuple(_checked_inertias(root, file, path, source_notes))
    remarks = Remarks(source_notes, left_out)
    visual = urdf_shapes(root, path, "visual", remarks)
    collision = urdf_shapes(root, path, "collision", remarks, visual)
    try:
        model = pin.buildModelFromXML(kinematics(root), pin.JointModelFreeFlyer(), ROOT)
    except Exception as error:
        raise RobotError(("model",), f"{path}: {_one_line(error)}", "mend it, so that Pinocchio can read it") from None
    model.name = file.name
    return Source(model, visual, collision, followers, notes=source_notes, left_out=left_out, parts=parts)


def _check_parts(model: pin.Model, path: Path) -> None:
    """Refuse bodies that no robot has, however an engine came to them, and joints that could not be found by name.

    Raises:
        RobotError: a mass, a moment of inertia or a length is out of range, or a joint has a name of something else.
    """
    for name in (*SITES, "universe"):
        if name in tuple(model.names)[1:]:
            what = f"{path}: a joint has the name '{name}', which means something else in every robot"
            raise RobotError(("model",), what, "give it another")
    links = {frame.parentJoint: frame.name for frame in reversed(model.frames) if frame.type == pin.FrameType.BODY}
    for joint in range(1, model.njoints):
        inertia, name = model.inertias[joint], links.get(joint, model.names[joint])
        bounds = {
            "mass": (inertia.mass, MASS, "kg"),
            "moment of inertia": (np.abs(inertia.inertia).max(), INERTIA, "kg m^2"),
            "centre of mass": (np.abs(inertia.lever).max(), LENGTH, "m"),
            "place": (np.abs(model.jointPlacements[joint].homogeneous).max(), LENGTH, "m"),
            "armature": (float(np.abs(model.armature).max()), INERTIA, "kg m^2"),
        }
        for what, (value, most, unit) in bounds.items():
            if not value <= most:
                said = f"{path}: the {what} of link '{name}' is {value:g} {unit}"
                raise RobotError(("model",), said, f"give at most {most:g} {unit}")


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__


def _mended_joints(root: Node, notes: list[str]) -> Iterator[tuple[str, Follower]]:
    """Bound joints that turn without end, since both engines then have one angle for each; yields those that follow.

    A limit that is not there is zero, which says that a joint has no torque, no speed or no range.
    """
    for joint in (node for node in root.nodes if node.tag == "joint"):
        name, kind = joint.get("name", ""), joint.get("type")
        limit = joint.find("limit")
        if limit is None and kind in ("continuous", "revolute", "prismatic"):
            limit = joint.child("limit")
        if limit is not None:
            limit.attrib |= {"effort": "0", "velocity": "0", **limit.attrib}
        if kind == "continuous" and limit is not None:
            joint.set("type", "revolute")
            limit.attrib |= {"lower": str(-2 * np.pi), "upper": str(2 * np.pi)}
            notes.append(f"joint '{name}' turns without end in the model and one turn either way here")
        mimic = joint.find("mimic")
        if mimic is not None:
            joint.remove(mimic)
            offset, ratio = (number(mimic.get(key, usual)) for key, usual in (("offset", "0"), ("multiplier", "1")))
            if limit is not None:
                limit.set("effort", "0")  # what a joint follows has the motor of both
            yield name, Follower("mimic", "", mimic.get("joint", ""), offset or 0.0, ratio or None)


def _checked_inertias(root: ElementTree.Element, file: RobotFile, path: Path, notes: list[str]) -> Iterator[Part]:
    """Refuse or repair what no body can have; yields links as the file has them.

    Raises:
        RobotError: an inertia is unphysical and not to be repaired.
    """
    for link in root.findall("link"):
        inertial = link.find("inertial")
        mass, inertia = (None if inertial is None else inertial.find(part) for part in ("mass", "inertia"))
        if mass is None or inertia is None:
            continue
        name, kilograms = link.get("name", ""), float(mass.get("value", "0"))
        xx, xy, xz, yy, yz, zz = (float(inertia.get(part, "0")) for part in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        repaired = physical(about, kilograms, name, file, path, notes)
        origin = None if inertial is None else inertial.find("origin")
        com = np.array([float(part) for part in ("" if origin is None else origin.get("xyz", "")).split()] or [0.0] * 3)
        yield Part(name, kilograms, com, float(np.linalg.eigvalsh(about)[2]))
        if repaired is not None:
            for part, (i, j) in {
                "ixx": (0, 0),
                "ixy": (0, 1),
                "ixz": (0, 2),
                "iyy": (1, 1),
                "iyz": (1, 2),
                "izz": (2, 2),
            }.items():
                inertia.set(part, repr(float(repaired[i, j])))


def physical(inertia: Array, mass: float, link: str, file: RobotFile, path: Path, notes: list[str]) -> Array | None:
    """The inertia that some body has, next to one that none has; None where it needs no repair.

    With Σ = ½ tr(I) 1 - I the second moments of the mass, a body has Σ >= 0: its principal moments fulfil a + b >= c.

    Raises:
        RobotError: it is unphysical and not to be repaired.
    """
    second = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    moments, axes = np.linalg.eigh(second)
    total = float(np.abs(moments).sum())
    if mass < 0.0:
        raise RobotError(("model",), f"{path}: link '{link}' has the mass {mass:.6g} kg", "give one of at least 0 kg")
    if moments[0] >= -1e-6 * total or total < 1e-12:
        return None
    a, b, c = np.linalg.eigvalsh(inertia)
    if file.inertia == "refuse":
        what = f"{path}: link '{link}' has principal moments {a:.3g}, {b:.3g}, {c:.3g} kg m^2, of which the two smaller"
        what += f" ones add up to {c - a - b:.2g} less than the largest: no body has them"
        raise RobotError(("inertia",), what, "correct them, or write 'inertia: repair' for the nearest that one has")
    mended = np.maximum(moments, _REPAIR * total)
    notes.append(
        f"the inertia of link '{link}' is repaired: its moments {a:.3g}, {b:.3g}, {c:.3g} kg m^2 are of no body"
    )
    found: Array = mended.sum() * np.eye(3) - (axes * mended) @ axes.T
    return found
