"""The closed loop in full physics: a simulated robot under its whole-body controller, planner and log around it."""

import math
from collections.abc import Callable, Iterator
from dataclasses import fields
from operator import index
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import NO_LOAD, ExternalLoad, Push
from surefoot.guard import Guard, MisfitError, shown
from surefoot.models.pinocchio import limb_shapes, pinocchio_model
from surefoot.planner.plan import PlanSample, PlanSampler, WalkPlan
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.scenarios.judge.body import lies
from surefoot.scenarios.log import AttachedFile, LogWriter
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.estimation import EstimationRecorder
from surefoot.scenarios.record.foxglove.views import BodyView
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.record.walk import WalkRecorder
from surefoot.scenarios.run.planning import FaultSchedule, RunFault
from surefoot.scenarios.run.reference import ReferenceMaker
from surefoot.scenarios.run.sensed import Senses, foot_sensing, unsure
from surefoot.scenarios.run.sensing import ESTIMATORS, Estimator, SensorEstimator
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.run.tick import Look
from surefoot.scenarios.setup.feasible import made_ready
from surefoot.scenarios.setup.hardware import refuse_unread
from surefoot.scenarios.setup.parts import TASK, guarded
from surefoot.scenarios.setup.stance import (
    Body,
    body_of,
    disturbed,
    feet_at,
    frames_of,
    pressed,
)
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.drives import IDEAL, Drives
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.measurement import Measurement
from surefoot.sim.world import World
from surefoot.values import dataclass
from surefoot.wbc.controller import Sole, WholeBodyController
from surefoot.wbc.falling import GivingWay
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.statics import LEVER, standing_torque
from surefoot.wbc.tasks import TASKS, Task, TaskFactory
from surefoot.wbc.types import RobotState, WbcReport
from surefoot.wbc.zmp import measured_zmp

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of the loop that a user may replace.

    Attributes:
        controller: makes the whole-body controller; takes the arguments of `WholeBodyController` by name.
        estimator: makes the state estimator of a walk; None for the one that the scenario names.
        tasks: make tasks of the whole-body QP, which go after the default ones and those that the scenario names.
    """

    controller: Callable[..., WholeBodyController] = WholeBodyController
    estimator: Callable[[Walk], Estimator | SensorEstimator] | None = None
    tasks: tuple[TaskFactory, ...] = ()

    @classmethod
    def of(cls, **chosen: Any) -> "Parts":
        """Parts of which None stands for surefoot's own."""
        return cls(**{name: part for name, part in chosen.items() if part is not None})

    def given(self) -> dict[str, object]:
        """Those that are not surefoot's own, by name."""
        own = Parts()
        return {
            e.name: getattr(self, e.name) for e in fields(self) if getattr(self, e.name) is not getattr(own, e.name)
        }


def full_loop(walk: Walk, writer: LogWriter, parts: Parts | None = None) -> ClosedLoop:
    """Put the parts of one run together, with the robot standing at its start.

    Controller and planner believe in the robot as described; the simulated one differs by the scenario's errors.

    Args:
        walk: what to run.
        writer: gets every boundary crossing.
        parts: what a user replaces.

    Raises:
        ValueError: a part refuses its parameters, e.g. a start posture out of reach.
    """
    parts = parts or Parts()
    body = body_of(walk.robot)
    posture, leg = made_ready(walk, body)
    q = pressed(disturbed(posture, walk, body), walk.size.length)
    world = World(walk.true_robot, walk.ground.true_terrain, walk.rates.physics, walk.pushes, walk.size, _drives(walk))
    torque = standing_torque(body.model, body.frames, q, LEVER * walk.size.length)
    world.reset(q, torque=torque)
    controller = _controller(walk, body, posture, parts)
    planner = walk.planner(feet_at(body, q), leg)
    layout = controller.layout
    sizes = Sizes(
        nj=layout.joints, nq=len(q), nv=layout.nv, horizon=planner.parameters.horizon, tasks=controller.task_layout
    )
    writer.attach(AttachedFile(WORLD_FILE, "application/xml", world.mjcf().encode()))
    senses = _senses(walk, world, parts)
    body_recorder, recorder = Recorder(writer, sizes, walk.robot.torque_limit), WalkRecorder(writer, sizes)
    view = BodyView(writer, world, walk.robot, walk.rates.control)
    sensed = EstimationRecorder(writer, sizes) if senses.suite is not None else None
    walker = SimulatedRobot(walk, world, controller, senses, body.limits, body_recorder, view, sensed)
    return ClosedLoop.of(walk, walker, planner, recorder)


