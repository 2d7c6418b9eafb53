"""The planner inside a closed loop: asked on its own clock, its plans and the touchdowns between them logged."""

from planner.plan import WalkPlan
from planner.planner import WalkingPlanner
from planner.sampling import PlanSampler
from planner.types import CentroidalState, FeetState, PhaseInfo, PhaseKind
from scenarios.closed_loop.faults import FaultSchedule
from scenarios.file.schema import Rates
from scenarios.recording.walk_recorder import WalkRecorder


class Planning:
    """Planner, its latest plan, and the record of both.

    Attributes:
        plan: the latest plan; there is none before the first `update`.
        sampler: of the latest plan.
    """

    def __init__(self, planner: WalkingPlanner, recorder: WalkRecorder, faults: FaultSchedule, rates: Rates) -> None:
        self._planner, self._recorder, self._faults = planner, recorder, faults
        self._every = rates.control // rates.planner
        self.plan: WalkPlan
        self.sampler: PlanSampler
        self._started = False

    @property
    def phase(self) -> PhaseInfo:
        """Where the gait stands."""
        return self.plan.phase

    def due(self, tick: int) -> bool:
        """Whether a new plan is to be made at a control tick; the first one is made whatever the faults say."""
        return tick % self._every == 0 and not (self._started and self._faults.active("planner_freeze", tick))

    def update(self, now_ns: int, state: CentroidalState, feet: FeetState) -> None:
        """Plan from a measurement."""
        before = self.plan if self._started else None
        self.plan = plan = self._planner.update(state, feet)
        self.sampler = PlanSampler(plan)
        self._started = True
        self._recorder.plan(now_ns, plan)
        if before is not None and before.phase.kind is PhaseKind.SINGLE and plan.phase.kind is not PhaseKind.SINGLE:
            self._recorder.touchdown(now_ns, before.footsteps[0], feet)
