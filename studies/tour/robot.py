"""The robot of the tour, out of Unitree's own model by what a file says is different about it."""

from collections.abc import Sequence
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import yaml
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict

from surefoot.models import kept
from surefoot.models.robot_file.document import MODEL, content
from surefoot.models.robot_file.paths import resolve
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason, write_whole

Array = NDArray[np.float64]
Triple = tuple[float, float, float]

ARM_JOINTS = 7
"""Joints of an arm [-]."""

_FILE = ("robot.yaml", "robot.urdf")
_OF_ROBOT = ("name", "feet", "licence", "source", "torque_limit", "armature")


class Inertia(BaseModel):
    """The inertia of a body.

    Attributes:
        mass: [kg].
        com: centre of mass in the body's frame [m].
        moments: about that [kg m^2].
        axes: of the moments in the body's frame, quaternion w x y z.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    mass: float
    com: Triple
    moments: Triple
    axes: tuple[float, float, float, float]


class TourRobot(BaseModel):
    """The robot by the harness of the tour, see ``g1.yaml``.

    Attributes:
        model: URDF that it differs from.
        inertias: of bodies that weigh something else.
        weightless: bodies whose mass is in others.
        raised: by what joints are higher than in that URDF [m].
        drawn_raised: by what the shapes of bodies are [m].
        damping: of every joint [N·m·s/rad].
        friction_loss: of every joint [N·m].
        contact_radius: of the balls that a foot touches the ground with [m].
        contact_points: where they are in the frame of the foot's link [m].
        stands_for: robot for which contracts of policies are written that walk this one.
        leg_stance: angles of the legs on the crane by the ends of their joints' names, others straight [rad].
        crane_height: of the pelvis there [m].
        arm_frequency: natural frequency that the arms' drives would have on their armature alone [Hz].
        arm_damping: damping ratio that they would have on their armature alone [-].
        arm_stance: angles of the left arm at the start [rad].
        arm_mirror: signs with which the right arm mirrors the left one.
        hand_box: lowest and highest corner of the left hand in the frame of its link [m].
        head_bottom: lower end of the head in the frame of the torso [m].
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str
    model: str
    feet: dict[str, str]
    licence: str
    source: str
    inertias: dict[str, Inertia]
    weightless: tuple[str, ...]
    raised: dict[str, float]
    drawn_raised: dict[str, float]
    torque_limit: dict[str, float]
    armature: dict[str, float]
    damping: float
    friction_loss: float
    contact_radius: float
    contact_points: tuple[Triple, ...]
    stands_for: str
    leg_stance: dict[str, float]
    crane_height: float
    arm_frequency: float
    arm_damping: float
    arm_stance: tuple[float, ...]
    arm_mirror: tuple[float, ...]
    hand_box: tuple[Triple, Triple]
    head_bottom: float

    def drive_gains(self, armature: float) -> tuple[float, float]:
        """Stiffness and damping of a drive of the harness for a joint with that armature [N·m/rad, N·m·s/rad]."""
        omega = 2.0 * np.pi * self.arm_frequency
        return float(armature * omega**2), float(2.0 * self.arm_damping * armature * omega)

    def files(self, folder: Path) -> dict[str, str]:
        """Texts of a robot file and of the model that it names, by their names in a folder.

        Raises:
            RobotError: the model that this one differs from is not installed.
        """
        root = ElementTree.fromstring(content(resolve(self.model, folder), MODEL))
        _change(root, self)
        keys: dict[str, Any] = {**self.model_dump(include=set(_OF_ROBOT)), "model": _FILE[1]}
        texts = (yaml.safe_dump(keys, sort_keys=False), ElementTree.tostring(root, encoding="unicode"))
        return dict(zip(_FILE, texts, strict=True))


@lru_cache(maxsize=1)
def tour_robot() -> TourRobot:
    """The robot by the harness."""
    text = resources.files(__package__).joinpath("g1.yaml").read_text(encoding="utf-8")
    return TourRobot.model_validate(yaml.safe_load(text))


def arms_of(names: Sequence[str]) -> NDArray[np.bool_]:
    """Joints of the arms, by their names, shape (nj,)."""
    return np.array([any(part in name for part in ("shoulder", "elbow", "wrist")) for name in names])


def robot_file() -> Path:
    """The robot file that scenarios of the tour name, written anew into the user's cache folder.

    Raises:
        RobotError: Unitree's model is not installed.
        LogError: the folder cannot be written.
    """
    robot = tour_robot()
    folder = kept.place("tour", robot.name).with_suffix("")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LogError(f"{folder}: cannot be made, {reason(error)}; let XDG_CACHE_HOME name another folder") from None
    path = folder / _FILE[0]
    for name, text in robot.files(folder).items():
        file = folder / name
        if not file.is_file() or file.read_text(encoding="utf-8") != text:
            with write_whole(file, replace=True) as temporary:
                temporary.write_text(text, encoding="utf-8")
    return path


def _change(root: ElementTree.Element, robot: TourRobot) -> None:
    """Make a URDF that of the robot."""
    links = {link.get("name", ""): link for link in root.iter("link")}
    joints = {joint.get("name", ""): joint for joint in root.iter("joint")}
    for name in robot.weightless:
        links[name].remove(_child(links[name], "inertial"))
    for name, inertia in robot.inertias.items():
        element = _child(links[name], "inertial")
        element.clear()
        R = pin.Quaternion(*inertia.axes).normalized().matrix()
        moments = R @ np.diag(inertia.moments) @ R.T
        ElementTree.SubElement(element, "origin", xyz=_text(inertia.com), rpy="0 0 0")
        ElementTree.SubElement(element, "mass", value=repr(inertia.mass))
        axes = "xyz"
        upper = {f"i{axes[i]}{axes[j]}": repr(float(moments[i, j])) for i in range(3) for j in range(i, 3)}
        ElementTree.SubElement(element, "inertia", upper)
    for name, height in robot.raised.items():
        _raise(joints[name], height)
    for name, height in robot.drawn_raised.items():
        for kind in ("visual", "collision"):
            for shape in links[name].iter(kind):
                _raise(shape, height)


def _raise(element: ElementTree.Element, height: float) -> None:
    """Lift the origin of a joint or of a shape [m]."""
    origin = element.find("origin")
    if origin is None:
        origin = ElementTree.SubElement(element, "origin", xyz="0 0 0", rpy="0 0 0")
    x, y, z = (float(part) for part in origin.get("xyz", "0 0 0").split())
    origin.set("xyz", _text((x, y, z + height)))


def _child(element: ElementTree.Element, kind: str) -> ElementTree.Element:
    found = element.find(kind)
    assert found is not None, f"{element.get('name')} has no {kind}"
    return found


def _text(numbers: Triple) -> str:
    return " ".join(map(repr, numbers))
