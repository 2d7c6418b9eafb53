"""The whole-body controller: reference and measurement in, joint torques out."""

import math
import time
from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.wbc.arm_swing import ArmSwing, shoulder_pitches
from surefoot.wbc.balance import BalanceGains, SupportRegion, com_acceleration
from surefoot.wbc.cone import CONE_ROWS, wrench_cone
from surefoot.wbc.contacts import ContactParameters, ContactSchedule, ContactState
from surefoot.wbc.dynamics import ContactGains, HardConstraints
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames, RobotTerms
from surefoot.wbc.qp import UNBOUNDED, QpData, QpLayout, allocate
from surefoot.wbc.separation import Separation, SeparationParameters
from surefoot.wbc.solvers import QpSolution, equalities_only, make_solver
from surefoot.wbc.tasks import TaskGains, TaskStack, TaskWeights
from surefoot.wbc.types import GRAVITY, Array, FootSensing, RobotState, SolveStatus, WbcReference, WbcReport

ACCEPTED_VIOLATION = 1e-3
"""A solution that breaks a row by more than this (N, N·m, m/s^2) is not used, whatever its solver says."""


TOE_DEPTH = 0.003
"""Half length of the strip that stands for a toe edge in its wrench cone [m]."""


@dataclass(frozen=True, slots=True)
class Sole:
    """The sole's contact: half sizes [m] and the friction coefficient that the controller counts on [-]."""

    half_length: float
    half_width: float
    friction: float
    cop_share: float = 0.9
    """Share of the half sizes that the planned CoP may use [-]."""


@dataclass(frozen=True, slots=True)
class WbcParameters:
    """Everything one may turn.

    Attributes:
        weights: of the tasks.
        gains: of the tasks.
        balance: gains of the CoM law.
        contact: gains of the rigid contacts.
        schedule: thresholds of the contact schedule.
        separation: when limbs keep away from each other.
        solver: the solver tried first, chosen by ``benchmarks/qp_solvers.py``.
        second_solver: the one tried when the first fails.
        arm_swing: swing of the shoulders per stride [rad/m].
    """

    weights: TaskWeights = field(default_factory=TaskWeights)
    gains: TaskGains = field(default_factory=TaskGains)
    balance: BalanceGains = field(default_factory=BalanceGains)
    contact: ContactGains = field(default_factory=ContactGains)
    schedule: ContactParameters = field(default_factory=ContactParameters)
    separation: SeparationParameters = field(default_factory=SeparationParameters)
    solver: str = "equality-first"
    second_solver: str = "proxqp"
    arm_swing: float = 0.6


