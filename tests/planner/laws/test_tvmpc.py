from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import qpsolvers

from surefoot.planner.laws.footstep_tvmpc import FootstepTvmpc
from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.laws.qp import OPTIONS, solve
from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.model.nominal import nominal_motion
from surefoot.planner.parameters import SOLVERS, PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.step_region import reachable_shifts
from surefoot.planner.types import CentroidalState, SolverStatus

pytestmark = pytest.mark.unit


def problem_at(stand, com=(0.0, 0.0), velocity=(0.0, 0.0), ticks=1, **parameters):
    gait = GaitParameters(lateral_step=0.1, initial_stand=0.0)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, parameters=PlannerParameters(**parameters))
    for tick in range(ticks):
        state = CentroidalState(0.02 * tick, np.array([*com, 1.0]), np.array([*velocity, 0.0]))
        planner.update(state, stand())
    return planner.motion.qps


def kkt_residuals(qp, solver):
    solution = qpsolvers.solve_problem(qp.problem(), solver, **OPTIONS[solver])
    return solution.x, solution.primal_residual(), solution.dual_residual(), solution.duality_gap()


@pytest.mark.parametrize("com", [(0.0, 0.0), (0.01, -0.02), (0.04, -0.1), (0.2, 0.3)])
def test_solution_passes_kkt_and_two_solvers_agree(stand, com):
    for qp in problem_at(stand, com, ticks=3):
        first, *residuals = kkt_residuals(qp, SOLVERS[0])
        second, *_ = kkt_residuals(qp, SOLVERS[1])
        assert max(residuals) < 1e-8
        np.testing.assert_allclose(first, second, atol=1e-5)
        assert qp.P @ first @ first / 2 + qp.q @ first == pytest.approx(qp.P @ second @ second / 2 + qp.q @ second)


def tick_of(fallback=None, seed=4, **parameters):
    """A tick with everything varying, and the law for it."""
    p = PlannerParameters(**parameters)
    rng, count = np.random.default_rng(seed), p.horizon + p.preview + 1
    ramp = np.clip((np.arange(count)[:, None] - (20, 90)) / 25, 0.0, 1.0)
    stiffness = 9.0 + np.sin(0.1 * np.arange(count))
    box = rng.uniform(0.02, 0.05, (count, 2))
    reference = ZmpReference(ramp @ [[0.2, 0.1], [0.3, -0.2]], ramp, box, np.zeros(count), np.zeros((count, 2)))
    increment, free = np.full((2, 2), 0.2), (True, True)
    bounds = reachable_shifts(p, increment, 1.0, free, np.zeros(2), 0.4)
    steps = StepContext(increment, (1.0, -1.0), free, np.zeros(2), 0.4, 0.2, *bounds)
    fallback = np.zeros((p.horizon, 2)) if fallback is None else fallback
    state, omega = rng.normal(size=(2, 3)), np.sqrt(stiffness) + 0.1
    problem = MotionProblem(state, stiffness, omega, reference, steps, rng.normal(size=2), fallback, np.eye(2))
    return FootstepTvmpc(p, 1.0), problem, p


RATES = pytest.mark.parametrize("rate", [1e3, np.inf])
"""With a limit on its rate the moves are the whole jerk, without one what differs from the nominal motion."""


def errors_of(z, axis, problem, p, nominal):
    """ZMP errors at samples 1..N and DCM error at the end: jerks through the integrator, sample by sample.

    The DCM that the known footholds keep bounded is that of the nominal motion, where there is one.
    """
    t, (x, v, a), shifts, n = p.sample_time, problem.state[axis], z[10:12], p.horizon
    point, shifted = problem.reference.point[:, axis], problem.reference.gain @ shifts
    target, errors = point + shifted, []
    for k in range(n):
        u = nominal[k, axis] + z[sum(start <= k for start in p.moves) - 1]
        x, v, a = x + t * v + t**2 / 2 * a + t**3 / 6 * u, v + t * a + t**2 / 2 * u, a + t * u
        errors.append(x - a / problem.stiffness[k + 1] - target[k + 1])
    viable = nominal_dcm(problem.stiffness[n:], problem.omega[n:], np.stack((point, shifted))[:, n:].T, t)[0]
    if nominal.any():
        com = nominal_motion(problem.state[:, 0], problem.reference.point, problem.stiffness, t).com
        viable[0] = com[0, n, axis] + com[1, n, axis] / problem.omega[n]
    viable = viable.sum()
    return np.array(errors), x + v / problem.omega[n] - viable


