"""From a network to the beginning of its contract: what its file says, and comments where it says nothing."""

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surefoot.errors import ParameterError
from surefoot.models.types import RobotDescription
from surefoot.scenarios.policy.contract import KEY
from surefoot.scenarios.policy.network import Network

_NAMES: Mapping[str, tuple[str, ...]] = {
    "joints": ("joint_names",),
    "default": ("default_joint_pos", "default_joint_positions"),
    "stiffness": ("joint_stiffness", "stiffness"),
    "damping": ("joint_damping", "damping"),
    "scale": ("action_scale",),
    "observations": ("observation_names",),
    "history": ("observation_history_lengths", "history_length"),
    "rate": ("control_frequency", "policy_rate", "frequency"),
}
"""Names under which trainers attach them to a network, as mjlab and Isaac Lab's exporters do."""

_TERMS: Mapping[str, str] = {
    **dict.fromkeys(("base_ang_vel", "angular_velocity", "gyro", "base_angular_velocity"), "angular_velocity"),
    **dict.fromkeys(("projected_gravity", "gravity"), "gravity"),
    **dict.fromkeys(("base_lin_vel", "linear_velocity", "base_linear_velocity"), "linear_velocity"),
    **dict.fromkeys(("command", "velocity_commands", "twist"), "command"),
    **dict.fromkeys(("joint_pos", "joint_pos_rel", "joint_position"), "joint_position"),
    **dict.fromkeys(("joint_vel", "joint_vel_rel", "joint_velocity"), "joint_velocity"),
    **dict.fromkeys(("actions", "last_action"), "last_action"),
    **dict.fromkeys(("gait_phase", "phase"), "phase"),
}
"""Observations of trainers by the names of ours."""

USUAL = ("angular_velocity", "gravity", "command", "joint_position", "joint_velocity", "last_action")
"""Terms that most walkers observe, in the order in which most do."""

_SIZES = {"angular_velocity": 3, "gravity": 3, "linear_velocity": 3, "command": 3, "phase": 2}


@dataclass(frozen=True, slots=True)
class Line:
    """A key of a contract: its value in YAML, and a comment."""

    key: str
    value: Any
    comment: str = ""

    @property
    def text(self) -> str:
        """The text, on a line of its own."""
        comment = f"  # {self.comment}" if self.comment else ""
        return f"{self.key}: {json.dumps(self.value)}{comment}"


def begun(network: Network, robot: RobotDescription | None = None, place: str | None = None) -> str:
    """The text of a contract to be completed: lines that say ``to do`` are guessed.

    Args:
        network: from which they are derived.
        robot: that it is for; None where nobody says.
        place: path of the network seen from the contract; its name if None.

    Raises:
        ParameterError: it has no output of joints.
    """
    attached = _attached(network.metadata)
    actions = next((size for size in network.outputs.values() if size), 0)
    if not actions:
        what = f"{network.path}: no output whose size is known"
        raise ParameterError(KEY, what, "export the network with fixed sizes")
    head = (
        f"# The contract of {network.path.name}: what it observes, and what its outputs mean. The page of policies has"
    )
    lines = [f"{head} all keys."]
    if network.metadata:
        lines.append(f"# The network itself tells: {', '.join(sorted(network.metadata))}.")
    lines.append(Line("network", place or network.path.name).text)
    lines += [line.text for line in _lines(attached, robot, actions)]
    lines += _observed(network, attached, len(attached.get("joints") or ()) or actions, actions)
    return "\n".join(lines) + "\n"


def _attached(metadata: Mapping[str, str]) -> dict[str, list[Any]]:
    """Data that a trainer has attached, by our names: lists of names or numbers."""
    found = {}
    for name, theirs in _NAMES.items():
        text = next((metadata[one] for one in theirs if one in metadata), None)
        if text is not None:
            found[name] = _listed(text)
    return found


def _listed(text: str) -> list[Any]:
    """A list that was written as JSON, or side by side with commas."""
    try:
        values = json.loads(text)
    except ValueError:
        values = [part.strip() for part in text.split(",")]
    values = values if isinstance(values, list) else [values]
    return [_number(value) for value in values]


def _number(value: Any) -> Any:
    try:
        return float(value)
    except (TypeError, ValueError):
        return value


