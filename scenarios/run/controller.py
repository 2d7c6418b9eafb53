"""The controller of a walking robot: what is measured in, what its joints shall do out; no simulator in it."""

import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.joints import JointCommand
from surefoot.models.types import RobotDescription
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.readings import Reading, Readings
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.run.assembly import Parts, resolved_walk, senses_of, whole_body_of
from surefoot.scenarios.run.landing import Landing
from surefoot.scenarios.run.output import Output
from surefoot.scenarios.run.planning import FaultSchedule, Measured, Planning, RunFault
from surefoot.scenarios.run.reference import planned
from surefoot.scenarios.run.sensed import foot_sensing, with_deviations
from surefoot.scenarios.run.tick import Spent
from surefoot.scenarios.setup.feasible import made_ready
from surefoot.scenarios.setup.robot.body import body_of, feet_at
from surefoot.scenarios.setup.walk import Walk
from surefoot.similarity import GRAVITY
from surefoot.wbc.body.falling import GivingWay
from surefoot.wbc.body.model import VERTICAL, RobotTerms
from surefoot.wbc.body.soles import yaws
from surefoot.wbc.contact.zmp import measured_zmp
from surefoot.wbc.qp.driven import DrivenRows
from surefoot.wbc.types import NONE_TOUCHES, Array, RobotState, WbcReport

