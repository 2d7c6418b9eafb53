"""The whole-body controller: reference and measurement in, joint torques out."""

import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.forces import NO_LOAD
from surefoot.wbc.answer import AnswerReader
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.body.separation import Separation
from surefoot.wbc.contact.cone import CONE_ROWS, TOE_DEPTH, Sole
from surefoot.wbc.contact.contacts import ContactSchedule, ContactState
from surefoot.wbc.contact.external import LoadObserver
from surefoot.wbc.dynamics import HardConstraints
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.qp.data import UNBOUNDED, WRENCH_UNIT, QpData, QpLayout, allocate
from surefoot.wbc.qp.driven import DrivenRows, without_driven
from surefoot.wbc.qp.solvers import QpSolution, QpSolver, equalities_only, in_turn
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.arm_swing import ArmSwing
from surefoot.wbc.tasks.balance import SupportRegion
from surefoot.wbc.tasks.default import default_tasks
from surefoot.wbc.tasks.diagonal import ForceDistribution, Posture, Regularisation
from surefoot.wbc.tasks.knees import Knees, StanceKnees
from surefoot.wbc.tasks.registry import TaskLayout
from surefoot.wbc.tasks.stack import TaskStack
from surefoot.wbc.tasks.swing import AnkleStops
from surefoot.wbc.tasks.task import Task
from surefoot.wbc.tasks.trunk import HipStops
from surefoot.wbc.types import (
    GRAVITY,
    Array,
    FootSensing,
    RobotState,
    SolveStatus,
    WbcAnswer,
    WbcReport,
)

ACCEPTED_VIOLATION = 1e-3
"""A solution that breaks a row by more than this (N, N·m, m/s^2) is not used, whatever its solver says."""


# Members are looked up by name at each access.
_SOLVED, _SOFTENED = SolveStatus.SOLVED, SolveStatus.SOFTENED
_IN_TURN = (_SOLVED, _SOFTENED, _SOFTENED, SolveStatus.SECOND_SOLVER)


