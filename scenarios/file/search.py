"""The search for a threshold as it is written: of which key, over which range, and how well it shall be known."""

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from surefoot.scenarios.file.group import Group

MOST_RUNS = 1_000_000
MOST = 1e100
"""No value that is searched, drawn or shown on an axis is farther from zero, so that no difference of two overflows."""

BoundedNumber = Annotated[float, Field(ge=-MOST, le=MOST, allow_inf_nan=False)]


class Bisect(Group):
    """The search for the value of a key from which on runs fail."""

    key: str = Field(description="of the scenario")
    low: BoundedNumber = Field(description="one end of the range")
    high: BoundedNumber = Field(description="the other")
    tolerance: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = Field(
        default=None, description="how well the threshold shall be known; the range is halved"
    )
    ratio: Annotated[float, Field(gt=1, le=1000, allow_inf_nan=False)] | None = Field(
        default=None, description="of a rung over the one below it; the ladder is climbed as long as every seed passes"
    )

    most: BoundedNumber | None = Field(
        default=None, description="where the whole range passes it goes on upwards, doubled each time, to here"
    )

    @model_validator(mode="after")
    def _goes_on(self) -> Self:
        if self.most is not None and (self.tolerance is None or self.low < 0.0 or self.most < self.high):
            raise ValueError(
                "most is of a range from 0 on that is halved, and above it; give tolerance, or leave it out"
            )
        return self

    @model_validator(mode="after")
    def _a_range(self) -> Self:
        if (self.tolerance is None) == (self.ratio is None):
            raise ValueError("needs tolerance, to halve the range, or ratio, to climb it; give one of them")
        if self.low >= self.high:
            raise ValueError(f"the range from {self.low:g} to {self.high:g} is empty; give low below high")
        if self.ratio is not None and self.low <= 0.0:
            raise ValueError(f"low is {self.low:g}, from which no ratio leads upwards; give more than 0")
        if self.ratio is not None and math.log(self.high) - math.log(self.low) > MOST_RUNS * math.log(self.ratio):
            raise ValueError(f"the ladder has more than {MOST_RUNS} rungs; give a greater ratio")
        if self.ratio is not None and not math.isfinite(self.high / self.low):
            raise ValueError(
                f"the range from {self.low:g} to {self.high:g} is too wide for a ladder; give a greater low"
            )
        return self

    @property
    def rungs(self) -> tuple[float, ...]:
        """Values of a ladder, the highest not above the range."""
        assert self.ratio is not None
        count = 1 + math.floor(math.log(self.high / self.low) / math.log(self.ratio) + 1e-9)
        return tuple(self.low * self.ratio**k for k in range(count))
