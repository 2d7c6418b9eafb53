"""Numbers for people: metrics in the units an engineer thinks in, with their bounds. JSON stays in SI."""

import math
from collections.abc import Mapping
from typing import Any

from scenarios.file.criteria import Bound

_UNITS: dict[str, tuple[float, str]] = {
    **dict.fromkeys(("zmp_error_rms", "com_error_rms", "dcm_error_rms"), (1e3, "mm")),
    **dict.fromkeys(("estimation_error_rms", "dcm_estimation_error_rms"), (1e3, "mm")),
    **dict.fromkeys(("zmp_error_max", "zmp_excursion_max"), (1e3, "mm")),
    **dict.fromkeys(
        ("footstep_error_max", "foot_slip_max", "stair_edge_margin_min", "swing_clearance_min", "com_height_range"),
        (1e3, "mm"),
    ),
    **dict.fromkeys(
        ("fall_time", "duration", "standing_time_final", "standing_time_between", "self_contact_time"), (1.0, "s")
    ),
    **dict.fromkeys(("planner_time", "wbc_time"), (1e3, "ms")),
    **dict.fromkeys(("joint_limit_margin_min", "knee_angle_mean", "heading_change"), (180.0 / math.pi, "deg")),
    **dict.fromkeys(("cop_ratio_p99", "cop_ratio_max"), (1e2, "% of half the foot")),
    "zmp_inside_fraction": (1e2, "% of the time"),
    "planner_infeasible_fraction": (1e2, "% of the plans"),
    "torque_ratio_max": (1e2, "% of the limit"),
    "torque_at_limit_fraction": (1e2, "% of the time"),
    **dict.fromkeys(("path_length", "displacement"), (1.0, "m")),
    "knee_torque_rms": (1.0, "N m"),
    "speed_mean": (1.0, "m/s"),
    "real_time_factor": (1.0, "times real time"),
    "log_bytes": (1e-6, "MB"),
}


def unit(name: str) -> str:
    """Unit in which a metric, or the part of one after a dot, is shown."""
    return _scale(name)[1]


def value_text(name: str, value: Any) -> str:
    """A metric's value in its shown unit."""
    if isinstance(value, list):
        return "  ".join(value_text(name, element) for element in value)
    if isinstance(value, Mapping):
        return "  ".join(f"{key} {value_text(name, element)}" for key, element in value.items())
    if value is None:
        return "-"
    scaled = isinstance(value, float) or name == "log_bytes"
    return _number(name, value) if scaled else str(value).lower()


def bound_text(name: str, bound: Bound | None) -> str:
    """A criterion in its metric's shown unit; empty when there is none."""
    if bound is None:
        return ""
    parts = [] if bound.equals is None else [f"= {value_text(name, bound.equals)}"]
    for sign, limit in ((">=", bound.min), ("<=", bound.max)):
        if limit is not None:
            parts.append(f"{sign} {value_text(name, list(limit) if isinstance(limit, tuple) else limit)}")
    return ", ".join(parts)


def _scale(name: str) -> tuple[float, str]:
    return _UNITS.get(name.partition(".")[0], (1.0, ""))


def _number(name: str, value: float) -> str:
    """Three digits; a share is rounded down, so that it shows 100 % only when it is."""
    shown = _scale(name)[0] * value
    if name == "zmp_inside_fraction":
        return f"{math.floor(shown * 100 + 1e-6) / 100:.6g}"
    return f"{shown:.0f}" if abs(shown) >= 1000 else f"{shown:.3g}"
