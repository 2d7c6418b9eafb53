"""The closed loop on one integer clock: measure, plan, control, log, simulate."""

import time
from dataclasses import dataclass

import numpy as np

from models.types import RobotDescription
from planner.plan import WalkPlan
from planner.sampling import PlanSample, PlanSampler
from planner.types import CentroidalState, FeetState, PhaseKind
from scenarios.assembly import Rig, assemble
from scenarios.faults import FaultSchedule
from scenarios.log import LogWriter
from scenarios.log.channels import Sizes
from scenarios.metrics.walking import FALLEN_HEIGHT, FALLEN_TILT
from scenarios.progress import End, OnProgress, Progress
from scenarios.recorder import Recorder, TickTiming
from scenarios.reference import whole_body_reference
from scenarios.schema import Scenario
from scenarios.timeline import run_duration
from sim.errors import SimulationDiverged
from sim.measurement import Measurement
from wbc.model import RobotTerms
from wbc.types import FootSensing, RobotState, WbcReport

_PHASE_NAMES = {PhaseKind.STAND: "standing", PhaseKind.DOUBLE: "double support", PhaseKind.SINGLE: "single support"}

AFTER_FALL = 0.3
"""How long a run goes on after a fall, so that the log shows it [s]."""


def simulate(scenario: Scenario, robot: RobotDescription, writer: LogWriter, on_progress: OnProgress) -> End:
    """Run a scenario in full physics.

    Args:
        scenario: what to run.
        robot: its robot.
        writer: gets every boundary crossing.
        on_progress: is told where the run is, every simulated tenth of a second.

    Raises:
        ValueError: robot and gait do not fit together.
        LogError: the log cannot be written.
    """
    return ClosedLoop(scenario, robot, writer).run(on_progress)


@dataclass(slots=True)
class _Watch:
    """Splits the wall-clock time of a tick."""

    last: float

    def lap(self) -> float:
        now = time.perf_counter()
        passed = now - self.last
        self.last = now
        return passed


