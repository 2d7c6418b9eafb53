"""The closed loop in full physics on one integer clock: measure, plan, control, log, simulate."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.models.belief import with_com_raised, with_mass_scaled
from surefoot.models.pinocchio import limb_shapes, pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia
from surefoot.planner.plan import Planner
from surefoot.planner.types import CentroidalState, FeetState, PhaseInfo
from surefoot.scenarios.file.schema import BeliefErrors, Scenario
from surefoot.scenarios.judge.walking import FALLEN_HEIGHT, FALLEN_TILT
from surefoot.scenarios.log import AttachedFile, LogWriter
from surefoot.scenarios.loop.planning import Planning, whole_body_reference
from surefoot.scenarios.loop.sensing import PlannerSensing
from surefoot.scenarios.loop.skeleton import End, FaultSchedule, OnProgress, RunFault, Watch, refusing, run_ticks
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.foxglove.views import BodyView
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.record.walk import TickTiming, WalkRecorder
from surefoot.scenarios.setup.gait import push_time, run_duration
from surefoot.scenarios.setup.ground import terrain_of, true_terrain_of
from surefoot.scenarios.setup.planner import planner_parameters, square_stance, walking_planner
from surefoot.scenarios.setup.stance import Body, body_of, disturbed, feet_at, pressed, start_posture
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.measurement import Measurement
from surefoot.sim.pushes import Push
from surefoot.sim.world import World
from surefoot.wbc.controller import Sole, WbcParameters, WholeBodyController
from surefoot.wbc.leg_mass import LinkMass, leg_mass
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.statics import standing_torque
from surefoot.wbc.types import FootSensing, RobotState
from surefoot.wbc.zmp import measured_zmp

Array = NDArray[np.float64]

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""


@dataclass(frozen=True, slots=True)
class Rig:
    """Everything that one run needs.

    Attributes:
        world: the simulated robot, reset to its start.
        truth: terms of the simulated robot, for the record; the controller's own when its model is right.
        controller: the whole-body controller.
        planner: the walking planner.
    """

    world: World
    truth: RobotTerms
    controller: WholeBodyController
    planner: Planner


def assemble(scenario: Scenario, robot: RobotDescription) -> Rig:
    """Build world, controller and planner, with the robot standing at its start.

    Controller and planner believe in the robot as described; the simulated one differs by the scenario's errors.

    Raises:
        ValueError: a part refuses its parameters, e.g. a start posture out of reach; one sentence says which and why.
    """
    body, terrain = body_of(robot), terrain_of(scenario)
    posture = start_posture(scenario, body)
    q = pressed(disturbed(posture, scenario, body))
    actual = true_robot(scenario.errors, robot)
    world = World(actual, true_terrain_of(scenario), scenario.rates.physics, pushes(scenario, robot))
    world.reset(q, torque=standing_torque(body.model, body.frames, q))
    controller = WholeBodyController(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, believed_friction(scenario)),
        limits=body.limits,
        posture=posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / scenario.rates.control,
        parameters=WbcParameters(),
        limbs=limb_shapes(robot, body.model),
    )
    parameters = planner_parameters(scenario, leg_inertia(body, posture))
    truth = controller.terms if actual is robot else RobotTerms(pinocchio_model(actual), body.frames)
    return Rig(world, truth, controller, walking_planner(scenario, robot, terrain, feet_at(body, q), parameters))


def true_robot(errors: BeliefErrors, robot: RobotDescription) -> RobotDescription:
    """The robot as it is; itself when nothing about its mass is believed wrongly."""
    if errors.com_height != 0.0:
        robot = with_com_raised(robot, -errors.com_height)
    if errors.mass_scale != 1.0:
        robot = with_mass_scaled(robot, 1.0 / errors.mass_scale)
    return robot


def believed_friction(scenario: Scenario) -> float:
    """Friction coefficient that the controller counts on."""
    return max(scenario.terrain.friction + scenario.errors.friction, LEAST_BELIEVED_FRICTION)


def leg_inertia(body: Body, q: Array) -> LegInertia:
    """The robot's legs as the planner sees them, from its start posture q, shape (nq,)."""
    leg = leg_mass(body.model, body.frames, q, body.leg_joints)
    chain = LegChain(
        hip_half_width=leg.hip_half_width,
        trunk=leg.trunk,
        thigh=_link(leg.thigh),
        shank=_link(leg.shank),
        foot_mass=leg.foot_mass,
        foot_centre=leg.foot_centre,
        ankle=leg.ankle,
    )
    return LegInertia(leg.ratio, chain)


def _link(link: LinkMass) -> Link:
    return Link(link.length, link.mass, link.centre, link.inertia)


def pushes(scenario: Scenario, robot: RobotDescription) -> tuple[Push, ...]:
    """The scenario's pushes with their times and bodies resolved; a push without a body acts on the torso."""
    return tuple(
        Push(push_time(scenario.gait, p), p.duration, np.array(p.force), p.body or robot.torso_body)
        for p in scenario.pushes
    )


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
