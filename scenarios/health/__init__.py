"""Health checks: pure functions of a log that name the likely cause of what they find."""

from collections.abc import Callable

import numpy as np

from scenarios.health import contacts, control
from scenarios.health.finding import Finding
from scenarios.metrics.digest import Digest
from scenarios.metrics.view import RunView

_BODY = ("/truth", "/measurement", "/estimate", "/torque")
_CHECKS: tuple[tuple[tuple[str, ...], Callable[[RunView], Finding]], ...] = (
    (_BODY, control.not_finite),
    (("/truth", "/contact", "/reference"), contacts.forces_match_weight),
    (("/truth", "/contact", "/reference"), contacts.foot_slip),
    (("/truth", "/reference"), contacts.late_touchdowns),
    (("/truth", "/contact", "/reference"), contacts.zmp_at_edge),
    (("/torque",), control.torque_saturation),
    (("/truth", "/estimate"), control.estimator_drift),
    (("/wbc",), control.controller_fallbacks),
    (("/plan",), control.planner_fallbacks),
    (("/timing",), control.overrun_ticks),
)
"""Every check and the topics that it needs."""


def findings(digest: Digest) -> tuple[Finding, ...]:
    """Apply every check whose channels are there.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(digest)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return tuple(check(run) for topics, check in _CHECKS if run.has("/truth", *topics))


__all__ = ["Finding", "findings"]