class ClosedLoop:
    """World, planner, controller and recorder of one run."""

    def __init__(self, scenario: Scenario, robot: RobotDescription, writer: LogWriter) -> None:
        rates = scenario.rates
        self._rig: Rig = assemble(scenario, robot)
        layout, nq = self._rig.controller.layout, len(robot.joint_names) + 7
        sizes = Sizes(nj=layout.joints, nq=nq, nv=layout.nv, horizon=scenario.planner.horizon)
        self._recorder = Recorder(writer, sizes, robot.torque_limit)
        self._faults = FaultSchedule(scenario.faults, rates.control)
        self._rate, self._ticks = rates.control, round(run_duration(scenario) * rates.control)
        self._steps = rates.physics // rates.control
        self._planner_every = rates.control // rates.planner
        self._fallen_height = FALLEN_HEIGHT * scenario.gait.com_height
        self._zero_torque = np.zeros(layout.joints)
        self._landed = (True, True)
        self._plan: WalkPlan | None = None
        self._sampler: PlanSampler | None = None

    def run(self, on_progress: OnProgress) -> End:
        """Run to the end, to a fall or to a fault."""
        started = time.perf_counter()
        end_tick, end = self._ticks, End("completed", self._ticks / self._rate)
        tick = 0
        try:
            while tick < end_tick:
                if self._tick(tick) and end.kind == "completed":
                    end = End("fall", tick / self._rate, f"the robot fell at {tick / self._rate:.3f} s")
                    end_tick = min(end_tick, tick + round(AFTER_FALL * self._rate))
                tick += 1
                if tick % (self._rate // 10 or 1) == 0:
                    on_progress(self._progress(tick, time.perf_counter() - started))
        except _NotFinite as fault:
            return End("fault", tick / self._rate, f"{fault} at {tick / self._rate:.3f} s")
        except SimulationDiverged as fault:
            return End("fault", tick / self._rate, str(fault))
        return end

    def _tick(self, tick: int) -> bool:
        """One control tick; returns whether the robot lies on the ground."""
        watch = _Watch(time.perf_counter())
        begin = watch.last
        now, now_ns = tick / self._rate, tick * 1_000_000_000 // self._rate
        world, controller, recorder = self._rig.world, self._rig.controller, self._recorder
        measurement = world.measure()
        state = self._sense(measurement, tick)
        terms = controller.observe(state)
        state_time = watch.lap()
        if tick % self._planner_every == 0 and not (self._plan and self._faults.active("planner_freeze", tick)):
            self._replan(now, now_ns, terms)
        plan, sampler = self._plan, self._sampler
        assert plan is not None and sampler is not None
        sample = sampler.sample(now)
        planner_time = watch.lap()
        reference = whole_body_reference(plan, sample)
        sensing = FootSensing((float(measurement.wrench[0, 2]), float(measurement.wrench[1, 2])))
        report = controller.update(reference, sensing, self._faults.active("qp_failure", tick))
        self._landed = report.active
        torque = self._zero_torque if self._faults.active("torque_loss", tick) else report.torque
        watch.lap()
        recorder.body(now_ns, measurement, terms)
        recorder.estimate(now_ns, terms, state.q, state.v, sample.omega)
        recorder.contact(now_ns, measurement, terms, reference, report)
        recorder.reference(now_ns, plan, sample)
        recorder.control(now_ns, report, torque)
        log_time = watch.lap()
        fallen = self._fallen(terms, measurement)
        world.advance(torque, self._steps)
        physics_time = watch.lap()
        recorder.timing(now_ns, self._timing(report, state_time, planner_time, physics_time, log_time, watch.last - begin))
        return fallen

    def _sense(self, measurement: Measurement, tick: int) -> RobotState:
        q, v = measurement.q, measurement.v
        if self._faults.active("state_nan", tick):
            q = np.full_like(q, np.nan)
        if not np.isfinite(np.dot(q, q) + np.dot(v, v)):
            raise _NotFinite("the measured state is not finite")
        return RobotState(q, v)

    def _replan(self, now: float, now_ns: int, terms: RobotTerms) -> None:
        R = terms.sole_rotation
        feet = FeetState(terms.sole_position.copy(), np.arctan2(R[:, 1, 0], R[:, 0, 0]), self._landed)
        before = self._plan
        plan = self._rig.planner.update(CentroidalState(now, terms.com.copy(), terms.com_velocity.copy()), feet)
        self._plan, self._sampler = plan, PlanSampler(plan)
        self._recorder.plan(now_ns, plan)
        if before is not None and before.phase.kind is PhaseKind.SINGLE and plan.phase.kind is not PhaseKind.SINGLE:
            self._recorder.touchdown(now_ns, before.footsteps[0], terms)

    def _fallen(self, terms: RobotTerms, measurement: Measurement) -> bool:
        low = terms.com[2] - min(terms.sole_position[0, 2], terms.sole_position[1, 2]) < self._fallen_height
        tilted = terms.torso_rotation[2, 2] < np.cos(FALLEN_TILT)
        return bool(low or tilted or measurement.nonfoot_contact)

    def _timing(
        self, report: WbcReport, state: float, planner: float, physics: float, log: float, tick: float
    ) -> TickTiming:
        return TickTiming(state, report.build_time, report.solve_time, planner, physics, log, tick)

    def _progress(self, tick: int, wall: float) -> Progress:
        assert self._plan is not None
        phase, now = self._plan.phase, tick / self._rate
        name = _PHASE_NAMES[phase.kind]
        if phase.kind is PhaseKind.SINGLE:
            name = f"{name}, step {phase.step}"
        return Progress(now, self._ticks / self._rate, name, now / wall if wall > 0.0 else 0.0)


class _NotFinite(ArithmeticError):
    """The measured state is no state."""
