"""Options every robot offers, checked and applied to its tree."""

import math
from dataclasses import replace

from surefoot.models.mjcf import Body
from surefoot.models.types import RobotError, RobotOptions, nearest


def foot_size(options: RobotOptions, length: float, width: float) -> tuple[float, float]:
    """Sole length and width [m]: the options' or else the robot's own.

    Raises:
        RobotError: a size is not within 0.01 to 0.5 m.
    """
    length = length if options.foot_length is None else options.foot_length
    width = width if options.foot_width is None else options.foot_width
    for key, value in (("foot_length", length), ("foot_width", width)):
        if not 0.01 <= value <= 0.5:
            raise RobotError((key,), f"robot option {key} is {value} m", "it must lie within 0.01 and 0.5 m")
    return length, width


def with_payload(base: Body, options: RobotOptions, default_body: str) -> Body:
    """The tree with the payload at the CoM of its body.

    Raises:
        RobotError: the mass is negative or not finite, or the body is unknown.
    """
    mass = options.payload_mass
    if not (math.isfinite(mass) and mass >= 0):
        what = f"robot option payload_mass is {mass} kg"
        raise RobotError(("payload_mass",), what, "it must be a finite mass of at least 0 kg")
    names = tuple(body.name for body in base.walk())
    carrier = default_body if options.payload_body is None else options.payload_body
    if carrier not in names:
        what = f"robot option payload_body '{carrier}' is no body of this robot"
        raise RobotError(("payload_body",), what, nearest(carrier, names))
    return _loaded(base, carrier, mass)


def _loaded(body: Body, carrier: str, mass: float) -> Body:
    inertial = body.inertial.with_point_mass(mass) if body.name == carrier else body.inertial
    children = tuple(_loaded(child, carrier, mass) for child in body.children)
    return replace(body, inertial=inertial, children=children)
