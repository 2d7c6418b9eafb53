"""Robots whose mass is not where, or not what, their own software believes; geometry, joints and motors stay."""

import math
from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree

from surefoot.models.mjcf import numbers
from surefoot.models.types import RobotDescription, RobotError


def with_com_raised(description: RobotDescription, height: float) -> RobotDescription:
    """The robot with its trunk's mass sitting higher, so that the whole CoM does with an upright trunk.

    The trunk is every body from the pelvis to the torso. Their CoMs move along their own z axes, which stand upright
    in standing and nearly so in walking; masses and moments about the CoMs stay.

    Args:
        description: the robot.
        height: by which the whole CoM rises; negative lowers it [m].

    Raises:
        RobotError: the height is not finite.
    """
    if not math.isfinite(height):
        what = f"the CoM of {description.name} shall rise by {height} m"
        raise RobotError(("height",), what, "it must be a finite height")
    root = ElementTree.fromstring(description.mjcf)
    inertials = list(_trunk(root, description))
    lift = height * description.mass / sum(float(inertial.attrib["mass"]) for inertial in inertials)
    for inertial in inertials:
        x, y, z = (float(value) for value in inertial.attrib["pos"].split())
        inertial.set("pos", numbers((x, y, z + lift)))
    return replace(description, mjcf=_text(root))


def with_mass_scaled(description: RobotDescription, factor: float) -> RobotDescription:
    """The robot with all masses and moments of inertia multiplied by one factor.

    Raises:
        RobotError: the factor is not a positive number.
    """
    if not 0.0 < factor < math.inf:
        what = f"the mass of {description.name} shall be scaled by {factor}"
        raise RobotError(("factor",), what, "it must be a positive number")
    root = ElementTree.fromstring(description.mjcf)
    for inertial in root.iter("inertial"):
        inertial.set("mass", repr(factor * float(inertial.attrib["mass"])))
        inertial.set("diaginertia", numbers(factor * float(value) for value in inertial.attrib["diaginertia"].split()))
    return replace(description, mjcf=_text(root), mass=factor * description.mass)


def _trunk(root: ElementTree.Element, description: RobotDescription) -> Iterator[ElementTree.Element]:
    """Inertials of the bodies that contain the torso: the way from the pelvis to it."""
    for body in root.iter("body"):
        if any(inner.get("name") == description.torso_body for inner in body.iter("body")):
            inertial = body.find("inertial")
            if inertial is None:
                what = f"body {body.get('name')} of {description.name} has no inertial"
                raise RobotError(("mjcf",), what, "it must have one")
            yield inertial


def _text(root: ElementTree.Element) -> str:
    return ElementTree.tostring(root, encoding="unicode") + "\n"
