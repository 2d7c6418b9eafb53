"""Numbers of a run that its metrics need and no channel carries; they travel in the log's metadata."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from pydantic import TypeAdapter

from scenarios.errors import LogError

RECORD = "run"
"""Name of the metadata record."""

WORLD_FILE = "world.xml"
"""Attachment that holds the simulated world as MJCF, the robot in it."""


@dataclass(frozen=True, slots=True)
class RunConstants:
    """What is fixed during a run.

    Attributes:
        scenario: its name.
        fidelity: full or pendulum.
        seed: its seed.
        steps_planned: footsteps asked for.
        mass: true mass of the robot [kg].
        com_height: true nominal CoM height above the soles [m].
        foot_length: of the soles [m].
        foot_width: of the soles [m].
        control_rate: ticks of the controller [Hz].
        sample_time: of the planner's preview [s].
        joint_names: in the order of the joint arrays.
        torque_limit: by joint [N m].
        position_lower: by joint [rad].
        position_upper: by joint [rad].
        terrain: kind of ground.
        plant: of fidelity pendulum.
        boxes: the solids on the ground plane, each as centre, half sizes [m] and rotation to the world, row by row.
    """

    scenario: str
    fidelity: str
    seed: int
    steps_planned: int
    mass: float
    com_height: float
    foot_length: float
    foot_width: float
    control_rate: int
    sample_time: float
    joint_names: tuple[str, ...]
    torque_limit: tuple[float, ...]
    position_lower: tuple[float, ...]
    position_upper: tuple[float, ...]
    terrain: str
    plant: str = "pendulum"
    boxes: tuple[tuple[float, ...], ...] = ()

    def to_metadata(self) -> dict[str, str]:
        """Write as metadata: JSON by name."""
        return {name: json.dumps(value) for name, value in asdict(self).items()}

    @classmethod
    def from_metadata(cls, records: Mapping[str, Mapping[str, str]], log_name: str) -> "RunConstants":
        """Read back.

        Args:
            records: the metadata of a log.
            log_name: what to call the log in messages.

        Raises:
            LogError: the log does not carry them.
        """
        try:
            values = {name: json.loads(text) for name, text in records[RECORD].items()}
            return TypeAdapter(cls).validate_python(values)
        except (KeyError, TypeError, ValueError, RecursionError):
            raise LogError(f"{log_name}: does not describe a run; give a log that `surefoot run` has written") from None
