"""Unitree's ``deploy.yaml`` read as a contract: what unitree_rl_lab writes beside a policy that it exports."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from surefoot.errors import ParameterError
from surefoot.scenarios.policy.contract import KEY

KEYS = ("joint_ids_map", "step_dt", "observations")
"""Keys by which such a file is known."""

_TERMS = {
    "base_ang_vel": "angular_velocity",
    "projected_gravity": "gravity",
    "velocity_commands": "command",
    "joint_pos_rel": "joint_position",
    "joint_vel_rel": "joint_velocity",
    "last_action": "last_action",
    "gait_phase": "phase",
    "base_lin_vel": "linear_velocity",
}
"""Observations of such files by the names of ours."""

_PLACES = ("../exported/policy.onnx", "exported/policy.onnx", "policy.onnx", "../policy.onnx")
"""Places of the network, seen from the file."""

_RANGES = {"v_x": "lin_vel_x", "v_y": "lin_vel_y", "yaw_rate": "ang_vel_z"}


def contract(values: Mapping[str, Any], file: Path, joint_names: Sequence[str]) -> dict[str, Any]:
    """The contract of such a file.

    Its joints are numbered as the motors of the robot are, which are taken to be in the order of the robot's joints.
    Stiffness and damping are given by motor, all else by joint of the policy. Histories go from old to new by terms.

    Raises:
        ParameterError: it says what no contract can, or the robot has fewer joints.
    """
    order = values["joint_ids_map"]
    if not isinstance(order, list) or not all(isinstance(i, int) and 0 <= i < len(joint_names) for i in order):
        what = f"{file}: joint_ids_map has numbers beyond the {len(joint_names)} joints of the robot"
        raise ParameterError(KEY, what, "run it with its own robot")
    names = [joint_names[i] for i in order]
    gains = {name: _gains(values, name, order, file) for name in ("stiffness", "damping")}
    actions = values.get("actions") or {}
    if len(actions) != 1:
        raise ParameterError(KEY, f"{file}: {len(actions)} actions", "give one")
    action = next(iter(actions.values()))
    ranges = ((values.get("commands") or {}).get("base_velocity") or {}).get("ranges") or {}
    command = {name: ranges[theirs] for name, theirs in _RANGES.items() if ranges.get(theirs) is not None}
    return {
        "network": next((place for place in _PLACES if (file.parent / place).is_file()), _PLACES[0]),
        "rate": round(1.0 / float(values["step_dt"]), 6),
        "joints": names,
        "default": values.get("default_joint_pos") or 0.0,
        **gains,
        "action": _action(action, names, file),
        "observations": list(_observations(values["observations"], names, joint_names, file)),
        "command": command,
    }


def _gains(values: Mapping[str, Any], name: str, order: Sequence[int], file: Path) -> list[float]:
    given = values.get(name)
    if not isinstance(given, list) or len(given) <= max(order):
        raise ParameterError(KEY, f"{file}: {name} does not tell all motors", "give a number for each")
    return [float(given[i]) for i in order]


def _action(action: Mapping[str, Any], names: Sequence[str], file: Path) -> dict[str, Any]:
    ids = action.get("joint_ids")
    joints = [names[i] for i in ids] if isinstance(ids, list) else []
    found = {"joints": joints, "scale": action.get("scale", 1.0), "offset": action.get("offset")}
    clip = action.get("clip")
    if clip is not None:
        found["limits"] = clip if isinstance(clip[0], list) else [clip] * len(joints or names)
    return found


def _observations(
    given: Mapping[str, Any], names: Sequence[str], joint_names: Sequence[str], file: Path
) -> Iterator[dict[str, Any]]:
    for theirs, keys in given.items():
        if not isinstance(keys, Mapping):
            continue
        if theirs not in _TERMS:
            what = f"{file}: observation '{theirs}', which is not known here"
            raise ParameterError(KEY, what, f"write a contract with a term of your own; known are {', '.join(_TERMS)}")
        params = keys.get("params") or {}
        found: dict[str, Any] = {"term": _TERMS[theirs], "history": keys.get("history_length") or 1}
        if keys.get("scale") is not None:
            found["scale"] = keys["scale"]
        if keys.get("clip") is not None:
            found["clip"] = keys["clip"]
        ids = (params.get("asset_cfg") or {}).get("joint_ids")
        if isinstance(ids, list):
            found["joints"] = [names[i] for i in ids]
        if "period" in params:
            silent = {"rest": "zeros"} if _trained_in_mujoco(names, joint_names) else {}
            found["options"] = {"period": float(params["period"]), **silent}
        yield found


def _trained_in_mujoco(names: Sequence[str], joint_names: Sequence[str]) -> bool:
    """Return true if joints come limb by limb as motors do: Isaac Lab counts them breadth first, across the limbs.

    Walkers of unitree_rl_mjlab observe no clock, but zeros, while they are to stand; those of unitree_rl_lab always do.
    """
    return list(names) == list(joint_names[: len(names)])
