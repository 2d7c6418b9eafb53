"""The controller of a walking robot: what is measured in, what its joints shall do out; no simulator in it."""

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, replace
from operator import index
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from surefoot.errors import ParameterError
from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.guard import Guard, MisfitError, shown
from surefoot.joints import JointCommand
from surefoot.models.pinocchio import limb_shapes
from surefoot.models.types import RobotDescription
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.readings import Reading, Readings
from surefoot.scenarios.file.control import ControlSettings
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.run.landing import Landing
from surefoot.scenarios.run.output import Output
from surefoot.scenarios.run.planning import FaultSchedule, Measured, Planning, RunFault
from surefoot.scenarios.run.reference import ReferenceMaker
from surefoot.scenarios.run.sensed import Senses, foot_sensing, unsure
from surefoot.scenarios.run.sensing import ESTIMATORS, Estimator, SensorEstimator
from surefoot.scenarios.run.tick import Spent
from surefoot.scenarios.setup.feasible import made_ready
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.parts import TASK, guarded
from surefoot.scenarios.setup.stance import body_of, feet_at
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.similarity import GRAVITY
from surefoot.values import dataclass
from surefoot.wbc.controller import Sole, WholeBodyController
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.falling import GivingWay
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.tasks import TASKS, Task, TaskFactory
from surefoot.wbc.types import Array, RobotState, WbcReport
from surefoot.wbc.zmp import measured_zmp

