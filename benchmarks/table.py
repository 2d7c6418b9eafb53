"""Measured numbers as tables for people and as JSON for programs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

Value = str | float | int | None


@dataclass(frozen=True)
class Section:
    """A table.

    Attributes:
        name: what is measured.
        columns: headings, with units.
        rows: values by row; the first one names the row.
        note: what a reader must know.
        ratios: numbers that hardly depend on the machine, by name: those that the history keeps.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]
    note: str = ""
    ratios: Mapping[str, float] = field(default_factory=dict)

    def text(self) -> str:
        cells = [self.columns, *(tuple(map(shown, row)) for row in self.rows)]
        widths = [max(len(row[i]) for row in cells) for i in range(len(self.columns))]
        lines = ["  ".join(map(_aligned, row, widths, range(len(row)))) for row in cells]
        return "\n".join((f"== {self.name}", *lines, *([self.note] if self.note else []), ""))

    def to_json(self) -> dict[str, Any]:
        return {**asdict(self), "ratios": dict(self.ratios)}


Measure = Callable[[bool], Section]
"""Makes a table; of little work where the argument is true."""


def _aligned(cell: str, width: int, column: int) -> str:
    return f"{cell:>{width}}" if column else f"{cell:<{width}}"


def shown(value: Value) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 100.0 else f"{value:.0f}"
    return str(value)


def microseconds(seconds: Sequence[float], *percentiles: float) -> tuple[float, ...]:
    return tuple(1e6 * float(value) for value in np.percentile(np.asarray(seconds), percentiles))
