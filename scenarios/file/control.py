"""The keys of what stands on both ends of a joint: what moves the robot, and what its joints are given."""

from typing import Annotated, Any

from surefoot.scenarios.file.group import Group, key
from surefoot.scenarios.file.names import OneOf


class PlantSettings(Group):
    """What moves the robot: its own simulation, or another simulator or a machine that a package brings."""

    name: Annotated[str, OneOf("plant", "name")] | None = key(
        None, "what is measured and moved, null: mujoco, the simulated world"
    )
    options: dict[str, Any] | None = key(None, "given to it by name, null: none")
