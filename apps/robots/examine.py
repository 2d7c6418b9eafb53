"""An examination of a described robot: engines, legs, soles, and torque in standing."""

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin
import typer
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import Coordinates
from surefoot.models.facts import facts_of
from surefoot.models.registry import explain
from surefoot.models.types import Explanation, RobotDescription, RobotError, UnknownRobotError
from surefoot.parts.plugins import PluginError
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.judge.metrics import plain
from surefoot.scenarios.setup.robot.body import Body, TorqueMargin, body_of, on_one_foot, standing
from surefoot.scenarios.show.console import print_table

Array = NDArray[np.float64]

PARITY = 1e-9
"""Engines that differ by more do not compute the same robot; over the mass in kilograms, or absolute below 1 kg."""

_ALIKE = 1e-3
"""Relative difference of left and right from which on it is reported [-]."""

HEIGHTS = (0.98, 1.02, 0.96, 1.04, 0.94, 0.92, 0.9, 0.87)
"""CoM heights that are proposed, over the nominal one, the nearest first [-]."""

_STATES = 50
_LEVEL, _TILT = 1e-4, 1e-3


@dataclass(frozen=True, slots=True)
class Examination:
    """The measurements of a description.

    Attributes:
        parity: largest difference between MuJoCo and Pinocchio over random states, over the mass in kilograms, or
            absolute below 1 kg.
        differences: what is not alike on the left and on the right, one sentence each.
        sole_height: how much higher the right sole is than the left one in the nominal posture [m].
        sole_tilt: larger angle of a sole's normal from the vertical there, pelvis upright [rad].
        both_feet: static torques of standing with the CoM between the soles at its nominal height.
        one_foot: static torques of standing with the CoM over one sole, which bears all; the worse of both.
        both_height: CoM height at which the joints could stand on both feet; None where no other is needed or does [m].
        one_height: CoM height at which they could stand on one foot; None where no other is needed or does [m].
        longest_step: with flat soles at the nominal CoM height [m].
        touching: bodies that touch each other in that stance, by pairs.
    """

    parity: float
    differences: tuple[str, ...]
    sole_height: float
    sole_tilt: float
    both_feet: TorqueMargin
    one_foot: TorqueMargin
    both_height: float | None
    one_height: float | None
    longest_step: float
    touching: tuple[tuple[str, str], ...]

    @property
    def faults(self) -> tuple[str, ...]:
        """Faults that keep it from walking, one sentence each; what is merely unlike is none."""
        return tuple(self._faults())

    def _faults(self) -> Iterator[str]:
        if not self.parity <= PARITY:
            yield f"MuJoCo and Pinocchio differ by {self.parity:.1e}; they must agree within {PARITY:.0e}"
        if abs(self.sole_height) > _LEVEL:
            yield (
                f"in the nominal posture the right sole is {1e3 * self.sole_height:.1f} mm higher than the left one; "
                "give a posture in which both are on the same ground"
            )
        if self.sole_tilt > _TILT:
            yield (
                f"in the nominal posture a sole is tilted by {math.degrees(self.sole_tilt):.2f} deg; "
                "give a posture in which both are level"
            )
        if not self.both_feet.joint:
            yield f"it cannot stand on both feet at its nominal CoM height; {self._height(self.both_height)}"
        for margin, height, where in (
            (self.both_feet, self.both_height, "both feet"),
            (self.one_foot, self.one_height, "one foot"),
        ):
            if margin.joint and margin.share > 1.0:
                more = f"give torque_limit: {{{margin.joint}: {math.ceil(margin.needed)}}} if its motor has it"
                yield (
                    f"joint '{margin.joint}' needs {margin.needed:.0f} N m to stand on {where}, "
                    f"{margin.share:.0%} of its limit; {self._height(height) if height else more}"
                )
        for one, other in self.touching:
            yield f"bodies '{one}' and '{other}' touch in the stance; give a posture that keeps them apart"

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on it that keep it from nothing, one sentence each."""
        leaning = "it cannot stand still on one foot at its nominal CoM height, which walking need not"
        wide = () if self.one_foot.joint else (f"{leaning}; {self._height(self.one_height)}",)
        return (*self.differences, *wide)

    @staticmethod
    def _height(height: float | None) -> str:
        return f"com_height: {height:g} would do" if height else "no com_height near it would do"


def known(name: str) -> Explanation:
    """A robot by its name or file, with what of it was derived and what else is to be known.

    Raises:
        ScenarioError: there is none, or its file cannot be used.
    """
    try:
        return explain(name)
    except (UnknownRobotError, PluginError, RobotError) as error:
        raise ScenarioError([str(error)]) from None


def examine(robot: RobotDescription) -> Examination:
    """Measure a robot."""
    body = body_of(robot)
    height, tilt = _soles(body)
    both, q = standing(body, 0.0)
    one = on_one_foot(body)
    return Examination(
        parity=_parity(robot),
        differences=tuple(_differences(body)),
        sole_height=height,
        sole_tilt=tilt,
        both_feet=both,
        one_foot=one,
        both_height=_other_height(body, both, lambda other: standing(other, 0.0)[0]),
        one_height=_other_height(body, one, on_one_foot),
        longest_step=facts_of(robot).leg_span(robot.com_height),
        touching=_touching(robot, q),
    )


def _other_height(body: Body, margin: TorqueMargin, stands: Callable[[Body], TorqueMargin]) -> float | None:
    """The nearest of some CoM heights at which a robot stands that does not at its own; None where it does [m]."""
    heights = (float(f"{share * body.robot.com_height:.3g}") for share in HEIGHTS)
    others = (replace(body, robot=replace(body.robot, com_height=height)) for height in heights)
    return None if margin.share <= 1.0 else next((b.robot.com_height for b in others if stands(b).share <= 1.0), None)


def _parity(robot: RobotDescription) -> float:
    pair, rng = EnginePair(robot), np.random.default_rng(0)
    return max(pair.difference(*pair.random_state(rng)).largest for _ in range(_STATES)) / max(1.0, robot.mass)


def _differences(body: Body) -> Iterator[str]:
    """Limits of each pair of leg joints, and masses of the legs."""
    robot = body.robot
    masses = []
    for leg in (robot.roles.left_leg, robot.roles.right_leg):
        data = body.model.createData()
        pin.computeSubtreeMasses(body.model, data)
        masses.append(data.mass[body.model.getJointId(leg[0])])
    if abs(masses[0] - masses[1]) > _ALIKE * max(masses):
        yield f"the left leg weighs {masses[0]:.3f} kg, the right one {masses[1]:.3f} kg"
    pairs = zip(robot.roles.left_leg, robot.roles.right_leg, strict=False)
    for left, right in pairs:
        i, j = robot.joint_indices((left, right))
        for name, unit in (("torque_limit", "N m"), ("velocity_limit", "rad/s")):
            one, other = float(getattr(robot, name)[i]), float(getattr(robot, name)[j])
            if abs(one - other) > _ALIKE * max(one, other):
                kind = name.replace("_", " ")
                yield f"the {kind} of '{left}' is {one:g} {unit}, that of '{right}' {other:g} {unit}"
        here, there = (np.array((robot.position_lower[k], robot.position_upper[k])) for k in (i, j))
        if min(np.abs(here - there).max(), np.abs(here + there[::-1]).max()) > _ALIKE:
            yield (
                f"'{left}' turns from {here[0]:.3f} to {here[1]:.3f} rad, "
                f"'{right}' from {there[0]:.3f} to {there[1]:.3f} rad, which is no mirror image"
            )


def _soles(body: Body) -> tuple[float, float]:
    """Height of the right sole over the left, and the larger tilt, with the pelvis upright in the nominal posture."""
    q = pin.neutral(body.model)
    q[7:] = body.robot.nominal_joint_positions
    data = body.model.createData()
    pin.framesForwardKinematics(body.model, data, q)
    left, right = (data.oMf[body.model.getFrameId(name)] for name in body.frames.soles)
    # How a foot leans that no joint rolls is its leg's.
    rows = slice(0, 1 if body.robot.roles.feet_lean else 2)
    tilt = max(math.atan2(np.linalg.norm(sole.rotation[2, rows]), sole.rotation[2, 2]) for sole in (left, right))
    return float(right.translation[2] - left.translation[2]), tilt


def _touching(robot: RobotDescription, q: Array) -> tuple[tuple[str, str], ...]:
    """Bodies that touch at a configuration in Pinocchio's convention."""
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    data = mujoco.MjData(model)
    Coordinates(model).to_mujoco(q, np.zeros(len(q) - 1), data.qpos, data.qvel)
    mujoco.mj_forward(model, data)
    found = []
    for contact in data.contact[: data.ncon]:
        one, other = (model.body(model.geom_bodyid[geom]).name for geom in contact.geom)
        if contact.dist < 0.0:
            found.append((one, other))
    return tuple(dict.fromkeys(found))


