"""A contract is begun from what a network tells, and is one as soon as its guesses are right."""

import numpy as np
import pytest
import yaml

from surefoot.scenarios.policy.contract import contract_of
from surefoot.scenarios.policy.derived import begun
from surefoot.scenarios.policy.network import Network

pytestmark = pytest.mark.unit


def test_what_a_trainer_has_attached_is_written(policies, tmp_path):
    robot = policies.robot_of("g1")
    names, size = robot.joint_names, len(robot.joint_names)
    file = policies.network(
        tmp_path / "policy.onnx",
        np.zeros((6 + 3 * size, size)),
        [("obs", 6 + 3 * size)],
        joint_names=",".join(names),
        joint_stiffness=",".join(["40.0"] * size),
        joint_damping=",".join(["1.5"] * size),
        default_joint_pos=",".join(["0.1"] * size),
        action_scale=",".join(["0.3"] * size),
        observation_names="base_ang_vel,projected_gravity,joint_pos,joint_vel,actions",
    )
    text = begun(Network(file), robot)
    contract = contract_of(yaml.safe_load(text), "begun")
    assert contract.joints == names
    assert (contract.stiffness[0], contract.damping[0], contract.default[0]) == (40.0, 1.5, 0.1)
    assert contract.action.scale == (0.3,) * size
    told = [term.term for term in contract.observations]
    assert told == ["angular_velocity", "gravity", "joint_position", "joint_velocity", "last_action"]
    assert "to do" not in next(line for line in text.splitlines() if line.startswith("joints"))
    assert "to do" in next(line for line in text.splitlines() if line.startswith("rate"))


def test_the_period_of_a_clock_is_asked_for(policies, tmp_path):
    joints = len(policies.robot_of("g1").joint_names)
    inputs = [("obs", 2 + joints)]
    weights = np.zeros((2 + joints, joints))
    file = policies.network(tmp_path / "policy.onnx", weights, inputs, observation_names="phase,joint_pos")
    phase, position = (line for line in begun(Network(file)).splitlines() if "- {term" in line)
    assert "term: phase" in phase and "to do" in phase and "period" in phase
    assert "to do" not in position


def test_what_cannot_be_told_is_guessed_and_marked(policies, tmp_path):
    robot = policies.robot_of("g1")
    size, frame = len(robot.joint_names), 9 + 3 * len(robot.joint_names)
    file = policies.network(tmp_path / "policy.onnx", np.zeros((5 * frame, size)), [("obs", 5 * frame)])
    text = begun(Network(file), robot)
    contract = contract_of(yaml.safe_load(text), "begun")
    assert contract.history.length == 5
    for key in ("rate", "joints", "default", "stiffness", "damping", "action", "history"):
        assert "to do" in next(line for line in text.splitlines() if line.startswith(key)), key
    recurrent = policies.network(tmp_path / "state.onnx", np.zeros((frame, size)), [("obs", frame)], state=4)
    contract = contract_of(yaml.safe_load(begun(Network(recurrent), robot)), "begun")
    assert [(state.input, state.output) for state in contract.recurrent] == [("state_in", "state_out")]
