"""Robots that are not what their own software believes: other masses, joints that lose torque; shapes stay."""

import math
from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np

from surefoot.models.mjcf import numbers
from surefoot.models.types import Array, RobotDescription, RobotError, nearest


def with_com_raised(description: RobotDescription, height: float) -> RobotDescription:
    """The robot with its trunk's mass sitting higher, so that the whole CoM does with an upright trunk.

    The trunk is every body from the pelvis to the torso. Their CoMs move along what is upright in them with all joints
    at zero, and nearly so in walking; masses and moments about the CoMs stay.

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
    trunk = list(_trunk(root, description))
    lift = height * description.mass / sum(float(inertial.attrib["mass"]) for inertial, _ in trunk)
    for inertial, up in trunk:
        place = np.array([float(value) for value in inertial.attrib["pos"].split()])
        inertial.set("pos", numbers(place + lift * up))
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
        _scale(inertial, factor)
    return replace(description, mjcf=_text(root), mass=factor * description.mass)


def with_masses_scattered(
    description: RobotDescription, half_range: float, rng: np.random.Generator
) -> RobotDescription:
    """The robot with the mass of every body, and its moments of inertia, multiplied by 1 + u.

    Args:
        description: the robot.
        half_range: each u is drawn from within it, by itself, in the order of the bodies [-].
        rng: draws them.

    Raises:
        RobotError: the half range would let a mass vanish.
    """
    if not 0.0 <= half_range < 1.0:
        what = f"the masses of {description.name} shall be scattered by {half_range}"
        raise RobotError(("half_range",), what, "it must be at least 0 and less than 1")
    root = ElementTree.fromstring(description.mjcf)
    inertials = list(root.iter("inertial"))
    for inertial, error in zip(inertials, rng.uniform(-half_range, half_range, len(inertials)), strict=True):
        _scale(inertial, 1.0 + float(error))
    return replace(description, mjcf=_text(root), mass=sum(float(inertial.attrib["mass"]) for inertial in inertials))


def with_torso_com_moved(description: RobotDescription, offset: Array) -> RobotDescription:
    """The robot with the CoM of its torso moved by an offset in the torso's frame, shape (3,) [m]; moments stay.

    Raises:
        RobotError: the torso has no inertial, or the offset is not finite.
    """
    if not np.isfinite(offset).all():
        what = f"the CoM of the torso of {description.name} shall move by {offset} m"
        raise RobotError(("offset",), what, "it must be three finite numbers")
    root = ElementTree.fromstring(description.mjcf)
    inertial = _inertial(root, description, description.torso_body)
    inertial.set("pos", numbers(np.array([float(value) for value in inertial.attrib["pos"].split()]) + offset))
    return replace(description, mjcf=_text(root))


def with_torso_mass_scaled(description: RobotDescription, factor: float) -> RobotDescription:
    """The robot with mass and moments of inertia of its torso's own body multiplied by a factor.

    Raises:
        RobotError: the torso has no inertial, or the factor is not a positive number.
    """
    if not 0.0 < factor < math.inf:
        what = f"the mass of the torso of {description.name} shall be scaled by {factor}"
        raise RobotError(("factor",), what, "it must be a positive number")
    root = ElementTree.fromstring(description.mjcf)
    inertial = _inertial(root, description, description.torso_body)
    added = (factor - 1.0) * float(inertial.attrib["mass"])
    _scale(inertial, factor)
    return replace(description, mjcf=_text(root), mass=description.mass + added)


def with_joint_losses(description: RobotDescription, damping: float, friction: float) -> RobotDescription:
    """The robot whose joints are damped and rub.

    Args:
        description: the robot.
        damping: viscous friction of every joint [N·m·s/rad].
        friction: dry friction of every joint [N·m].

    Raises:
        RobotError: one of them is negative or not finite.
    """
    for name, value in (("damping", damping), ("friction", friction)):
        if not 0.0 <= value < math.inf:
            what = f"the joints of {description.name} shall have a {name} of {value:.6g}"
            raise RobotError((name,), what, "it must be at least 0")
    root = ElementTree.fromstring(description.mjcf)
    for joint in (joint for joint in root.iter("joint") if joint.get("name") in description.joint_names):
        joint.set("damping", repr(float(damping)))
        joint.set("frictionloss", repr(float(friction)))
    return replace(description, mjcf=_text(root))


def with_load(description: RobotDescription, mass: float, body: str | None = None) -> RobotDescription:
    """The robot with a point mass [kg] at the CoM of a body, the torso if None; the payload option of a finished text.

    Raises:
        RobotError: the mass is negative or not finite, or the body is unknown or has no inertial.
    """
    if not 0.0 <= mass < math.inf:
        what = f"{description.name} shall carry {mass:.6g} kg"
        raise RobotError(("mass",), what, "it must be a finite mass of at least 0 kg")
    root = ElementTree.fromstring(description.mjcf)
    inertial = _inertial(root, description, body or description.torso_body)
    inertial.set("mass", repr(float(inertial.attrib["mass"]) + mass))
    return replace(description, mjcf=_text(root), mass=description.mass + mass)


def _scale(inertial: ElementTree.Element, factor: float) -> None:
    inertial.set("mass", repr(factor * float(inertial.attrib["mass"])))
    moments = "diaginertia" if "diaginertia" in inertial.attrib else "fullinertia"
    inertial.set(moments, numbers(factor * float(value) for value in inertial.attrib[moments].split()))


def _inertial(root: ElementTree.Element, description: RobotDescription, name: str) -> ElementTree.Element:
    """Inertial of the body of that name."""
    if name not in description.bodies:
        what = f"'{name}' is no body of {description.name}"
        raise RobotError(("body",), what, nearest(name, description.bodies))
    return _own(next(body for body in root.iter("body") if body.get("name") == name), description)


def _own(body: ElementTree.Element, description: RobotDescription) -> ElementTree.Element:
    inertial = body.find("inertial")
    if inertial is None:
        what = f"body {body.get('name')} of {description.name} has no inertial"
        raise RobotError(("mjcf",), what, "it must have one")
    return inertial


def _trunk(root: ElementTree.Element, description: RobotDescription) -> Iterator[tuple[ElementTree.Element, Array]]:
    """Inertials of the bodies that contain the torso, the way from the pelvis to it; and what is up in each."""
    up = np.array([0.0, 0.0, 1.0])
    for body in root.iter("body"):
        if any(inner.get("name") == description.torso_body for inner in body.iter("body")):
            up = _seen_from(body, up)
            yield _own(body, description), up


def _seen_from(body: ElementTree.Element, vector: Array) -> Array:
    """A vector of the parent's frame in that of a body with its joint at zero, shape (3,)."""
    if "quat" not in body.attrib:
        return vector
    w, *axis = (float(value) for value in body.attrib["quat"].split())
    v = np.array(axis)
    return np.asarray(vector + 2.0 * np.cross(v, np.cross(v, vector) - w * vector))


def _text(root: ElementTree.Element) -> str:
    return ElementTree.tostring(root, encoding="unicode") + "\n"
