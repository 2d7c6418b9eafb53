"""Options every robot offers, checked and applied to its tree."""

import difflib
import math
from dataclasses import replace

from surefoot.models.tree import Body
from surefoot.models.types import RobotError, RobotOptions


def nearest(name: str, valid: tuple[str, ...]) -> str:
    """A hint for an unknown name: the nearest valid one, or all of them."""
    close = difflib.get_close_matches(name, valid, n=1)
    return f"did you mean '{close[0]}'?" if close else f"choose from {', '.join(valid)}"


def foot_size(options: RobotOptions, length: float, width: float) -> tuple[float, float]:
    """Sole length and width [m]: the options' or else the robot's own.

    Raises:
        RobotError: a size is not within 0.01 to 0.5 m.
    """
    length = length if options.foot_length is None else options.foot_length
    width = width if options.foot_width is None else options.foot_width
    for key, value in (("foot_length", length), ("foot_width", width)):
        if not 0.01 <= value <= 0.5:
            raise RobotError(f"robot option {key} is {value} m, it must lie within 0.01 and 0.5 m")
    return length, width


def with_payload(base: Body, options: RobotOptions, default_body: str) -> Body:
    """The tree with the payload at the CoM of its body.

    Raises:
        RobotError: the mass is negative or not finite, or the body is unknown.
    """
    mass = options.payload_mass
    if not (math.isfinite(mass) and mass >= 0):
        raise RobotError(f"robot option payload_mass is {mass} kg, it must be a finite mass of at least 0 kg")
    names = tuple(body.name for body in base.walk())
    carrier = default_body if options.payload_body is None else options.payload_body
    if carrier not in names:
        raise RobotError(f"robot option payload_body '{carrier}' is no body of this robot: {nearest(carrier, names)}")
    return _loaded(base, carrier, mass)


def _loaded(body: Body, carrier: str, mass: float) -> Body:
    inertial = body.inertial.with_point_mass(mass) if body.name == carrier else body.inertial
    children = tuple(_loaded(child, carrier, mass) for child in body.children)
    return replace(body, inertial=inertial, children=children)