def print_examination(explained: Explanation, found: Examination) -> None:
    """Print what the robot is, what was derived and what was measured."""
    robot = explained.description
    print_table(("robot", robot.name), _facts(robot))
    for title, lines in (
        ("derived", explained.derived),
        ("note", (*explained.notes, *found.notes)),
        ("fault", found.faults),
    ):
        for line in lines:
            fault = title == "fault" or None
            typer.secho(f"{title}: {line}", fg="red" if fault else None, bold=fault)
    print_table(("measured", "value"), _measured(found))


def _facts(robot: RobotDescription) -> Iterator[tuple[str, str]]:
    yield "mass", f"{robot.mass:.2f} kg"
    following = f"; {', '.join(one.follower for one in robot.couplings)} follow" if robot.couplings else ""
    yield "joints", f"{len(robot.joint_names)}, {len(robot.roles.legs)} of them in the legs{following}"
    for side, leg in (("left", robot.roles.left_leg), ("right", robot.roles.right_leg)):
        yield f"{side} leg", ", ".join(leg)
    yield "knees", ", ".join(robot.roles.knees)
    yield "waist", ", ".join(robot.roles.waist) or "none"
    yield "arm swing", ", ".join(robot.roles.arm_swing or ()) or "none"
    yield "pelvis, torso", f"{robot.pelvis_body}, {robot.torso_body}"
    yield "leg length, hip width", f"{robot.leg_length:.3f} m, {robot.hip_width:.3f} m"
    yield "soles", f"{robot.sole_length:.3f} x {robot.sole_width:.3f} m"
    yield "CoM height in walking", f"{robot.com_height:.3f} m"


def _measured(found: Examination) -> Iterator[tuple[str, str]]:
    yield "MuJoCo against Pinocchio", f"{found.parity:.1e}, at most {PARITY:.0e}"
    yield (
        "soles in the nominal posture",
        f"{1e3 * found.sole_height:.2f} mm apart in height, tilted by at most {math.degrees(found.sole_tilt):.3f} deg",
    )
    yield "torque on both feet", _margin(found.both_feet)
    yield "torque on one foot", _margin(found.one_foot)
    yield "longest step with flat soles", f"{found.longest_step:.2f} m"
    yield "touching in the stance", ", ".join(" and ".join(pair) for pair in found.touching) or "none"


def _margin(margin: TorqueMargin) -> str:
    if not margin.joint:
        return "no such stance"
    return f"{margin.share:.0%} of its limit in '{margin.joint}', {margin.needed:.1f} N m"


def to_json(explained: Explanation, found: Examination) -> dict[str, Any]:
    """Everything derived and measured, as one object; what could not be measured is null."""
    return {
        "robot": explained.description.name,
        "facts": dict(_facts(explained.description)),
        "derived": list(explained.derived),
        "notes": [*explained.notes, *found.notes],
        "faults": list(found.faults),
        "measured": plain(asdict(found)),
    }