class WholeBodyController:
    """Weighted inverse-dynamics QP, solved once per control tick.

    Herzog et al., "Momentum control with hierarchical inverse dynamics", Autonomous Robots 2016, in its weighted form,
    with the CoM law of ``wbc.balance``. A tick that no solver answers degrades as ``SolveStatus`` says; it never
    raises.
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
        """
        self.terms = RobotTerms(model, frames)
        self._separation = Separation(model, limbs, parameters.separation) if limbs is not None else None
        self.layout = QpLayout(model.nv, CONE_ROWS, parameters.separation.slots if limbs is not None else 0)
        self.qp: QpData = allocate(self.layout)
        shoulders = shoulder_pitches(tuple(model.names)[2:])
        arms = ArmSwing(shoulders, parameters.arm_swing) if shoulders and parameters.arm_swing else None
        share = sole.cop_share
        gaps = self.layout.separation
        self._gap_rows = self.qp.A[gaps, : model.nv]
        self._gap_lower = self.qp.bounds_lower[self.layout.variables :][gaps]
        friction = sole.friction / np.sqrt(2.0)
        cone = wrench_cone(share * sole.half_length, share * sole.half_width, friction)
        edge = wrench_cone(TOE_DEPTH, share * sole.half_width, friction)
        self._hard = HardConstraints(self.qp, self.layout, (cone, edge), limits, parameters.contact)
        mass, weights, gains = self.terms.mass, parameters.weights, parameters.gains
        self._toe = sole.half_length
        self._tasks = TaskStack(self.qp, self.layout, mass, weights, gains, posture, leg_joints, arms, self._toe)
        self._contacts = ContactSchedule(parameters.schedule, self.terms.mass * GRAVITY, control_period)
        self._region = SupportRegion(sole.half_length, sole.half_width, parameters.balance.polygon_share)
        self._region_contacts: tuple[tuple[bool, bool], int] | None = None
        self._edge: tuple[int, Array] | None = None
        self._balance = parameters.balance
        self._solvers = (make_solver(parameters.solver), make_solver(parameters.second_solver))
        self._limits = limits
        self._period = control_period
        self._state = RobotState(pin.neutral(model), np.zeros(model.nv))
        self._torque, self._torque_rows = np.zeros(self.layout.joints), self.qp.A[self.layout.torque_rows]
        self._acceleration = np.zeros(self.layout.nv)
        self._wrench_flat = np.zeros(12)
        self._wrench = self._wrench_flat.reshape(2, 6)
        self._task_error = np.zeros(18)

    def observe(self, state: RobotState) -> RobotTerms:
        """Take the measured or estimated state of this tick; returns its terms, which the next call overwrites."""
        self._state = state
        self.terms.update(state.q, state.v)
        return self.terms

    def update(self, reference: WbcReference, sensing: FootSensing, fail_solvers: bool = False) -> WbcReport:
        """Torques for the state last observed.

        Args:
            reference: what to do.
            sensing: what the feet feel.
            fail_solvers: pretend that both QP solvers failed, to exercise the fallback.
        """
        start, state = time.perf_counter(), self._state
        contacts = self._contacts.update(reference, sensing)
        self._assemble(state, reference, contacts)
        built = time.perf_counter()
        status, solution = self._solve(fail_solvers)
        if solution is not None:
            self._apply(solution)
        else:
            self._hold(state.v)
        solved = time.perf_counter()
        return WbcReport(
            torque=self._torque,
            status=status,
            iterations=solution.iterations if solution else 0,
            primal_residual=solution.violation if solution else math.inf,
            dual_residual=solution.dual_residual if solution else math.nan,
            acceleration=self._acceleration,
            wrench=self._wrench,
            active=contacts.active,
            felt=contacts.felt,
            task_error=self._task_error,
            build_time=built - start,
            solve_time=solved - built,
        )

    def _assemble(self, state: RobotState, reference: WbcReference, contacts: ContactState) -> None:
        terms, rolling, self._edge = self.terms, reference.rolling_foot, None
        if rolling >= 0 and (rolling == contacts.rolling or not contacts.active[rolling]):
            self._edge = rolling, terms.shift_foot(rolling, self._toe, reference.roll[0])
        holding = (contacts.active, contacts.rolling)
        if holding != self._region_contacts and np.isfinite(terms.sole_position).all():
            self._region.rebuild(terms.contact_position, terms.contact_rotation, contacts.active, contacts.rolling)
            self._region_contacts = holding
        acceleration = com_acceleration(reference, terms.com, terms.com_velocity, self._region, self._balance)
        self._tasks.write(terms, state.q, state.v, acceleration, reference)
        self._hard.write(terms, state.q, state.v, contacts, reference.ground_normal, reference.roll[1:])
        if self._separation is not None:
            self._separation.write(terms.data, state.v, self._gap_rows, self._gap_lower, UNBOUNDED)

    def _solve(self, fail_solvers: bool) -> tuple[SolveStatus, QpSolution | None]:
        if not fail_solvers:
            for status, solver in zip((SolveStatus.SOLVED, SolveStatus.SECOND_SOLVER), self._solvers, strict=True):
                solution = solver.solve(self.qp)
                if solution is not None and solution.violation <= ACCEPTED_VIOLATION:
                    return status, solution
        solution = equalities_only(self.qp)
        return (SolveStatus.HELD if solution is None else SolveStatus.EQUALITIES_ONLY), solution

    def _apply(self, solution: QpSolution) -> None:
        """Interpret the solution into torque, acceleration and wrenches."""
        x, nv = solution.x, self.layout.nv
        np.matmul(self._torque_rows, x, out=self._torque)
        self._torque += self.terms.bias[6:]
        self._clip()
        self._acceleration[:] = x[:nv]
        np.multiply(x[nv:], self.layout.wrench_unit, out=self._wrench_flat)
        if self._edge is not None:
            foot, to_sole = self._edge
            self._wrench[foot] = to_sole @ self._wrench[foot]
        self._task_error[:] = self._tasks.residual(x)

    def _clip(self) -> None:
        np.minimum(self._torque, self._limits.torque, out=self._torque)
        np.maximum(self._torque, -self._limits.torque, out=self._torque)

    def _hold(self, v: Array) -> None:
        """Fade the last torque out within about 50 ms while damping the joints whose velocity is known."""
        rate = np.where(np.isfinite(v[6:]), v[6:], 0.0)
        self._torque += self._period / 0.05 * (-0.02 * self._limits.torque * rate - self._torque)
        self._clip()
