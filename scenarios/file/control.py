"""The keys of what stands on both ends of a joint: what moves the robot, and what its joints are given."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from surefoot.scenarios.file.group import WHOLE, Group, as_tuple, key
from surefoot.scenarios.file.names import OneOf
from surefoot.scenarios.file.units import RADIAN, Unit

_Gain = Annotated[float, Field(ge=0, le=1e6)]
_Gains = Annotated[tuple[_Gain, _Gain], BeforeValidator(as_tuple)]


class PlantSettings(Group):
    """The plant that moves the robot: Surefoot's own simulation, or another simulator or a machine of a package."""

    name: Annotated[str, OneOf("plant", "name")] | None = key(
        None, "what is measured and moved, null: mujoco, the simulated world"
    )
    options: dict[str, Any] | None = key(None, "given to it by name, null: none")


class SeatSettings(Group):
    """The controller in the seat of planner and whole-body controller: a policy, or one that a package brings."""

    policy: str | None = key(
        None, "file of a policy's contract, or its folder, or what its trainer has exported, null: none"
    )
    name: Annotated[str, OneOf("controller", "name")] | None = key(None, "a controller by name, null: policy")
    options: dict[str, Any] | None = key(None, "given to it by name, null: none")
    digest: str | None = key(None, "of the policy's files, which must be those of a log to run again, null: any")
    left_out: Annotated[tuple[str, ...], BeforeValidator(as_tuple)] = key(
        (), "criteria of the scenario that need a planner, and so are not asked"
    )


class ControlSettings(Group):
    """The commands to the joints; `surefoot.Controller` takes the same keys."""

    output: Literal["torque", "position"] | None = key(
        None, "torques, or targets with gains that the drives follow by themselves, null: torque"
    )
    output_rate: Annotated[int, Field(ge=1, le=100_000), WHOLE, Unit("Hz")] | None = key(
        None, "commands in a second, each held until the next, null: rates.control"
    )
    stiffness: Annotated[_Gain, Unit("1/rad")] | None = key(
        None, "torque of a target per angle over the largest torque of its joint, null: 1"
    )
    damping: Annotated[_Gain, Unit("s/rad")] | None = key(
        None, "torque of a target per speed over the largest torque, null: 0.01"
    )
    gains: dict[str, _Gains] | None = key(
        None,
        "stiffness and damping of joints by regular expressions of their names, over the two keys above, null: none "
        "[N·m/rad, N·m·s/rad]",
    )
    feed_forward: bool | None = key(
        None, "targets come with a torque and a velocity, false: both are in the position, null: true"
    )
    driven_joints: dict[str, _Gains] | None = key(
        None,
        "joints that somebody else drives, by regular expressions of their names; in a simulation drives with these "
        "stiffnesses and dampings hold them where they stand at the start, null: none [N·m/rad, N·m·s/rad]",
    )
    driven_motion: Annotated[float, Field(ge=0, le=1), RADIAN] | None = key(
        None, "half range by which the targets of these joints change every 0.02 s, drawn from the seed, null: 0"
    )
    driven_told: bool | None = key(
        None, "the controller is given the targets of these joints, false: it sees them move, null: true"
    )
    give_way: bool | None = key(None, "joints give way once a fall is sure, false: they are driven on, null: true")
