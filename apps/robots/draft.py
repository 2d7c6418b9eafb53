"""A first robot file for a model: its feet found by shape, and in comments what else may be given."""

import itertools
import math
import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import yaml

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import explain
from surefoot.models.robot_file.files import Document, read_document
from surefoot.models.robot_file.paths import resolve
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.source import read_source
from surefoot.models.types import Explanation, RobotError

_FEWEST = 4
"""Joints that a leg has at least."""

_OPTIONAL = (
    "forward",
    "torso",
    "imu",
    "com_height",
    "lock",
    "posture",
    "armature",
    "torque_limit",
    "velocity_limit",
    "sole",
    "keep_apart",
    "inertia",
    "srdf",
    "scale",
    "licence",
    "source",
)
_COLUMN = 44
GUESSED = (
    "# The feet are guessed: the lowest ends of two long chains of joints, left by the greater y. Look whether they\n"
    "# carry the soles; otherwise name other links here, feet: {left: LINK, right: LINK}.\n"
)


@dataclass(frozen=True, slots=True)
class Draft:
    """A first file.

    Attributes:
        text: YAML.
        refusal: why it cannot be used as it stands, one sentence; empty where it can.
    """

    text: str
    refusal: str = ""


def draft(model: str, folder: Path) -> Draft:
    """Write a first robot file.

    Args:
        model: URDF or MJCF, as the file shall name it: a path from the folder, or package://NAME/...
        folder: where the file will be.

    Raises:
        RobotError: the model cannot be read.
    """
    path = resolve(model, folder)
    document = read_document(path)
    name = _name(document)
    source = read_source(RobotFile(name=name, model=model, inertia="repair"), document)
    feet = _feet(source.model)
    head = f"name: {_scalar(name)}\nmodel: {_scalar(model)}\n"
    if feet is None:
        ends = ", ".join(_link(source.model, joint) for joint in _ends(source.model)) or "none"
        text = f"{head}feet: {{left: LINK, right: LINK}}  # two of the links at the ends of chains: {ends}\n"
        return Draft(_commented(text, None), f"the feet of {model} cannot be found by shape; name their links in feet")
    orders = [f"{head}feet: {{left: {_scalar(left)}, right: {_scalar(right)}}}\n" for left, right in (feet, feet[::-1])]
    refusal = ""
    for more in ("", "inertia: repair\n"):  # an inertia that no body can have is refused before feet are looked at
        for lines in orders:
            try:
                found = _tried(f"{lines}{more}", model, path)
            except RobotError as error:
                refusal = refusal or str(error)
            else:
                why = f"# {refusal}\n" if more else ""
                return Draft(_commented(f"{lines}{why}{more}", found, _centre(source.model, lines, found)))
    return Draft(_commented(orders[0], None), refusal)


def _name(document: Document) -> str:
    """Name of the model by itself; the name of its file where it has none of its own."""
    root = document.root
    for text in (root.get("name" if root.tag == "robot" else "model", ""), document.path.stem):
        name = re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip("._-")
        if name:
            return name
    return "robot"


def _scalar(text: str) -> str:
    """A text as YAML has it within a list, in quotes where it would be something else without."""
    return str(yaml.safe_dump([text], default_flow_style=True, allow_unicode=True, width=math.inf))[1:-2]


def _centre(model: pin.Model, lines: str, found: Explanation) -> str:
    """Centre of the left sole in the frame of its foot's link, as a robot file would say it."""
    robot, link = found.description, str(yaml.safe_load(lines)["feet"]["left"])
    built, data = pinocchio_model(robot), model.createData()
    sole = built.frames[built.getFrameId(robot.sole_sites[0])]
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    foot = data.oMi[model.getJointId(built.names[sole.parentJoint])]
    placed = data.oMf[model.getFrameId(link, pin.FrameType.BODY)].actInv(foot.act(sole.placement.translation))
    return ", ".join(f"{value:.3f}" for value in placed + 0.0)


def _tried(lines: str, model: str, path: Path) -> Explanation:
    """Derive a robot from the lines of a file, wherever it will be."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.yaml"
        there = lines.replace(f"model: {_scalar(model)}\n", f"model: {_scalar(str(path.absolute()))}\n")
        file.write_text(there, encoding="utf-8")
        return explain(str(file))


def _feet(model: pin.Model) -> tuple[str, str] | None:
    """Links of the two lowest ends of long chains that are beside each other, the one with the greater y first.

    Where z has none y is taken for up, and then x; ends of as many joints go before others, whatever is up.
    """
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    places = {joint: np.array(data.oMi[joint].translation) for joint in _ends(model)}
    for alike, up in itertools.product((True, False), (2, 1, 0)):
        lowest = sorted(places, key=lambda joint: float(places[joint][up]))[:2]
        if len(lowest) < 2:
            return None
        first, second = lowest
        apart = places[first] - places[second]
        level, apart[up] = abs(float(apart[up])), 0.0
        unlike = len(model.supports[first]) != len(model.supports[second])
        if level > 0.1 * float(np.linalg.norm(apart)) or (alike and unlike):
            continue
        along = int(np.argmax(np.abs(apart)))
        left, right = (first, second) if (apart[along] > 0.0) == (along == 1) else (second, first)
        return _link(model, left), _link(model, right)
    return None


def _ends(model: pin.Model) -> list[int]:
    """Last joints of the chains that are long enough for a leg."""
    return [
        joint
        for joint in range(2, model.njoints)
        if not len(model.children[joint]) and len(model.supports[joint]) - 2 >= _FEWEST
    ]


def _link(model: pin.Model, joint: int) -> str:
    """The first link that a joint moves."""
    return str(next(f.name for f in model.frames if f.parentJoint == joint and f.type == pin.FrameType.BODY))


def _commented(lines: str, found: Explanation | None, centre: str = "0.0, 0.0, 0.0") -> str:
    """The lines of a file with what is to be known of it, and what else it may say."""
    notes = found.notes if found is not None else ()
    return "".join(
        (
            "# `surefoot robot check FILE` says what is derived of this robot, and what it can walk.\n",
            lines,
            GUESSED if "LINK" not in lines else "",
            *(f"# Note: {note}\n" for note in notes),
            "\n# All else follows from the model, unless it is given here:\n",
            *_others(found, centre),
        )
    )


def _others(found: Explanation | None, centre: str) -> Iterator[str]:
    robot = found.description if found is not None else None
    known = (
        {}
        if robot is None
        else {
            "torso": _scalar(robot.torso_body),
            "com_height": f"{robot.com_height:.3f}",
            "sole": f"{{length: {robot.sole_length:.3f}, width: {robot.sole_width:.3f}, centre: [{centre}]}}",
        }
    )
    examples = {
        "forward": "x",
        "lock": '["*finger*"]',
        "posture": "half_sitting",
        "armature": '{"*knee*": 0.1}',
        "torque_limit": '{"*knee*": 150}',
        "velocity_limit": '{"*knee*": 15}',
        "keep_apart": "[[LINK, LINK]]",
        "inertia": "repair",
        "srdf": "robot.srdf",
        "scale": "1.0",
        "torso": "LINK",
        "imu": "LINK",
        "com_height": "0.8",
        "sole": f"{{length: 0.2, width: 0.1, centre: [{centre}]}}",
    }
    for key in _OPTIONAL:
        value = known.get(key, examples.get(key, "..."))
        line, meaning = f"# {key}: {value}", RobotFile.model_fields[key].description
        yield f"{line:<{_COLUMN}}  # {meaning}\n"
