"""The closed loop in full physics on one integer clock: measure, plan, control, log, simulate."""

import numpy as np
from numpy.typing import NDArray

from models.types import RobotDescription
from planner.types import CentroidalState, FeetState, PhaseInfo
from scenarios.closed_loop.assembly import Rig, assemble
from scenarios.closed_loop.faults import FaultSchedule
from scenarios.closed_loop.planner_state import PlannerSensing
from scenarios.closed_loop.planning import Planning
from scenarios.closed_loop.reference import whole_body_reference
from scenarios.closed_loop.ticks import RunFault, Watch, refusing, run_ticks
from scenarios.constants import WORLD_FILE
from scenarios.file.planner_setup import square_stance
from scenarios.file.schema import Scenario
from scenarios.file.timeline import run_duration
from scenarios.log import AttachedFile, LogWriter
from scenarios.log.channels import Sizes
from scenarios.metrics.walking import FALLEN_HEIGHT, FALLEN_TILT
from scenarios.progress import End, OnProgress
from scenarios.recording.recorder import Recorder
from scenarios.recording.walk_recorder import TickTiming, WalkRecorder
from scenarios.viewer.body_view import BodyView
from sim.errors import SimulationDiverged
from sim.measurement import Measurement
from wbc.model import RobotTerms
from wbc.types import FootSensing, RobotState
from wbc.zmp import measured_zmp


def simulate(scenario: Scenario, robot: RobotDescription, writer: LogWriter, on_progress: OnProgress) -> End:
    """Run a scenario in full physics.

    Args:
        scenario: what to run.
        robot: its robot.
        writer: gets every boundary crossing.
        on_progress: is told where the run is, every simulated tenth of a second.

    Raises:
        SetupError: robot and gait do not fit together.
        LogError: the log cannot be written.
    """
    with refusing():
        loop = ClosedLoop(scenario, robot, writer)
    return run_ticks(loop, scenario.rates.control, run_duration(scenario), on_progress)


class ClosedLoop:
    """World, planner, controller and recorders of one run.

    Attributes:
        rig: world, controller and planner, to be looked at between ticks.

    Raises:
        ValueError: robot and gait do not fit together.
    """

    def __init__(self, scenario: Scenario, robot: RobotDescription, writer: LogWriter) -> None:
        rates = scenario.rates
        self.rig: Rig = assemble(scenario, robot)
        layout, nq = self.rig.controller.layout, len(robot.joint_names) + 7
        sizes = Sizes(nj=layout.joints, nq=nq, nv=layout.nv, horizon=self.rig.planner.parameters.horizon)
        writer.attach(AttachedFile(WORLD_FILE, "application/xml", self.rig.world.mjcf().encode()))
        self._recorder = Recorder(writer, sizes, robot.torque_limit)
        self._walk_recorder = WalkRecorder(writer, sizes)
        self._view = BodyView(writer, self.rig.world, robot, rates.control)
        self._faults = FaultSchedule(scenario.faults, rates.control)
        sensing = PlannerSensing(scenario, square_stance(scenario))
        self._planning = Planning(self.rig.planner, sensing, self._walk_recorder, self._faults, rates)
        self._rate = rates.control
        self._steps = rates.physics // rates.control
        self._fallen_height = FALLEN_HEIGHT * (scenario.gait.com_height - scenario.errors.com_height)
        self._zero_torque = np.zeros(layout.joints)
        self._landed = (True, True)
        self._toe = 0.5 * robot.sole_length if scenario.gait.heel_off else 0.0

    @property
    def phase(self) -> PhaseInfo:
        """Where the gait stands."""
        return self._planning.phase

    def tick(self, tick: int) -> bool:
        """One control tick; returns whether the robot lies on the ground.

        Raises:
            RunFault: the measured state is not finite, or the simulation diverged.
        """
        watch = Watch.start()
        begin = watch.last
        now, now_ns = tick / self._rate, tick * 1_000_000_000 // self._rate
        world, controller, recorder, planning = self.rig.world, self.rig.controller, self._recorder, self._planning
        measurement = world.measure()
        state = self._sense(measurement, tick)
        terms = controller.observe(state)
        truth = self._true_terms(measurement)
        state_time = watch.lap()
        planner_time = 0.0
        if planning.due(tick):
            self._replan(tick, now_ns, terms, measurement)
            planner_time = watch.lap()
        sample = planning.sampler.sample(now)
        reference = whole_body_reference(planning.plan, sample)
        sensing = FootSensing((float(measurement.wrench[0, 2]), float(measurement.wrench[1, 2])))
        report = controller.update(reference, sensing, self._faults.active("qp_failure", tick))
        self._landed = report.active
        torque = self._zero_torque if self._faults.active("torque_loss", tick) else report.torque
        watch.lap()
        recorder.tick(now_ns, measurement, truth, terms, state, reference, report, torque)
        self._walk_recorder.reference(now_ns, planning.plan, sample)
        fallen = self._fallen(truth, measurement)
        self._view.events(now_ns, measurement, report, planning.plan, fallen)
        self._view.picture(tick, now_ns, measurement, truth, planning.plan, sample)
        log_time = watch.lap()
        self._advance(torque)
        physics_time = watch.lap()
        parts = (state_time, report.build_time, report.solve_time, planner_time, physics_time, log_time)
        self._walk_recorder.timing(now_ns, TickTiming(*parts, watch.last - begin))
        return fallen

    def _sense(self, measurement: Measurement, tick: int) -> RobotState:
        q, v = measurement.q, measurement.v
        if self._faults.active("state_nan", tick):
            q = np.full_like(q, np.nan)
        if not np.isfinite(np.dot(q, q) + np.dot(v, v)):
            raise RunFault(f"the measured state is not finite at {tick / self._rate:.3f} s")
        return RobotState(q, v)

    def _true_terms(self, measurement: Measurement) -> RobotTerms:
        truth = self.rig.truth
        if truth is not self.rig.controller.terms:
            truth.update(measurement.q, measurement.v)
        return truth

    def _replan(self, tick: int, now_ns: int, terms: RobotTerms, measurement: Measurement) -> None:
        R = terms.sole_rotation
        feet = FeetState(terms.level_soles(self._toe), np.arctan2(R[:, 1, 0], R[:, 0, 0]), self._landed)
        state = CentroidalState(tick / self._rate, terms.com.copy(), terms.com_velocity.copy())
        zmp = np.array(measured_zmp(measurement.wrench, terms.sole_position, R)[:2])
        self._planning.update(tick, now_ns, state, zmp, feet)

    def _advance(self, torque: NDArray[np.float64]) -> None:
        try:
            self.rig.world.advance(torque, self._steps)
        except SimulationDiverged as fault:
            raise RunFault(str(fault)) from None

    def _fallen(self, terms: RobotTerms, measurement: Measurement) -> bool:
        low = terms.com[2] - min(terms.sole_position[0, 2], terms.sole_position[1, 2]) < self._fallen_height
        tilted = terms.torso_rotation[2, 2] < np.cos(FALLEN_TILT)
        return bool(low or tilted or measurement.nonfoot_contact)
