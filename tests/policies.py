"""Small policies of our own, written where a test needs them: they hold a posture and balance on the ankles."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from surefoot.models import RobotDescription, RobotOptions, describe

STIFF, DAMPED = 4.0, 0.15
"""Gains over the largest torque of a joint [1/rad, s/rad]: stiff enough to stand on."""

LEAN, SWAY = 0.4, 0.15
"""Ankle angle for a tilt of the base, and for its speed [-, s]."""

SCALE = 0.25
"""Scale of the actions [rad]."""

RATES = (0.2, 0.05)
"""Scales of angular velocities and joint speeds [s]."""


def robot_of(name: str) -> RobotDescription:
    """A robot by its name."""
    return describe(name, RobotOptions())


def network(
    path: Path,
    weights: np.ndarray,
    inputs: Sequence[tuple[str, int]],
    state: int = 0,
    bias: Any = None,
    **metadata: str,
) -> Path:
    """Write a network whose actions are a linear function of its inputs, side by side.

    Args:
        path: of the file.
        weights: shape (inputs together, actions).
        inputs: names and sizes.
        bias: of the actions; None for none.
        state: size of a state that counts decisions, fed back from ``state_out`` to ``state_in``; 0 for none.
        metadata: that is attached.
    """
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    def tensor(name: str, size: int) -> Any:
        return helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, size])

    names = [name for name, _ in inputs]
    nodes = [helper.make_node("Concat", names, ["all"], axis=1)] if len(names) > 1 else []
    nodes.append(helper.make_node("Gemm", ["all" if len(names) > 1 else names[0], "weights", "bias"], ["actions"]))
    rest = np.zeros(weights.shape[1]) if bias is None else bias
    constants = [
        numpy_helper.from_array(one.astype(np.float32), name) for name, one in (("weights", weights), ("bias", rest))
    ]
    given, made = [tensor(*one) for one in inputs], [tensor("actions", weights.shape[1])]
    if state:
        nodes.append(helper.make_node("Add", ["state_in", "one"], ["state_out"]))
        constants.append(numpy_helper.from_array(np.ones((1, state), dtype=np.float32), "one"))
        given.append(tensor("state_in", state))
        made.append(tensor("state_out", state))
    model = helper.make_model(
        helper.make_graph(nodes, "walker", given, made, constants),
        opset_imports=[helper.make_opsetid("", 17)],
        ir_version=9,
    )
    helper.set_model_props(model, metadata)
    onnx.save(model, path)
    return path


TERMS = ("angular_velocity", "gravity", "command", "joint_position", "joint_velocity", "last_action")


def sizes(joints: int) -> list[int]:
    """Numbers of each of these terms."""
    return [3, 3, 3, joints, joints, joints]


def balance(joints: Sequence[str], history: int = 1, newest: int = -1) -> list[np.ndarray]:
    """Weights of each term from its newest value to actions, zeros from older ones: term by term, oldest first."""
    found = []
    for term, size in zip(TERMS, sizes(len(joints)), strict=True):
        weights = np.zeros((history, size, len(joints)))
        for index, name in enumerate(joints):
            if "ankle_pitch" in name:
                if term == "gravity":
                    weights[newest, 0, index] = LEAN / SCALE
                elif term == "angular_velocity":
                    weights[newest, 1, index] = SWAY / SCALE / RATES[0]
        found.append(weights)
    return found


def gains(robot: RobotDescription, joints: Sequence[str]) -> dict[str, list[float]]:
    """Stiffness and damping of joints."""
    at = [robot.joint_names.index(name) for name in joints]
    limit = np.asarray(robot.torque_limit)[at]
    return {"stiffness": (STIFF * limit).tolist(), "damping": (DAMPED * limit).tolist()}


def posture(robot: RobotDescription, joints: Sequence[str]) -> list[float]:
    """Angles of joints at rest."""
    at = [robot.joint_names.index(name) for name in joints]
    return np.asarray(robot.nominal_joint_positions)[at].tolist()


def contract(robot: RobotDescription, joints: Sequence[str], /, **more: Any) -> dict[str, Any]:
    """A contract of these terms."""
    scales = {"angular_velocity": RATES[0], "joint_velocity": RATES[1]}
    found = {
        "network": "policy.onnx",
        "rate": 50,
        "joints": list(joints),
        "default": posture(robot, joints),
        **gains(robot, joints),
        "action": {"scale": SCALE, "clip": [-10, 10]},
        "observations": [{"term": term, "scale": scales.get(term, 1.0)} for term in TERMS],
        "command": {"v_x": [-0.5, 1.0], "v_y": [-0.3, 0.3], "yaw_rate": [-0.5, 0.5]},
    }
    return {**found, **more}


def write(folder: Path, values: dict[str, Any], name: str = "contract.yaml") -> Path:
    """Write a contract, or what stands for one."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(yaml.safe_dump(values, sort_keys=False), encoding="utf-8")
    return file


def stander(folder: Path, name: str = "g1", **more: Any) -> Path:
    """A policy that stands: the plainest contract."""
    robot = robot_of(name)
    joints = robot.joint_names
    folder.mkdir(parents=True, exist_ok=True)
    weights = np.concatenate([one[0] for one in balance(joints)])
    network(folder / "policy.onnx", weights, [("obs", len(weights))])
    return write(folder, contract(robot, joints, **more))


