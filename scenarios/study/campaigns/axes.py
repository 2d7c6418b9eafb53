"""The axes of a campaign: names, units and labels of what varies in it, as its tables, figures and pages show them."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.study.campaigns.spec import MOST

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_PANELS = 12
"""Of a figure; the tables have all."""


class Axis(NamedTuple):
    """An axis of a campaign.

    Attributes:
        name: of its key or its own.
        values: labels of its settings.
    """

    name: str
    values: tuple[Any, ...]

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers that an axis can have."""
        return all(is_number(value) and abs(value) <= MOST for value in self.values)

    @property
    def heading(self) -> str:
        """Name and unit."""
        return with_unit(self.name)


def is_number(value: Any) -> bool:
    """Whether a value is a number, be it NaN or infinite, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def with_unit(key: str) -> str:
    """A key with its unit."""
    unit = key_unit(key)
    return f"{key} [{unit}]" if unit else key


def angle_of(axes: Sequence[Axis]) -> Axis | None:
    """The axis that is a direction: of numbers in rad."""
    return next((axis for axis in axes if axis.numeric and key_unit(axis.name) == "rad"), None)


def is_around(axes: Sequence[Axis]) -> bool:
    """Whether thresholds are drawn around the compass."""
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
    return str(described(key).get("unit", ""))


def described(key: str) -> Mapping[str, Any]:
    """What the schema says of a key."""
    schema = _schema()
    node: Mapping[str, Any] = schema
    found: dict[str, Any] = {}
    for part in key.split("."):
        node = next((one for one in _branches(node, schema) if _child(one, part) is not None), {})
        node = _child(node, part) or {}
        found = {**found, **{name: one[name] for one in _branches(node, schema) for name in ("unit",) if name in one}}
        if "description" in node:
            found["description"] = node["description"]
    return found


@cache
def _schema() -> Mapping[str, Any]:
    return Scenario.model_json_schema()


def _branches(node: Mapping[str, Any], schema: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """A part of the schema with what it refers to."""
    yield node
    for branch in (*node.get("anyOf", ()), *node.get("allOf", ())):
        yield from _branches(branch, schema)
    if "$ref" in node:
        yield from _branches(schema["$defs"][node["$ref"].rpartition("/")[2]], schema)


def _child(node: Mapping[str, Any], part: str) -> Mapping[str, Any] | None:
    if part.isdecimal():
        several = node.get("prefixItems")
        return several[int(part)] if several and int(part) < len(several) else node.get("items")
    child: Mapping[str, Any] | None = node.get("properties", {}).get(part)
    return child


def name_axis(axes: "Axes", axis: Axis, which: str, ticks: bool = True) -> None:
    """Label the x or the y axis of a figure, with a tick for each value, of which not all have room along x."""
    axes.set(**{f"{which}label": axis.heading})
    if ticks:
        places, labels = range(len(axis.values)), [text(value) for value in axis.values]
        every = -(-len(places) // 12) if which == "x" else 1
        {"x": axes.set_xticks, "y": axes.set_yticks}[which](places[::every], labels[::every])
