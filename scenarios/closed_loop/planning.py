"""The planner inside a closed loop: it measures and plans on its own clock, and all of that is logged."""

import numpy as np
from numpy.typing import NDArray

from planner.plan import WalkPlan
from planner.planner import WalkingPlanner
from planner.sampling import PlanSampler
from planner.types import CentroidalState, FeetState, PhaseInfo, PhaseKind
from scenarios.closed_loop.faults import FaultSchedule
from scenarios.closed_loop.planner_state import PlannerSensing
from scenarios.file.schema import Rates
from scenarios.recording.walk_recorder import WalkRecorder


class Planning:
    """Planner, its sensing, its latest plan, and the record of all.

    Attributes:
        plan: the latest plan; there is none before the first `update`.
        sampler: of the latest plan.
    """

    def __init__(
        self,
        planner: WalkingPlanner,
        sensing: PlannerSensing,
        recorder: WalkRecorder,
        faults: FaultSchedule,
        rates: Rates,
    ) -> None:
        self._planner, self._sensing, self._recorder, self._faults = planner, sensing, recorder, faults
        self._every = rates.control // rates.planner
        self.plan: WalkPlan
        self.sampler: PlanSampler
        self._started = False

    @property
    def phase(self) -> PhaseInfo:
        """Where the gait stands."""
        return self.plan.phase

    def due(self, tick: int) -> bool:
        """Whether the planner measures at a control tick."""
        return tick % self._every == 0

    def update(self, tick: int, now_ns: int, state: CentroidalState, zmp: NDArray[np.float64], feet: FeetState) -> None:
        """Measure and plan; a frozen planner only measures, but the first plan is made whatever the faults say.

        Args:
            tick: control tick.
            now_ns: its time [ns].
            state: CoM without noise, as the planner's robot model has it.
            zmp: ZMP without noise, shape (2,) [m].
            feet: the feet, which are measured without noise.
        """
        before = self.plan if self._started else None
        sensed = self._sensing.sense(state, zmp, before)
        self._recorder.planner_state(now_ns, sensed)
        if self._started and self._faults.active("planner_freeze", tick):
            return
        self.plan = plan = self._planner.update(sensed.given, feet)
        self.sampler = PlanSampler(plan)
        self._started = True
        self._recorder.plan(now_ns, plan)
        if before is not None and before.phase.kind is PhaseKind.SINGLE and plan.phase.kind is not PhaseKind.SINGLE:
            self._recorder.touchdown(now_ns, before.footsteps[0], feet)
