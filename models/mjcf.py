"""A robot as a tree of bodies, and the tree as MJCF text, every number with all its digits.

Both engines read the same text. Inertials are explicit: Pinocchio's MJCF reader silently drops the mass of geoms
that do not collide, and MuJoCo's own XML writer rounds to six digits, which would make the engines differ by 5e-6.

Robot geoms have contype 2 and conaffinity 3: they touch a terrain of contype 1 and each other, neighbours aside.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from xml.etree import ElementTree

from surefoot.models.actuator import Actuator
from surefoot.models.inertia import Inertial, Vector
from surefoot.models.types import Coupling

_RIGID = "1e-06 1.0", "0.9999 0.9999 0.001 0.5 2.0"
"""Time constant and damping ratio of an equality, of which MuJoCo takes two steps at least; and its impedance."""

AXES: dict[str, Vector] = {"roll": (1.0, 0.0, 0.0), "pitch": (0.0, 1.0, 0.0), "yaw": (0.0, 0.0, 1.0)}
"""Joint axes in the body frame; positive angles follow the right-hand rule."""


class Role(Enum):
    """The role of a geom; the value is its MJCF default class."""

    VISUAL = "visual"
    SOLE = "sole"
    COLLISION = "collision"


@dataclass(frozen=True, slots=True)
class Joint:
    """A revolute joint through the origin of its body, with its motor.

    Attributes:
        name: joint and motor name.
        axis: key of `AXES`.
        lower: lower limit [rad].
        upper: upper limit [rad].
        actuator: the motor.
    """

    name: str
    axis: str
    lower: float
    upper: float
    actuator: Actuator


@dataclass(frozen=True, slots=True)
class Geom:
    """A shape on a body.

    Attributes:
        shape: MJCF geom type.
        size: MJCF sizes [m].
        position: centre in the body frame [m]; ignored with `ends`.
        ends: end points of a capsule's or cylinder's axis, (x1, y1, z1, x2, y2, z2) [m].
        tilt: rotation about the body's y axis [rad]; ignored with `ends`.
        material: colour.
        role: drawn only, drawn and in contact (sole), or in contact only; what is in contact touches terrain and robot.
        name: optional name.
    """

    shape: str
    size: tuple[float, ...]
    position: Vector = (0.0, 0.0, 0.0)
    ends: tuple[float, float, float, float, float, float] | None = None
    tilt: float = 0.0
    material: str = "shell"
    role: Role = Role.VISUAL
    name: str | None = None


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body; its joint, if any, turns it about its own origin.

    Attributes:
        name: name.
        position: origin in the parent's frame at zero joint angle [m].
        inertial: mass properties.
        joint: the joint to the parent; None is the floating base.
        geoms: shapes.
        sites: named points with the axes of the body, (name, position [m]).
        children: bodies hanging on this one, in joint order.
    """

    name: str
    position: Vector
    inertial: Inertial
    joint: Joint | None = None
    geoms: tuple[Geom, ...] = ()
    sites: tuple[tuple[str, Vector], ...] = ()
    children: tuple["Body", ...] = ()

    def walk(self) -> Iterator["Body"]:
        """All bodies from here on, depth first: the order of bodies and joints in both engines."""
        yield self
        for child in self.children:
            yield from child.walk()


def numbers(values: Iterable[float]) -> str:
    """Numbers as an XML attribute; reading them back gives the same doubles."""
    return " ".join(repr(float(value)) for value in values)


