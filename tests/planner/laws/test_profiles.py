"""Every profile on the true pendulum, and the QPs that it solves there."""

from functools import cache

import numpy as np
import pytest
import qpsolvers
from pendulum_walk import walk_pendulum

from surefoot.forces import Push
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.laws.qp import OPTIONS
from surefoot.planner.parameters import SOLVERS
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import SolverStatus

pytestmark = pytest.mark.unit

GAIT = GaitParameters(steps=2)
"""Lateral stance of ±0.1 m: the paper's limits of the jerk allow no more than 0.24 m of ZMP in its double support."""


@pytest.fixture(scope="module")
def walks(stand):
    def walk(name, gait=GAIT, pushes=()):
        planner, qps = WalkingPlanner(gait, stand(), 0.075, 0.075, profile=PROFILES[name]), []
        update = planner.update

        def observed(state, feet):
            plan = update(state, feet)
            qps.extend(planner.motion.qps)
            return plan

        planner.update = observed
        duration = gait.duration + 1.0
        com = np.array([0.0, 0.0, gait.com_height])
        return walk_pendulum(planner, stand(), duration, com=com, pushes=pushes, substeps=2), qps

    cases = {name: (name,) for name in PROFILES} | {
        "repaired, pushed": ("repaired", GAIT, (Push(2.5, 0.1, np.array([60.0, 40.0, 0.0])),)),
        "repaired, wide": ("repaired", GaitParameters(steps=2, lateral_step=0.1)),
    }
    return cache(lambda case: walk(*cases[case]))


def infeasible(trace):
    return np.mean([plan.status.infeasible for plan in trace.plans])


def rms(trace):
    return np.sqrt(np.mean((trace.zmp - trace.zmp_reference) ** 2, axis=0)).max()


@pytest.mark.parametrize("name", ["default", "lti", "preview", "dcm"])
def test_profiles_without_hard_constraints_walk_within_2_mm(walks, name):
    trace = walks(name)[0]
    assert trace.fall_time is None
    assert trace.margin.min() > 0.02
    assert rms(trace) < 2e-3
    assert infeasible(trace) == 0.0
    assert np.abs(trace.plans[-1].com_velocity[0]).max() < 5e-3


def test_paper_is_infeasible_and_falls(walks):
    trace = walks("paper")[0]
    assert trace.fall_time is not None
    assert infeasible(trace) > 0.2
    worst = max(plan.status.zmp_slack.max() for plan in trace.plans if plan.status.infeasible)
    assert worst > 0.02
    assert all(plan.status.zmp_slack.max() == 0.0 for plan in trace.plans if not plan.status.infeasible)


def test_repaired_is_feasible_inside_the_box_and_within_the_papers_limits(walks):
    trace = walks("repaired")[0]
    assert trace.fall_time is None
    assert infeasible(trace) == 0.0
    assert trace.margin.min() > 0.0
    assert rms(trace) < 0.012
    applied = np.array([plan.jerk[0] for plan in trace.plans])
    assert np.abs(applied).max() <= 1.5 + 1e-9
    assert np.abs(np.diff(applied, axis=0)).max() <= 0.1 + 1e-9


def test_a_zmp_that_moves_too_far_for_the_papers_limits_is_counted_not_hidden(walks):
    """0.3 m sideways in the double support: an offline LP over all jerks leaves the box by 4 mm at least."""
    trace = walks("repaired, wide")[0]
    assert infeasible(trace) > 0.05
    assert trace.margin.min() < 0.0


def test_a_push_beyond_the_papers_limits_softens_and_recovers(walks):
    trace = walks("repaired, pushed")[0]
    assert 0.0 < infeasible(trace) < 0.5
    assert trace.fall_time is None


@pytest.mark.parametrize("name", ["default", "lti", "paper", "repaired", "repaired, pushed"])
def test_solutions_pass_kkt_and_two_solvers_agree(walks, name):
    """Residuals of stationarity and complementarity are relative to the largest cost gradient, primal ones in units.

    Where the cost is flat the solvers agree in cost far better than in jerk.
    """
    qps = walks(name)[1]
    softened = {len(qp.q) for qp in qps} if name not in ("default", "lti") else {0}
    assert len(softened) == (2 if name in ("paper", "repaired, pushed") else 1)
    for qp in qps[:: max(1, len(qps) // 60)]:
        first = qpsolvers.solve_problem(qp.problem(), SOLVERS[0], **OPTIONS[SOLVERS[0]])
        second = qpsolvers.solve_problem(qp.problem(), SOLVERS[1], **OPTIONS[SOLVERS[1]])
        z, scale = first.x, 1.0 + np.abs(qp.q).max()
        gradient = qp.P @ z + qp.q + qp.G.T @ first.z + first.z_box
        gap = np.minimum(np.abs(z - qp.lower), np.abs(z - qp.upper))
        assert np.abs(gradient).max() < 1e-8 * scale
        assert max((qp.G @ z - qp.h).max(), (qp.lower - z).max(), (z - qp.upper).max()) < 1e-8
        assert first.z.min() >= -1e-8
        assert np.abs(first.z * (qp.h - qp.G @ z)).max() < 1e-8 * scale
        assert np.abs(np.where(first.z_box != 0.0, first.z_box * gap, 0.0)).max() < 1e-8 * scale
        cost = [0.5 * x @ qp.P @ x + qp.q @ x for x in (z, second.x)]
        assert abs(cost[0] - cost[1]) < 1e-8 * scale
        apart = z - second.x
        assert apart @ qp.P @ apart < 1e-10 * scale
        assert np.abs(apart).max() < 1e-3


def test_every_profile_solves_what_it_solves(walks):
    for name in PROFILES:
        trace, qps = walks(name)
        assert all(plan.status.solver is not SolverStatus.HELD for plan in trace.plans)
        assert len(qps) == (2 * len(trace.plans) if PROFILES[name].moves else 0)


def test_profiles_without_previewed_dynamics_see_one_stiffness(stand):
    """On a rising CoM the LTI plan differs from the time-varying one; on a level one they are the same plan."""
    plans = {}
    for name in ("default", "lti"):
        for apex in (0.0, 0.05):
            gait = GaitParameters(steps=2, single_support=0.6, double_support=0.2, apex_ss=apex, apex_ds=0.0)
            planner = WalkingPlanner(gait, stand(), 0.075, 0.075, profile=PROFILES[name])
            trace = walk_pendulum(planner, stand(), 2.2, com=np.array([0.0, 0.0, 1.0]), substeps=1)
            plans[name, apex] = trace.plans[-1].jerk
    np.testing.assert_allclose(plans["lti", 0.0], plans["default", 0.0], atol=1e-6)
    assert np.abs(plans["lti", 0.05] - plans["default", 0.05]).max() > 0.1
