"""The motors of a model: limits of torque and speed, rotors; and what an SRDF knows of them."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import names_of
from surefoot.models.robot_file.document import SRDF, read_xml
from surefoot.models.robot_file.quantities import check_numbers, of_srdf
from surefoot.models.robot_file.schema import RobotFile, matched
from surefoot.models.types import Array, RobotError


def set_limits(model: pin.Model, file: RobotFile, names: tuple[str, ...]) -> None:
    """Put the limits that the file gives over those of the model.

    Raises:
        RobotError: a pattern means no joint.
    """
    for key, field in (("torque_limit", "EffortLimit"), ("velocity_limit", "VelocityLimit")):
        values = np.array(getattr(model, f"upper{field}"))
        for name, value in matched(getattr(file, key), names, key, file.name).items():
            values[model.joints[model.getJointId(name)].idx_v] = value
        setattr(model, f"upper{field}", values)
        setattr(model, f"lower{field}", -values)


class Srdf(NamedTuple):
    """The part of an SRDF that is read.

    Attributes:
        rotors: inertias at the joints by name [kg m^2].
        states: angles of joints by the name of a posture [rad].
        passive: joints that have no motor.
    """

    rotors: dict[str, float]
    states: dict[str, dict[str, float]]
    passive: tuple[str, ...]


def read_srdf(path: Path | None, names: tuple[str, ...]) -> Srdf:
    """Read one; of none nothing is known.

    Raises:
        RobotError: the file cannot be read, is no XML, or has numbers that no robot has.
    """
    if path is None:
        return Srdf({}, {}, ())
    root = read_xml(path, SRDF)
    for group in root.nodes:
        if group.tag in ("rotor_params", "group_state"):
            check_numbers(group, of_srdf)
    rotors = {
        joint.get("name", ""): float(joint.get("mass", "0")) * float(joint.get("gear_ratio", "1")) ** 2
        for joint in root.iterfind("rotor_params/joint")
    }
    states = {
        state.get("name", ""): {
            joint.get("name", ""): float(joint.get("value", "0").split()[0])
            for joint in state.iterfind("joint")
            if joint.get("name") in names
        }
        for state in root.iterfind("group_state")
    }
    return Srdf(rotors, states, tuple(joint.get("name", "") for joint in root.iterfind("passive_joint")))


def set_armature(
    model: pin.Model, given: dict[str, float], rotors: dict[str, float], srdf: Path | None, notes: list[str]
) -> None:
    """Put the rotors of the SRDF over the armatures of the model, and those that the file gives over both."""
    armature = np.array(model.armature)
    known = {**{name: value for name, value in rotors.items() if model.existJointName(name)}, **given}
    for name, value in known.items():
        armature[model.joints[model.getJointId(name)].idx_v] = value
    model.armature = armature
    if rotors and srdf is not None:
        notes.append(f"armature: from the rotors in {srdf.name}")
    if not armature.any():
        notes.append("armature: none known, so joints have no rotors; give armature: {PATTERN: kg m^2} if it has gears")


SPEED = 12.0
"""No-load speed of joints whose model says none: that of many robots' slower joints [rad/s]."""


def require_limits(model: pin.Model, notes: list[str]) -> None:
    """Refuse joints whose motors nobody knows; those without a speed limit get a usual one, which is noted.

    Raises:
        RobotError: a torque limit or a range is missing.
    """
    ends = zip(names_of(model), model.lowerPositionLimit[7:], model.upperPositionLimit[7:], strict=True)
    for name, lower, upper in ends:
        if not -np.inf < lower < upper < np.inf:
            what = f"joint '{name}' of {model.name} has no range, it turns from {lower:.4g} to {upper:.4g} rad"
            raise RobotError(("model",), what, "give it limits in the model")
    unknown = _unlimited(model, model.upperEffortLimit)
    if unknown:
        others, have = (f" and {len(unknown) - 1} more", "have") if len(unknown) > 1 else ("", "has")
        said = f"joint '{unknown[0]}'{others} of {model.name} {have} no torque limit"
        raise RobotError(("torque_limit",), said, "give torque_limit: {PATTERN: N m}; '*' means every joint")
    unknown = _unlimited(model, model.upperVelocityLimit)
    if unknown:
        others = f"joint '{unknown[0]}'" if len(unknown) == 1 else f"{len(unknown)} joints, '{unknown[0]}' first,"
        notes.append(
            f"velocity_limit: {SPEED:g} rad/s is taken for {others} without one in the model; give velocity_limit: "
            "{PATTERN: rad/s} with what their motors can do"
        )
        speeds = np.array(model.upperVelocityLimit)
        speeds[[model.joints[model.getJointId(name)].idx_v for name in unknown]] = SPEED
        model.upperVelocityLimit, model.lowerVelocityLimit = speeds, -speeds


def _unlimited(model: pin.Model, limits: Array) -> list[str]:
    """Joints whose limit is none, the floating base aside."""
    pairs = zip(names_of(model), limits[6:], strict=True)
    return [name for name, value in pairs if not 0.0 < value < np.inf]
