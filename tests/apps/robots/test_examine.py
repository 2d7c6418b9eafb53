"""Measurements of a robot, each against a robot made worse in that one thing."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.apps.robots.examine import PARITY, examine, known
from surefoot.models import RobotDescription, RobotOptions, describe
from surefoot.scenarios.errors import ScenarioError

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def humanoid() -> RobotDescription:
    return describe("humanoid100", RobotOptions())


def changed(robot: RobotDescription, field: str, joint: str, value: float) -> RobotDescription:
    """The robot with one number of one joint changed."""
    values = np.array(getattr(robot, field))
    values[robot.joint_names.index(joint)] = value
    return replace(robot, **{field: values})


def test_a_sound_robot_has_no_fault(humanoid: RobotDescription) -> None:
    found = examine(humanoid)
    assert found.faults == () and found.differences == () and found.touching == ()
    assert found.parity <= PARITY
    assert abs(found.sole_height) < 1e-9 and found.sole_tilt < 1e-6


def test_one_foot_bears_twice_the_weight(humanoid: RobotDescription) -> None:
    """On one foot some joint needs more of its torque than any does on both."""
    found = examine(humanoid)
    assert found.both_feet.share < found.one_foot.share < 1.0
    heavier = examine(describe("humanoid100", RobotOptions(payload_mass=50.0)))
    assert heavier.one_foot.share > 1.2 * found.one_foot.share


def test_a_weak_joint_is_named_with_what_it_needs(humanoid: RobotDescription) -> None:
    needed = examine(humanoid).both_feet.needed
    weak = examine(changed(humanoid, "torque_limit", "left_knee", 0.5 * needed))
    assert weak.both_feet.joint == "left_knee"
    assert weak.both_feet.share == pytest.approx(2.0, rel=1e-6)
    assert any("'left_knee'" in fault and "200%" in fault for fault in weak.faults)


@pytest.mark.parametrize("field", ["torque_limit", "velocity_limit", "position_upper"])
def test_legs_that_differ_are_told_and_no_fault(humanoid: RobotDescription, field: str) -> None:
    joint = "right_ankle_pitch"
    value = 0.9 * getattr(humanoid, field)[humanoid.joint_names.index(joint)]
    found = examine(changed(humanoid, field, joint, value))
    assert len(found.differences) == 1 and "left_ankle_pitch" in found.differences[0]
    assert found.faults == ()


def test_a_posture_with_tilted_soles_is_a_fault(humanoid: RobotDescription) -> None:
    found = examine(changed(humanoid, "nominal_joint_positions", "right_knee", 0.75))
    assert found.sole_tilt == pytest.approx(0.1, abs=1e-6)
    assert any("tilted" in fault for fault in found.faults) and any("higher" in fault for fault in found.faults)


def test_a_com_height_out_of_reach_is_a_fault(humanoid: RobotDescription) -> None:
    found = examine(replace(humanoid, com_height=1.3))
    assert any("cannot stand on both feet" in fault for fault in found.faults)


def test_bodies_that_touch_in_the_stance_are_named(humanoid: RobotDescription) -> None:
    crossed = changed(humanoid, "nominal_joint_positions", "left_shoulder_roll", -0.3)
    found = examine(changed(crossed, "nominal_joint_positions", "left_shoulder_pitch", 0.0))
    assert found.touching and any("touch" in fault for fault in found.faults)


def test_engines_that_differ_are_a_fault(humanoid: RobotDescription) -> None:
    found = examine(humanoid)
    assert any("differ by" in fault for fault in replace(found, parity=2e-9).faults)
    assert any("differ by" in fault for fault in replace(found, parity=float("nan")).faults)


def test_a_robot_that_is_not_there_is_one_sentence() -> None:
    with pytest.raises(ScenarioError, match="did you mean 'humanoid100'"):
        known("humanoid10")