def robot_mjcf(
    name: str, base: Body, materials: Mapping[str, Mapping[str, str]], neighbours: Iterable[tuple[str, str]] = ()
) -> str:
    """The robot as a complete MJCF document.

    Args:
        name: model name.
        base: the floating base with everything that hangs on it.
        materials: MJCF attributes per material name.
        neighbours: pairs of bodies that may overlap at the joints between them; parent and child always may.
    """
    root = ElementTree.Element("mujoco", model=name)
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="true")
    add_defaults(root)
    asset = ElementTree.SubElement(root, "asset")
    for material, attributes in materials.items():
        ElementTree.SubElement(asset, "material", {"name": material, **attributes})
    _add_body(ElementTree.SubElement(root, "worldbody"), base)
    contact = ElementTree.SubElement(root, "contact")
    for one, other in neighbours:
        ElementTree.SubElement(contact, "exclude", name=f"{one}-{other}", body1=one, body2=other)
    motors = ElementTree.SubElement(root, "actuator")
    for body in base.walk():
        if body.joint is not None:
            _add_motor(motors, body.joint)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def add_defaults(root: ElementTree.Element) -> None:
    """Add the default class of each role: what it touches, and the group by which viewers tell it."""
    top = ElementTree.SubElement(root, "default")
    for role in Role:
        group = {Role.VISUAL: "1", Role.SOLE: "2", Role.COLLISION: "3"}[role]
        contype, conaffinity = ("0", "0") if role is Role.VISUAL else ("2", "3")
        attributes = {"contype": contype, "conaffinity": conaffinity, "condim": "3", "group": group}
        ElementTree.SubElement(ElementTree.SubElement(top, "default", {"class": role.value}), "geom", attributes)


def add_couplings(root: ElementTree.Element, couplings: Iterable[Coupling]) -> None:
    """Add an equality for each joint that follows another one, as stiff as the physics step lets it be."""
    couplings = tuple(couplings)
    if not couplings:
        return
    section = ElementTree.SubElement(root, "equality")
    for one in couplings:
        ends = {"name": f"{one.follower}-{one.leader}", "joint1": one.follower, "joint2": one.leader}
        law = {"polycoef": numbers((one.offset, one.ratio, 0.0, 0.0, 0.0)), "solref": _RIGID[0], "solimp": _RIGID[1]}
        ElementTree.SubElement(section, "joint", {**ends, **law})


def without_looks(mjcf: str) -> str:
    """A robot's text without the meshes that are only drawn; one without such meshes as it is."""
    root = ElementTree.fromstring(mjcf)
    asset, drawn = root.find("asset"), set()
    for body in root.iter("body"):
        for geom in body.findall(f"geom[@class='{Role.VISUAL.value}'][@mesh]"):
            drawn.add(geom.get("mesh"))
            body.remove(geom)
    if asset is None or not drawn:
        return mjcf
    for mesh in asset.findall("mesh"):
        if mesh.get("name") in drawn:
            asset.remove(mesh)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _add_body(parent: ElementTree.Element, body: Body) -> None:
    element = ElementTree.SubElement(parent, "body", name=body.name, pos=numbers(body.position))
    inertial = {"pos": numbers(body.inertial.com), "mass": repr(body.inertial.mass)}
    ElementTree.SubElement(element, "inertial", inertial, diaginertia=numbers(body.inertial.moments))
    if body.joint is None:
        ElementTree.SubElement(element, "freejoint", name=f"{body.name}_free")
    else:
        _add_joint(element, body.joint)
    for geom in body.geoms:
        _add_geom(element, geom)
    for site, position in body.sites:
        ElementTree.SubElement(element, "site", name=site, pos=numbers(position), size="0.005", group="4")
    for child in body.children:
        _add_body(element, child)


def _add_joint(element: ElementTree.Element, joint: Joint) -> None:
    ElementTree.SubElement(
        element,
        "joint",
        name=joint.name,
        axis=numbers(AXES[joint.axis]),
        range=numbers((joint.lower, joint.upper)),
        armature=repr(joint.actuator.armature),
    )


def _add_geom(element: ElementTree.Element, geom: Geom) -> None:
    attributes = {"class": geom.role.value, "type": geom.shape, "size": numbers(geom.size), "material": geom.material}
    if geom.name is not None:
        attributes["name"] = geom.name
    if geom.ends is not None:
        attributes["fromto"] = numbers(geom.ends)
    else:
        attributes["pos"] = numbers(geom.position)
        attributes["quat"] = numbers((math.cos(geom.tilt / 2), 0.0, math.sin(geom.tilt / 2), 0.0))
    ElementTree.SubElement(element, "geom", attributes)


def _add_motor(motors: ElementTree.Element, joint: Joint) -> None:
    limit = numbers((-joint.actuator.torque_limit, joint.actuator.torque_limit))
    ElementTree.SubElement(motors, "motor", name=joint.name, joint=joint.name, ctrlrange=limit, forcerange=limit)
