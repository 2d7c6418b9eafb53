"""What the planner hands over at every tick, and the references that follow from it at any instant."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from numpy import bool_
from numpy.typing import NDArray

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.swing.trajectory import SwingTrajectory
from surefoot.planner.types import (
    Array,
    Balance,
    CentroidalState,
    FeetState,
    Foot,
    Footstep,
    PhaseInfo,
    PlanStatus,
)


@dataclass(frozen=True)
class WalkPlan:
    """A plan from the measured state at `time` over N samples; world frame.

    Attributes:
        time: instant of the measurement [s].
        sample_time: length of a sample [s].
        com: CoM positions at samples 0..N, shape (N + 1, 3) [m].
        com_velocity: shape (N + 1, 3) [m/s].
        com_acceleration: shape (N + 1, 3) [m/s^2].
        jerk: horizontal CoM jerk of each sample, shape (N, 2) [m/s^3].
        zmp: ZMP that this motion has, shape (N + 1, 2) [m].
        zmp_offset: what the swing leg adds to it (see `planner.references.leg_offset`), shape (N + 1, 2) [m].
        zmp_reference: ZMP that the footsteps define, shape (N + 1, 2) [m].
        stiffness: λ of c'' = λ (c - (zmp - zmp_offset)), shape (N + 1,) [1/s^2].
        omega: ω of the DCM, ω' = ω² - λ, shape (N + 1,) [1/s].
        phase: where the plan stands in the gait.
        contacts: planned contacts (left, right) from each sample on, shape (N + 1, 2) [-].
        load_left: planned share of the weight on the left foot, shape (N + 1,) [-]; the right one has the rest.
        support_polygon: hull of the planned soles now, anticlockwise, shape (v, 2) [m].
        inner_polygon: the same of the soles shrunk to the ZMP margin (90 %), shape (v, 2) [m].
        footholds: where the left and the right foot stand now, or stood last.
        footsteps: the next footsteps with number and time, at most three.
        swing: trajectory of the swing foot in single support, otherwise None. It is that of the sole as if it were
            level: a foot that rolls turns about its toe edge.
        roll: pitch of the foot that leaves the ground next or has just left it, None for one that stays level.
        status: how the plan was made.
        balance: what is left to the body, and what of it the plan makes use of.
    """

    time: float
    sample_time: float
    com: Array
    com_velocity: Array
    com_acceleration: Array
    jerk: Array
    zmp: Array
    zmp_offset: Array
    zmp_reference: Array
    stiffness: Array
    omega: Array
    phase: PhaseInfo
    contacts: NDArray[bool_]
    load_left: Array
    support_polygon: Array
    inner_polygon: Array
    footholds: tuple[Footstep, Footstep]
    footsteps: tuple[Footstep, ...]
    swing: SwingTrajectory | None
    roll: FootRoll | None
    status: PlanStatus
    balance: Balance = field(default_factory=Balance)


class Planner(Protocol):
    """What a closed loop asks of a planner; anything with this can take the place of `planner.planner.WalkingPlanner`.

    It is asked once per `parameters.sample_time`, from time 0 on, and each plan has `parameters.horizon` samples;
    nothing else is read of its parameters.
    """

    @property
    def parameters(self) -> PlannerParameters:
        """Gives sample time and horizon of the plans."""

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        """Plan from a measurement.

        Args:
            state: measured CoM.
            feet: measured feet.
        """


PLACES: Mapping[str, tuple[int, int]] = {
    "zmp_reference": (0, 2),
    "zmp_offset": (2, 2),
    "omega": (4, 1),
    "stiffness": (5, 1),
    "load_left": (6, 1),
    "com": (7, 3),
    "swing": (10, 6),
    "com_velocity": (16, 3),
    "swing_velocity": (19, 6),
    "com_acceleration": (25, 3),
    "swing_acceleration": (28, 6),
    "pendulum_zmp": (34, 2),
    "zmp": (36, 2),
    "dcm": (38, 2),
}
"""Where quantities begin in the numbers of a sample, and how many numbers each has."""

POINT = 40
"""Numbers of a sample, which are those of all its quantities: seven linear functions of time, then motions [-]."""


def in_point(name: str) -> slice:
    """Where a quantity is in the numbers of a sample."""
    first, size = PLACES[name]
    return slice(first, first + size)


class _Vector:
    """A quantity of a sample that is an array: the part of its point that holds it."""

    def __init__(self, name: str) -> None:
        self._place = in_point(name)

    def __get__(self, sample: "PlanSample", owner: type) -> Array:
        part: Array = sample.point[self._place]
        return part


class _Number:
    """A quantity of a sample that is a number."""

    def __init__(self, name: str) -> None:
        self._place = in_point(name).start

    def __get__(self, sample: "PlanSample", owner: type) -> float:
        return sample.point.item(self._place)


@dataclass(frozen=True, slots=True)
class PlanSample:
    """References at one instant; world frame, arrays are fresh at every call.

    Attributes:
        time: instant [s].
        point: the numbers that the quantities below are parts of, shape (POINT,) [SI].
        contacts: planned contacts (left, right).
        swing_foot: the swinging foot, or None; the swing arrays are zero without one.
        com: CoM position, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        com_acceleration: shape (3,) [m/s^2].
        zmp: ZMP of this motion, shape (2,) [m].
        zmp_offset: what the swing leg adds to it, shape (2,) [m].
        pendulum_zmp: the ZMP less that: c - c''/λ, which drives the CoM, shape (2,) [m].
        zmp_reference: ZMP that the footsteps define, shape (2,) [m].
        dcm: ξ = c + c'/ω, shape (2,) [m].
        omega: ω [1/s].
        stiffness: λ [1/s^2].
        load_left: planned share of the weight on the left foot [-].
        swing: swing sole x, y, z [m], yaw, pitch, roll [rad], shape (6,).
        swing_velocity: shape (6,) [m/s, rad/s].
        swing_acceleration: shape (6,) [m/s^2, rad/s^2].
    """

    time: float
    point: Array
    contacts: tuple[bool, bool]
    swing_foot: Foot | None

    com = _Vector("com")
    com_velocity = _Vector("com_velocity")
    com_acceleration = _Vector("com_acceleration")
    zmp = _Vector("zmp")
    zmp_offset = _Vector("zmp_offset")
    pendulum_zmp = _Vector("pendulum_zmp")
    zmp_reference = _Vector("zmp_reference")
    dcm = _Vector("dcm")
    omega = _Number("omega")
    stiffness = _Number("stiffness")
    load_left = _Number("load_left")
    swing = _Vector("swing")
    swing_velocity = _Vector("swing_velocity")
    swing_acceleration = _Vector("swing_acceleration")