def framed(folder: Path, name: str = "g1", legs: bool = True) -> Path:
    """The same, of legs alone, that sees five frames with the newest one first."""
    robot = robot_of(name)
    joints = robot.roles.legs if legs else robot.joint_names
    joints = tuple(one for one in robot.joint_names if one in joints)
    folder.mkdir(parents=True, exist_ok=True)
    frame = np.concatenate([one[0] for one in balance(joints)])
    weights = np.concatenate([frame, *[np.zeros_like(frame)] * 4])
    network(folder / "policy.onnx", weights, [("obs", len(weights))])
    history = {"length": 5, "order": "newest_first", "interleaved": True, "begin": "zero"}
    rest = [one for one in robot.joint_names if one not in joints]
    others = {name: dict(zip(rest, values, strict=True)) for name, values in gains(robot, rest).items()}
    return write(folder, contract(robot, joints, history=history, others=others))


def unitree(folder: Path) -> Path:
    """The same as unitree_rl_lab exports one: a folder with params/deploy.yaml and exported/policy.onnx."""
    robot = robot_of("g1")
    order = [*range(0, 12, 2), *range(1, 12, 2), *range(12, len(robot.joint_names))]
    joints = [robot.joint_names[i] for i in order]
    (folder / "exported").mkdir(parents=True)
    weights = np.concatenate([one.reshape(-1, len(joints)) for one in balance(joints, history=5)])
    network(folder / "exported/policy.onnx", weights, [("obs", len(weights))])
    rest = posture(robot, joints)
    theirs = ("base_ang_vel", "projected_gravity", "velocity_commands", "joint_pos_rel", "joint_vel_rel", "last_action")
    scales = {"base_ang_vel": RATES[0], "joint_vel_rel": RATES[1]}
    deploy = {
        "joint_ids_map": order,
        "step_dt": 0.02,
        **gains(robot, robot.joint_names),
        "default_joint_pos": rest,
        "commands": {"base_velocity": {"ranges": {"lin_vel_x": [-0.5, 1.0], "lin_vel_y": [-0.3, 0.3]}}},
        "actions": {
            "JointPositionAction": {
                "clip": None, "joint_names": [".*"], "scale": [SCALE] * len(joints), "offset": rest, "joint_ids": None
            }
        },
        "observations": {
            name: {"params": {}, "clip": None, "scale": [scales.get(name, 1.0)] * size, "history_length": 5}
            for name, size in zip(theirs, sizes(len(joints)), strict=True)
        },
    }  # fmt: skip
    file = write(folder, deploy, "params/deploy.yaml")
    text = file.read_text().replace(
        "joint_ids: null", "joint_ids: !!python/object/apply:builtins.slice [null, null, null]"
    )
    file.write_text(text)
    return folder


def leapp(folder: Path) -> Path:
    """The same as LEAPP exports one, its observations inside the network, with a state that it hands to itself."""
    robot = robot_of("g1")
    joints = list(robot.joint_names)
    folder.mkdir(parents=True, exist_ok=True)
    inputs = [("gyro", 3), ("gravity", 3), ("joint_pos", len(joints))]
    weights = np.zeros((6 + len(joints), len(joints)))
    for index, name in enumerate(joints):
        if "ankle_pitch" in name:
            weights[1, index], weights[3, index] = SWAY, LEAN
    network(folder / "policy.onnx", weights, inputs, state=2, bias=np.array(posture(robot, joints)))
    rest = posture(robot, joints)
    told = {"gyro": "root_ang_vel_b", "gravity": "projected_gravity_b", "joint_pos": "joint_pos"}
    described = [
        {"name": name, "shape": [1, size], "dtype": "float32", "isaaclab_connection": f"state:robot:{told[name]}"}
        for name, size in inputs
    ]
    described[-1]["element_names"] = [joints]
    values = {
        "models": {
            "policy": {
                "inputs": [*described, {"name": "state_in", "shape": [1, 2], "dtype": "float32"}],
                "outputs": [
                    {
                        "name": "actions",
                        "shape": [1, len(joints)],
                        "dtype": "float32",
                        "element_names": [joints],
                        "isaaclab_connection": "write:robot:set_joint_position_target",
                    },
                    {"name": "state_out", "shape": [1, 2], "dtype": "float32"},
                ],
                "parameters": {"model_path": "policy.onnx", "backend": "onnx", "md5sum": "", "sha256sum": ""},
            }
        },
        "pipeline": {
            "inputs": {"policy": [name for name, _ in inputs]},
            "outputs": {"policy": ["actions"]},
            "feedback_flow": {"policy/state_out": ["policy/state_in"]},
            "configs": {"frequency": 50.0},
        },
        "system information": {},
        "agile": {
            "articulations": {
                "robot": {
                    "joint_names": joints,
                    "default_joint_pos": rest,
                    **{f"default_joint_{name}": value for name, value in gains(robot, joints).items()},
                }
            }
        },
    }
    return write(folder, values, "policy.yaml")