def cost_of(z, errors, end, p):
    """The cost in words."""
    cost = errors @ errors + p.terminal_weight * end**2
    cost += p.jerk_weight * z[:10] @ z[:10] + p.step_weight * z[10:12] @ z[10:12]
    return cost + sum(c[0] * s**2 + c[1] * s for c, s in ((p.zmp_slack, z[12]), (p.terminal_slack, z[13])))


def some_moves(seed):
    return np.random.default_rng(seed).normal(size=(5, 14)) * [*[5.0] * 10, 0.1, 0.1, 0.1, 0.1]


@RATES
def test_cost_is_the_sum_of_squares_it_says(rate):
    law, problem, p = tick_of(jerk_weight=1e-3, jerk_rate_limit=rate)
    built = law.build(problem)
    assert built.jerk.any() == np.isinf(rate)
    for axis, qp in enumerate(built.axes):
        np.testing.assert_array_equal(qp.P, qp.P.T)
        assert np.linalg.eigvalsh(qp.P).min() > 0.0
        least = cost_of(np.zeros(14), *errors_of(np.zeros(14), axis, problem, p, built.jerk), p)
        for z in some_moves(axis):
            expected = cost_of(z, *errors_of(z, axis, problem, p, built.jerk), p) - least
            assert 0.5 * z @ qp.P @ z + qp.q @ z == pytest.approx(expected, rel=1e-9)


@RATES
def test_constraints_are_box_terminal_bound_and_rate(rate):
    law, problem, p = tick_of(jerk_rate_limit=rate)
    built, n = law.build(problem), p.horizon
    for axis, qp in enumerate(built.axes):
        for z in some_moves(axis):
            (errors, end), room = errors_of(z, axis, problem, p, built.jerk), qp.h - qp.G @ z
            box, bound = problem.reference.half_size[1 : n + 1, axis] + z[12], problem.reference.half_size[n, axis]
            bound = p.terminal_margin * bound + z[13]
            right = [box - errors, box + errors, [bound - end, bound + end]]
            if np.isfinite(rate):
                change = np.diff(z[:10], prepend=problem.last_jerk[axis])
                right += [rate - change, rate + change]
            np.testing.assert_allclose(room, np.concatenate(right), rtol=1e-9, atol=1e-9)


def test_bounds_keep_the_whole_jerk_of_each_block_and_the_shifts_within_their_limits():
    law, problem, p = tick_of(jerk_limit=20.0)
    built, blocks = law.build(problem), [*p.moves, p.horizon]
    assert np.abs(built.jerk).max() > p.jerk_limit  # which a move of zero keeps allowed
    for axis, qp in enumerate(built.axes):
        for move, (begin, end) in enumerate(pairwise(blocks)):
            jerk = built.jerk[begin:end, axis]
            assert qp.lower[move] == min(-p.jerk_limit - jerk.min(), 0.0)
            assert qp.upper[move] == max(p.jerk_limit - jerk.max(), 0.0)
        np.testing.assert_array_equal(qp.lower[10:], [*problem.steps.lower[:, axis], 0.0, 0.0])
        np.testing.assert_array_equal(qp.upper[10:], [*problem.steps.upper[:, axis], np.inf, np.inf])


