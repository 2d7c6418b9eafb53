"""A first robot file for a model: its feet found by shape, and in comments what else may be given."""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

from surefoot.models.robot_file.build import Explanation, explain
from surefoot.models.robot_file.paths import resolve
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.source import read_source
from surefoot.models.types import RobotError

_FEWEST = 4
"""Joints that a leg has at least."""

_OPTIONAL = (
    "forward",
    "torso",
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
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", Path(model).stem).lstrip("._-") or "robot"
    path = resolve(model, folder)
    source = read_source(RobotFile(name=name, model=model, inertia="repair"), path)
    feet = _feet(source.model)
    head = f"name: {name}\nmodel: {model}\n"
    if feet is None:
        ends = ", ".join(_link(source.model, joint) for joint in _ends(source.model)) or "none"
        text = f"{head}feet: {{left: LINK, right: LINK}}  # two of the links at the ends of chains: {ends}\n"
        return Draft(_commented(text, None), f"the feet of {model} cannot be told by shape; name their links in feet")
    orders = [f"{head}feet: {{left: {left}, right: {right}}}\n" for left, right in (feet, feet[::-1])]
    refusal = ""
    for more in ("", "inertia: repair\n"):  # an inertia that no body can have is refused before feet are looked at
        for lines in orders:
            try:
                found = _tried(f"{lines}{more}", model, path)
            except RobotError as error:
                refusal = refusal or str(error)
            else:
                return Draft(_commented(lines, found), refusal if more else "")
    return Draft(_commented(orders[0], None), refusal)


def _tried(lines: str, model: str, path: Path) -> Explanation:
    """What is derived from the lines of a file, wherever it will be."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.yaml"
        file.write_text(lines.replace(f"model: {model}\n", f"model: {path.absolute()}\n"), encoding="utf-8")
        return explain(file)


def _feet(model: pin.Model) -> tuple[str, str] | None:
    """Links of the two lowest ends of long chains that are beside each other, the one with the greater y first."""
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    ends = sorted(_ends(model), key=lambda joint: float(data.oMi[joint].translation[2]))
    if len(ends) < 2:
        return None
    first, second = ends[:2]
    apart = data.oMi[first].translation - data.oMi[second].translation
    level, aside = abs(float(apart[2])), float(np.hypot(apart[0], apart[1]))
    if level > 0.1 * aside:
        return None
    along = int(np.argmax(np.abs(apart[:2])))
    left, right = (first, second) if (apart[along] > 0.0) == (along == 1) else (second, first)
    return _link(model, left), _link(model, right)


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


def _commented(lines: str, found: Explanation | None) -> str:
    """The lines of a file with what else it may say."""
    return "".join(
        (
            "# `surefoot robot check FILE` says what is derived of this robot, and what it can walk.\n",
            lines,
            "# Look whether these are the links that carry the soles, and whether left is left.\n\n",
            "# All else follows from the model, unless it is given here:\n",
            *_others(found),
        )
    )


def _others(found: Explanation | None) -> Iterator[str]:
    robot = found.description if found is not None else None
    known = (
        {}
        if robot is None
        else {
            "torso": robot.torso_body,
            "com_height": f"{robot.com_height:.3f}",
            "sole": f"{{length: {robot.sole_length:.3f}, width: {robot.sole_width:.3f}, centre: [0.0, 0.0, 0.0]}}",
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
    }
    for key in _OPTIONAL:
        value = known.get(key, examples.get(key, "..."))
        line, meaning = f"# {key}: {value}", RobotFile.model_fields[key].description
        yield f"{line:<{_COLUMN}}  # {meaning}\n"