class WholeBodyController:
    """Weighted inverse-dynamics QP, built, solved and interpreted once per control tick.

    Herzog et al., "Momentum control with hierarchical inverse dynamics", Autonomous Robots 2016, in its weighted form,
    with the CoM law of ``surefoot.wbc.tasks.balance``. A tick that no solver answers degrades as ``SolveStatus`` says;
    it never raises. ``update`` is a whole tick; its parts can be called one by one:

        terms = controller.observe(state)
        qp = controller.build(terms, reference, contacts)       # qp.copy() survives the next tick
        status, solution = controller.solve(qp)
        answer = controller.interpret(terms, solution)

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
        knees: those of the legs; None for legs of which none is known.
        tasks: others, after the default ones.

    Attributes:
        terms: of the state last observed.
        layout: where everything is in the QP.
        qp: the QP, as last built.
        schedule: which contacts the QP holds, from plan and feeling.
        tasks: the weighted tasks.
        driven: rows of joints that somebody else drives; None without such joints.
        region: where the commanded ZMP may lie.
        solvers: in the order in which they are asked.

    Raises:
        ValueError: a frame does not exist, a sole has no extent, or a task no name of its own, size or weight.
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
        knees: Knees | None = None,
    ) -> None:
        size, limits = parameters.size, parameters.size.scaled(limits)
        if driven is not None and limbs is not None:
            limbs = without_driven(model, limbs, driven)
        leaning = frames.leaning is not None
        if leaning:
            sole = replace(sole, half_width=TOE_DEPTH * size.length)
        self.terms = RobotTerms(model, frames, WRENCH_UNIT * size.factor("N"))
        self.layout = QpLayout(model.nv, CONE_ROWS, parameters.separation.slots if limbs is not None else 0)
        self.qp: QpData = allocate(self.layout)
        self._separation = Separation(model, pin.GeometryModel() if limbs is None else limbs, parameters.separation)
        self._separation.look_into(self.terms.data)
        gaps = self.layout.separation
        self._gap_rows = self.qp.A[gaps, : model.nv]
        self._gap_lower = self.qp.bounds_lower[self.layout.variables :][gaps]
        ankles, cones = AnkleStops(model, frames, limits), sole.cones(TOE_DEPTH * size.length)
        self._hard = HardConstraints(self.qp, self.layout, cones, limits, parameters.contact, ankles, leaning)
        self.region = SupportRegion(sole.half_length, sole.half_width, parameters.balance.polygon_share)
        self._region_contacts: tuple[tuple[bool, bool], tuple[int, int]] | None = None
        self._contacts: ContactState | None = None
        edges, hips = (sole.half_length, sole.half_width), HipStops(model, frames, limits)
        default = default_tasks(parameters, self.region, edges, ankles, hips, self.terms.waist, leaning)
        arms = _swinging(arm_joints, arm_back, parameters, driven)
        diagonal = (
            Regularisation(parameters.weights, size.length),
            Posture(parameters.weights, parameters.gains, posture, leg_joints, arms, driven),
            ForceDistribution(parameters.weights, self.terms.wrench_unit),
        )
        straight = () if knees is None or not parameters.knees.weight else (StanceKnees(parameters.knees, knees),)
        self.tasks = TaskStack(self.qp, (*default, *straight, *tasks), diagonal)
        self.schedule = ContactSchedule(parameters.schedule, self.terms.mass * GRAVITY, control_period)
        self._observer = LoadObserver(self.terms.mass, control_period, size)
        self.driven = None if driven is None or not driven.any() else DrivenRows(self.layout, driven, control_period)
        fixed = None if self.driven is None else self.driven.fixed
        self._half_length = sole.half_length
        self._seen: list[tuple[int, Array]] = []
        self._reader = AnswerReader(self.qp, self.layout, self.tasks, limits.torque, control_period, size)
        self.solvers: tuple[QpSolver, ...] = in_turn(
            parameters.solver, parameters.second_solver, self.layout.soft, fixed
        )

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
        start, terms = time.perf_counter(), self.terms
        if sensing.wrench is not None:
            load = self._observer.update(terms, sensing.wrench, sensing.load_deviation, sensing.wrench_age)
            if load is not NO_LOAD:
                terms.bear(load)
            self.schedule.weight = terms.mass * GRAVITY
        contacts = self.schedule.update(reference, sensing)
        qp = self.build(terms, reference, contacts)
        built = time.perf_counter()
        status, solution = self.solve(qp, fail_solvers)
        answer = self.interpret(terms, solution)
        iterations, violation, dual = 0, math.inf, math.nan
        if solution is not None:
            iterations, violation, dual = solution.iterations, solution.violation, solution.dual_residual
        return WbcReport(
            answer.torque, status, iterations, violation, dual, answer.acceleration, answer.wrench, contacts.active,
            contacts.felt, contacts.edge, answer.task_error, built - start, time.perf_counter() - built, terms.load,
        )  # fmt: skip

    def build(self, terms: RobotTerms, reference: WbcReference, contacts: ContactState) -> QpData:
        """The QP of a state, a reference and contacts, written over the last one.

        The terms of a rolling foot are seen from its edge from here on, those of a leaning one from its line (see
        ``RobotTerms.shift_foot``).
        """
        rolls = reference.edge[0] != 0 or reference.edge[1] != 0
        if rolls or self._seen or terms.is_shifted or terms.leaning is not None:
            self._shift(terms, reference, contacts)
        if contacts is not self._contacts or terms.leaning is not None:
            self._hold(terms, contacts)
        self.tasks.write(terms, reference)
        self._hard.write(terms, reference, contacts)
        self._separation.write(terms.data, terms.v, self._gap_rows, self._gap_lower, UNBOUNDED)
        if self.driven is not None:
            self.driven.write(self.qp, terms.bias, terms.v)
        return self.qp

    def _hold(self, terms: RobotTerms, contacts: ContactState) -> None:
        """Stand on other contacts than those of the tick before."""
        holding = (contacts.active, contacts.edge)
        # The line on which a leaning foot stands moves over its sole.
        if terms.leaning is not None or holding != self._region_contacts:
            if not np.isfinite(terms.sole_position).all():
                return
            self.region.rebuild(terms.contact_position, terms.contact_rotation, contacts.active, contacts.edge)
            self._region_contacts = holding
        self._contacts = contacts

    def solve(self, qp: QpData, fail_solvers: bool = False) -> tuple[SolveStatus, QpSolution | None]:
        """A solution by the first solver whose answer holds, else by the equalities alone; None if there is none.

        What holds no limits at all throws the robot. So before that some of the soft ones are broken. If that is not
        enough, soles may slide, lift or turn: a sole that its load tears off the ground cannot be held.
        """
        for status, solver in zip(_IN_TURN, () if fail_solvers else self.solvers, strict=False):
            solution = solver.solve(qp)
            if solution is not None and solution.violation <= ACCEPTED_VIOLATION:
                # A solver that may break limits has broken none if its solution meets all of them: it stands for one
                # that failed.
                if status is _SOFTENED and qp.violation(solution.x) <= ACCEPTED_VIOLATION:
                    status = SolveStatus.SECOND_SOLVER
                return status, solution
        solution = equalities_only(qp)
        return (SolveStatus.HELD if solution is None else SolveStatus.EQUALITIES_ONLY), solution

    def interpret(self, terms: RobotTerms, solution: QpSolution | None) -> WbcAnswer:
        """Torque, acceleration, wrenches and task errors of a solution of the QP last built, from the same terms.

        Without a solution the last torque fades; acceleration, wrenches and task errors stay as they were.
        """
        reader = self._reader
        if solution is None:
            reader.fade(terms.v)
        else:
            reader.read(terms, solution.x)
            if self._seen:
                reader.see_soles(self._seen)
        return reader.answer

    def _shift(self, terms: RobotTerms, reference: WbcReference, contacts: ContactState) -> None:
        """See a rolling foot from its edge, a leaning one from its line, others from their soles."""
        self._seen = []
        for foot in (0, 1):
            edge = reference.edge[foot]
            if edge and (edge == contacts.edge[foot] or not contacts.active[foot]):
                ahead, pitch = edge * self._half_length, reference.roll[foot][0]
                self._seen.append((foot, terms.shift_foot(foot, ahead, pitch)))
            elif terms.leaning is not None:
                self._seen.append((foot, terms.shift_foot(foot, 0.0, 0.0)))
            else:
                terms.unshift(foot)


def _swinging(
    joints: tuple[int, int] | None,
    back: tuple[float, float],
    parameters: WbcParameters,
    driven: NDArray[np.bool_] | None,
) -> ArmSwing | None:
    """Arms that swing; None where none are named, they are not to swing, or somebody else drives one of them."""
    if joints is None or not parameters.arm_swing or (driven is not None and driven[list(joints)].any()):
        return None
    return ArmSwing(joints, parameters.arm_swing, back)
