"""Criteria: bounds on metrics; which metrics there are, `surefoot.scenarios.judge.metrics` tells."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from surefoot.scenarios.file.group import Group, as_tuple

Limit = Annotated[float | tuple[float, ...], BeforeValidator(as_tuple)]


class Bound(Group):
    """Bounds on one metric; of a list-valued one element by element, by one limit for all or one for each."""

    min: Limit | None = Field(default=None, description="least value allowed")
    max: Limit | None = Field(default=None, description="greatest value allowed")
    equals: bool | float | str | None = Field(default=None, description="the value, or another metric's name")

    @model_validator(mode="before")
    @classmethod
    def _scalar_means_equals(cls, value: Any) -> Any:
        if isinstance(value, dict) and None in value.values():
            side = next(name for name, limit in value.items() if limit is None)
            raise ValueError(f"{side} is null; give its value, or leave it out")
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
