"""A contract is held against its network and its robot before anything walks; what does not fit is one sentence."""

import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.errors import ParameterError
from surefoot.scenarios.policy.contract import contract_of, schema
from surefoot.scenarios.policy.controller import Policy
from surefoot.scenarios.policy.files import read
from surefoot.scenarios.policy.joints import Joints
from surefoot.scenarios.policy.terms import TERMS
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit


def faulty(policies, tmp_path, **changes):
    return policies.stander(tmp_path / "faulty", **changes)


FAULTS = {
    "a joint of another robot": ({"joints": ["left_wheel"] * 1, "default": 0.0}, "left_wheel"),
    "too few observations": ({"observations": [{"term": "gravity"}]}, r"takes 96 numbers, .* make 3 .*gravity 3"),
    "an unknown term": ({"observations": [{"term": "gravitas"}]}, "no observation is called 'gravitas'"),
    "an unknown option": ({"observations": [{"term": "gravity", "options": {"of": 1}}]}, "gravity: "),
    "scales of another size": ({"observations": [{"term": "gravity", "scale": [1.0, 2.0]}]}, "3 numbers, and 2 scales"),
    "gains of fewer joints": ({"stiffness": [1.0, 2.0]}, "stiffness has 2 numbers for 29 joints"),
    "a pattern that names none": ({"damping": {"wheel": 1.0}}, "no joint is called 'wheel'"),
    "a joint without gains": ({"damping": {"left.*": 1.0}}, "damping says nothing of right_hip_pitch_joint"),
    "negative gains": ({"damping": -1.0}, "negative"),
    "another robot": ({"robot": "talos"}, "of robot talos, and this is g1"),
    "too fast": ({"rate": 5000}, "5000 times a second"),
    "no such state": ({"recurrent": [{"input": "h", "output": "obs"}]}, "no input 'h'"),
    "no such output": ({"action": {"output": "torques"}}, "no output 'torques'"),
    "an unknown key": ({"gains": 3}, "gains"),
    "neither observations nor inputs": ({"observations": []}, "either observations or inputs"),
    "unlike frames": (
        {
            "history": {"interleaved": True},
            "observations": [{"term": "gravity"}, {"term": "command", "history": 3}],
        },
        "frames of terms",
    ),
    "no network": ({"network": "nowhere.onnx"}, "no such network"),
    "no network but a text": ({"network": "contract.yaml"}, "no network that can be run"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_does_not_fit_is_said_in_one_sentence(policies, scenario, tmp_path, name):
    changes, said = FAULTS[name]
    walk = resolve(load(str(scenario(policies.stander(tmp_path / "faulty", **changes)))))
    with pytest.raises(ParameterError, match=said) as refusal:
        Policy(walk, str(tmp_path / "faulty" / "contract.yaml"))
    assert refusal.value.key[0] == "controller"
    assert "\n" not in str(refusal.value)


def test_a_contract_that_fits_is_taken(scenario, stander):
    walk = resolve(load(str(scenario(stander))))
    policy = Policy(walk, str(stander))
    assert policy.posture.shape == (29,)
    with pytest.raises(ParameterError, match="is not the policy that made the log"):
        Policy(walk, str(stander), digest="0" * 64)


@pytest.mark.parametrize("name", ["missing.yaml", "empty.yaml", "list.yaml", "broken.yaml", "binary.yaml"])
def test_a_file_that_is_none_is_said(tmp_path, name):
    content = {"empty.yaml": b"", "list.yaml": b"[1]", "broken.yaml": b"a: [", "binary.yaml": b"\xff\xfe\x00"}
    if name in content:
        (tmp_path / name).write_bytes(content[name])
    with pytest.raises(ParameterError, match=name):
        read(tmp_path / name, ("a",))
    with pytest.raises(ParameterError, match="no contracts"):
        (tmp_path / "folder").mkdir()
        read(tmp_path / "folder", ("a",))


def test_without_onnxruntime_the_extra_is_named(monkeypatch, scenario, stander):
    walk = resolve(load(str(scenario(stander))))
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(ParameterError, match=r"onnxruntime; install it with: .*policy"):
        Policy(walk, str(stander))


def test_the_schema_takes_what_is_accepted(policies):
    import jsonschema

    robot = policies.robot_of("g1")
    values = policies.contract(robot, robot.joint_names)
    jsonschema.validate(values, schema())
    contract_of(values, "here")
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({**values, "gains": 1}, schema())


def test_a_scenario_asks_of_a_seat_what_it_can_hear(scenario, stander, tmp_path):
    def refused(**keys):
        with pytest.raises(surefoot.ScenarioError) as refusal:
            load(str(scenario(stander, **keys)))
        return str(refusal.value)

    assert "velocities alone" in refused(commands=[{"time": 0.5, "place": {"x": 1.0, "y": 0.0}}])
    assert "velocities alone" in refused(commands=[{"time": 0.5, "v_x": 0.1, "swing_height": 0.05}], duration=3)
    assert "velocities alone" in refused(gait={"waypoints": [{"x": 1.0, "y": 0.0}], "com_height": 0.67})
    assert "has none" in refused(fidelity="pendulum")
    assert "planner or a QP" in refused(faults=[{"kind": "qp_failure", "time": 0.5}])
    assert "is of a planner" in refused(criteria={"fell": False, "zmp_error_rms": {"max": 0.01}})
    assert "is of a planner" in refused(criteria={"steps_taken": "steps_planned"})
    load(str(scenario(stander, faults=[{"kind": "torque_loss", "time": 0.5}])))


def test_criteria_of_a_planner_are_left_out_where_the_scenario_names_no_controller(stander):
    asked = [f"controller.policy={stander}"]
    loaded = load("walk-level", ["robot=g1", *asked])
    assert "zmp_error_rms" in loaded.left_out and "zmp_error_rms" not in loaded.criteria
    assert "foot_slip_max" in loaded.criteria
    with pytest.raises(surefoot.ScenarioError, match="zmp_error_rms is of a planner"):
        load("walk-level", ["robot=g1", *asked, "criteria.zmp_error_rms.max=0.1"])


def test_equal_steps_are_the_velocity_of_their_path(stander):
    from surefoot.scenarios.setup.seat import velocities

    walk = resolve(load("walk-level", ["robot=g1", f"controller.policy={stander}"]))
    begin, end = velocities(walk)
    gait = walk.asked_gait
    assert end.twist.is_zero
    assert begin.twist.x * (end.time - begin.time) == pytest.approx((gait.steps - 1) * gait.step_length)


def test_unitree_numbers_joints_by_motor(policies, tmp_path):
    folder = policies.unitree(tmp_path / "unitree")
    robot = policies.robot_of("g1")
    contract = read(folder, robot.joint_names).contract
    assert contract.joints[:3] == ("left_hip_pitch_joint", "left_hip_yaw_joint", "left_ankle_pitch_joint")
    limit = dict(zip(robot.joint_names, robot.torque_limit.tolist(), strict=True))
    np.testing.assert_allclose(contract.stiffness, [policies.STIFF * limit[name] for name in contract.joints])
    assert [term.history for term in contract.observations] == [5] * 6
    assert contract.rate == 50.0


@pytest.mark.parametrize(("order", "rest"), [("motors", "zeros"), ("breadth first", None)])
def test_a_clock_of_unitree_is_silent_at_rest_where_joints_come_as_motors_do(policies, tmp_path, order, rest):
    robot, folder = policies.robot_of("g1"), tmp_path / "clocked"
    policies.unitree(folder)
    file = folder / "params" / "deploy.yaml"
    text = file.read_text().replace("!!python/object/apply:builtins.slice [null, null, null]", "null")
    values = yaml.safe_load(text)
    if order == "motors":
        values["joint_ids_map"] = sorted(values["joint_ids_map"])
    values["observations"]["gait_phase"] = {"params": {"period": 0.6}, "scale": [1.0, 1.0], "history_length": 1}
    file.write_text(yaml.safe_dump(values))
    (phase,) = (term for term in read(folder, robot.joint_names).contract.observations if term.term == "phase")
    assert (phase.options["period"], phase.options.get("rest")) == (0.6, rest)


@pytest.mark.parametrize("name", ["falcon", "openwbt", "rl_mjlab"])
def test_the_contracts_of_the_documentation_are_of_the_g1(name):
    from surefoot.models import RobotOptions, describe

    file = Path(__file__).parents[3] / "docs" / "policies" / f"{name}.yaml"
    robot = describe("g1", RobotOptions())
    contract = read(file, robot.joint_names).contract
    joints = Joints(contract, robot)
    assert joints.posture.shape == (29,) and (joints.stiffness > 0.0).all()
    assert {term.term for term in contract.observations} <= set(TERMS)
