"""The QPs of the TVMPC whose footsteps are variables: errors, cost, constraints and bounds of a tick.

Variables z of an axis: m moves of the jerk beside a nominal motion [m/s^3], shifts of the next two footsteps [m], ZMP
slack [m], terminal slack [m]. With C(k) = [1 0 -1/λ(k)] the errors are linear in the first m + 2 of them, as eq. (10):

    ZMP at samples k = 1..N:    y(k) - p(k) = C(k) (P(k) ΔU + x(k)) - γ(k) shifts
    DCM at sample N:            ξ - ξ_p     = [1 1/ω 0] (P(N) ΔU + x(N)) - Σ w_j γ_j shifts

with the response P to the moves, the free motion x(k) from what the state differs from the nominal one, the sensitivity
γ of the reference to the shifts, and the weights w of `planner.model.dcm.viability_weights` over the preview.

Cost (eq. (7) with what it lacks): squared ZMP error, terminal DCM error, footstep shifts, moves, slacks. The terminal
cost is the squared ZMP error that the best linear feedback leaves after the horizon. Without it the optimum keeps a
constant ZMP error of millimetres.

All constraints on the motion are soft (the paper's hard ones are infeasible under noise), so that the problem always
has a solution. The paper's box (eq. (9)) is printed as an equality that is not centred on the foot; here it is
± foot_margin / 2 of the foot around the moving reference, at samples 1..N (sample 0 has no feed-through). Where a foot
rolls, it is around what of the foot is down.
"""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.planner.laws.law import BuiltQps, MotionProblem
from surefoot.planner.laws.qp import Qp
from surefoot.planner.model import dcm
from surefoot.planner.model.jerk import Prediction
from surefoot.planner.model.nominal import NominalMotion
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.types import Array

SHIFTS = 2
"""Footsteps that are variables, behind the moves: those that a horizon of one second meets [-]."""

EXTRA = 4
"""Variables after the moves: two footstep shifts, ZMP slack, terminal slack [-]."""

_UNSHIFTED = np.zeros((2, 2))


