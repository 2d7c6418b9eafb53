"""Health checks: pure functions of a log that name the likely cause of what they find."""

from collections.abc import Callable
from math import inf

import numpy as np

from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge import balance, computing_checks, effort, motion_checks
from surefoot.scenarios.judge.digest import SENSED, Digest, RunView
from surefoot.scenarios.judge.finding import Finding, shared

_BODY = ("/truth", "/measurement", "/estimate", "/torque")
_CHECKS: tuple[tuple[tuple[str, ...], Callable[[RunView], Finding]], ...] = (
    (_BODY, computing_checks.not_finite),
    (("/truth", "/contact", "/reference"), motion_checks.forces_match_weight),
    (("/truth", "/contact", "/reference"), motion_checks.foot_slip),
    (("/truth", "/reference"), motion_checks.late_touchdowns),
    (("/truth", "/contact", "/reference"), motion_checks.zmp_at_edge),
    (("/torque",), motion_checks.torque_saturation),
    (("/measurement", "/contact", "/reference"), motion_checks.joint_stops),
    (("/measurement", "/contact", "/reference"), motion_checks.joint_speeds),
    (("/truth", "/estimate"), computing_checks.estimator_drift),
    ((SENSED,), computing_checks.estimator_confidence),
    (("/wbc",), computing_checks.controller_fallbacks),
    (("/plan",), computing_checks.planner_fallbacks),
    (("/timing",), computing_checks.overrun_ticks),
)
"""Every check and the topics that it needs."""

READS: Reads = {
    "/measurement": ("external_force",),
    "/truth": ("com", "com_velocity", "external_force"),  # the force is of the pendulum
    "/estimate": ("com",),
    SENSED: ("com_error",),
    "/contact": ("normal_force", "planned", "active", "felt"),
    "/reference": ("stance", "phase_duration"),
    "/wbc": ("fallback",),
    "/timing": (*computing_checks.PARTS, "tick"),
    "/plan": ("held",),
}
"""Fields that the checks read, beside those that tell a fall."""

REDUCTIONS = (
    *(effort.torque_ratio, effort.joint_overrun, effort.joint_speed_ratio, effort.joint_power),
    balance.zmp_depth,
)
"""Reductions that the checks use."""

TOPICS = frozenset(
    (
        *(topic for topics, _ in _CHECKS for topic in topics),
        *READS,
        *(topic for reduction in REDUCTIONS for topic in reduction.needs),
    )
)
"""Topics that the checks read, in one way or another."""


def findings(digest: Digest) -> tuple[Finding, ...]:
    """Apply every check whose channels are there.

    Returns:
        Warnings in the order of their first evidence, so that a cause stands before what follows from it; then those
        of the run as a whole, and the checks that found nothing.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(digest)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        found = [_found(check, run) for topics, check in _CHECKS if run.has("/truth", *topics)]
    return tuple(sorted(found, key=lambda one: (one.status == "ok", inf if one.time is None else one.time)))


def _found(check: Callable[[RunView], Finding], run: RunView) -> Finding:
    """What a check finds, also in values that no run has."""
    try:
        return check(run)
    except (LogError, ValueError, IndexError, TypeError) as error:
        return shared(check.__name__, True, None, f"cannot be looked at: {error}")
