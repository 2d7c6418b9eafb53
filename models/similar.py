"""The similar robot of another size: the same shape and the same materials under the same gravity.

With λ the factor of all lengths, Froude similarity gives times √λ and joint speeds 1/√λ; masses go with λ³, moments of
inertia λ⁵, torques λ⁴ (a weight at a lever). So each quotient without a unit, as torque over limit, stays.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np

from surefoot.models.inertia import LEAST_MASS
from surefoot.models.mjcf import numbers
from surefoot.models.types import RobotDescription, RobotError, fixed

POWERS: dict[str, dict[str, int]] = {
    "body": {"pos": 1},
    "inertial": {"pos": 1, "mass": 3, "diaginertia": 5, "fullinertia": 5},
    "joint": {"pos": 1, "armature": 5},
    "geom": {"pos": 1, "size": 1, "fromto": 1},
    "site": {"pos": 1, "size": 1},
    "mesh": {"vertex": 1},
    "motor": {"ctrlrange": 4, "forcerange": 4},
}
"""Powers of the size factor by which attributes of a robot's MJCF grow; all others have no unit, or are angles."""


def scaled(description: RobotDescription, factor: float) -> RobotDescription:
    """The similar robot that is larger by a factor [-]; of the same name and with the same joint angles.

    Raises:
        RobotError: the factor is not a positive number, or so small that a link would have no moment of inertia.
    """
    if not 0.0 < factor < math.inf:
        what = f"the size of {description.name} shall be scaled by {factor}"
        raise RobotError(("scale",), what, "it must be a positive number")
    if factor == 1.0:
        return description
    root, light = ElementTree.fromstring(description.mjcf), 0.0
    for element in root.iter():
        mass = float(element.get("mass", "inf"))
        massless = element.tag == "inertial" and mass <= LEAST_MASS
        light += mass if massless else 0.0
        for attribute, power in POWERS.get(element.tag, {}).items():
            if attribute in element.attrib and not (massless and power > 1):  # a link without mass has none in any size
                values = element.attrib[attribute].split()
                element.set(attribute, numbers(factor**power * float(value) for value in values))
    _require_moments(root, description.name, factor)
    d = description
    x, y, z = d.imu.position
    return replace(
        d,
        mjcf=ElementTree.tostring(root, encoding="unicode") + "\n",
        mass=factor**3 * (d.mass - light) + light,
        torque_limit=fixed(factor**4 * d.torque_limit),
        velocity_limit=fixed(d.velocity_limit / math.sqrt(factor)),
        sole_length=factor * d.sole_length,
        sole_width=factor * d.sole_width,
        hip_width=factor * d.hip_width,
        leg_length=factor * d.leg_length,
        shank_spacing=factor * d.shank_spacing,
        com_height=factor * d.com_height,
        imu=replace(d.imu, position=(factor * x, factor * y, factor * z)),
    )


_LEAST = 1e-14
"""Moment of inertia of which MuJoCo still tells that it is positive [kg m^2]."""


def _require_moments(root: ElementTree.Element, name: str, factor: float) -> None:
    """Refuse a size at which a link has no moment of inertia.

    Raises:
        RobotError: one has none.
    """
    for body in root.iter("body"):
        inertial = body.find("inertial")
        xx, yy, zz, xy, xz, yz = _moments({} if inertial is None else inertial.attrib)
        least = float(np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[0])
        if least < _LEAST:
            what = f"link '{body.get('name', '')}' of {name} has a moment of {least:.2g} kg m^2 at the scale {factor:g}"
            raise RobotError(("scale",), what, "choose a larger one")


def _moments(inertial: Mapping[str, str]) -> tuple[float, ...]:
    """Moments about x, y and z, and products of xy, xz and yz; ones where a body has none of its own [kg m^2]."""
    given = [float(value) for value in inertial.get("fullinertia", inertial.get("diaginertia", "1 1 1")).split()]
    return (*given, 0.0, 0.0, 0.0)[:6]
