"""The specification of a campaign as it is written: what is fixed, varied, drawn and searched for.

Its axes: names, units and labels of what varies, as tables, figures and pages show them.
"""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Self, cast

from pydantic import BaseModel, Field, model_validator

from surefoot.scenarios.errors import nearest
from surefoot.scenarios.file.group import WHOLE, Group, groups_in
from surefoot.scenarios.file.schema import Scenario, own_keys
from surefoot.scenarios.file.search import MOST, MOST_RUNS, Bisect, BoundedNumber
from surefoot.scenarios.file.units import is_number, unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Draw(Group):
    """A distribution of which a value is drawn for each seed."""

    uniform: Annotated[list[BoundedNumber], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="least and greatest value"
    )
    normal: Annotated[list[BoundedNumber], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="mean and standard deviation"
    )
    choice: Annotated[list[Any], Field(min_length=1)] | None = Field(default=None, description="one of these")

    @model_validator(mode="after")
    def _one_that_can_be(self) -> Self:
        if sum(one is not None for one in (self.uniform, self.normal, self.choice)) != 1:
            raise ValueError("needs one distribution; give uniform: [a, b], normal: [mean, sd] or choice: [...]")
        if self.uniform is not None and self.uniform[0] > self.uniform[1]:
            raise ValueError(f"uniform from {self.uniform[0]:g} to {self.uniform[1]:g} is empty; give the least first")
        if self.normal is not None and self.normal[1] < 0.0:
            raise ValueError(f"normal has a standard deviation of {self.normal[1]:g}; give 0 or more")
        return self


class Published(Group):
    """A value of the searched key that others have published, drawn beside the thresholds."""

    name: str = Field(min_length=1, description="of whom or what it is")
    value: BoundedNumber = Field(description="in the unit of the searched key")
    source: str = Field(min_length=1, description="where it was published")
    at: dict[str, Any] = Field(default={}, description="settings of axes that it is comparable with")


GridAxis = Annotated[list[Any], Field(min_length=1)] | Annotated[dict[str, dict[str, Any]], Field(min_length=1)]


class Spec(Group):
    """A campaign as it is written."""

    name: str = Field(default="sweep", min_length=1, max_length=100, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")
    about: str = Field(default="", description="what it is for, in a sentence or two")
    scenario: str = Field(default="", description="catalogue name or file, sought beside the specification first")
    sized_for: str | None = Field(
        default=None,
        description="robot for which values of set and of named settings are written",
    )
    set: dict[str, Any] = Field(default={}, description="values of keys in every run")
    grid: dict[str, GridAxis] = Field(
        default={},
        description="every combination: by key a list of values, or by a name of one's own named groups of settings",
    )
    first: dict[str, Annotated[list[Any], Field(min_length=1)]] = Field(
        default={}, max_length=1, description="values of a key of which the first is taken that is not refused"
    )
    sample: dict[str, Draw] = Field(default={}, description="values drawn anew for each seed")
    bisect: Bisect | None = Field(default=None, description="a threshold instead of single runs")
    records: list[Published] = Field(default=[], description="published values to draw beside thresholds")
    seeds: Annotated[int, Field(ge=1, le=MOST_RUNS), WHOLE] = Field(default=1, description="runs 0, 1, ... of each")
    seed: Annotated[int, Field(ge=0, lt=2**32), WHOLE] = Field(default=0, description="of what is drawn")
    keep: Literal["failing", "all"] = Field(default="failing", description="of which runs the logs are kept")

    @model_validator(mode="after")
    def _one_search(self) -> Self:
        if self.first and self.bisect is not None:
            raise ValueError("has both first and bisect; a campaign searches one key")
        if self.records and self.bisect is None:
            raise ValueError("has records but searches nothing that is like them; give bisect")
        return self

    @model_validator(mode="after")
    def _records_in_the_grid(self) -> Self:
        for record in self.records:
            for name, label in record.at.items():
                if not any(label == known for known in self.grid.get(name, ())):
                    known = self.grid.get(name, self.grid)
                    raise ValueError(
                        f"a record is at {name}: {label}, not in the grid; {nearest(str(label), map(str, known))}"
                    )
        return self


MOST_PANELS = 12
"""Most panels of a figure; the tables have all."""


class Axis(NamedTuple):
    """An axis of a campaign: the name of its key, or its own, and the labels of its settings."""

    name: str
    values: tuple[Any, ...]

    @property
    def numeric(self) -> bool:
        """True if its values are numbers that an axis can have."""
        return all(is_number(value) and abs(value) <= MOST for value in self.values)

    @property
    def heading(self) -> str:
        """Name and unit."""
        return with_unit(self.name)


def with_unit(key: str) -> str:
    """A key with its unit."""
    unit = key_unit(key)
    return f"{key} [{unit}]" if unit else key


def angle_of(axes: Sequence[Axis]) -> Axis | None:
    """The axis that is a direction: of numbers in rad."""
    return next((axis for axis in axes if axis.numeric and key_unit(axis.name) == "rad"), None)


def is_around(axes: Sequence[Axis]) -> bool:
    """Return true if thresholds are drawn around the compass."""
    angle = angle_of(axes)
    return angle is not None and len(angle.values) > 2


def text(value: Any) -> str:
    """A label."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def title(labels: Mapping[str, Any]) -> str:
    """Labels of a panel."""
    return ", ".join(
        text(value) if isinstance(value, str) else f"{name.rpartition('.')[2]} {text(value)}"
        for name, value in labels.items()
    )


def combinations(axes: Sequence[Axis]) -> list[dict[str, Any]]:
    """Labels of every combination of some axes, the last one fastest."""
    names = [axis.name for axis in axes]
    return [dict(zip(names, labels, strict=True)) for labels in product(*(axis.values for axis in axes))]


def key_unit(key: str) -> str:
    """SI unit of a scenario's key, given dotted; empty when it has none."""
    return described(key)[0]


def described(key: str) -> tuple[str, str]:
    """Unit and description that a scenario's key has, given dotted, or the nearest one above it; empty for none."""
    unit, description, model, field = "", "", cast("type[BaseModel] | None", Scenario), None
    for part in key.split("."):
        if part.isdecimal():
            unit = unit_of(field.annotation, field.metadata) if field is not None else ""
            continue
        field = (model.model_fields | dict(own_keys(model))).get(part) if model is not None else None
        unit = unit_of(field.annotation, field.metadata, elements=False) if field is not None else unit
        description = (field and field.description) or description
        model = next(groups_in(field.annotation), None) if field is not None else None
    return unit, description


def name_axis(axes: "Axes", axis: Axis, which: str, ticks: bool = True) -> None:
    """Label the x or the y axis of a figure, with a tick for each value, of which not all have room along x."""
    axes.set(**{f"{which}label": axis.heading})
    if ticks:
        places, labels = range(len(axis.values)), [text(value) for value in axis.values]
        every = -(-len(places) // 12) if which == "x" else 1
        {"x": axes.set_xticks, "y": axes.set_yticks}[which](places[::every], labels[::every])
