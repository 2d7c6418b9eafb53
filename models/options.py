"""Options every robot offers, checked and applied to its tree, or to its text where that is all there is."""

import math
from collections.abc import Sequence
from dataclasses import replace
from xml.etree import ElementTree

from surefoot.models.mjcf import Body, numbers
from surefoot.models.types import RobotDescription, RobotError, RobotOptions, nearest


def foot_size(options: RobotOptions, length: float, width: float) -> tuple[float, float]:
    """Sole length and width [m]: the options' or else the robot's own.

    Raises:
        RobotError: a size is not within 0.01 to 0.5 m.
    """
    check_foot_size(options)
    length = length if options.foot_length is None else options.foot_length
    width = width if options.foot_width is None else options.foot_width
    return length, width


def check_foot_size(options: RobotOptions) -> None:
    """Refuse soles that no robot has.

    Raises:
        RobotError: a size is not within 0.01 to 0.5 m.
    """
    for key, value in (("foot_length", options.foot_length), ("foot_width", options.foot_width)):
        if value is not None and not 0.01 <= value <= 0.5:
            raise RobotError((key,), f"robot option {key} is {value:.6g} m", "it must lie within 0.01 and 0.5 m")


def with_soles(description: RobotDescription, length: float | None, width: float | None) -> RobotDescription:
    """The robot with the contact boxes of its soles in another size about the same centres [m]; None keeps one."""
    length = description.sole_length if length is None else length
    width = description.sole_width if width is None else width
    root = ElementTree.fromstring(description.mjcf)
    boxes = {f"{site}_box" for site in description.sole_sites}
    for box in (geom for geom in root.iter("geom") if geom.get("name") in boxes):
        thickness = float(box.attrib["size"].split()[2])
        box.set("size", numbers((length / 2, width / 2, thickness)))
    text = ElementTree.tostring(root, encoding="unicode") + "\n"
    return replace(description, mjcf=text, sole_length=length, sole_width=width)


def with_payload(base: Body, options: RobotOptions, default_body: str) -> Body:
    """The tree with the payload at the CoM of its body.

    Raises:
        RobotError: the mass is negative or not finite, or the body is unknown.
    """
    check_payload(options, tuple(body.name for body in base.walk()))
    carrier = default_body if options.payload_body is None else options.payload_body
    return _loaded(base, carrier, options.payload_mass)


def check_payload(options: RobotOptions, bodies: Sequence[str]) -> None:
    """Refuse a payload that cannot be, or that nothing carries.

    Raises:
        RobotError: the mass is negative or not finite, or the body is unknown.
    """
    mass, carrier = options.payload_mass, options.payload_body
    if not (math.isfinite(mass) and mass >= 0):
        what = f"robot option payload_mass is {mass:.6g} kg"
        raise RobotError(("payload_mass",), what, "it must be a finite mass of at least 0 kg")
    if carrier is not None and carrier not in bodies:
        what = f"robot option payload_body '{carrier}' is no body of this robot"
        raise RobotError(("payload_body",), what, nearest(carrier, tuple(bodies)))


def _loaded(body: Body, carrier: str, mass: float) -> Body:
    inertial = body.inertial.with_point_mass(mass) if body.name == carrier else body.inertial
    children = tuple(_loaded(child, carrier, mass) for child in body.children)
    return replace(body, inertial=inertial, children=children)