class FootstepQps:
    """Builds them for one planner.

    With a limit on the jerk's rate, which the nominal motion does not keep, the moves are the whole jerk.

    Args:
        parameters: planner parameters.
        prediction: its prediction matrices.

    Attributes:
        rows: of G.
        size: variables of a QP.
    """

    def __init__(self, parameters: PlannerParameters, prediction: Prediction) -> None:
        p = self._parameters = parameters
        self._horizon, self._moves, self._sample_time = p.horizon, len(p.moves), p.sample_time
        self._ends = np.array([*p.moves[1:], p.horizon], dtype=np.int64)
        self._response = prediction.moves
        self._jerk_limit, self._rate_limit = p.jerk_limit, p.jerk_rate_limit
        self._limits_rate = math.isfinite(p.jerk_rate_limit)
        self._terminal_weight, self._terminal_margin = p.terminal_weight, p.terminal_margin
        self._jerk_weight, self._step_weight = p.jerk_weight, p.step_weight
        (self._zmp_slack, self._zmp_price), (self._end_slack, self._end_price) = p.zmp_slack, p.terminal_slack
        self.size, n = self._moves + EXTRA, p.horizon
        self.rows = 2 * n + 2 + (2 * self._moves if self._limits_rate else 0)
        self._S, self._WS = np.zeros((n + 1, self._moves + SHIFTS)), np.zeros((n + 1, self._moves + SHIFTS))
        self._s, self._Ws, self._box = np.zeros((2, n + 1)), np.zeros(n + 1), np.zeros((2, n + 1))
        self._beside, self._middle = np.zeros((2, 3)), np.zeros((2, n + 1))
        self._look(n + p.preview + 1)

    def _look(self, count: int) -> None:
        """Make room for a window of so many samples."""
        self._count, self._aim = count, np.zeros((count, 2))
        self._nominal = NominalMotion(self._sample_time, count)
        self._decay, self._weights = np.zeros(count - self._horizon), np.zeros(count - self._horizon)

    def build(self, problem: MotionProblem) -> BuiltQps:
        """The QPs of the plan frame's x and y axis, which share P and G and count from the nominal motion.

        Args:
            problem: this tick; its last jerk enters only with a finite rate limit.
        """
        steps, reference, size = problem.steps, problem.reference, self.size
        P = np.zeros((size, size))
        q = np.zeros((2, size))
        G = np.zeros((self.rows, size))
        h = np.empty((2, self.rows))
        lower, upper = np.empty((2, size)), np.empty((2, size))
        if len(problem.stiffness) != self._count:
            self._look(len(problem.stiffness))
        self._predict(
            problem.state, problem.stiffness, problem.omega, reference.point, reference.gain, reference.half_size
        )
        self._box_around(reference.middle)
        self._cost(P, q)
        self._inequalities(G, h)
        if self._limits_rate:
            self._rate_limits(G, h, problem.last_jerk)
        self._bounds(lower, upper, steps.lower, steps.upper)
        axes = Qp(P, q[0], G, h[0], lower[0], upper[0]), Qp(P, q[1], G, h[1], lower[1], upper[1])
        return BuiltQps(axes, self._nominal.jerk[: self._horizon].copy(), _UNSHIFTED)

    def _predict(
        self, state: Array, stiffness: Array, omega: Array, point: Array, gain: Array, half_size: Array
    ) -> None:
        """Errors of a window: by its state, and by point, gain and half size of its ZMP reference."""
        n = self._horizon
        self._begin(state, point, stiffness)
        dcm.fade(stiffness[n:], omega[n:], self._sample_time, self._decay)
        dcm.weigh(self._decay, self._weights)
        self._zmp_errors(stiffness, gain, half_size)
        self._end_errors(omega[n], gain, half_size)

    def _begin(self, state: Array, point: Array, stiffness: Array) -> None:
        """The nominal motion, what the state has beside it, and what of the reference it leaves."""
        if self._limits_rate:
            self._aim[:] = point
        else:
            self._nominal.follow(state[:, 0], point, stiffness)
        for axis in range(2):
            self._beside[axis, 0] = state[axis, 0] - self._nominal.c[0, axis]
            self._beside[axis, 1] = state[axis, 1] - self._nominal.v[0, axis]
            self._beside[axis, 2] = state[axis, 2] - self._nominal.a[0, axis]

    def _free(self, axis: int, time: float) -> algebra.Vector:
        """Difference of position, velocity and acceleration from the nominal ones after a time without moves."""
        x, v, a = self._beside[axis, 0], self._beside[axis, 1], self._beside[axis, 2]
        return x + time * v + (0.5 * time * time) * a, v + time * a, a

    def _zmp_errors(self, stiffness: Array, gain: Array, half_size: Array) -> None:
        """S_k and s_k: the ZMP errors S_k z + s_k of samples 1..N, and their box."""
        m, P = self._moves, self._response
        for k in range(1, self._horizon + 1):
            softness = 1.0 / stiffness[k]
            for j in range(m):
                self._S[k - 1, j] = P[0, k, j] - softness * P[2, k, j]
            for step in range(SHIFTS):
                self._S[k - 1, m + step] = -gain[k, step]
            for axis in range(2):
                x, _, a = self._free(axis, self._sample_time * k)
                self._s[axis, k - 1] = x - softness * a - self._aim[k, axis]
                self._box[axis, k - 1] = half_size[k, axis]

    def _end_errors(self, omega: float, gain: Array, half_size: Array) -> None:
        """The last row of the errors: the error of the DCM at the end of the horizon, and its bound."""
        n, m, P = self._horizon, self._moves, self._response
        period = 1.0 / omega
        for j in range(m):
            self._S[n, j] = P[0, n, j] + period * P[1, n, j]
        for step in range(SHIFTS):
            self._S[n, m + step] = -self._ahead(gain, step)
        for axis in range(2):
            x, v, _ = self._free(axis, self._sample_time * n)
            self._s[axis, n] = x + period * v - self._ahead(self._aim, axis)
            self._box[axis, n] = self._terminal_margin * half_size[n, axis]

    def _box_around(self, middle: Array) -> None:
        """Take the middles of the boxes of samples 1..N, from their references."""
        for k in range(1, self._horizon + 1):
            for axis in range(2):
                self._middle[axis, k - 1] = middle[k, axis]

    def _ahead(self, values: Array, column: int) -> float:
        """Σ w_j of a column of values over the window, from the end of the horizon on."""
        total = 0.0
        for j in range(self._count - self._horizon):
            total += self._weights[j] * values[self._horizon + j, column]
        return total

    def _cost(self, P: Array, q: Array) -> None:
        """P = 2 (S' W S + diag), q = 2 S' W s, and what shifts, moves and slacks cost (eq. (7))."""
        n, m = self._horizon, self._moves
        for k in range(n + 1):
            weight = 2.0 if k < n else 2.0 * self._terminal_weight
            for j in range(m + SHIFTS):
                self._WS[k, j] = weight * self._S[k, j]
        linear.add_products(P, self._WS, self._S)
        for i in range(m + SHIFTS):
            for j in range(i):
                P[i, j] = P[j, i]
            P[i, i] += 2.0 * (self._jerk_weight if i < m else self._step_weight)
        P[m + 2, m + 2], P[m + 3, m + 3] = 2.0 * self._zmp_slack, 2.0 * self._end_slack
        for axis in range(2):
            for k in range(n + 1):
                self._Ws[k] = (2.0 if k < n else 2.0 * self._terminal_weight) * self._s[axis, k]
            linear.add_transposed_product(1.0, self._S, self._Ws, q[axis, : m + SHIFTS])
            q[axis, m + 2], q[axis, m + 3] = self._zmp_price, self._end_price

    def _inequalities(self, G: Array, h: Array) -> None:
        """Rows of G z <= h: ZMP box above and below at samples 1..N, terminal DCM bound above and below (eq. (8))."""
        n, m = self._horizon, self._moves
        for k in range(n + 1):
            above, below, slack = (k, n + k, m + 2) if k < n else (2 * n, 2 * n + 1, m + 3)
            G[above, slack], G[below, slack] = -1.0, -1.0
            for j in range(m + SHIFTS):
                G[above, j], G[below, j] = self._S[k, j], -self._S[k, j]
            for axis in range(2):
                h[axis, above] = self._box[axis, k] + (self._middle[axis, k] - self._s[axis, k])
                h[axis, below] = self._box[axis, k] - (self._middle[axis, k] - self._s[axis, k])

    def _rate_limits(self, G: Array, h: Array, last_jerk: Array) -> None:
        """Bound the change of the jerk from the last tick and from block to block (the paper's ±0.1, per sample)."""
        m = self._moves
        for j in range(m):
            above, below = 2 * self._horizon + 2 + j, 2 * self._horizon + 2 + m + j
            G[above, j], G[below, j] = 1.0, -1.0
            if j > 0:
                G[above, j - 1], G[below, j - 1] = -1.0, 1.0
            for axis in range(2):
                change = last_jerk[axis] if j == 0 else 0.0
                h[axis, above], h[axis, below] = self._rate_limit + change, self._rate_limit - change

    def _bounds(self, lower: Array, upper: Array, least: Array, most: Array) -> None:
        """Bounds of z: shifts within their own, slacks not negative, the whole jerk of a block within its limit.

        The limit counts where the nominal jerk keeps it; a move of zero always is allowed.

        Args:
            lower: to be written, shape (axis, size).
            upper: to be written, shape (axis, size).
            least: of the shifts, shape (step, axis) [m].
            most: of the shifts, shape (step, axis) [m].
        """
        m = self._moves
        for axis in range(2):
            begin = 0
            for move in range(m):
                lowest, highest = algebra.INFINITY, -algebra.INFINITY
                for k in range(begin, self._ends[move]):
                    lowest, highest = min(lowest, self._nominal.u[k, axis]), max(highest, self._nominal.u[k, axis])
                lower[axis, move] = min(-self._jerk_limit - lowest, 0.0)
                upper[axis, move] = max(self._jerk_limit - highest, 0.0)
                begin = self._ends[move]
            for step in range(SHIFTS):
                lower[axis, m + step], upper[axis, m + step] = least[step, axis], most[step, axis]
            for slack in range(m + SHIFTS, m + EXTRA):
                lower[axis, slack], upper[axis, slack] = 0.0, algebra.INFINITY
