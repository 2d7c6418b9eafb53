"""Metrics: pure functions of a log."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.criteria import BODY_METRICS, METRIC_NAMES
from surefoot.scenarios.judge import balance, effort, walking
from surefoot.scenarios.judge.digest import Digest, RunView, Source
from surefoot.scenarios.log import Log

_BODY = ("/truth",)
_FEET = ("/truth", "/contact")
_PLAN = ("/truth", "/plan")

_METRICS: dict[str, tuple[tuple[str, ...], Callable[[RunView], Any]]] = {
    "fell": (_BODY, walking.fell),
    "fall_time": (_BODY, walking.fall_time),
    "duration": (_BODY, walking.duration),
    "steps_planned": ((), walking.steps_planned),
    "steps_taken": (_BODY, walking.steps_taken),
    "standing_time_final": (_FEET, walking.standing_time_final),
    "standing_time_between": ((*_FEET, "/reference"), walking.standing_time_between),
    "zmp_inside_fraction": ((*_FEET, "/reference"), balance.zmp_inside_fraction),
    "zmp_excursion_max": ((*_FEET, "/reference"), balance.zmp_excursion_max),
    "cop_ratio_p99": (("/contact", "/reference"), balance.cop_ratio_p99),
    "cop_ratio_max": (("/contact", "/reference"), balance.cop_ratio_max),
    "zmp_error_rms": (("/contact", "/reference"), balance.zmp_error_rms),
    "zmp_error_max": (("/contact", "/reference"), balance.zmp_error_max),
    "com_error_rms": (_PLAN, balance.com_error_rms),
    "dcm_error_rms": (_PLAN, balance.dcm_error_rms),
    "footstep_error_max": (("/footstep",), walking.footstep_error_max),
    "stair_edge_margin_min": (("/footstep",), walking.stair_edge_margin_min),
    "swing_clearance_min": (("/truth", "/reference"), walking.swing_clearance_min),
    "foot_slip_max": (_FEET, walking.foot_slip_max),
    "self_contact_time": (_BODY, walking.self_contact_time),
    "torque_ratio_max": (("/torque",), effort.torque_ratio_max),
    "torque_at_limit_fraction": (("/torque",), effort.torque_at_limit_fraction),
    "knee_torque_rms": (("/torque", "/reference"), effort.knee_torque_rms),
    "joint_limit_margin_min": (("/measurement",), effort.joint_limit_margin_min),
    "knee_angle_mean": (("/measurement", "/reference"), walking.knee_angle_mean),
    "cost_of_transport": (("/truth", "/measurement"), effort.cost_of_transport),
    "speed_mean": (("/truth", "/reference"), walking.speed_mean),
    "path_length": (_BODY, walking.path_length),
    "displacement": (_BODY, walking.displacement),
    "heading_change": (_BODY, walking.heading_change),
    "com_height_range": (_BODY, walking.com_height_range),
    "planner_infeasible_fraction": (("/plan",), effort.planner_infeasible_fraction),
    "estimation_error_rms": (("/truth", "/planner_state"), balance.estimation_error_rms),
    "dcm_estimation_error_rms": (("/truth", "/planner_state", "/reference"), balance.dcm_estimation_error_rms),
    "planner_time": (("/timing",), effort.planner_time),
    "wbc_time": (("/timing",), effort.wbc_time),
    "real_time_factor": (("/timing",), effort.real_time_factor),
    "qp_failures": (("/wbc",), effort.qp_failures),
    "wbc_fallbacks": (("/wbc",), effort.wbc_fallbacks),
    "log_bytes": ((), effort.log_bytes),
}


_REDUCTIONS: tuple[tuple[tuple[str, ...], Callable[[RunView], Any]], ...] = (
    (("/torque",), effort.torque_ratio),
    (("/torque",), effort.strained_joint),
    (("/torque",), effort.knee_torque_squared),
    (("/measurement",), effort.joint_limit_margin),
    (("/measurement",), effort.joint_power),
    (("/measurement",), walking.knee_flexion),
    (("/truth", "/contact", "/reference"), balance.zmp_depth),
    (("/plan",), balance.predicted),
)
"""What wide channels are reduced to while the log is read, and the topics it needs."""


def digest(log: Log) -> Digest:
    """Gather what the metrics need, in one pass with bounded memory.

    Raises:
        LogError: the log does not describe a run.
    """
    constants = RunView(log).constants

    def reduce(part: Source) -> dict[Any, Any]:
        run = RunView(part, constants)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            return {function: function(run) for topics, function in _REDUCTIONS if run.has(*topics)}

    return Digest(log, reduce)


def compute(log: Log | Digest) -> dict[str, Any]:
    """Compute every metric of the public contract.

    Args:
        log: a log of a run, whole or truncated, or its digest.

    Returns:
        values by metric name, None where a metric does not apply or its channels or fields are missing; plain JSON
        values.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(log if isinstance(log, Digest) else digest(log))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return {name: _metric(run, name) for name in METRIC_NAMES}


def _metric(run: RunView, name: str) -> Any:
    if name not in _METRICS or (run.constants.fidelity == "pendulum" and name in BODY_METRICS):
        return None
    topics, function = _METRICS[name]
    try:
        return _plain(function(run)) if run.has(*topics) else None
    except LogError:  # the log of another version lacks a field
        return None


def _plain(value: Any) -> Any:
    """The value for JSON: what is not a finite number becomes None."""
    if isinstance(value, list):
        return [_plain(element) for element in value]
    if isinstance(value, dict):
        return {key: _plain(element) for key, element in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def describe_metric(name: str) -> str:
    """What a metric is, in a sentence: the first line of its function's documentation."""
    return (_METRICS[name][1].__doc__ or "").split("\n", 1)[0]
