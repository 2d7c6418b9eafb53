"""Soft TVMPC with the footsteps as variables of the QP (Herdt et al., 2010): profiles `default` and `lti`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from surefoot.native.library import Block, Library, library
from surefoot.planner.laws.law import BuiltQps, Motion, MotionProblem, StepContext
from surefoot.planner.laws.qp import AxesSolver, Qp, QpSolution, bind_qps
from surefoot.planner.model.dcm import (
    NominalMotion,
    bind_motion,
    jerk_range,
    no_motion,
    nominal_motion,
    viability_weights,
)
from surefoot.planner.model.jerk import Prediction, block_moves, predict, zmp_response
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.leg_offset import softening
from surefoot.planner.types import GRAVITY, Array, SolverStatus
from surefoot.values import dataclass

_EXTRA = 4
"""Variables after the moves: two footstep shifts, ZMP slack, terminal slack [-]."""

_UNSHIFTED = np.zeros((2, 2))


def build_problem(
    parameters: PlannerParameters,
    prediction: Prediction,
    problem: MotionProblem,
    move_range: tuple[Array, Array] | None = None,
) -> tuple[Qp, Qp]:
    """The QPs of the plan frame's x and y axis; they share P and G.

    Variables per axis: m moves of the jerk [m/s^3], shifts of the next two footsteps [m], ZMP slack [m], terminal slack
    [m].

    Cost (eq. (7) with what it lacks): squared ZMP error, terminal DCM error, footstep shifts, moves, slacks.
    The terminal cost is what the best linear feedback would still spend on the squared ZMP error after the horizon;
    without it the optimum prefers a constant ZMP error of millimetres to paying once for its correction.
    All constraints on the motion are soft (the paper's hard ones are infeasible under noise), so that the problem
    always has a solution. The paper's box (eq. (9)) is printed as an equality that is not centred on the foot; here it
    is ± foot_margin / 2 of the foot around the moving reference, at samples 1..N (sample 0 has no feed-through).

    Args:
        parameters: planner parameters.
        prediction: cached prediction matrices.
        problem: this tick; its last jerk enters only with a finite rate limit.
        move_range: bounds of the moves, shape (axis, m) each [m/s^3]; the jerk limit on both sides by default.
    """
    errors = _linear_errors(parameters, prediction, problem)
    m = prediction.basis.shape[1]
    P, q = _cost(parameters, errors, m)
    G, h = _inequalities(errors, m)
    if np.isfinite(parameters.jerk_rate_limit):
        G, h = _with_rate_limit(G, h, m, parameters.jerk_rate_limit, problem.last_jerk)
    lower, upper = _bounds(problem.steps, m, move_range or (-parameters.jerk_limit, parameters.jerk_limit))
    x, y = (Qp(P, q[i], G, h[i], lower[i], upper[i]) for i in range(2))
    return x, y


@dataclass(frozen=True, slots=True)
class _Errors:
    """Errors that are linear in moves and shifts z, and what of them is free of cost beyond their weight.

    Attributes:
        zmp_rows: ZMP error `zmp_rows @ z + zmp` at samples 1..N, shape (N, m + 2).
        zmp: shape (N, 2) [m].
        box: half size of the ZMP box there, shape (N, 2) [m].
        end_row: error `end_row @ z + end` of the DCM at the end of the horizon, shape (m + 2,).
        end: against that which the known future footholds keep bounded, shape (2,) [m].
        end_box: half size of the terminal bound, shape (2,) [m].
    """

    zmp_rows: Array
    zmp: Array
    box: Array
    end_row: Array
    end: Array
    end_box: Array


def _linear_errors(parameters: PlannerParameters, prediction: Prediction, problem: MotionProblem) -> _Errors:
    n, state, reference = parameters.horizon, problem.state, problem.reference
    stiffness, end_omega = problem.stiffness[1 : n + 1], float(problem.omega[n])
    weights = viability_weights(problem.stiffness[n:], problem.omega[n:], parameters.sample_time)
    moves = zmp_response(prediction.moves[:, 1:], stiffness)
    free = zmp_response(prediction.state[:, 1:] @ state.T, stiffness)
    end_state = prediction.state[0, n] + prediction.state[1, n] / end_omega
    end_moves = prediction.moves[0, n] + prediction.moves[1, n] / end_omega
    return _Errors(
        zmp_rows=np.concatenate((moves, -reference.gain[1 : n + 1]), axis=1),
        zmp=free - reference.point[1 : n + 1],
        box=reference.half_size[1 : n + 1],
        end_row=np.concatenate((end_moves, -(weights @ reference.gain[n:]))),
        end=state @ end_state - weights @ reference.point[n:],
        end_box=parameters.terminal_margin * reference.half_size[n],
    )


def _cost(parameters: PlannerParameters, errors: _Errors, m: int) -> tuple[Array, Array]:
    weighted_end = parameters.terminal_weight * errors.end_row
    P = np.zeros((m + _EXTRA, m + _EXTRA))
    P[: m + 2, : m + 2] = 2.0 * (errors.zmp_rows.T @ errors.zmp_rows + np.outer(weighted_end, errors.end_row))
    P.flat[:: m + _EXTRA + 1] += _diagonal_cost(parameters, m)
    q = np.empty((2, m + _EXTRA))
    q[:, : m + 2] = 2.0 * (errors.zmp.T @ errors.zmp_rows + np.outer(errors.end, weighted_end))
    q[:, m + 2], q[:, m + 3] = parameters.zmp_slack[1], parameters.terminal_slack[1]
    return P, q


def _inequalities(errors: _Errors, m: int) -> tuple[Array, Array]:
    """Rows: ZMP box above and below at samples 1..N, terminal DCM bound above and below."""
    n = len(errors.zmp)
    G = np.zeros((2 * n + 2, m + _EXTRA))
    G[:n, : m + 2] = errors.zmp_rows
    G[n : 2 * n, : m + 2] = -errors.zmp_rows
    G[: 2 * n, m + 2] = -1.0
    G[2 * n, : m + 2] = errors.end_row
    G[2 * n + 1, : m + 2] = -errors.end_row
    G[2 * n :, m + 3] = -1.0
    h = np.empty((2, 2 * n + 2))
    h[:, :n] = (errors.box - errors.zmp).T
    h[:, n : 2 * n] = (errors.box + errors.zmp).T
    h[:, 2 * n] = errors.end_box - errors.end
    h[:, 2 * n + 1] = errors.end_box + errors.end
    return G, h


def _diagonal_cost(parameters: PlannerParameters, m: int) -> Array:
    cost = np.full(m + _EXTRA, 2.0 * parameters.jerk_weight)
    cost[m : m + 2] = 2.0 * parameters.step_weight
    cost[m + 2], cost[m + 3] = 2.0 * parameters.zmp_slack[0], 2.0 * parameters.terminal_slack[0]
    return cost


def _bounds(steps: StepContext, m: int, moves: tuple[Array, Array] | tuple[float, float]) -> tuple[Array, Array]:
    lower, upper = np.zeros((2, m + _EXTRA)), np.full((2, m + _EXTRA), np.inf)
    lower[:, :m], upper[:, :m] = moves
    lower[:, m : m + 2], upper[:, m : m + 2] = steps.lower.T, steps.upper.T
    return lower, upper


def _with_rate_limit(G: Array, h: Array, m: int, limit: float, last_jerk: Array) -> tuple[Array, Array]:
    """Bound the change of the jerk from the last tick and from block to block (the paper's ±0.1, per sample)."""
    change = np.eye(m) - np.eye(m, k=-1)
    rows = np.zeros((2 * m, G.shape[1]))
    rows[:m, :m], rows[m:, :m] = change, -change
    bound = np.full((2, 2 * m), limit)
    bound[:, 0] += last_jerk
    bound[:, m] -= last_jerk
    return np.concatenate((G, rows)), np.concatenate((h, bound), axis=1)


_STATUSES = tuple(SolverStatus)
"""By the number of solvers that have failed."""


class FootstepTvmpc:
    """Blocked jerk and two footstep shifts per axis; ZMP box and terminal DCM bound are soft, so it has no bad tick.

    The moves are what differs from the nominal motion (see `planner.model.dcm`); with a limit on the jerk's rate, which
    the nominal motion does not keep, they are the whole jerk.

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground, which it does not need [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self._parameters = parameters
        self._prediction = predict(parameters.sample_time, block_moves(parameters.moves, parameters.horizon))
        self._blocks = self._prediction.basis.argmax(axis=1)
        self._compiled: _CompiledQps | None = None
        self._solver, kernels = AxesSolver(parameters.solvers), library()
        if kernels is not None and not math.isfinite(parameters.jerk_rate_limit):
            self._compiled = _CompiledQps(kernels, parameters, self._prediction)
            self._solver.prepare(*self._compiled.shape)
        # A subclass may have steps of its own.
        own = all(getattr(type(self), step) is getattr(FootstepTvmpc, step) for step in ("build", "solve", "interpret"))
        self._at_once = self._compiled if own and self._solver.compiled else None

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`; one kernel builds, solves and interprets where it solves both QPs."""
        if self._at_once is not None and self._at_once.holds(problem):
            motion = self._at_once.plan(self._as_seen(problem))
            if motion is not None:
                return motion
        built = self.build(problem)
        return self.interpret(problem, built, self.solve(built))

    def _as_seen(self, problem: MotionProblem) -> MotionProblem:
        """The problem as the law takes it."""
        return problem

    def build(self, problem: MotionProblem) -> BuiltQps:
        """See `QpLaw`; the QPs count from the nominal motion."""
        p, problem = self._parameters, self._as_seen(problem)
        if self._compiled is not None and self._compiled.holds(problem):
            return self._compiled.build(problem)
        nominal = self._nominal(problem)
        rest = replace(problem.reference, point=problem.reference.point - nominal.zmp)
        beside = replace(problem, state=problem.state - nominal.com[:, 0].T, reference=rest)
        moves = jerk_range(nominal.jerk[: p.horizon], p.moves, p.jerk_limit)
        axes = build_problem(p, self._prediction, beside, moves)
        return BuiltQps(axes, nominal.jerk[: p.horizon], _UNSHIFTED)

    def solve(self, built: BuiltQps) -> tuple[QpSolution, QpSolution]:
        """See `QpLaw`."""
        return self._solver.solve(*built.axes)

    def interpret(self, problem: MotionProblem, built: BuiltQps, solutions: tuple[QpSolution, QpSolution]) -> Motion:
        """See `QpLaw`; an axis that no solver solved takes the fallback jerk and does not shift its footsteps."""
        m, (x, y) = len(self._parameters.moves), solutions
        if x.z is not None and y.z is not None:
            z = np.array((x.z, y.z)).T
            jerk, shifts, slack = z.take(self._blocks, axis=0), z[m : m + 2].copy(), z[m + 2 :]
        else:
            jerk, shifts, slack = problem.fallback - built.jerk, built.shifts.copy(), np.full((2, 2), np.nan)
            for axis, solution in enumerate(solutions):
                if solution.z is not None:
                    jerk[:, axis] = solution.z[self._blocks]
                    shifts[:, axis], slack[:, axis] = solution.z[m : m + 2], solution.z[m + 2 :]
        worst = _STATUSES[max(x.attempt, y.attempt)]
        return Motion(jerk + built.jerk, shifts, slack[0], slack[1], worst, qps=built.axes)

    def _nominal(self, problem: MotionProblem) -> NominalMotion:
        t, zmp = self._parameters.sample_time, problem.reference.point
        if math.isfinite(self._parameters.jerk_rate_limit):
            return no_motion(len(zmp), t)
        return nominal_motion(problem.state[:, 0], zmp, problem.stiffness, t)


def _axes(P: Array, q: Array, G: Array, h: Array, lower: Array, upper: Array, *_: Array) -> tuple[Qp, Qp]:
    """Problems that share P and G, of which the other arrays have a row for each axis."""
    return Qp(P, q[0], G, h[0], lower[0], upper[0]), Qp(P, q[1], G, h[1], lower[1], upper[1])


class _KeptQps(Sequence[Qp]):
    """The QPs of both axes, which are seen in their arrays once somebody looks at them."""

    def __init__(self, told: Callable[[], list[Array]]) -> None:
        self._told = told
        self._axes: tuple[Qp, ...] = ()

    def __len__(self) -> int:
        return 2

    def __getitem__(self, axis: Any) -> Any:
        self._axes = self._axes or _axes(*self._told())
        return self._axes[axis]


class _CompiledQps:
    """Arrays of the kernels that do what `FootstepTvmpc.build` and `FootstepTvmpc.plan` do.

    Attributes:
        shape: rows and variables of each QP.
    """

    def __init__(self, kernels: Library, parameters: PlannerParameters, prediction: Prediction) -> None:
        p, most = parameters, parameters.horizon + parameters.preview + 1
        m, rows = len(p.moves), 2 * p.horizon + 2
        size = m + _EXTRA
        self.shape = rows, size
        self._state, (self._lower, self._upper) = np.empty((2, 3)), np.empty((2, 2, 2))
        self._omega, (self._gain, self._half_size) = np.empty(most), np.empty((2, most, 2))
        shapes = (size, size), (2, size), (rows, size), (2, rows), (2, size), (2, size), (most, 2)
        self._block, self._horizon = Block(*shapes), p.horizon
        P, q, G, h, lower, upper, jerk = self._block.arrays
        motion, own = bind_motion(kernels, p.sample_time, most, jerk=jerk)
        self._position, self._stiffness, self._zmp = own["position"], own["stiffness"], own["zmp"]
        numbers = ("jerk_limit", "jerk_weight", "step_weight", "terminal_weight", "terminal_margin")
        qps = kernels.fill(
            "FootstepQps",
            motion=motion,
            horizon=p.horizon,
            moves=m,
            starts=np.array(p.moves, dtype=np.int64),
            response=prediction.moves,
            **{name: getattr(p, name) for name in (*numbers, "zmp_slack", "terminal_slack")},
            state=self._state,
            omega=self._omega,
            gain=self._gain,
            half_size=self._half_size,
            step_lower=self._lower,
            step_upper=self._upper,
            weights=np.empty(most),
            P=P,
            q=q,
            G=G,
            h=h,
            lower=lower,
            upper=upper,
        )
        self._run, self._answer = kernels.bind("footstep_qps_make", qps), Block((p.horizon, 2), (2, 2), (2, 2))
        x, y = bind_qps(kernels, [(axis, np.zeros(size)) for axis in _axes(P, q, G, h, lower, upper)])
        answer: dict[str, Any] = dict(zip(("jerk", "shifts", "slack"), self._answer.arrays, strict=True))
        self._plan = kernels.bind("footstep_motion_make", qps=qps, x=x, y=y, **answer)

    def holds(self, problem: MotionProblem) -> bool:
        """Whether the window of a problem is no longer than that of its planner."""
        return len(problem.stiffness) <= len(self._stiffness)

    def plan(self, problem: MotionProblem) -> Motion | None:
        """The motion; None where the kernel does not solve an axis."""
        if self._plan(self._tell(problem)):
            return None
        jerk, shifts, slack = self._answer.copied()
        return Motion(jerk, shifts, slack[0], slack[1], qps=_KeptQps(self._block.kept()))

    def build(self, problem: MotionProblem) -> BuiltQps:
        self._run(self._tell(problem))
        *arrays, jerk = self._block.copied()
        return BuiltQps(_axes(*arrays), jerk[: self._horizon], _UNSHIFTED)

    def _tell(self, problem: MotionProblem) -> int:
        """Let the kernels look at a problem; says how many samples it has."""
        n, reference, steps = len(problem.stiffness), problem.reference, problem.steps
        self._state[:], self._position[:] = problem.state, problem.state[:, 0]
        self._stiffness[:n], self._omega[:n] = problem.stiffness, problem.omega
        self._zmp[:n], self._gain[:n], self._half_size[:n] = reference.point, reference.gain, reference.half_size
        self._lower[:], self._upper[:] = steps.lower, steps.upper
        return n


class ConstantHeightTvmpc(FootstepTvmpc):
    """The same without previewing the dynamics: λ = g / z_c and ω = sqrt(λ) over the whole window (LIPM).

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground at rest, z_c [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        super().__init__(parameters, com_height)
        self._stiffness = softening(parameters.leg) * GRAVITY / com_height

    def _as_seen(self, problem: MotionProblem) -> MotionProblem:
        stiffness = np.full_like(problem.stiffness, self._stiffness)
        omega = np.full_like(problem.omega, math.sqrt(self._stiffness))
        return replace(problem, stiffness=stiffness, omega=omega)