if TYPE_CHECKING:
    from surefoot.scenarios.run.plant import PlantMaker
    from surefoot.sim.measurement import Measurement


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of the loop that a user may replace.

    Attributes:
        controller: makes the whole-body controller; takes the arguments of `WholeBodyController` by name.
        estimator: makes the state estimator of a walk; None for the one that the scenario names.
        tasks: make tasks of the whole-body QP, which go after the default ones and those that the scenario names.
        plant: makes what moves the robot, a `surefoot.Plant`, of a walk; None for the one that the scenario names. A
            `Controller` has none.
    """

    controller: Callable[..., WholeBodyController] = WholeBodyController
    estimator: Callable[[Walk], Estimator | SensorEstimator] | None = None
    tasks: tuple[TaskFactory, ...] = ()
    plant: "PlantMaker | None" = None

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


class Controller:
    """Estimator, planner and whole-body controller of one robot, under whatever measures it and moves its joints.

        controller = surefoot.Controller("g1", "commanded")
        while walking:
            command = controller.step(readings)

    Its clock is that of what it is given. Readings may come at any rate, late, or not at all for a while; those that
    are older than the last ones change nothing. `surefoot.Simulation` runs this object.

    Args:
        robot: name of a robot, path of a robot file, or a description.
        gait: a scenario, whatever `surefoot.load` takes to find one, or a resolved walk. What it says of the world, of
            pushes and of the true robot has no effect.
        control: keys of the group ``control`` of a scenario, in the place of those of the gait.
        parts: in place of surefoot's own.

    Attributes:
        walk: what is walked, resolved.
        body: the robot in the whole-body controller's terms.
        whole_body: the whole-body controller.
        planning: the planner on its clock.
        posture: configuration in which the walk begins, shape (nq,).
        senses: the estimator.
        state: that controller and planner were given last.
        report: what the whole-body controller did last.

    Raises:
        ScenarioError: the gait cannot be found or walked.
        ParameterError: a part refuses it.
        PartError: a part of others cannot be made.
    """

    def __init__(
        self,
        robot: str | RobotDescription,
        gait: Scenario | Walk | str = "commanded",
        *,
        control: Mapping[str, Any] | None = None,
        parts: Parts | None = None,
    ) -> None:
        self.walk = walk = _walk(robot, gait, control)
        self._parts = parts = parts or Parts()
        self.body = body = body_of(walk.robot)
        self.posture, self._leg = made_ready(walk, body)
        self.whole_body = _whole_body(self, parts)
        self.senses = _senses(walk, parts)
        self._references = ReferenceMaker()
        self._faults = FaultSchedule(walk.faults, walk.rates.control) if walk.faults else None
        self._period = 1.0 / walk.rates.control
        self._output = Output(walk.control, walk.robot, walk.size, walk.rates.control)
        self._next = -math.inf
        self._estimates = walk.sensing.force_estimate
        self._toe = 0.5 * walk.robot.sole_length if walk.gait.heel_off else 0.0
        self._giving_way = GivingWay(body.limits, walk.size)
        self._landed, self._load = (True, True), NO_LOAD
        self._landing: Landing | None = None
        self._begin, self._now = math.nan, -math.inf
        self._torques: TorqueWrench | None = None
        self._command: JointCommand
        self.planning: Planning
        self.state: RobotState
        self.report: WbcReport

        self.reset()

    def reset(self, q: Array | None = None) -> None:
        """Begin the walk anew; its time begins with the next readings, or when the robot stands.

        Args:
            q: configuration that stands on both feet, shape (nq,) [m, -, rad]; None for a robot that hangs or stands
                somewhere: it is held in its posture until both feet carry it.

        Raises:
            ParameterError: the gait cannot be planned from there.
        """
        if self._now >= 0.0:
            self.whole_body, self.senses = _whole_body(self, self._parts), _senses(self.walk, self._parts)
            self._landed, self._load, self._torques = (True, True), NO_LOAD, None
        self._begin, self._now, self._next = math.nan, -math.inf, -math.inf
        self._landing = Landing(self.body, self.posture, self.walk.size) if q is None else None
        if q is not None:
            self._stand(q)

    def _stand(self, q: Array) -> None:
        self.planning = Planning.of(self.walk, self.walk.planner(feet_at(self.body, q), self._leg))

    @property
    def time(self) -> float:
        """Time since the walk began, 0 before [s]."""
        return max(self._now, 0.0)

    @property
    def orders(self) -> Command:
        """What the walk does of what it has been told, in its last plan.

        Raises:
            ParameterError: the planner takes no commands.
        """
        return self.planning.orders

    @property
    def sizes(self) -> Sizes:
        """Of what is logged of it; there are none before the first `reset`."""
        layout = self.whole_body.layout
        horizon, tasks = self.planning.planner.parameters.horizon, self.whole_body.task_layout
        return Sizes(nj=layout.joints, nq=len(self.posture), nv=layout.nv, horizon=horizon, tasks=tasks)

    def step(self, readings: "Readings | Measurement", command: Command | None = None) -> JointCommand:
        """What the joints shall do from now on.

        Args:
            readings: what sensors say; of an estimator that is given the truth, that.
            command: what the walk is to do from its next plan on; None goes on.

        Raises:
            RunFault: the state is not finite, or nothing was measured for too long.
            ParameterError: the command cannot be done.
        """
        if readings.time < self._begin + self._now:
            return self._command
        if self._landing is not None:
            held = self._landing.hold(readings)
            if held is not None:
                return held
            self._stand(self.senses(readings).state.q)
            self.senses, self._landing = _senses(self.walk, self._parts), None
        if self._now < 0.0:
            self._begin = readings.time
        now = readings.time - self._begin
        if command is not None:
            self.planning.command(command, now)
        begin = time.perf_counter()
        self._observe(readings, now)
        state_time = time.perf_counter() - begin
        self.sample, until, plan_time = self.planning.follow(now, self._output.period, self._measured)
        if now < self._next:
            self.spent = Spent(state_time, plan_time)
            return self._command
        if self._output.holds:
            self._next = self._output.after(now)
        reference = self._references.reference(self.planning.plan, until)
        sensing = foot_sensing(self.estimate, self.wrench, self._estimates)
        fails = self._faults is not None and self._faults.active("qp_failure", self.planning.tick(now))
        self.report = report = self.whole_body.update(reference, sensing, fails)
        self.senses.told(reference, report)
        self._landed, self._load = report.active, report.load
        self.spent = Spent(state_time, plan_time, report.build_time, report.solve_time)
        # What falls gives way; the controller goes on, unheard, since estimator and planner take its contacts.
        falling, state = self.planning.plan.status.falling, self.state
        torque = self._giving_way.torque(state.q[7:], state.v[6:]) if falling else report.torque
        self._command = JointCommand(torque)
        if self._output.servo:
            self._command = self._output.command(torque, state.q[7:], state.v[6:], report.acceleration[6:])
        return self._command

    def _observe(self, readings: "Readings | Measurement", now: float) -> None:
        """Find the state and its terms."""
        self.estimate = estimate = self.senses(readings)
        assert estimate.wrench is not None
        self.wrench, state, passed = estimate.wrench, estimate.state, now - self._now
        self._now = now
        if math.isnan(self.wrench.item(2)):
            self.wrench = self._inferred(readings, state, passed)
        if self._faults is not None and self._faults.active("state_nan", self.planning.tick(now)):
            state = RobotState(np.full_like(state.q, np.nan), state.v)
        if not math.isfinite(np.dot(state.q, state.q) + np.dot(state.v, state.v)):
            raise RunFault(f"the measured state is not finite at {now:.3f} s")
        self.state = state
        self.terms: RobotTerms = self.whole_body.observe(state)

    def _inferred(self, readings: "Readings | Measurement", state: RobotState, passed: float) -> Array:
        """Wrenches of soles that feel none, by the torques of the joints, shape (2, 6) [N, N·m]."""
        if self._torques is None:
            self._torques = TorqueWrench(self.body.model, self.body.frames.soles, self._period)
            half = np.zeros((2, 6))
            half[:, 2] = 0.5 * GRAVITY * float(self.walk.robot.mass)
            return half
        given = readings.joint_torque
        torque = given.values if isinstance(given, Reading) else given
        return self._torques.update(state, self._command.torque if math.isnan(torque.item(0)) else torque, passed)

    def _measured(self) -> Measured:
        """What the planner may measure, without noise."""
        terms, wrench = self.terms, self.wrench
        R = terms.sole_rotation
        if terms.compiled is not None and terms.leaning is None:
            soles, yaw, zmp = terms.compiled.feet(wrench, self._toe)
        else:
            soles, yaw = terms.level_soles(self._toe), np.arctan2(R[:, 1, 0], R[:, 0, 0])
            zmp = np.array(measured_zmp(wrench, terms.sole_position, R))
        state = CentroidalState(self._now, terms.com.copy(), terms.com_velocity.copy(), self._lasting())
        feet = FeetState(soles, yaw, self._landed)
        if self.estimate.deviation is not None:
            state, feet = unsure(self.estimate.deviation, state, feet)
        return state, zmp[:2], feet

    def _lasting(self) -> ExternalLoad | None:
        """The load that the controller counted with a tick ago, per mass."""
        load = self._load
        return None if load is NO_LOAD else load.per_mass(load.mass_scale * self.whole_body.terms.model_mass)


def _walk(robot: str | RobotDescription, gait: Scenario | Walk | str, control: Mapping[str, Any] | None) -> Walk:
    """The walk of a robot."""
    if isinstance(gait, Walk):
        return gait
    scenario = load(gait) if isinstance(gait, str) else gait
    if isinstance(robot, str) and robot != scenario.robot:
        if not isinstance(gait, str):
            what = f"a scenario of {scenario.robot} for {robot}"
            right = "give the scenario of this robot, or the name of one to be scaled to it"
            raise ParameterError(("robot",), what, right)
        scenario = load(gait, {"robot": robot, "sized_for": scenario.sized_for or scenario.robot})
    if control is not None:
        try:
            keys = ControlSettings.model_validate(dict(control))
        except ValidationError as error:
            fault = error.errors(include_url=False)[0]
            key = ("control", *fault["loc"])
            raise ParameterError(key, f"{'.'.join(map(str, key))} {fault['input']!r}", fault["msg"]) from None
        scenario = scenario.model_copy(update={"control": keys})
    return resolve(scenario, None if isinstance(robot, str) else robot)


def _senses(walk: Walk, parts: Parts) -> Senses:
    """The estimator that a program hands over, else that which the scenario names."""
    source = walk.sensing.source
    make = parts.estimator or ESTIMATORS[source]
    guard = ESTIMATORS.guard(source) if parts.estimator is None else Guard.of_program("estimator", make)
    with guard.making:
        return Senses(make(walk, **(walk.sensing.options or {})), guard)


def _tasks(controller: Controller, parts: Parts) -> Iterator[Task]:
    """The tasks that the scenario names, then those that a program hands over."""
    body = controller.body
    named = ((TASKS[name], TASKS.guard(name)) for name in controller.walk.tasks)
    for make, guard in (*named, *((make, Guard.of_program("task", make)) for make in parts.tasks)):
        with guard.making:
            task = guarded(make(body.model, body.frames), guard, TASK)
            if not isinstance(task.name, str):
                raise MisfitError(f"has the name {shown(task.name)}, which is no text")
            index(task.size)
            np.asarray(task.weight, dtype=np.float64)
        yield task


def _whole_body(controller: Controller, parts: Parts) -> WholeBodyController:
    walk, body, robot = controller.walk, controller.body, controller.walk.robot
    rate, parameters = walk.control.output_rate or walk.rates.control, walk.controller
    if rate != walk.rates.control:
        # A foot feels for a time, not for a number of commands.
        ticks = max(1, round(parameters.schedule.felt_ticks * rate / walk.rates.control))
        parameters = replace(parameters, schedule=replace(parameters.schedule, felt_ticks=ticks))
    shoulders = robot.joint_indices(robot.roles.arm_swing or ())
    return parts.controller(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, walk.friction),
        limits=body.limits,
        posture=controller.posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / rate,
        parameters=parameters,
        limbs=limb_shapes(robot),
        arm_joints=(shoulders[0], shoulders[1]) if shoulders else None,
        arm_back=robot.roles.arm_back,
        tasks=tuple(_tasks(controller, parts)),
    )
