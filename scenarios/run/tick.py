"""The view of a control tick: of what walks, and of a simulation that is stepped from outside."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import PlanSample
from surefoot.planner.types import PhaseInfo, PhaseKind
from surefoot.sim.measurement import Measurement
from surefoot.wbc.types import RobotState, WbcReport

Array = NDArray[np.float64]


class Spent(NamedTuple):
    """Wall-clock time that deciding took in one control tick.

    Attributes:
        state: to find the state and its terms [s].
        plan: to plan; zero where no plan was due [s].
        build: to build the whole-body QP [s].
        solve: to solve it and to make torques of it [s].
    """

    state: float = 0.0
    plan: float = 0.0
    build: float = 0.0
    solve: float = 0.0


@dataclass(frozen=True, slots=True)
class Look:
    """A look at a walker after a step; arrays may be overwritten by the next one.

    Attributes:
        com: true CoM, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        zmp: true ZMP, shape (2,) [m]; NaN in flight.
        state: state that the controller was given; None without one, as are the following.
        report: what the controller did.
        measurement: what the sensors said.
    """

    com: Array
    com_velocity: Array
    zmp: Array
    state: RobotState | None = None
    report: WbcReport | None = None
    measurement: Measurement | None = None


@dataclass(frozen=True, slots=True, repr=False)
class Tick:
    """The events of one control tick; its arrays are its own.

    Attributes:
        time: begin of the tick [s].
        com: true CoM, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        zmp: true ZMP, shape (2,) [m]; NaN in flight.
        phase: where it is in its gait, as planned, or as felt of a robot without a plan.
        planned: the plan that is followed, and its references at this instant; None without a planner.
        fell: whether the robot has fallen, now or before.
        state: state that the controller was given; None on a pendulum.
        report: what the whole-body controller did, its torques and contact wrenches; None on a pendulum.
        measurement: what the sensors said, and the true state; None on a pendulum.
    """

    time: float
    com: Array
    com_velocity: Array
    zmp: Array
    phase: PhaseInfo
    planned: tuple[WalkPlan, PlanSample] | None
    fell: bool
    state: RobotState | None
    report: WbcReport | None
    measurement: Measurement | None

    @property
    def plan(self) -> WalkPlan:
        """The plan that is followed.

        Raises:
            AttributeError: there is none, since another controller has the planner's seat.
        """
        return self._found()[0]

    @property
    def reference(self) -> PlanSample:
        """References of the plan at this instant; AttributeError if another controller has the planner's seat."""
        return self._found()[1]

    def _found(self) -> tuple[WalkPlan, PlanSample]:
        if self.planned is None:
            raise AttributeError("nothing is planned, since a controller has the seat of the planner")
        return self.planned

    def __repr__(self) -> str:
        """A line: when, where in the gait, where the CoM is."""
        phase, (x, y, z) = self.phase, self.com.tolist()
        where = {PhaseKind.STAND: "standing", PhaseKind.DOUBLE: "double support"}.get(phase.kind, "single support")
        fallen = ", fallen" if self.fell else ""
        return f"<Tick {self.time:.3f} s, {where}, step {phase.step}, CoM ({x:.3f}, {y:.3f}, {z:.3f}) m{fallen}>"