class SimulatedRobot:
    """The robot in MuJoCo, its estimator and its whole-body controller; a `Walker`.

    Args:
        walk: what is run.
        world: reset to the start.
        controller: of the robot.
        senses: give the state that the controller gets.
        limits: of the joints.
        recorder: of its channels.
        view: of what MCAP viewers show.
        sensed: record what sensors say and what is made of it; None for an estimator that senses nothing.

    Attributes:
        world: the simulated world.
        controller: the whole-body controller.
        measurement: of this tick; its arrays are overwritten by the next.
        state: that the controller was given.
        report: what the controller did.
    """

    def __init__(
        self,
        walk: Walk,
        world: World,
        controller: WholeBodyController,
        senses: Senses,
        limits: JointLimits,
        recorder: Recorder,
        view: BodyView,
        sensed: EstimationRecorder | None = None,
    ) -> None:
        self.world, self.controller, self._senses = world, controller, senses
        self._recorder, self._view, self._sensed = recorder, view, sensed
        self._references = ReferenceMaker()
        # The controller's terms are those of the true robot in its true state where nothing is believed or estimated.
        known = senses.is_truth and walk.true_robot is walk.robot
        self._own_truth = None if known else RobotTerms(pinocchio_model(walk.true_robot), frames_of(walk.robot))
        self._faults = FaultSchedule(walk.faults, walk.rates.control)
        self._rate = walk.rates.control
        self._steps = walk.rates.physics // walk.rates.control
        self._nominal_height = walk.true_com_height
        self._zero_torque = np.zeros(controller.layout.joints)
        self._landed, self._load = (True, True), NO_LOAD
        self._estimates = walk.sensing.force_estimate
        self._giving_way = GivingWay(limits, walk.size)
        self._toe = 0.5 * walk.robot.sole_length if walk.gait.heel_off else 0.0
        self.measurement: Measurement
        self.state: RobotState
        self.report: WbcReport

    def sense(self, tick: int, now: float) -> None:
        """See `Walker`."""
        self.measurement = measurement = self.world.measure()
        self._estimate = estimate = self._senses(measurement, tick)
        self._wrench = measurement.wrench if estimate.wrench is None else estimate.wrench
        state = estimate.state
        if self._faults.active("state_nan", tick):
            state = RobotState(np.full_like(state.q, np.nan), state.v)
        if not math.isfinite(np.dot(state.q, state.q) + np.dot(state.v, state.v)):
            raise RunFault(f"the measured state is not finite at {tick / self._rate:.3f} s")
        self.state = state
        self._terms = self.controller.observe(state)
        self._truth = self._own_truth or self._terms
        if self._own_truth is not None:
            self._own_truth.update(measurement.q, measurement.v)

    def measured(self, now: float) -> tuple[CentroidalState, Array, FeetState]:
        """See `Walker`."""
        terms, wrench = self._terms, self._wrench
        R = terms.sole_rotation
        if terms.compiled is not None and terms.leaning is None:
            soles, yaw, zmp = terms.compiled.feet(wrench, self._toe)
        else:
            soles, yaw = terms.level_soles(self._toe), np.arctan2(R[:, 1, 0], R[:, 0, 0])
            zmp = np.array(measured_zmp(wrench, terms.sole_position, R))
        state = CentroidalState(now, terms.com.copy(), terms.com_velocity.copy(), self._lasting())
        feet = FeetState(soles, yaw, self._landed)
        if self._estimate.deviation is not None:
            state, feet = unsure(self._estimate.deviation, state, feet)
        return state, zmp[:2], feet

    def _lasting(self) -> ExternalLoad | None:
        """The load that the controller counted with a tick ago, per mass."""
        load = self._load
        return None if load is NO_LOAD else load.per_mass(load.mass_scale * self.controller.terms.model_mass)

    def act(self, tick: int, plan: WalkPlan, sample: PlanSample) -> tuple[float, float]:
        """See `Walker`."""
        self._reference = self._references.reference(plan, sample)
        sensing = foot_sensing(self._estimate, self._wrench, self._estimates)
        report = self.controller.update(self._reference, sensing, self._faults.active("qp_failure", tick))
        self._senses.told(self._reference, report)
        self._landed, self._load = report.active, report.load
        # Who falls gives way; the controller goes on, unheard, since estimator and planner take its contacts.
        torque = self._giving_way.torque(self.state.q[7:], self.state.v[6:]) if plan.status.falling else report.torque
        self._torque = self._zero_torque if self._faults.active("torque_loss", tick) else torque
        self.report = report
        return report.build_time, report.solve_time

    def record(self, now_ns: int, sample: PlanSample) -> None:
        """See `Walker`."""
        truth, terms = self._truth, self._terms
        self._recorder.tick(now_ns, self.measurement, truth, terms, sample, self.report, self._torque)
        if self._sensed is not None:
            forces = self.measurement.wrench[:, 2]
            self._sensed.tick(now_ns, self._senses.readings, self._estimate, self._wrench, terms, truth, forces)

    def fallen(self, sample: PlanSample) -> bool:
        """See `Walker`."""
        terms = self._truth
        soles = terms.sole_position
        height = terms.com.item(2) - min(soles.item(2), soles.item(5))
        tilt = math.acos(min(terms.torso_rotation.item(2, 2), 1.0))
        return bool(lies(height, self._nominal_height, tilt, self.measurement.nonfoot_contact))

    def draw(self, tick: int, now_ns: int, plan: WalkPlan, sample: PlanSample, fallen: bool) -> None:
        """See `Walker`."""
        self._view.events(now_ns, self.measurement, self.report, plan, fallen)
        self._view.picture(tick, now_ns, self.measurement, self._truth, plan, sample)

    def advance(self, now: float, sampler: PlanSampler) -> None:
        """See `Walker`."""
        try:
            self.world.advance(self._torque, self._steps)
        except SimulationDiverged as fault:
            raise RunFault(str(fault)) from None

    def look(self) -> Look:
        """See `Walker`."""
        truth = self._truth
        zmp = measured_zmp(self.measurement.wrench, truth.sole_position, truth.sole_rotation)
        com, velocity = truth.com.copy(), truth.com_velocity.copy()
        return Look(com, velocity, np.array(zmp[:2]), self.state, self.report, self.measurement)

    def push(self, push: Push) -> None:
        """See `Walker`."""
        self.world.push(push)


