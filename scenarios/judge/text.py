"""Metrics and criteria in the units that engineers speak in."""

import math
from collections.abc import Mapping
from typing import Any

from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import known

FIRST_METRICS = (
    "steps_taken",
    "zmp_inside_fraction",
    "cop_ratio_p99",
    "zmp_error_rms",
    "com_error_rms",
    "footstep_error_max",
    "foot_slip_max",
    "torque_ratio_max",
    "speed_mean",
    "real_time_factor",
)
"""The ten metrics that a walking engineer asks for first."""


def shown_unit(name: str) -> str:
    """Unit in which a metric, or the part of one after a dot, is shown."""
    metric = known(name)
    return metric.shown if metric else ""


def value_text(name: str, value: Any) -> str:
    """A metric's value in its shown unit."""
    if isinstance(value, list):
        return "  ".join(value_text(name, element) for element in value)
    if isinstance(value, Mapping):
        return "  ".join(f"{key} {value_text(name, element)}" for key, element in value.items())
    if value is None:
        return "-"
    scale = _scale(name)
    counted = isinstance(value, bool | str) or (isinstance(value, int) and scale == 1.0)
    return str(value).lower() if counted else _number(name, scale * value)


def bound_text(name: str, bound: Bound | None) -> str:
    """A criterion in its metric's shown unit; empty when there is none."""
    if bound is None:
        return ""
    parts = [] if bound.equals is None else [f"= {value_text(name, bound.equals)}"]
    for sign, limit in ((">=", bound.min), ("<=", bound.max)):
        if limit is not None:
            parts.append(f"{sign} {value_text(name, list(limit) if isinstance(limit, tuple) else limit)}")
    return ", ".join(parts)


def _scale(name: str) -> float:
    metric = known(name)
    return metric.scale if metric else 1.0


def _number(name: str, shown: float) -> str:
    """Three digits; the share of the time inside is rounded down, so that it shows 100 % only when it is."""
    if name == "zmp_inside_fraction":
        return f"{math.floor(shown * 100 + 1e-6) / 100:.6g}"
    return f"{shown:.0f}" if abs(shown) >= 1000 else f"{shown:.3g}"
