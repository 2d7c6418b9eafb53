"""The results of a campaign as tables: typed columns with units, as CSV and parquet."""

import csv
import importlib
import importlib.util
import io
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surefoot.scenarios.errors import require
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.many.points import Outcome, facts
from surefoot.scenarios.output import write_whole
from surefoot.studies.campaigns.points import Cell
from surefoot.studies.campaigns.spec import described, text

TableValue = bool | int | float | str | None
_MOST_WHOLE = 2**63 - 1
"""Greatest number that a column of whole numbers can hold."""


@dataclass(frozen=True, slots=True)
class TableColumn:
    """A column of a table.

    Attributes:
        name: of a key, a metric or a property of the run.
        unit: SI; empty for none.
        meaning: in a sentence; empty where the name says it.
        values: of one type each, None where there is none.
    """

    name: str
    unit: str
    meaning: str
    values: tuple[TableValue, ...]

    @property
    def heading(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, slots=True)
class Table:
    """Columns of the same length, in order."""

    columns: tuple[TableColumn, ...]

    def __getitem__(self, name: str) -> tuple[TableValue, ...]:
        """Values of a column."""
        return next(column.values for column in self.columns if column.name == name)

    def csv(self) -> bytes:
        """Comma-separated values, units in the headings, an empty cell where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(column.heading for column in self.columns)
        writer.writerows(
            [_cell(value) for value in row] for row in zip(*(column.values for column in self.columns), strict=True)
        )
        return text.getvalue().encode()

    def parquet(self) -> bytes:
        """Parquet, with unit and meaning as metadata of the columns.

        Raises:
            MissingExtraError: pyarrow is not installed.
        """
        pyarrow = require("pyarrow", "parquet", "parquet", "read the .csv")
        kinds = {bool: pyarrow.bool_(), int: pyarrow.int64(), float: pyarrow.float64(), str: pyarrow.string()}
        arrays = [pyarrow.array(column.values, kinds[_kind(column.values)]) for column in self.columns]
        fields = [
            pyarrow.field(column.name, array.type, metadata={"unit": column.unit, "meaning": column.meaning})
            for column, array in zip(self.columns, arrays, strict=True)
        ]
        data = io.BytesIO()
        parquet = importlib.import_module("pyarrow.parquet")
        parquet.write_table(pyarrow.table(arrays, schema=pyarrow.schema(fields)), data)
        return data.getvalue()


def runs_table(outcomes: Iterable[Outcome]) -> Table:
    """A row for each run that has a result: what varies, what became of it, its metrics, and how to make it again."""
    runs = [run for outcome in outcomes for run in outcome.runs]
    labels = [point.labels for point, _ in runs]
    columns = [_of_key(name, [row.get(name) for row in labels]) for name in _names(labels)]
    records, first = [record for _, record in runs], {point.id for point, _ in facts(runs)}
    columns += [
        _column("status", [record.status for record in records], "", "pass, fail, refused or broken"),
        _column("reasons", ["; ".join(record.reasons) for record in records], "", "why not"),
        *_metric_columns([record.metrics for record in records]),
        _column("repeats", [point.id not in first for point, _ in runs], "", "the run of another seed, to the digit"),
        _column("wall_time", [float(record.wall_time) for record in records], "s", "that the run took"),
        _column("log", [record.log or None for record in records], "", "below the campaign's directory"),
        _column("command", [point.command for point, _ in runs], "", "makes the run again"),
    ]
    return Table(tuple(columns))


def thresholds_table(outcomes: Sequence[Outcome]) -> Table:
    """A row for each search that is complete: what varies, its threshold, and the first run that did not pass."""
    found = [(outcome, outcome.cell) for outcome in outcomes if outcome.threshold is not None]
    cells = [cell for _, cell in found if isinstance(cell, Cell)]
    if not cells:
        return Table(())
    bisect = cells[0].campaign.spec.bisect
    assert bisect is not None
    labels = [cell.labels for cell in cells]
    columns = [_of_key(name, [row.get(name) for row in labels]) for name in _names(labels)]
    thresholds = [outcome.threshold for outcome, _ in found if outcome.threshold is not None]
    values = _of_key(bisect.key, [None if one.value is None else float(one.value) for one in thresholds])
    failed = [next((run for run in outcome.runs if run[1].status != "pass"), None) for outcome, _ in found]
    columns += [
        TableColumn("threshold", values.unit, f"of {bisect.key}", values.values),
        _column("side", [one.side for one in thresholds], "", "of the range on which it lies"),
        _column("runs", [len(outcome.runs) for outcome, _ in found], "", "that the search took"),
        _column(
            "first_failure",
            [run and run[0].command for run in failed],
            "",
            "makes the first run without a pass again",
        ),
        _column("reasons", [run and "; ".join(run[1].reasons) for run in failed], "", "why it did not"),
        _column("log", [run and (run[1].log or None) for run in failed], "", "of that run"),
    ]
    return Table(tuple(columns))


MOST_THRESHOLDS = 48
"""Thresholds that are printed; the files have all."""


def threshold_lines(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Lines of a table for a person: what varies and the threshold of each search, with units, if it searches."""
    table = thresholds_table(outcomes)
    if not table.columns:
        return
    labels = [column for column in table.columns[: [one.name for one in table.columns].index("threshold")]]
    shown = [_shown(outcome) for outcome in outcomes if outcome.threshold is not None]
    sought = next(column for column in table.columns if column.name == "threshold")
    heading = f"{sought.meaning.removeprefix('of ')} [{sought.unit or '-'}]"
    rows = [(*(column.heading for column in labels), heading)]
    cells = zip(*(column.values for column in labels), shown, strict=True)
    rows += [tuple(text(cell) for cell in row) for row in cells][:MOST_THRESHOLDS]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    yield from ("  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows)
    if len(shown) > MOST_THRESHOLDS:
        yield f"and {len(shown) - MOST_THRESHOLDS} thresholds more"


def _shown(outcome: Outcome) -> str:
    """A threshold, or the end of its range beyond which it lies."""
    cell, found = outcome.cell, outcome.threshold
    assert isinstance(cell, Cell)
    assert found is not None
    bisect = cell.campaign.bisect(cell.keys)
    assert bisect is not None
    if found.value is not None and found.side == "inside":
        return text(float(found.value))
    return f"below {text(float(bisect.low))}" if found.side == "below" else f"above {text(float(bisect.high))}"


def write_table(table: Table, path: Path) -> list[Path]:
    """Write a table as CSV, and as parquet where that is installed; files of an earlier time are replaced.

    Raises:
        LogError: one cannot be written.
    """
    written = []
    for ending, content in ((".csv", table.csv), (".parquet", table.parquet)):
        if ending == ".parquet" and not has_parquet():
            continue
        target = path.with_suffix(ending)
        with write_whole(target, replace=True) as temporary:
            temporary.write_bytes(content())
        written.append(target)
    return written


def has_parquet() -> bool:
    """Return true if parquet can be written here."""
    return importlib.util.find_spec("pyarrow") is not None


def _names(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    return list(dict.fromkeys(name for row in rows for name in row))


def _of_key(name: str, values: Sequence[Any]) -> TableColumn:
    return _column(name, values, *described(name))


def _column(name: str, values: Sequence[Any], unit: str, meaning: str) -> TableColumn:
    """A column of one type: whole and other numbers are numbers, and what is mixed or no plain value is text."""
    kinds = {type(value) for value in values if value is not None}
    make: Callable[[Any], TableValue] = lambda value: value  # noqa: E731
    if kinds == {int, float} or (kinds == {int} and any(abs(value or 0) > _MOST_WHOLE for value in values)):
        make = as_float
    elif len(kinds) > 1 or not kinds <= {bool, int, float, str}:
        make = lambda value: value if isinstance(value, str) else json.dumps(value)  # noqa: E731
    return TableColumn(name, unit, meaning, tuple(None if value is None else make(value) for value in values))


def as_float(value: float) -> float:
    """A number as a float, infinite where it is too great for one."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _metric_columns(rows: Sequence[Mapping[str, Any]]) -> Iterator[TableColumn]:
    for name in _names(rows):
        metric = known(name)
        unit, meaning = (metric.unit, metric.meaning) if metric is not None else ("", "")
        values = [row.get(name) for row in rows]
        for part in _parts(values):
            label = name if part is None else f"{name}.{part}"
            yield _column(label, [_element(value, part) for value in values], unit, meaning)


def _parts(values: Sequence[Any]) -> list[Any]:
    """Parts of a metric: None for a plain one."""
    several = next((value for value in values if isinstance(value, list | tuple | dict)), None)
    if several is None:
        return [None]
    return list(several) if isinstance(several, dict) else list(range(len(several)))


def _element(value: Any, part: Any) -> Any:
    return value if part is None or value is None else value[part]


def _kind(values: Sequence[TableValue]) -> type:
    return next((type(value) for value in values if value is not None), float)


def _cell(value: TableValue) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)