def test_a_window_of_another_length_is_planned_as_by_a_fresh_law():
    law, problem, p = tick_of()
    law.build(problem)
    short = replace(
        problem,
        stiffness=problem.stiffness[:-7],
        omega=problem.omega[:-7],
        reference=replace(
            problem.reference,
            **{name: getattr(problem.reference, name)[:-7] for name in ("point", "gain", "half_size")},
        ),
    )
    for found, right in zip(law.build(short).axes, FootstepTvmpc(p, 1.0).build(short).axes, strict=True):
        for name in ("P", "q", "G", "h", "lower", "upper"):
            np.testing.assert_array_equal(getattr(found, name), getattr(right, name))


def test_any_state_has_a_solution_and_its_slack_is_reported():
    law, problem, _ = tick_of()
    problem = replace(problem, state=np.array([[0.5, 2.0, 0.0], [0.5, -2.0, 0.0]]))
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.SOLVED
    assert np.all(motion.zmp_slack + motion.terminal_slack > 0.1)


def test_rate_limit_bounds_every_change_of_jerk(stand):
    qp = problem_at(stand, (0.0, 0.02), jerk_limit=1.5, jerk_rate_limit=0.1)[1]
    moves = solve(qp).z[:10]
    assert np.abs(np.diff(moves, prepend=0.0)).max() <= 0.1 + 1e-8
    assert np.abs(np.diff(moves, prepend=0.0)).max() > 0.09


def test_second_solver_is_used_and_said(stand):
    qp = problem_at(stand)[0]
    assert solve(qp, ("no-such-solver", SOLVERS[1])).attempt == 1
    np.testing.assert_allclose(solve(qp, ("no-such-solver", SOLVERS[1])).z, solve(qp).z, atol=1e-5)


def test_both_solvers_find_out_what_has_no_solution(stand):
    qp = problem_at(stand)[0]
    impossible = replace(qp, G=np.vstack((qp.G[:1], -qp.G[:1])), h=np.array([-1.0, 0.5]))
    for name in SOLVERS:
        assert solve(impossible, (name,)).z is None


def test_without_any_solver_the_fallback_jerk_is_kept():
    fallback = np.random.default_rng(0).normal(size=(50, 2))
    law, problem, _ = tick_of(fallback, solvers=("none", "neither"), jerk_rate_limit=1e3)
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.HELD
    np.testing.assert_array_equal(motion.jerk, fallback)
    assert np.isnan(motion.zmp_slack).all()
    assert not motion.shifts.any()


def test_the_three_steps_are_the_plan():
    law, problem, _ = tick_of()
    built = law.build(problem)
    motion, whole = law.interpret(problem, built, law.solve(built)), law.plan(problem)
    np.testing.assert_array_equal(motion.jerk, whole.jerk)
    np.testing.assert_array_equal(motion.shifts, whole.shifts)
    halved = tuple(replace(solution, z=0.5 * solution.z) for solution in law.solve(built))
    np.testing.assert_allclose(law.interpret(problem, built, halved).jerk, 0.5 * (whole.jerk + built.jerk))


def test_qps_are_those_of_their_plan_whenever_they_are_looked_at():
    law, problem, _ = tick_of()
    motion, built = law.plan(problem), law.build(problem)
    law.plan(tick_of(seed=5)[1])
    for found, right in zip(motion.qps, built.axes, strict=True):
        for name in ("P", "q", "G", "h", "lower", "upper"):
            np.testing.assert_array_equal(getattr(found, name), getattr(right, name))


def test_where_an_axis_is_not_solved_the_jerk_before_is_kept():
    law, problem, _ = tick_of(np.random.default_rng(0).normal(size=(50, 2)))
    problem.state[:, 1:] = np.nan
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.HELD
    np.testing.assert_allclose(motion.jerk, problem.fallback, atol=1e-12)


def test_a_law_with_a_step_of_its_own_takes_it():
    class Halved(FootstepTvmpc):
        def solve(self, built):
            return tuple(replace(solution, z=0.5 * solution.z) for solution in super().solve(built))

    law, problem, p = tick_of()
    np.testing.assert_array_equal(Halved(p, 1.0).plan(problem).shifts, 0.5 * law.plan(problem).shifts)
