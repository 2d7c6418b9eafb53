"""A tree of bodies as MJCF text, every number with all its digits.

Both engines read the same text. Inertials are explicit: Pinocchio's MJCF reader silently drops the mass of geoms
that do not collide, and MuJoCo's own XML writer rounds to six digits, which would make the engines differ by 5e-6.

Robot geoms have contype 2 and conaffinity 3: they touch a terrain of contype 1 and each other, neighbours aside.
"""

import math
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree

from surefoot.models.tree import AXES, Body, Geom, Joint, Role


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
    _add_defaults(root)
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


def _add_defaults(root: ElementTree.Element) -> None:
    top = ElementTree.SubElement(root, "default")
    for role in Role:
        group = {Role.VISUAL: "1", Role.SOLE: "2", Role.COLLISION: "3"}[role]
        contype, conaffinity = ("0", "0") if role is Role.VISUAL else ("2", "3")
        attributes = {"contype": contype, "conaffinity": conaffinity, "condim": "3", "group": group}
        ElementTree.SubElement(ElementTree.SubElement(top, "default", {"class": role.value}), "geom", attributes)


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
