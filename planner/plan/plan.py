"""The plan that the planner hands over at every tick, and the references that follow from it at any instant."""

from dataclasses import dataclass, field
from typing import Protocol

from numpy import bool_
from numpy.typing import NDArray

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.rolling import FootRoll
from surefoot.planner.swing.sway import Pelvis
from surefoot.planner.swing.trajectory import SwingTrajectory
from surefoot.planner.types import (
    Array,
    Balance,
    CentroidalState,
    FeetState,
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
            level: a foot that rolls turns about an edge of it.
        rolls: pitch of the foot that leaves the ground next or has just left it, and of that which lands; of one foot
            at most one at an instant.
        status: how the plan was made.
        balance: what is left to the body, and what of it the plan makes use of.
        pelvis: how it turns and lists against the heading of the feet; None for a gait that moves it not.
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
    rolls: tuple[FootRoll, ...]
    status: PlanStatus
    balance: Balance = field(default_factory=Balance)
    pelvis: Pelvis | None = None


class Planner(Protocol):
    """The planner as a closed loop sees it; anything with this can take the place of `planner.planner.WalkingPlanner`.

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
