"""The whole-body controller: reference and measurement in, joint torques out."""

import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.forces import NO_LOAD
from surefoot.values import dataclass, maker
from surefoot.wbc.arm_swing import ArmSwing
from surefoot.wbc.balance import SupportRegion
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.cone import CONE_ROWS, TOE_DEPTH, Sole
from surefoot.wbc.contacts import ContactSchedule, ContactState
from surefoot.wbc.driven import DrivenRows, without_driven
from surefoot.wbc.dynamics import HardConstraints
from surefoot.wbc.external import LoadObserver
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames, RobotTerms
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.qp import UNBOUNDED, WRENCH_UNIT, QpData, QpLayout, allocate
from surefoot.wbc.separation import Separation
from surefoot.wbc.solvers import EqualityFirst, QpSolution, equalities_only, in_turn
from surefoot.wbc.tasks.default import default_tasks
from surefoot.wbc.tasks.diagonal import ForceDistribution, Posture, Regularisation
from surefoot.wbc.tasks.registry import TaskLayout
from surefoot.wbc.tasks.stack import TaskStack
from surefoot.wbc.tasks.swing import AnkleStops
from surefoot.wbc.tasks.task import Task
from surefoot.wbc.tasks.trunk import HipStops
from surefoot.wbc.types import GRAVITY, Array, FootSensing, RobotState, SolveStatus, WbcReference, WbcReport

ACCEPTED_VIOLATION = 1e-3
"""A solution that breaks a row by more than this (N, N·m, m/s^2) is not used, whatever its solver says."""

FADE, FADE_DAMPING = 0.05, 0.02
"""Time in which the last torque fades out [s], and torque of a joint's damper at 1 rad/s meanwhile over its largest one
[s/rad].

Constants here are the reference robot's; see `surefoot.similarity`."""

_a_report = maker(WbcReport)

# Members are looked up by name at each access.
_SOFTENED = SolveStatus.SOFTENED
_IN_TURN = (SolveStatus.SOLVED, _SOFTENED, SolveStatus.SECOND_SOLVER)


@dataclass(frozen=True, slots=True)
class WbcAnswer:
    """What a solution means for the robot. Arrays are overwritten by the next one.

    Attributes:
        torque: joint torques within their limits, shape (nj,) [N·m].
        acceleration: planned generalised acceleration, shape (nv,) [m/s^2, rad/s^2].
        wrench: planned contact wrenches, in the sole frames, shape (2, 6) [N, N·m].
        task_error: residuals of all tasks before weighting, shape (rows,) [m/s^2, rad/s^2, N, N m].
    """

    torque: Array
    acceleration: Array
    wrench: Array
    task_error: Array


