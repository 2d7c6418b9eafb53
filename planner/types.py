"""Values that cross the planner's boundary. World frame, SI units; arrays are float64."""

import math
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from surefoot.similarity import GRAVITY as GRAVITY

Array = NDArray[np.float64]


class Foot(IntEnum):
    """Which foot; the value indexes every (2, ...) array of feet."""

    LEFT = 0
    RIGHT = 1

    @property
    def other(self) -> "Foot":
        """The opposite foot."""
        return Foot(1 - self)

    @property
    def side(self) -> float:
        """+1 for the left foot, -1 for the right one: which way is outward, to the left counted positive."""
        return 1.0 - 2.0 * self


class PhaseKind(IntEnum):
    """Support phase."""

    STAND = 0
    DOUBLE = 1
    SINGLE = 2


def _upwards() -> Array:
    return np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Footstep:
    """A foothold.

    Attributes:
        foot: the foot that stands here.
        position: sole centre in the world frame, shape (3,) [m].
        yaw: heading of the sole about the world's z axis [rad].
        normal: unit normal of the ground that the sole lies flat on, in the world frame, shape (3,) [-].
    """

    foot: Foot
    position: Array
    yaw: float
    normal: Array = field(default_factory=_upwards)


@dataclass(frozen=True, slots=True)
class FootstepPlan:
    """Footholds of a whole walk as they are nominally planned, in the world frame.

    Row 0 is the start foothold of the foot that moves first, row 1 that of the other foot (the stance foot of step 1),
    row i + 1 is footstep i.

    Attributes:
        feet: which foot each row belongs to, length n.
        position: sole centres, shape (n, 3) [m].
        yaw: headings, unwrapped, shape (n,) [rad].
        normal: unit normals of the ground, shape (n, 3) [-].
    """

    feet: tuple[Foot, ...]
    position: Array
    yaw: Array
    normal: Array

    @property
    def steps(self) -> int:
        """Number of steps of the walk."""
        return len(self.feet) - 2

    def footstep(self, row: int) -> Footstep:
        """The foothold of a row."""
        return Footstep(self.feet[row], self.position[row], float(self.yaw[row]), self.normal[row])


@dataclass(frozen=True, slots=True)
class LastingForce:
    """A horizontal force that goes on acting on the body, per mass of that; world frame.

    Attributes:
        force: x and y, shape (2,) [m/s^2].
        moment: of it about the CoM, its x and y, shape (2,) [m^2/s^2].
    """

    force: Array
    moment: Array


@dataclass(frozen=True, slots=True)
class CentroidalState:
    """What the planner is told of the body at one instant.

    Attributes:
        time: instant [s].
        com: CoM position, shape (3,) [m].
        com_velocity: CoM velocity, shape (3,) [m/s].
        lasting: force that goes on acting on it; None for none.
        deviation: standard deviations of the CoM's horizontal position and velocity, zero for the truth [m, m/s].
    """

    time: float
    com: Array
    com_velocity: Array
    lasting: LastingForce | None = None
    deviation: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class FeetState:
    """What the planner is told of the feet at one instant.

    Attributes:
        position: sole centres in the world frame, shape (2, 3) [m], left first.
        yaw: sole headings, shape (2,) [rad].
        contact: which feet feel the ground, (left, right).
        height_deviation: standard deviations of the soles' heights over the ground, zero for the truth [m].
    """

    position: Array
    yaw: Array
    contact: tuple[bool, bool]
    height_deviation: tuple[float, float] = (0.0, 0.0)


class SolverStatus(IntEnum):
    """How the jerk of a plan came about; higher is worse."""

    SOLVED = 0
    """The first solver solved both axes."""
    SECOND_SOLVER = 1
    """The first solver failed on an axis and the second one solved it."""
    HELD = 2
    """Both solvers failed on an axis: its previous jerk sequence was shifted and kept."""


@dataclass(frozen=True, slots=True)
class PlanStatus:
    """How a plan was made.

    Attributes:
        solver: the worse status of the two axes.
        zmp_slack: violation of the ZMP box that the optimum accepts, shape (2,) for the plan frame's axes [m].
        terminal_slack: violation of the terminal DCM bound, shape (2,) [m].
        infeasible: the profile's hard constraints had no solution; it was softened by the slack told here.
        age: number of ticks since the last plan in which both axes were solved; 0 for a fresh one.
        late_touchdown: ticks for which the phase clock has waited for the touchdown.
        early_touchdown: the swing foot landed before its time; its foothold is fixed, the clock is not moved.
        falling: no step will save the body any more, as far as the planner can tell.
    """

    solver: SolverStatus
    zmp_slack: Array
    terminal_slack: Array
    infeasible: bool
    age: int
    late_touchdown: int
    early_touchdown: bool
    falling: bool = False


@dataclass(frozen=True, slots=True)
class Balance:
    """What is left to the body, and what of it a plan makes use of; NaN from a planner that does not tell.

    Attributes:
        planned: how far the DCM is inside what the CoP alone captures, all steps where and when they are planned, or
            inside the support where none is to come; negative outside, by the worse axis [m].
        movable: the same where the steps to come may be moved as far as legs, and what may be adapted, let them [m].
        shift: by how much the next landing is moved from where it nominally is, world frame, shape (2,) [m].
        delay: how much later than nominally it is made to come [s].
        outside: plans on end in which the DCM has been farther outside `movable` than a robot that can be saved.
    """

    planned: float = math.nan
    movable: float = math.nan
    shift: Array = field(default_factory=lambda: np.full(2, math.nan))
    delay: float = math.nan
    outside: int = 0


@dataclass(frozen=True, slots=True)
class PhaseInfo:
    """Where a plan stands in the gait.

    Attributes:
        kind: support phase.
        stance: the supporting foot in single support, otherwise None.
        step: number of the step being swung (single support) or last landed (otherwise); 0 before the first.
        elapsed: time since the phase began, without the time for which the clock waited [s].
        duration: length of the phase, infinite for the final standing [s].
        leads_to: number of the step being swung, or whose foot leaves the ground at its end; 0 for none.
        left: time until it ends, which is not what its duration leaves while the clock hurries or slows down [s].
    """

    kind: PhaseKind
    stance: Foot | None
    step: int
    elapsed: float
    duration: float
    leads_to: int
    left: float

    @property
    def landed(self) -> int:
        """Number of the step that landed last, 0 before the first."""
        return self.step - (self.kind is PhaseKind.SINGLE)


@dataclass(frozen=True, slots=True)
class PlannedFootstep:
    """A footstep to come.

    Attributes:
        step: its number in the walk, from 1.
        footstep: where it lands as planned now.
        touchdown_time: when it lands by the phase clock [s].
    """

    step: int
    footstep: Footstep
    touchdown_time: float
