"""The paper's QP per axis: changes of the jerk as variables, the squared ZMP error as cost, hard constraints."""

from dataclasses import replace

import numpy as np

from planner.dcm import viability_weights
from planner.motion import MotionProblem
from planner.parameters import PlannerParameters
from planner.qp import Qp
from planner.step_response import CachedResponse
from planner.types import Array


def build_hard_problem(
    parameters: PlannerParameters,
    response: CachedResponse,
    problem: MotionProblem,
    point: Array,
    terminal: bool,
) -> tuple[Qp, Qp]:
    """The QPs of both axes in ΔU [m/s^3], from eq. costfunction, constraints and param_constraint.

    Rows of G: ZMP box above and below, jerk above and below, and if wanted the terminal DCM above and below; bounds are
    those of the jerk's rate. A block of several samples may change the jerk by the rate times the samples since the
    last block began; the first one, the only one that is applied, begins one sample after the last jerk.

    - Erratum: eq. param_constraint prints G = [0.9 L_f/2, -0.9 L_f/2] for F = [1, -1]; here both are +0.9 L_f/2 and
      count from the moving reference, because as printed the ZMP would have to equal +34 mm and the box would not
      follow the feet.
    - Erratum: eq. constraints runs over j = 0..N_p; here 1..N_p, because C has no feed-through and y(k) is past.
    - Erratum: z_k of eq. costfunction holds N_p increments; here N_c, as announced.
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
    S = response.at(problem.stiffness[1 : n + 1])
    moves = S.S_u.shape[1]
    error = S.S_x @ problem.state.T + np.outer(S.S_u1, last) - point[1 : n + 1]
    P = 2.0 * (S.S_u.T @ S.S_u)
    P.flat[:: moves + 1] += 2.0 * p.jerk_weight
    q = 2.0 * (error.T @ S.S_u)
    sums = np.tri(moves)
    limits = np.full((moves, 2), p.jerk_limit)
    box = problem.reference.half_size[1 : n + 1]
    rows, bounds = [S.S_u, -S.S_u, sums, -sums], [box - error, box + error, limits - last, limits + last]
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

    Erratum: ε = [0, 0] of eq. param_constraint, "the solution must always satisfy it"; here a slack steps in when it
    cannot, because with the paper's own parameters the hard problem has no solution at a third of all ticks.

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
    end = response.last[0] + response.last[1] / problem.omega[n]
    free = problem.state @ end[:3] + end[3] * last
    half = parameters.terminal_margin * (weights @ problem.reference.half_size[n:])
    return end[None, 4:], (free - weights @ point[n:])[None], half[None]
