"""Criteria: bounds on metrics, and the list of metric names they may use."""

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

METRIC_NAMES = (
    "fell",
    "fall_time",
    "duration",
    "steps_planned",
    "steps_taken",
    "standing_time_final",
    "standing_time_between",
    "zmp_inside_fraction",
    "zmp_excursion_max",
    "cop_ratio_p99",
    "cop_ratio_max",
    "zmp_error_rms",
    "zmp_error_max",
    "com_error_rms",
    "dcm_error_rms",
    "footstep_error_max",
    "stair_edge_margin_min",
    "swing_clearance_min",
    "foot_slip_max",
    "self_contact_time",
    "torque_ratio_max",
    "knee_torque_rms",
    "torque_at_limit_fraction",
    "joint_limit_margin_min",
    "knee_angle_mean",
    "cost_of_transport",
    "speed_mean",
    "path_length",
    "displacement",
    "heading_change",
    "com_height_range",
    "estimation_error_rms",
    "planner_infeasible_fraction",
    "dcm_estimation_error_rms",
    "planner_time",
    "wbc_time",
    "real_time_factor",
    "qp_failures",
    "wbc_fallbacks",
    "log_bytes",
)
"""Names of the metrics that a log gives, in the order in which they are shown."""

BODY_METRICS = (
    "footstep_error_max",
    "swing_clearance_min",
    "foot_slip_max",
    "self_contact_time",
    "torque_ratio_max",
    "knee_torque_rms",
    "torque_at_limit_fraction",
    "joint_limit_margin_min",
    "knee_angle_mean",
    "cost_of_transport",
    "wbc_time",
    "qp_failures",
    "wbc_fallbacks",
)
"""Metrics of joints, sensors and real feet, which a pendulum has not got."""

TIMED = ("planner_time", "wbc_time")
"""Metrics that are a median and a 99th percentile."""

ELEMENTS = {
    "zmp_error_rms": 2,
    "zmp_error_max": 2,
    "com_error_rms": 3,
    "dcm_error_rms": 2,
    "dcm_estimation_error_rms": 2,
    "displacement": 2,
}
"""Number of elements of the list-valued metrics."""

BOUNDABLE = tuple(
    name
    for metric in METRIC_NAMES
    for name in ((f"{metric}.median", f"{metric}.p99") if metric in TIMED else (metric,))
)
"""Names that a criterion may use: metrics, and for the timed ones their median and 99th percentile."""

Number = Annotated[float, Field(allow_inf_nan=False)]


def _numbers(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


Limit = Annotated[Number | tuple[Number, ...], BeforeValidator(_numbers)]


class Bound(BaseModel):
    """Bounds on one metric; a list-valued metric is bounded element by element.

    Attributes:
        min: least value allowed, one for all elements or one per element.
        max: greatest value allowed, likewise.
        equals: the value itself, or the name of another metric that it must equal.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    min: Limit | None = Field(default=None, description="least value allowed")
    max: Limit | None = Field(default=None, description="greatest value allowed")
    equals: bool | Number | str | None = Field(default=None, description="the value, or another metric's name")

    @model_validator(mode="before")
    @classmethod
    def _scalar_means_equals(cls, value: Any) -> Any:
        return {"equals": value} if isinstance(value, bool | int | float | str) else value

    @model_validator(mode="after")
    def _bounds_something(self) -> "Bound":
        if self.min is None and self.max is None and self.equals is None:
            raise ValueError("a criterion without a bound; give min, max or equals")
        return self


def standing_walk() -> dict[str, Bound]:
    """The criteria of a file that gives none: no fall, every step taken, standing for a second at the end."""
    return {
        "fell": Bound(equals=False),
        "steps_taken": Bound(equals="steps_planned"),
        "standing_time_final": Bound(min=1.0),
    }
