"""A reduced model as normalised MJCF text with all digits, which both engines read alike."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import independent
from surefoot.models.joints import axis_of
from surefoot.models.mjcf import Role, add_couplings, add_defaults, numbers
from surefoot.models.robot_file.engine_mesh import add_mesh
from surefoot.models.robot_file.legs import SIDES, Leg
from surefoot.models.robot_file.shapes import Shape
from surefoot.models.robot_file.source import SITES
from surefoot.models.robot_file.touch import Hull, shape_name
from surefoot.models.types import Coupling

SOLE_THICKNESS = 0.02
"""Thickness of the sole's contact box over the leg's length [-]."""


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of a robot's text.

    Attributes:
        name: of the robot.
        model: its joints.
        bodies: names by joint index less 1.
        legs: for the soles.
        leg_length: for the thickness of the soles [m].
        sole: length and width of both soles [m].
        height: of the base over the ground [m].
        hulls: contact shapes by joint.
        looks: what is drawn, by joint index.
        excluded: pairs of bodies that may overlap.
        couplings: joints that follow others.
    """

    name: str
    model: pin.Model
    bodies: tuple[str, ...]
    legs: tuple[Leg, Leg]
    leg_length: float
    sole: tuple[float, float]
    height: float
    hulls: Mapping[int, Hull]
    looks: Sequence[Sequence[Shape]]
    excluded: Sequence[tuple[str, str]] = ()
    couplings: Sequence[Coupling] = ()


def robot_text(parts: Parts) -> str:
    """The robot as a complete MJCF document."""
    root = ElementTree.Element("mujoco", model=parts.name)
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="true")
    add_defaults(root)
    asset = ElementTree.SubElement(root, "asset")
    _Tree(parts, asset).add(ElementTree.SubElement(root, "worldbody"), 1)
    contact = ElementTree.SubElement(root, "contact")
    for one, other in parts.excluded:
        ElementTree.SubElement(contact, "exclude", name=f"{one}-{other}", body1=one, body2=other)
    motors = ElementTree.SubElement(root, "actuator")
    for joint in independent(parts.model):
        name, limit = parts.model.names[joint], parts.model.upperEffortLimit[parts.model.idx_vs[joint]]
        ends = numbers((-limit, limit))
        ElementTree.SubElement(motors, "motor", name=name, joint=name, ctrlrange=ends, forcerange=ends)
    add_couplings(root, parts.couplings)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


class _Tree:
    """Writes the bodies, in the order of the model's joints."""

    def __init__(self, parts: Parts, asset: ElementTree.Element) -> None:
        self._parts, self._asset = parts, asset
        self._colours: dict[tuple[float, ...], str] = {}
        self._feet = {leg.chain[-1]: (side, leg) for side, leg in zip(SIDES, parts.legs, strict=True)}
        ElementTree.SubElement(asset, "material", name="rubber", rgba="0.08 0.08 0.09 1")

    def add(self, parent: ElementTree.Element, joint: int) -> None:
        """Write the body that a joint moves, and all that hangs on it."""
        parts, model = self._parts, self._parts.model
        place = pin.SE3(np.eye(3), np.array([0.0, 0.0, parts.height])) if joint == 1 else model.jointPlacements[joint]
        name = parts.bodies[joint - 1]
        body = ElementTree.SubElement(parent, "body", {"name": name, **_pose(place)})
        _add_inertial(body, model.inertias[joint])
        if joint == 1:
            ElementTree.SubElement(body, "freejoint", name=f"{name}_free")
            ElementTree.SubElement(body, "site", name=SITES[0], pos="0.0 0.0 0.0", size="0.005", group="4")
        else:
            self._add_joint(body, joint)
        self._add_looks(body, joint)
        if joint in parts.hulls:
            self._add_hull(body, parts.hulls[joint], name)
        if joint in self._feet:
            self._add_sole(body, *self._feet[joint])
        for child in model.children[joint]:
            self.add(body, child)

    def _add_joint(self, body: ElementTree.Element, joint: int) -> None:
        model = self._parts.model
        axis = {"axis": numbers(axis_of(model, joint))}
        if not model.nvs[joint]:  # its leader has range and rotor of both
            ElementTree.SubElement(body, "joint", axis, name=model.names[joint])
            return
        at = model.idx_qs[joint]
        attributes = {**axis, "range": numbers((model.lowerPositionLimit[at], model.upperPositionLimit[at]))}
        armature = repr(float(model.armature[model.idx_vs[joint]]))
        ElementTree.SubElement(body, "joint", attributes, name=model.names[joint], armature=armature)

    def _add_sole(self, body: ElementTree.Element, side: str, leg: Leg) -> None:
        """The box that touches the ground, drawn only on a foot without looks, and the site at its bottom's centre."""
        half = SOLE_THICKNESS * self._parts.leg_length / 2
        length, width = self._parts.sole
        frame = leg.sole.placement
        middle = frame * pin.SE3(np.eye(3), np.array([0.0, 0.0, half]))
        size = numbers((length / 2, width / 2, half))
        role = Role.COLLISION if self._parts.looks[leg.chain[-1]] else Role.SOLE
        box = {"class": role.value, "type": "box", "size": size, "material": "rubber", **_pose(middle)}
        ElementTree.SubElement(body, "geom", box, name=f"{side}_sole_box")
        ElementTree.SubElement(body, "site", _pose(frame), name=f"{side}_sole", size="0.005", group="4")

    def _add_hull(self, body: ElementTree.Element, hull: Hull, name: str) -> None:
        add_mesh(self._asset, shape_name(name), (hull.vertices, hull.faces), drawn=False)
        geom = {"class": Role.COLLISION.value, "type": "mesh", "mesh": shape_name(name)}
        ElementTree.SubElement(body, "geom", geom, name=shape_name(name))

    def _add_looks(self, body: ElementTree.Element, joint: int) -> None:
        for index, look in enumerate(self._parts.looks[joint]):
            name = f"{self._parts.bodies[joint - 1]}_look{index}"
            add_mesh(self._asset, name, (look.vertices, look.faces), drawn=True)
            geom = {"class": Role.VISUAL.value, "type": "mesh", "mesh": name, "material": self._material(look.rgba)}
            ElementTree.SubElement(body, "geom", geom)

    def _material(self, rgba: tuple[float, float, float, float]) -> str:
        if rgba not in self._colours:
            self._colours[rgba] = f"colour{len(self._colours)}"
            ElementTree.SubElement(self._asset, "material", name=self._colours[rgba], rgba=numbers(rgba))
        return self._colours[rgba]


def _add_inertial(body: ElementTree.Element, inertia: pin.Inertia) -> None:
    about = inertia.inertia
    full = numbers(about[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    attributes = {"pos": numbers(inertia.lever), "mass": repr(float(inertia.mass)), "fullinertia": full}
    ElementTree.SubElement(body, "inertial", attributes)


def _pose(placement: pin.SE3) -> dict[str, str]:
    x, y, z, w = pin.Quaternion(placement.rotation).normalized().coeffs().tolist()
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    return {"pos": numbers(placement.translation + 0.0), "quat": numbers((w, x, y, z))}
