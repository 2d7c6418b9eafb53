"""Legs of five joints: without a joint that rolls the foot they walk on side edges, without another they do not."""

import math
from pathlib import Path

import biped
import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.apps.robots.examine import examine
from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.pinocchio import pinocchio_model
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.robot.body import body_of, feet_at
from surefoot.wbc.body.ik import PostureTarget

ROLLS = "lock: ['*_ankle_roll']\n"
BESIDE = 0.04
"""As far outside the roll axes as the legs of Unitree's H1, of its size."""


def robot(folder: Path, lock: str = ROLLS) -> Path:
    return biped.write(folder, biped.Biped(beside=BESIDE), biped.FILE + lock + biped.NARROW)


@pytest.mark.unit
def test_feet_that_no_joint_rolls_lean(tmp_path) -> None:
    explained = explain(str(robot(tmp_path)))
    assert explained.description.roles.feet_lean
    assert any("no joint rolls them" in line for line in explained.derived)
    assert not describe(str(biped.write(tmp_path)), RobotOptions()).roles.feet_lean


@pytest.mark.unit
def test_straight_and_nominal_legs_are_upright_on_level_soles_beside_the_hips(tmp_path) -> None:
    described = describe(str(robot(tmp_path)), RobotOptions())
    model = pinocchio_model(described)
    for angles in (described.straight_joint_positions, described.nominal_joint_positions):
        q = pin.neutral(model)
        q[7:] = angles
        data = model.createData()
        pin.framesForwardKinematics(model, data, q)
        for name, side in zip(described.sole_sites, (1.0, -1.0), strict=True):
            sole = data.oMf[model.getFrameId(name)]
            assert sole.rotation[2, 2] == pytest.approx(1.0, abs=1e-9)
            assert side * sole.translation[1] == pytest.approx(biped.HIP + BESIDE, abs=1e-9)


@pytest.mark.unit
def test_it_stands_on_one_line_under_each_foot(tmp_path) -> None:
    described = describe(str(robot(tmp_path)), RobotOptions())
    found = examine(described)
    assert found.both_feet.share < 0.5
    assert found.one_foot.share < 0.5
    assert not found.faults
    body = body_of(described)
    lines = np.array([[0.0, 0.07, 0.0], [0.0, -0.07, 0.0]])
    q = pin.neutral(body.model)
    q[2], q[7:] = described.leg_length, described.nominal_joint_positions
    target = PostureTarget(lines, np.zeros(2), np.array([0.0, 0.0, described.com_height]), 0.0)
    posture = body.ik(described.nominal_joint_positions).solve(target, q)
    assert posture.reached
    np.testing.assert_allclose(feet_at(body, posture.q).position, lines, atol=1e-6)
    data = body.model.createData()
    pin.framesForwardKinematics(body.model, data, posture.q)
    left, right = (data.oMf[body.model.getFrameId(name)] for name in body.frames.soles)
    lean = math.asin(left.rotation[2, 1])
    assert lean < -0.05
    assert math.asin(right.rotation[2, 1]) == pytest.approx(-lean, abs=1e-6)
    # The line is the lower edge of the sole: nothing of it is below the ground.
    corners = left.translation + np.array([[0.0, y, 0.0] for y in (-0.015, 0.015)]) @ left.rotation.T
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.unit
@pytest.mark.parametrize(
    ("lock", "what"),
    [
        ("lock: ['*_yaw']\n", "the left leg of biped, to link 'left_foot', has 5 joints, none of which yaws the foot"),
        ("lock: ['*_ankle_pitch']\n", "has 5 joints, none of which pitches the foot; a leg of five joints can do"),
        ("lock: [right_ankle_roll]\n", "no joint rolls the right foot of biped, but one rolls the other; both legs"),
    ],
)
def test_what_five_joints_cannot_do_without_is_said_in_one_sentence(tmp_path, lock, what) -> None:
    with pytest.raises(RobotError, match=what) as refused:
        describe(str(robot(tmp_path, lock)), RobotOptions())
    assert "\n" not in str(refused.value)


@pytest.mark.physics
def test_it_walks_and_stops_on_side_edges(tmp_path) -> None:
    keys = {"robot": str(robot(tmp_path)), "sensing.source": "truth"}
    verdict = run_scenario(surefoot.load("walk-level", keys), tmp_path).verdict
    assert verdict["fell"] is False
    assert verdict["steps_taken"] == verdict["steps_planned"] == 20
    assert verdict["standing_time_final"] > 1.0
    assert verdict["wbc_fallbacks"] == 0
    assert verdict["zmp_inside_fraction"] > 0.99
    assert verdict["foot_slip_max"] < 0.003
    assert verdict["footstep_error_max"] < 0.005
    assert verdict["cop_ratio_p99"] < 0.6
    assert verdict["stance_tilt_max"] < 0.02


@pytest.mark.physics
def test_it_takes_its_steps_from_sensors(tmp_path) -> None:
    """Steps are moved, by up to 0.29 m, with perfect sensors no less; in one of three seeds the walk ends stepping."""
    verdict = run_scenario(surefoot.load("walk-level", {"robot": str(robot(tmp_path))}), tmp_path).verdict
    assert verdict["fell"] is False and verdict["steps_taken"] >= 20
    assert verdict["step_shift"] < 0.3


@pytest.mark.physics
def test_it_stands_without_moving_on_side_edges(tmp_path) -> None:
    keys = {"robot": str(robot(tmp_path)), "sensing.source": "truth"}
    verdict = run_scenario(surefoot.load("stand", keys), tmp_path).verdict
    assert verdict.passed, verdict.reasons


@pytest.mark.physics
@pytest.mark.parametrize("seed", [0, pytest.param(3, marks=pytest.mark.long)])
def test_it_stands_on_side_edges_from_sensors(tmp_path, seed) -> None:
    """The turn of its soles about their edges is no measurement of level; the way between the edges is."""
    keys = {"robot": str(robot(tmp_path)), "seed": seed, "criteria": {}}
    verdict = run_scenario(surefoot.load("stand", keys), tmp_path).verdict
    assert not verdict["fell"] and verdict["ghost_force_max"] < 8.0
    assert max(verdict["com_estimation_error_rms"]) < 0.0025
    assert verdict["tilt_estimation_error_rms"] < math.radians(0.2)
    assert max(verdict["zmp_error_rms"]) < 0.005