def _drives(walk: Walk) -> Drives | None:
    """The motors of a walk, if they do anything but what is commanded."""
    errors = walk.hardware.drives
    return None if errors == IDEAL else Drives(walk.robot, errors, walk.rates.physics, walk.seed)


def _senses(walk: Walk, world: World, parts: Parts) -> Senses:
    """The estimator that a program hands over, else that which the scenario names."""
    source = walk.sensing.source
    make = parts.estimator or ESTIMATORS[source]
    guard = ESTIMATORS.guard(source) if parts.estimator is None else Guard.of_program("estimator", make)
    with guard.making:
        senses = Senses(make(walk, **(walk.sensing.options or {})), guard, world, walk)
    if senses.suite is None:
        refuse_unread(walk.sensing)
    return senses


def _tasks(walk: Walk, body: Body, parts: Parts) -> Iterator[Task]:
    """The tasks that the scenario names, then those that a program hands over."""
    named = ((TASKS[name], TASKS.guard(name)) for name in walk.tasks)
    for make, guard in (*named, *((make, Guard.of_program("task", make)) for make in parts.tasks)):
        with guard.making:
            task = guarded(make(body.model, body.frames), guard, TASK)
            if not isinstance(task.name, str):
                raise MisfitError(f"has the name {shown(task.name)}, which is no text")
            index(task.size)
            np.asarray(task.weight, dtype=np.float64)
        yield task


def _controller(walk: Walk, body: Body, posture: Array, parts: Parts) -> WholeBodyController:
    robot = walk.robot
    shoulders = robot.joint_indices(robot.roles.arm_swing or ())
    return parts.controller(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, walk.friction),
        limits=body.limits,
        posture=posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / walk.rates.control,
        parameters=walk.controller,
        limbs=limb_shapes(robot),
        arm_joints=(shoulders[0], shoulders[1]) if shoulders else None,
        arm_back=robot.roles.arm_back,
        tasks=tuple(_tasks(walk, body, parts)),
    )
