"""The YAML of LEAPP read as a contract: a network that makes targets of raw states, with its observations inside."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from surefoot.errors import ParameterError
from surefoot.scenarios.policy.contract import KEY

KEYS = ("models", "pipeline", "system information")
"""Keys by which such a file is known."""

_STATES: Mapping[str, dict[str, Any]] = {
    "joint_pos": {"term": "joint_position", "options": {"relative": False}},
    "joint_vel": {"term": "joint_velocity"},
    "root_ang_vel_b": {"term": "angular_velocity"},
    "root_lin_vel_b": {"term": "linear_velocity"},
    "projected_gravity_b": {"term": "gravity"},
    "root_quat_w": {"term": "orientation"},
}
"""Properties of an articulation of Isaac Lab by the terms that tell them."""

_TARGETS = {"set_joint_position_target": "position", "set_joint_effort_target": "torque"}

_GAINS = {"default": "default_joint_pos", "stiffness": "default_joint_stiffness", "damping": "default_joint_damping"}


def contract(values: Mapping[str, Any], file: Path, joint_names: Sequence[str]) -> dict[str, Any]:
    """The contract of such a file with one model.

    What the format does not tell stands in ``agile.articulations.robot``, as AGILE writes it: posture and gains.

    Raises:
        ParameterError: it says what no contract can, or does not say the gains.
    """
    models, pipeline = values["models"], values["pipeline"]
    if len(models) != 1:
        raise ParameterError(KEY, f"{file}: {len(models)} models in turn", "give a pipeline of one")
    (name, model), *_ = models.items()
    inputs, outputs = ({one["name"]: one for one in model[kind]} for kind in ("inputs", "outputs"))
    offered: list[str] = next(iter((pipeline.get("outputs") or {}).values()), [])
    targets = [one for one in offered if _target(outputs[one]) is not None]
    if len(targets) != 1:
        what = f"{file}: {len(targets)} outputs that are written to joints"
        raise ParameterError(KEY, what, "give one, of set_joint_position_target or set_joint_effort_target")
    target = outputs[targets[0]]
    robot = ((values.get("agile") or {}).get("articulations") or {}).get("robot") or {}
    joints = [str(one) for one in robot.get("joint_names") or _elements(target) or joint_names]
    missing = [key for key in ("stiffness", "damping") if _GAINS[key] not in robot]
    if missing:
        what = f"{file}: says not what {' and '.join(missing)} the drives have"
        raise ParameterError(KEY, what, "add agile.articulations.robot with joint_names, posture and gains")
    fed = _feedback(pipeline, name)
    rate = (pipeline.get("configs") or {}).get("frequency")
    if not rate:
        raise ParameterError(KEY, f"{file}: says not how often it decides", "add pipeline.configs.frequency")
    return {
        "network": model["parameters"]["model_path"],
        "rate": float(rate),
        "joints": joints,
        **{key: robot[theirs] for key, theirs in _GAINS.items() if theirs in robot},
        "action": {
            "output": target["name"],
            "kind": _target(target),
            "joints": _elements(target) or [],
            "offset": 0.0,
        },
        "inputs": {
            one: [_term(description, joints, file)]
            for one, description in inputs.items()
            if one not in {state["input"] for state in fed}
        },
        "recurrent": fed,
    }


def _target(output: Mapping[str, Any]) -> str | None:
    """Kind of what an output is written to; None for none of the joints'."""
    parts = str(output.get("isaaclab_connection")).split(":")
    return _TARGETS.get(parts[-1]) if parts[0] == "write" else None


def _elements(description: Mapping[str, Any]) -> list[str] | None:
    """Names of the joints that a tensor tells; None where it names none."""
    names = description.get("element_names")
    if isinstance(names, list) and names and isinstance(names[0], list):
        names = names[0]
    return [str(name) for name in names] if isinstance(names, list) and names else None


def _term(description: Mapping[str, Any], joints: Sequence[str], file: Path) -> dict[str, Any]:
    """The term that an input is made of."""
    parts = str(description.get("isaaclab_connection")).split(":")
    if parts[0] == "command":
        return {"term": "command"}
    if parts[0] == "state" and parts[-1] in _STATES:
        found = dict(_STATES[parts[-1]])
        names = _elements(description)
        if "joint" in found["term"] and names:
            found["joints"] = names
        return found
    what = f"{file}: input '{description['name']}' of {':'.join(parts)}, which is not known here"
    raise ParameterError(KEY, what, "write a contract with a term of your own")


def _feedback(pipeline: Mapping[str, Any], name: str) -> list[dict[str, str]]:
    """Outputs that the network hands to itself."""
    flows = pipeline.get("feedback_flow") or {}
    return [
        {"input": target.partition("/")[2], "output": source.partition("/")[2]}
        for source, targets in flows.items()
        for target in targets
        if source.startswith(f"{name}/") and target.startswith(f"{name}/")
    ]
