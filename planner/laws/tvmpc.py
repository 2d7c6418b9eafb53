"""The paper's TVMPC in the Δu form with hard constraints: profiles `paper` and `repaired`.

`paper` is the paper's: two moves over fifty samples and no terminal constraint. With the paper's own limits its hard
problem has no solution at a third of the ticks, and on a true pendulum the walk falls. Its step law makes it fall even
earlier, without any push (see `planner.laws.tvmpc.paper_shift`); `step_adaptation` none leaves the law out. `repaired`
changes what the paper needed: ten blocks of moves over the same horizon, the terminal DCM constraint and the corrected
step law. Horizon, limits, cost and hard constraints are those of the paper.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from surefoot.planner.laws.law import BuiltQps, Motion, MotionProblem
from surefoot.planner.laws.qp import Qp, QpSolution, solve
from surefoot.planner.model.dcm import dcm, decays, nominal_dcm, viability_weights
from surefoot.planner.model.jerk import CachedResponse, block_moves, cached_response
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.step_region import reach_box
from surefoot.planner.types import Array, SolverStatus


def paper_shift(problem: MotionProblem, parameters: PlannerParameters) -> Array:
    """Shift as printed in eq. (14): S_L(t) = (ζ_t - f_i) e^{ω (T_ss + T_ds - t)}, in both axes.

    Changes within the compliance margin are not made; the footstep is saturated in the reach box. The law is kept with
    its faults, for comparison. The foot lands T_ds earlier than the law assumes. It steps *onto* the DCM, where a walk
    would stop. It amplifies a DCM error by up to e^{2 ω} = 523. It changes nominal steps, and a walk with it falls
    without any push.

    Args:
        problem: the tick; the stance foot f_i is the origin of the plan frame.
        parameters: give margin and reach.

    Returns:
        Shift of the next footstep from its nominal increment, shape (2,) [m].
    """
    steps, nominal = problem.steps, problem.steps.increment[0]
    if steps.swing is None or not steps.free[0]:
        return np.zeros(2)
    omega = math.sqrt(problem.stiffness[0])
    here = dcm(problem.state[:, 0], problem.state[:, 1], omega)
    change = here * math.exp(omega * (steps.time_left + steps.transfer_time)) - nominal
    change[np.abs(change) <= parameters.compliance_margin] = 0.0
    low, high = reach_box(parameters, steps.side[0])
    return np.asarray(np.clip(nominal + change, low, high) - nominal)


def corrected_shift(problem: MotionProblem, parameters: PlannerParameters) -> Array:
    """The law that a walk needs: f = ξ_T - b, with the DCM ξ_T at touchdown that the CoP can no longer prevent.

    Erratum: eq. (14) counts until T_ss + T_ds and steps onto the DCM. Here the horizon ends at touchdown, and b is the
    offset of the DCM from the foot in the nominal gait. Only what the CoP cannot correct until then is left to the
    foot. Otherwise a gain of e^{ω (T_ss + T_ds)} would turn 0.1 mm of DCM error into a step of 5 cm.

    Without DCM error the step is the nominal one. A shift d of the foot moves the DCM that its future ZMP keeps bounded
    by g d at touchdown. There g < 1, as the ZMP reaches the new foot only during double support. The shift stays within
    reach and swing speed, and is not renewed shortly before touchdown.

    Args:
        problem: the tick.
        parameters: give sample time and freeze time.

    Returns:
        Shift of the next footstep from its nominal increment, shape (2,) [m].
    """
    steps, t = problem.steps, parameters.sample_time
    k = round(steps.time_left / t)
    blind = k >= len(problem.stiffness) - 1 or steps.time_left <= parameters.freeze_time
    if steps.swing is None or not steps.free[0] or blind:
        return np.zeros(2)
    nominal = nominal_dcm(problem.stiffness, problem.omega, problem.reference.point, t)[0]
    error = dcm(problem.state[:, 0], problem.state[:, 1], float(problem.omega[0])) - nominal
    growth = 1.0 / decays(problem.stiffness[: k + 1], problem.omega[: k + 1], t)[-1]
    authority = problem.reference.half_size[0] * (growth - 1.0)
    residual = np.sign(error) * np.maximum(np.abs(error) * growth - authority, 0.0)
    gain = viability_weights(problem.stiffness[k:], problem.omega[k:], t) @ problem.reference.gain[k:, 0]
    return np.asarray(np.clip(residual / gain, steps.lower[0], steps.upper[0]))


def build_hard_problem(
    parameters: PlannerParameters,
    response: CachedResponse,
    problem: MotionProblem,
    point: Array,
    terminal: bool,
) -> tuple[Qp, Qp]:
    """The QPs of both axes in ΔU [m/s^3], from eq. (7), eq. (8) and eq. (9).

    Rows of G: ZMP box above and below, jerk above and below, and if wanted the terminal DCM above and below; bounds are
    those of the jerk's rate. A block of several samples may change the jerk by the rate times the samples since the
    last block began; the first one, the only one that is applied, begins one sample after the last jerk.

    - Erratum: eq. (9) prints G = [0.9 L_f/2, -0.9 L_f/2] for F = [1, -1]; here both are +0.9 L_f/2 and count from the
      moving reference. As printed the ZMP would have to equal +34 mm, and the box would not follow the feet.
    - Erratum: eq. (8) runs over j = 0..N_p; here 1..N_p, because C has no feed-through and y(k) is past.
    - Erratum: z_k of eq. (7) holds N_p increments; here N_c, as announced.
    - Erratum: the rate of change of the jerk is limited to "0.1" without a unit; here per sample, because no motion at
      all walks this gait with 0.1 m/s^4.

    Args:
        parameters: planner parameters.
        response: cached prediction matrices.
        problem: the tick.
        point: ZMP reference over the window, the decided footstep shifts included, shape (N + M + 1, 2) [m].
        terminal: whether the DCM at the end of the horizon must lie in the set that the known future boxes allow; the
            paper has no such constraint.
    """
    p, n = parameters, parameters.horizon
    last = np.clip(problem.last_jerk, -p.jerk_limit, p.jerk_limit)
    S_x, S_u1, S_u = response.at(problem.stiffness[1 : n + 1])
    moves = S_u.shape[1]
    error = S_x @ problem.state.T + np.outer(S_u1, last) - point[1 : n + 1]
    P = 2.0 * (S_u.T @ S_u)
    P.flat[:: moves + 1] += 2.0 * p.jerk_weight
    q = 2.0 * (error.T @ S_u)
    sums = np.tri(moves)
    limits = np.full((moves, 2), p.jerk_limit)
    box, middle = problem.reference.half_size[1 : n + 1], problem.reference.middle[1 : n + 1]
    rows, bounds = (
        [S_u, -S_u, sums, -sums],
        [box - (error - middle), box + (error - middle), limits - last, limits + last],
    )
    if terminal:
        row, end, half = _terminal(p, response, problem, point, last)
        rows += [row, -row]
        bounds += [half - end, half + end]
    G, h = np.concatenate(rows), np.concatenate(bounds).T
    rate = np.asarray(p.jerk_rate_limit * np.diff(p.moves, prepend=-1), dtype=np.float64)
    x, y = (Qp(P, q[i], G, np.ascontiguousarray(h[i]), -rate, rate) for i in range(2))
    return x, y


def softened(qp: Qp, hard: slice, cost: tuple[float, float]) -> Qp:
    """The same problem with one slack s >= 0 on all rows but the hard ones, as the last variable.

    Erratum: ε = [0, 0] of eq. (9), "the solution must always satisfy it"; here a slack steps in when it cannot. With
    the paper's own parameters the hard problem has no solution at a third of all ticks.

    Args:
        qp: problem without a solution.
        hard: rows that stay hard: those of the jerk, which can always be met.
        cost: quadratic and linear cost of the slack.
    """
    n = len(qp.q)
    P = np.zeros((n + 1, n + 1))
    P[:n, :n], P[n, n] = qp.P, 2.0 * cost[0]
    slack = np.full((len(qp.h), 1), -1.0)
    slack[hard] = 0.0
    return replace(
        qp,
        P=P,
        q=np.append(qp.q, cost[1]),
        G=np.concatenate((qp.G, slack), axis=1),
        lower=np.append(qp.lower, 0.0),
        upper=np.append(qp.upper, np.inf),
    )


def _terminal(
    parameters: PlannerParameters, response: CachedResponse, problem: MotionProblem, point: Array, last: Array
) -> tuple[Array, Array, Array]:
    """Row of ΔU, deviation without them and half size of the viable interval, shapes (1, m), (1, 2), (1, 2)."""
    n = parameters.horizon
    weights = viability_weights(problem.stiffness[n:], problem.omega[n:], parameters.sample_time)
    end = dcm(response.last[0], response.last[1], problem.omega[n])
    free = problem.state @ end[:3] + end[3] * last
    half = parameters.terminal_margin * (weights @ problem.reference.half_size[n:])
    return end[None, 4:], (free - weights @ point[n:])[None], half[None]


StepLaw = Callable[[MotionProblem, PlannerParameters], Array]


class HardTvmpc:
    """The step law decides the next footstep, then a hard QP per axis the jerk; a QP without solution is softened.

    Args:
        parameters: planner parameters; `zmp_slack` is the cost of the softening slack.
        step_law: gives the shift of the next footstep.
        terminal: whether the terminal DCM is constrained.
    """

    def __init__(self, parameters: PlannerParameters, step_law: StepLaw, terminal: bool) -> None:
        p = self._parameters = parameters
        self._step_law, self._terminal = step_law, terminal
        self._response = cached_response(p.sample_time, p.moves, p.horizon)
        self._basis = np.asarray(np.cumsum(block_moves(p.moves, p.horizon)[:, ::-1], axis=1)[:, ::-1])
        self._jerk_rows = slice(2 * p.horizon, 2 * p.horizon + 2 * len(p.moves))

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        built = self.build(problem)
        return self.interpret(problem, built, self.solve(built))

    def build(self, problem: MotionProblem) -> BuiltQps:
        """See `QpLaw`; the step law has decided the next footstep, and ΔU counts from the last jerk."""
        p, reference = self._parameters, problem.reference
        shifts = np.zeros((2, 2))
        shifts[0] = self._step_law(problem, p)
        point = reference.point + reference.gain @ shifts
        axes = build_hard_problem(p, self._response, problem, point, self._terminal)
        last = np.clip(problem.last_jerk, -p.jerk_limit, p.jerk_limit)
        return BuiltQps(axes, np.broadcast_to(last, problem.fallback.shape), shifts)

    def solve(self, built: BuiltQps) -> tuple[QpSolution, QpSolution]:
        """See `QpLaw`; of a QP that has no solution it is that of the softened one."""
        x, y = built.axes
        return self._solve(x), self._solve(y)

    def _solve(self, qp: Qp) -> QpSolution:
        p = self._parameters
        solution = solve(qp, p.solvers)
        if solution.z is not None:
            return solution
        return solve(softened(qp, self._jerk_rows, p.zmp_slack), p.solvers)

    def interpret(self, problem: MotionProblem, built: BuiltQps, solutions: tuple[QpSolution, QpSolution]) -> Motion:
        """See `QpLaw`; an axis that no solver solved takes the fallback jerk."""
        moves = self._basis.shape[1]
        jerk, slack = problem.fallback.copy(), np.zeros(2)
        worst, infeasible = SolverStatus.SOLVED, False
        for axis, (hard, solution) in enumerate(zip(built.axes, solutions, strict=True)):
            soft, z = solution.qp is not hard, solution.z
            worst, infeasible = max(worst, SolverStatus(solution.attempt)), infeasible or soft
            slack[axis] = np.nan if z is None else z[moves] if soft else 0.0
            if z is not None:
                jerk[:, axis] = built.jerk[:, axis] + self._basis @ z[:moves]
        terminal_slack = slack if self._terminal else np.zeros(2)
        used = (solutions[0].qp, solutions[1].qp)
        return Motion(jerk, built.shifts, slack, terminal_slack, worst, infeasible, used)


def paper_law(parameters: PlannerParameters, com_height: float) -> HardTvmpc:
    """The law of profile `paper`."""
    return HardTvmpc(parameters, paper_shift, terminal=False)


def repaired_law(parameters: PlannerParameters, com_height: float) -> HardTvmpc:
    """The law of profile `repaired`."""
    return HardTvmpc(parameters, corrected_shift, terminal=True)