if TYPE_CHECKING:
    from surefoot.sim.measurement import Measurement
    from surefoot.wbc.estimation.torques import TorqueWrench


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
        self.walk = walk = resolved_walk(robot, gait, control)
        self._parts = parts = parts or Parts()
        self.body = body = body_of(walk.robot)
        self.posture, self._leg = made_ready(walk, body)
        self.whole_body = whole_body_of(walk, body, self.posture, parts)
        self.senses = senses_of(walk, parts)
        self._faults = FaultSchedule(walk.faults, walk.rates.control) if walk.faults else None
        self._period = 1.0 / walk.rates.control
        self._output = Output(walk.control, walk.robot, walk.size, walk.rates.control)
        self._next = -math.inf
        self._estimates = walk.sensing.force_estimate
        half_length = 0.5 * walk.robot.sole_length
        self._toe = half_length if walk.gait.heel_off else 0.0
        self._heel = -half_length if walk.gait.heel_strike else 0.0
        self._normals = VERTICAL
        self._giving_way = None if walk.control.give_way is False else GivingWay(body.limits, walk.size)
        self._landed, self._arriving, self._load = (True, True), NONE_TOUCHES, NO_LOAD
        self._landing: Landing | None = None
        self._stands = False
        self._begin, self._now = math.nan, -math.inf
        self._torques: TorqueWrench | None = None
        self._command = JointCommand(np.zeros(0))
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
            self.whole_body, self.senses = (
                whole_body_of(self.walk, self.body, self.posture, self._parts),
                senses_of(self.walk, self._parts),
            )
            self._landed, self._arriving = (True, True), NONE_TOUCHES
            self._load, self._torques = NO_LOAD, None
        self._begin, self._now, self._next = math.nan, -math.inf, -math.inf
        self._landing, self._stands = None, q is not None
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
        """Commands that the walk follows in its last plan.

        Raises:
            ParameterError: the planner takes no commands.
        """
        return self.planning.orders

    @property
    def sizes(self) -> Sizes:
        """Sizes of what is logged of it; there are none before the first `reset`."""
        layout = self.whole_body.layout
        horizon, tasks = self.planning.planner.parameters.horizon, self.whole_body.task_layout
        nf = len(self.walk.robot.couplings)
        return Sizes(nj=layout.joints, nq=len(self.posture), nv=layout.nv, horizon=horizon, tasks=tasks, nf=nf)

    def step(
        self,
        readings: "Readings | Measurement",
        command: Command | None = None,
        driven_joints: JointCommand | None = None,
    ) -> JointCommand:
        """Compute the command of the joints from now on.

        Args:
            readings: what sensors say; of an estimator that is given the truth, that.
            command: what the walk is to do from its next plan on; None goes on.
            driven_joints: what those joints are given that somebody else drives, by the key ``control.driven_joints``;
                other joints in it mean nothing. None where nobody tells.

        Raises:
            RunFault: the state is not finite, or nothing was measured for too long.
            ParameterError: the command cannot be done.
        """
        if readings.time < self._begin + self._now:
            return self._command
        if not self._stands and (held := self._held(readings)) is not None:
            return held
        if self._now < 0.0:
            self._begin = readings.time
        now = readings.time - self._begin
        if command is not None:
            self.planning.command(command, now)
        begin = time.perf_counter()
        self._observe(readings, now)
        state_time = time.perf_counter() - begin
        planning = self.planning
        plan_time = planning.follow(now, self._measured) if now >= planning.due else 0.0
        # The command acts until the next one, so that it follows the plan in the middle of that time. The state is
        # compared with the plan of now.
        middle = now + 0.5 * self._output.period
        self.sample, reference = planned(planning.sampler, now, middle)
        if self._toe or self._heel:
            self._normals = reference.ground_normal
        if now < self._next:
            self.spent = Spent(state_time, plan_time)
            return self._command
        if self._output.holds:
            self._next = self._output.after(now)
        soon = self._output.holds or self._arriving is not NONE_TOUCHES
        touching = self._touching() if soon else NONE_TOUCHES
        sensing = foot_sensing(self.estimate, self.wrench, self._estimates, self._torques, touching)
        fails = self._faults is not None and self._faults.active("qp_failure", planning.tick(now))
        if self.whole_body.driven is not None:
            self._drive(self.whole_body.driven, driven_joints)
        self.report = report = self.whole_body.update(reference, sensing, fails)
        if self.senses.listens:
            self.senses.feed_back(reference, report)
        self._landed, self._load = report.active, report.load
        # A named tuple's own constructor goes through Python.
        self.spent = tuple.__new__(Spent, (state_time, plan_time, report.build_time, report.solve_time))
        self._decide(report)
        return self._command

    def _held(self, readings: "Readings | Measurement") -> JointCommand | None:
        """The command that holds the posture until the feet stand; None from the tick on in which they do."""
        self._landing = self._landing or Landing(self.body, self.posture, self.walk.size)
        held = self._landing.hold(readings)
        if held is None:
            self._stand(self.senses(readings).state.q)
            self.senses, self._stands = senses_of(self.walk, self._parts), True
        return held

    def _decide(self, report: WbcReport) -> None:
        """Make the command of a report.

        A robot that falls gets the torques of `GivingWay`. The controller still runs, since estimator and planner use
        its contacts.
        """
        state, torque = self.state, report.torque
        if self._giving_way is not None and self.planning.plan.status.falling:
            torque = self._giving_way.torque(state.q[7:], state.v[6:])
        if self._output.servo:
            self._command = self._output.command(torque, state.q[7:], state.v[6:], report.acceleration[6:])
        elif self._command.torque is not torque:
            self._command = JointCommand(torque)

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
        self.terms: RobotTerms = self.whole_body.observe(state)
        if not self.terms.is_finite:
            raise RunFault(f"the measured state is not finite at {now:.3f} s")
        self.state = state

    def _touching(self) -> tuple[bool, bool]:
        """Mark the soles that count as standing before anything is felt of them, (left, right).

        Within a command that is held a foot lands and stands. Commands that swung it on all the while pushed the robot
        off its plan. A foot with which the planner has ended a single support is as good as on the ground.
        """
        arriving, self._arriving = self._arriving, NONE_TOUCHES
        if self.planning.plan.swing is None:
            return arriving
        if not self._output.holds:
            return NONE_TOUCHES
        soles = self.terms.level_soles(0.0, self._heel, self._normals)
        return comes_down(self.planning.plan, self.terms, soles, self._now, self._output.period)

    def _drive(self, driven: DrivenRows, command: JointCommand | None) -> None:
        """Give the whole-body controller the command of the joints that are not its own."""
        if command is None:
            driven.tell(None)
            return
        q, v, servo = self.state.q[7:], self.state.v[6:], command.servo
        torque = command.torque_at(q + self._output.period * v, v)
        driven.tell(torque, *((servo.stiffness, servo.damping) if servo is not None else ()))

    def _inferred(self, readings: "Readings | Measurement", state: RobotState, passed: float) -> Array:
        """Wrenches of soles that feel none, by the torques of the joints, shape (2, 6) [N, N·m]."""
        if self._torques is None:
            from surefoot.wbc.estimation.parameters import SensorNoise
            from surefoot.wbc.estimation.torques import TorqueWrench

            self._torques = TorqueWrench(
                self.body.model, self.body.frames.soles, self._period, SensorNoise(), held=not self._output.servo
            )
            half = np.zeros((2, 6))
            half[:, 2] = 0.5 * GRAVITY * float(self.walk.robot.mass)
            return half
        given = readings.joint_torque
        torque = given.values if isinstance(given, Reading) else given
        return self._torques.update(state, self._command.torque if math.isnan(torque.item(0)) else torque, passed)

    def _measured(self) -> Measured:
        """The state that the planner may measure, without noise."""
        terms, wrench = self.terms, self.wrench
        zmp = measured_zmp(wrench, terms.sole_position, terms.sole_rotation)
        state = CentroidalState(self._now, terms.com.copy(), terms.com_velocity.copy(), self._lasting())
        if False in self._landed and self.planning.plan.balance.catching:
            arrives = self._output.period + self.planning.planner.parameters.freeze_catching
            soles = terms.level_soles(0.0, self._heel, self._normals)
            self._arriving = comes_down(self.planning.plan, terms, soles, self._now, arrives, due=True)
        soles = terms.level_soles(self._toe, self._heel or self._toe, self._normals)
        feet = FeetState(soles, yaws(terms.sole_rotation), self._landed, arriving=self._arriving)
        if self.estimate.deviation is not None:
            state, feet = with_deviations(self.estimate.deviation, state, feet)
        return state, np.array(zmp[:2]), feet

    def _lasting(self) -> ExternalLoad | None:
        """The load that the controller counted with a tick ago, per mass."""
        load = self._load
        return None if load is NO_LOAD else load.per_mass(load.mass_scale * self.whole_body.terms.model_mass)


def comes_down(
    plan: WalkPlan, terms: RobotTerms, soles: Array, now: float, time: float, due: bool = False
) -> tuple[bool, bool]:
    """Mark the soles that come to the planned ground in no more than so long, (left, right).

    Args:
        plan: that is followed.
        terms: of the robot now.
        soles: centres of its soles if they were level, shape (2, 3) [m].
        now: instant [s].
        time: how long [s].
        due: whether one whose touchdown is planned by then does so as well, however slowly it comes down now.
    """
    if plan.swing is None:
        return NONE_TOUCHES
    foot = int(plan.swing.foot)
    height = float(soles[foot, 2] - plan.footsteps[0].position[2])
    speed = float(terms.sole_rotation[foot, 2] @ terms.sole_velocity[foot, :3])
    comes = speed < 0.0 and height + speed * time < 0.0
    comes = comes or (due and plan.swing.touchdown_time - now <= time)
    return comes and foot == 0, comes and foot == 1