def _lines(attached: Mapping[str, list[Any]], robot: RobotDescription | None, actions: int) -> Iterator[Line]:
    if robot is not None:
        yield Line("robot", robot.name)
    rate = attached.get("rate")
    yield Line("rate", rate[0] if rate else 50, "" if rate else "to do: decisions in a second")
    joints, comment = _joints(attached, robot, actions)
    yield Line("joints", joints, comment)
    for name, usual, what in (
        ("default", 0.0, "the posture from which joint positions are counted, and to which actions are added [rad]"),
        ("stiffness", 100.0, "of the drives, by joint or one for all [N·m/rad]"),
        ("damping", 2.0, "of the drives, by joint or one for all [N·m·s/rad]"),
    ):
        yield Line(name, attached.get(name, usual), "" if name in attached else f"to do: {what}")
    scale = attached.get("scale")
    value = {"scale": scale[0] if len(scale) == 1 else scale} if scale else {"scale": 0.25}
    yield Line("action", value, "" if scale else "to do: radians of an action of 1")
    wide = {"v_x": [-1.0, 1.0], "v_y": [-0.5, 0.5], "yaw_rate": [-1.0, 1.0]}
    yield Line("command", wide, "to do: velocities that it was trained for [m/s, rad/s]")


def _joints(attached: Mapping[str, list[Any]], robot: RobotDescription | None, actions: int) -> tuple[list[str], str]:
    """Names of the joints, and how far they can be trusted."""
    if "joints" in attached:
        return [str(name) for name in attached["joints"]], ""
    if robot is not None and len(robot.joint_names) == actions:
        return list(robot.joint_names), "to do: in the order of the robot, which that of the network need not be"
    if robot is not None and len(robot.roles.legs) == actions:
        legs = [name for name in robot.joint_names if name in robot.roles.legs]
        return legs, "to do: the legs in the order of the robot, which that of the network need not be"
    return [f"joint_{index}" for index in range(actions)], f"to do: names of the {actions} joints, in its order"


def _observed(network: Network, attached: Mapping[str, list[Any]], joints: int, actions: int) -> list[str]:
    """Lines of what the inputs are made of."""
    inputs, outputs = network.inputs, network.outputs
    states = _states(inputs, outputs)
    free = {name: size for name, size in inputs.items() if name not in {pair[0] for pair in states}}
    found = []
    if states:
        pairs = [{"input": one, "output": other} for one, other in states]
        found.append(Line("recurrent", pairs, "to do: outputs of the same size as inputs").text)
    names, size = attached.get("observations"), next(iter(free.values()), 0)
    if names and len(free) == 1 and all(name in _TERMS for name in names):
        return [*found, "observations:", *(_named(_TERMS[name]) for name in names)]
    sizes = {**_SIZES, "joint_position": joints, "joint_velocity": joints, "last_action": actions}
    frame = sum(sizes[name] for name in USUAL)
    length, rest = divmod(size, frame) if size else (1, 0)
    fits = length and not rest
    what = f"{length} frames of {frame} numbers" if fits else f"{size} numbers, and these terms make {frame}"
    found.append(f"# to do: the input takes {what}; terms, order and scales are those that most walkers have")
    if names:
        found.append(f"# its trainer calls them: {', '.join(map(str, names))}")
    if fits and length > 1:
        found.append(Line("history", {"length": length}, "to do: order, and whether frames are interleaved").text)
    terms = [f"  - {{term: {name}}}  # {sizes[name]}" for name in USUAL]
    if len(free) == 1:
        return [*found, "observations:", *terms]
    found.append("inputs:  # to do: what each is made of")
    for name, count in free.items():
        found += [f"  {name}:  # {count}", *(f"    {term}" for term in [f"- {{term: {one}}}" for one in USUAL])]
    return found


def _named(term: str) -> str:
    """Line of a term that the trainer has named; of a clock its file tells no more."""
    clock = "  # to do: options: its period [s], and rest: zeros if it is silent while the robot is to stand"
    return f"  - {{term: {term}}}{clock if term == 'phase' else ''}"


def _states(inputs: Mapping[str, int], outputs: Mapping[str, int]) -> list[tuple[str, str]]:
    """Inputs and outputs that are one state by their names and sizes."""
    found = []
    for name, size in inputs.items():
        stem = name.removesuffix("_in").removesuffix("_input")
        same = (f"{stem}_out", f"{stem}_output", f"{stem}n", f"next_{stem}")
        match = next((other for other in same if outputs.get(other) == size and other != name), None)
        if match is not None:
            found.append((name, match))
    return found


def write(model: Path, out: Path, robot: RobotDescription | None, replace: bool) -> None:
    """Write the beginning of a contract.

    Raises:
        ParameterError: the network cannot be read.
        LogError: the file exists or cannot be written.
    """
    from surefoot.scenarios.output import refuse_existing, write_whole

    refuse_existing(out, replace)
    text = begun(Network(model), robot, Path(os.path.relpath(model, out.parent)).as_posix())
    with write_whole(out, replace) as temporary:
        temporary.write_text(text, encoding="utf-8")
