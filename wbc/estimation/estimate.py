"""The answer of an estimator with its uncertainty, and the plan that the controller gives back to it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from surefoot.wbc.types import Array, RobotState


@dataclass(frozen=True)
class Deviation:
    """Standard deviations of an estimate; zeros for the truth.

    Attributes:
        com: of the CoM relative to the stance foot, world axes, shape (3,) [m].
        com_velocity: world axes, shape (3,) [m/s].
        tilt: of the base's roll and pitch, shape (2,) [rad].
        sole_height: of each sole's height over the ground under it, left first, shape (2,) [m].
        step_height: of the height of one sole over the other, which no height of the ground is in [m].
        force: of the horizontal external force that momentum and wrenches give over the span of the load observer [N].
        moment: of its moment about the CoM [N·m].
    """

    com: Array
    com_velocity: Array
    tilt: Array
    sole_height: Array
    step_height: float
    force: float
    moment: float


@dataclass(frozen=True)
class Estimate:
    """The estimate from the readings of a tick.

    Attributes:
        state: of the robot now.
        wrench: that the ground exerts on each sole, freed of what the sensors add, sole frames, left first, shape
            (2, 6) [N, N·m]; None for that of the readings.
        contact: which soles the ground carries; None where the controller shall decide by the wrench.
        deviation: how sure the estimate is; None where that is not known, which counts as the truth.
        channels: further numbers for the log, by name.
        wrench_age: time since the wrench acted, by latency of the sensors and by filters [s].
    """

    state: RobotState
    wrench: Array | None = None
    contact: tuple[bool, bool] | None = None
    deviation: Deviation | None = None
    channels: Mapping[str, Array] = field(default_factory=dict)
    wrench_age: float = 0.0


@dataclass(frozen=True)
class Planned:
    """The decisions of the controller at a tick, which an estimator is given after it.

    Attributes:
        acceleration: generalised acceleration q'' of the whole-body QP, shape (nv,) [m/s^2, rad/s^2].
        torque: commanded to the joints, shape (nj,) [N·m].
        contact: soles that the QP holds as contacts, left first.
        edge: of each foot that on which it rolls: 1 the toe edge, -1 the heel edge, 0 none, its sole lies flat [-].
    """

    acceleration: Array
    torque: Array
    contact: tuple[bool, bool]
    edge: tuple[int, int]
