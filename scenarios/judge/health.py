"""Health checks: pure functions of a log that name the likely cause of what they find, and of a fall what caused it."""

from collections.abc import Callable
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge import balance, computing_checks, effort, motion_checks
from surefoot.scenarios.judge.digest import SENSED, AbsentError, Digest, RunView
from surefoot.scenarios.judge.finding import Finding, shared

if TYPE_CHECKING:
    from surefoot.scenarios.judge.loss import Loss

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
    "/plan": ("held", "capture_margin"),
    "/link": ("command_age",),
}
"""Fields that the checks and causes of a fall read, beside those that tell a fall."""

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
    """Apply every check whose channels are there, and of a run that fell say why.

    Returns:
        Causes of a fall (`surefoot.scenarios.judge.causes`); warnings in the order of their first evidence; those of
        the run as a whole; the checks that found nothing.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(digest)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        found = [_found(check, run) for topics, check in _CHECKS if run.has("/truth", *topics)]
        lost, why = _fallen(run)
    if lost is not None:
        found = [_related(one, why, lost) for one in found]
    found.sort(key=lambda one: (one.status == "ok", inf if one.time is None else one.time))
    return (*why, *found)


def _fallen(run: RunView) -> "tuple[Loss | None, tuple[Finding, ...]]":
    """The loss of a robot's balance, and its causes; None of one that did not fall."""
    if not run.has("/truth"):
        return None, ()
    from surefoot.scenarios.judge.causes import causes
    from surefoot.scenarios.judge.loss import loss

    try:
        lost = loss(run)
        return lost, () if lost is None else causes(run, lost)
    except AbsentError:  # of a log that a topic was filtered out of
        return None, ()
    except (ValueError, IndexError, TypeError) as error:
        return None, (shared("causes", True, None, f"cannot be looked at: {error}"),)


def _related(finding: Finding, why: tuple[Finding, ...], lost: "Loss") -> Finding:
    """The same finding, an effect where its evidence comes after that of a cause or after the loss of balance."""
    if finding.status == "ok" or finding.time is None:
        return finding
    for cause in why:
        if cause.time is None or finding.time >= cause.time:
            return replace(finding, relation="effect", likely=f"it follows from the cause {cause.check}")
    if finding.time > lost.time:
        return replace(finding, relation="effect", likely=f"balance was lost before, at {lost.time:.3f} s")
    return finding


def _found(check: Callable[[RunView], Finding], run: RunView) -> Finding:
    """The finding of a check, also in values that no run has."""
    try:
        return check(run)
    except (LogError, ValueError, IndexError, TypeError) as error:
        return shared(check.__name__, True, None, f"cannot be looked at: {error}")