class WholeBodyController:
    """Weighted inverse-dynamics QP, built, solved and interpreted once per control tick.

    Herzog et al., "Momentum control with hierarchical inverse dynamics", Autonomous Robots 2016, in its weighted form,
    with the CoM law of ``surefoot.wbc.balance``. A tick that no solver answers degrades as ``SolveStatus`` says; it
    never raises. ``update`` is a whole tick; its parts can be called one by one:

        terms = controller.observe(state)
        qp = controller.build(terms, reference, contacts)       # qp.copy() survives the next tick
        status, solution = controller.solve(qp)
        answer = controller.interpret(terms, solution)

    Attributes:
        terms: of the state last observed.
        layout: where everything is in the QP.
        qp: the QP, as last built.
        schedule: which contacts the QP holds, from plan and feeling.
        tasks: the weighted tasks.
        driven: rows of joints that somebody else drives; None without such joints.
    """

    def __init__(
        self,
        model: pin.Model,
        frames: BodyFrames,
        sole: Sole,
        limits: JointLimits,
        posture: Array,
        leg_joints: NDArray[np.bool_],
        control_period: float,
        parameters: WbcParameters,
        limbs: pin.GeometryModel | None = None,
        arm_joints: tuple[int, int] | None = None,
        tasks: Sequence[Task] = (),
        arm_back: tuple[float, float] = (1.0, 1.0),
        driven: NDArray[np.bool_] | None = None,
    ) -> None:
        """Build the QP for a robot.

        Args:
            model: the robot, with a free-flyer base.
            frames: what to steer.
            sole: contact geometry and friction.
            limits: of the joints.
            posture: joint positions the upper body returns to, shape (nj,) [rad].
            leg_joints: which joints are leg joints, bool, shape (nj,).
            control_period: time between two updates [s].
            parameters: weights and gains.
            limbs: shapes with the collision pairs that are kept apart; None looks at none.
            arm_joints: which joints are the left and the right shoulder pitch; None for arms that do not swing.
            arm_back: sign of the angles of these that swing the arms back [-].
            driven: which joints somebody else drives, bool, shape (nj,); None for none.
            tasks: others, after the default ones.

        Raises:
            ValueError: a frame does not exist, a sole has no extent, or a task no name of its own, size or weight.
        """
        size, limits = parameters.size, parameters.size.scaled(limits)
        if driven is not None and limbs is not None:
            limbs = without_driven(model, limbs, driven)
        self.terms = RobotTerms(model, frames, WRENCH_UNIT * size.factor("N"))
        self.layout = QpLayout(model.nv, CONE_ROWS, parameters.separation.slots if limbs is not None else 0)
        self.qp: QpData = allocate(self.layout)
        self._separation = (
            Separation(model, limbs, parameters.separation, self.terms.compiled) if limbs is not None else None
        )
        gaps = self.layout.separation
        self._gap_rows = self.qp.A[gaps, : model.nv]
        self._gap_lower = self.qp.bounds_lower[self.layout.variables :][gaps]
        stops = AnkleStops(model, frames, limits), HipStops(model, frames, limits)
        leaning = frames.leaning is not None
        if leaning:
            sole = replace(sole, half_width=TOE_DEPTH * size.length)
        cones, ankles = sole.cones(TOE_DEPTH * size.length), stops[0].columns
        self._tick = CompiledTick(self.terms.compiled) if self.terms.compiled else None
        self._hard = HardConstraints(
            self.qp, self.layout, cones, limits, parameters.contact, ankles, stops[0].rolling, self._tick, leaning
        )
        self._region = SupportRegion(sole.half_length, sole.half_width, parameters.balance.polygon_share)
        self._region_contacts: tuple[tuple[bool, bool], int] | None = None
        swings = arm_joints and parameters.arm_swing and not (driven is not None and driven[list(arm_joints)].any())
        arms = ArmSwing(arm_joints, parameters.arm_swing, arm_back) if arm_joints and swings else None
        weights, gains, toe = parameters.weights, parameters.gains, sole.half_length
        balance, waist = parameters.balance, self.terms.waist
        default = default_tasks(
            weights, gains, balance, self._region, toe, size.length, *stops, waist=waist, leaning=leaning
        )
        diagonal = (
            Regularisation(weights, size.length),
            Posture(weights, gains, posture, leg_joints, arms, driven),
            ForceDistribution(weights, self.terms.wrench_unit),
        )
        self.tasks = TaskStack(self.qp, (*default, *tasks), diagonal, self._tick)
        self.schedule = ContactSchedule(parameters.schedule, self.terms.mass * GRAVITY, control_period)
        self._observer = LoadObserver(self.terms.mass, control_period, size, self.terms.compiled)
        self.driven = None if driven is None or not driven.any() else DrivenRows(self.layout, driven, control_period)
        fixed = None if self.driven is None else self.driven.fixed
        self._solvers = in_turn(parameters.solver, parameters.second_solver, self.layout.soft, fixed)
        if isinstance(self._solvers[0], EqualityFirst):
            self._solvers[0].prepare(self.qp)
        self._limits, self._toe = limits, toe
        self._fading = control_period / (FADE * size.time), FADE_DAMPING * size.time
        self._seen: list[tuple[int, Array]] = []
        self._torque_rows, self._wrench_flat = self.qp.A[self.layout.torque_rows], np.zeros(12)
        wrench, error = self._wrench_flat.reshape(2, 6), np.zeros_like(self.tasks.target)
        self._answer = WbcAnswer(np.zeros(self.layout.joints), np.zeros(self.layout.nv), wrench, error)
        if self._tick is not None:
            self._compile(self._tick)

    @property
    def task_layout(self) -> TaskLayout:
        """Names and sizes of the tasks, in the order of ``WbcReport.task_error``."""
        return self.tasks.layout

    def observe(self, state: RobotState) -> RobotTerms:
        """Take the measured or estimated state of this tick; returns its terms, which the next call overwrites."""
        self.terms.update(state.q, state.v)
        return self.terms

    def update(self, reference: WbcReference, sensing: FootSensing, fail_solvers: bool = False) -> WbcReport:
        """Torques for the state last observed; once per observation, since the load is found from tick to tick.

        Args:
            reference: what to do.
            sensing: what the feet feel.
            fail_solvers: pretend that both QP solvers failed, to exercise the fallback.
        """
        start = time.perf_counter()
        if sensing.wrench is not None:
            load = self._observer.update(self.terms, sensing.wrench, sensing.load_deviation, sensing.wrench_age)
            if load is not NO_LOAD:
                self.terms.bear(load)
            self.schedule.weight = self.terms.mass * GRAVITY
        contacts = self.schedule.update(reference, sensing)
        qp = self.build(self.terms, reference, contacts)
        built = time.perf_counter()
        status, solution = self.solve(qp, fail_solvers)
        answer = self.interpret(self.terms, solution)
        solved = time.perf_counter()
        iterations, violation, dual = 0, math.inf, math.nan
        if solution is not None:
            iterations, violation, dual = solution.iterations, solution.violation, solution.dual_residual
        return _a_report(
            answer.torque, status, iterations, violation, dual, answer.acceleration, answer.wrench, contacts.active,
            contacts.felt, answer.task_error, built - start, solved - built, self.terms.load,
        )  # fmt: skip

    def build(self, terms: RobotTerms, reference: WbcReference, contacts: ContactState) -> QpData:
        """The QP of a state, a reference and contacts, written over the last one.

        The terms of a rolling foot are seen from its toe edge from here on, those of a leaning one from its line (see
        ``RobotTerms.shift_foot``).
        """
        self._shift(terms, reference, contacts)
        holding = (contacts.active, contacts.rolling)
        # The line on which a leaning foot stands moves over its sole.
        if (terms.leaning is not None or holding != self._region_contacts) and np.isfinite(terms.sole_position).all():
            self._region.rebuild(terms.contact_position, terms.contact_rotation, contacts.active, contacts.rolling)
            self._region_contacts = holding
        if self._tick is None or terms is not self.terms:
            self.tasks.write(terms, reference)
            self._hard.write(terms, terms.q, terms.v, contacts, reference.ground_normal, reference.roll[1:])
        else:
            self._tick.refer(reference)
            self.tasks.write_compiled(terms, reference)
            self._hard.write_compiled(contacts)
        if self.driven is not None:
            self.driven.write(self.qp, terms.bias, terms.v)
        if self._separation is not None:
            self._separation.write(terms.data, terms.v, self._gap_rows, self._gap_lower, UNBOUNDED)
        return self.qp

    def solve(self, qp: QpData, fail_solvers: bool = False) -> tuple[SolveStatus, QpSolution | None]:
        """A solution by the first solver whose answer holds, else by the equalities alone; None if there is none.

        What holds no limits at all throws the robot. So before that some of the soft ones are broken.
        """
        if not fail_solvers:
            for status, solver in zip(_IN_TURN, self._solvers, strict=True):
                solution = solver.solve(qp)
                if solution is not None and solution.violation <= ACCEPTED_VIOLATION:
                    # What may break limits has broken none where it answers for a solver that failed.
                    if status is _SOFTENED and qp.violation(solution.x) <= ACCEPTED_VIOLATION:
                        status = SolveStatus.SECOND_SOLVER
                    return status, solution
        solution = equalities_only(qp)
        return (SolveStatus.HELD if solution is None else SolveStatus.EQUALITIES_ONLY), solution

    def interpret(self, terms: RobotTerms, solution: QpSolution | None) -> WbcAnswer:
        """Torque, acceleration, wrenches and task errors of a solution of the QP last built, from the same terms.

        Without a solution the last torque fades; acceleration, wrenches and task errors stay as they were.
        """
        answer = self._answer
        if solution is None:
            self._fade(answer.torque, terms.v)
            return answer
        if self._tick is None or terms is not self.terms:
            self._read(terms, solution.x)
        else:
            self._x[...] = solution.x
            self._read_compiled()
        for foot, to_sole in self._seen:
            answer.wrench[foot] = to_sole @ answer.wrench[foot]
        return answer

    def _read(self, terms: RobotTerms, x: Array) -> None:
        """Fill the answer, with wrenches in the frames of the QP."""
        answer, nv = self._answer, self.layout.nv
        np.matmul(self._torque_rows, x, out=answer.torque)
        np.add(answer.torque, terms.bias[6:], out=answer.torque)
        self._clip(answer.torque)
        answer.acceleration[:] = x[:nv]
        np.multiply(x[nv:], terms.wrench_unit, out=self._wrench_flat)
        answer.task_error[:] = self.tasks.residual(x)

    def _compile(self, tick: CompiledTick) -> None:
        answer, self._x = self._answer, np.zeros(self.layout.variables)
        self._read_compiled = tick.kernels.bind(
            "answer_read",
            terms=tick.terms,
            stack=self.tasks.bound,
            joints=self.layout.joints,
            torque_rows=self._torque_rows,
            torque_limit=np.ascontiguousarray(self._limits.torque, dtype=np.float64),
            x=self._x,
            torque=answer.torque,
            acceleration=answer.acceleration,
            wrench=self._wrench_flat,
            task_error=answer.task_error,
        )

    def _shift(self, terms: RobotTerms, reference: WbcReference, contacts: ContactState) -> None:
        """See a rolling foot from its toe edge, a leaning one from its line, others from their soles."""
        rolling, self._seen = reference.rolling_foot, []
        if rolling < 0 and terms.leaning is None and not terms.is_shifted:
            return
        for foot in (0, 1):
            if foot == rolling and (rolling == contacts.rolling or not contacts.active[rolling]):
                self._seen.append((foot, terms.shift_foot(foot, self._toe, reference.roll[0])))
            elif terms.leaning is not None:
                self._seen.append((foot, terms.shift_foot(foot, 0.0, 0.0)))
            else:
                terms.unshift(foot)

    def _clip(self, torque: Array) -> None:
        np.minimum(torque, self._limits.torque, out=torque)
        np.maximum(torque, -self._limits.torque, out=torque)

    def _fade(self, torque: Array, v: Array) -> None:
        """Fade the last torque out while damping the joints whose velocity is known."""
        rate = np.where(np.isfinite(v[6:]), v[6:], 0.0)
        share, damping = self._fading
        torque += share * (-damping * self._limits.torque * rate - torque)
        self._clip(torque)
