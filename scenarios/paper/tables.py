"""The tables of the page and the HTML that they are made of."""

import math
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from surefoot.scenarios.paper.results import Results, Sample, Spread
from surefoot.scenarios.paper.studies import (
    ADAPTATIONS,
    GAITS,
    KNEES,
    SHOVE_DIRECTIONS,
    SHOVE_IMPULSES,
    World,
    knee_study,
    shove,
)
from surefoot.scenarios.show.html import MISSING, escape, number, tag


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table.

    Attributes:
        text: as shown.
        kind: CSS classes.
        value: the number behind the text, in SI units; None for words.
        below: a second, quiet line.
    """

    text: str
    kind: str = ""
    value: float | None = None
    below: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the page.

    Attributes:
        name: its anchor.
        head: column heads, with units.
        groups: heading, which may be empty, and rows of cells.
        note: below it, a sentence or two.
    """

    name: str
    head: tuple[str, ...]
    groups: tuple[tuple[str, tuple[tuple[Cell, ...], ...]], ...]
    note: str = ""

    @property
    def rows(self) -> tuple[tuple[Cell, ...], ...]:
        """All rows of cells."""
        return tuple(row for _, rows in self.groups for row in rows)


def spread_text(spread: Spread | None, scale: float = 1.0, digits: int = 3) -> str:
    """A median, with its range where that is another text."""
    if spread is None:
        return MISSING
    between = _range(spread, scale, digits)
    return number(spread.median, scale, digits) + (f" ({between})" if between else "")


def spread_cell(spread: Spread | None, scale: float = 1.0, kind: str = "number") -> Cell:
    """The same as a cell, the range below the median."""
    if spread is None:
        return Cell(MISSING, kind)
    return Cell(number(spread.median, scale), kind, spread.median, _range(spread, scale, 3))


def words(text: str, kind: str = "") -> Cell:
    """A cell of words."""
    return Cell(text, kind)


def table_html(table: Table) -> str:
    """A table as HTML."""
    head = tag("tr", "".join(tag("th", escape(text), scope="col") for text in table.head))
    body = "\n".join(_group_html(heading, rows, len(table.head)) for heading, rows in table.groups)
    whole = tag("table", f"<thead>{head}</thead>\n<tbody>\n{body}\n</tbody>", id=table.name)
    return tag("div", whole, kind="wide") + (tag("p", table.note, kind="note") if table.note else "")


def paragraphs(texts: Iterable[str]) -> str:
    """Paragraphs of HTML."""
    return "\n".join(tag("p", text) for text in texts)


def listing(entries: Sequence[str]) -> str:
    """A list of HTML entries."""
    return tag("ul", "".join(tag("li", entry) for entry in entries))


def _group_html(heading: str, rows: Iterable[tuple[Cell, ...]], width: int) -> str:
    lines = [tag("tr", "".join(_cell_html(cell) for cell in row)) for row in rows]
    if heading:
        lines.insert(0, tag("tr", tag("th", escape(heading), scope="rowgroup", colspan=str(width)), kind="group"))
    return "\n".join(lines)


def _cell_html(cell: Cell) -> str:
    value = "" if cell.value is None else repr(cell.value)
    below = tag("small", escape(cell.below)) if cell.below else ""
    return tag("td", escape(cell.text) + below, kind=cell.kind, data_value=value)


def _range(spread: Spread, scale: float, digits: int) -> str:
    """Least and greatest value; empty when both read the same."""
    least, greatest = number(spread.least, scale, digits), number(spread.greatest, scale, digits)
    return "" if least == greatest else f"{least} … {greatest}"


MM = 1e3
PERCENT = 1e2
WORLD_NAMES: dict[World, str] = {"cart-table": "cart-table", "pendulum": "pendulum", "full": "full physics"}

BALANCE_HEAD = (
    *("profile", "world", "fell", "feasible plans [%]", "ZMP error RMS x [mm]", "y [mm]"),
    *("largest ZMP error x [mm]", "y [mm]", "beyond the 90 % box [mm]", "ZMP inside it [% of time]"),
)


def balance_table(name: str, samples: Iterable[Sample], note: str = "") -> Table:
    """Feasibility, ZMP errors and falls of some samples, study by study."""
    groups: dict[str, list[tuple[Cell, ...]]] = {}
    for sample in samples:
        groups.setdefault(sample.study.title, []).append(_balance_row(sample))
    return Table(name, BALANCE_HEAD, tuple((title, tuple(rows)) for title, rows in groups.items()), note)


def feasible(sample: Sample) -> Spread | None:
    """Share of plans whose problem, hard limits and all, had a solution [-]."""
    infeasible = sample.spread("planner_infeasible_fraction")
    if infeasible is None:
        return None
    return Spread(1.0 - infeasible.median, 1.0 - infeasible.greatest, 1.0 - infeasible.least)


def fell_text(sample: Sample) -> str:
    """How many of how many fell, and when the first of them."""
    if not sample.falls:
        return f"0 of {len(sample.runs)}"
    return f"{sample.falls} of {len(sample.runs)}, from {number(min(sample.values('fall_time')))} s on"


def _fell_cell(sample: Sample) -> Cell:
    first = f"from {number(min(sample.values('fall_time')))} s on" if sample.falls else ""
    return Cell(f"{sample.falls} of {len(sample.runs)}", "short bad" if sample.falls else "short", None, first)


def _balance_row(sample: Sample) -> tuple[Cell, ...]:
    head = (words(sample.profile), words(WORLD_NAMES[sample.world], "short"))
    if not sample.runs:
        return (*head, words("could not run", "bad short"), *(words(MISSING, "number"),) * (len(BALANCE_HEAD) - 3))
    kind = "number past" if sample.falls else "number"
    share = feasible(sample)
    inside = sample.spread("zmp_inside_fraction")
    excursion = sample.spread("zmp_excursion_max")
    outside = excursion is not None and excursion.greatest > 0.0
    return (
        *head,
        _fell_cell(sample),
        spread_cell(share, PERCENT, "number" if share is None or share.least >= 1.0 else "number bad"),
        *(spread_cell(sample.spread("zmp_error_rms", axis), MM, kind) for axis in (0, 1)),
        *(spread_cell(sample.spread("zmp_error_max", axis), MM, kind) for axis in (0, 1)),
        spread_cell(excursion, MM, f"{kind} bad" if outside else kind),
        spread_cell(inside, PERCENT, kind),
    )


def preview_gain(without: Sample, previewed: Sample) -> float | None:
    """How many times lower the ZMP error is with previewed dynamics: ratio of medians of `error_norms` [-], or None."""
    before, after = error_norms(without), error_norms(previewed)
    return statistics.median(before) / statistics.median(after) if before and after else None


def error_norms(sample: Sample) -> list[float]:
    """Norm of the ZMP error's RMS in x and y, of each run [m]."""
    return [math.hypot(*errors) for errors in zip(*(sample.values("zmp_error_rms", i) for i in (0, 1)), strict=True)]


def knee_table(results: Results) -> Table:
    """Effort with stretched and with bent knees, gait by gait."""
    head = (
        *("gait", "knees", "fell", "speed [m/s]", "knee angle, mean [deg]", "cost of transport [-]"),
        *("knee torque RMS [N m]", "largest torque [% of limit]"),
    )
    rows = []
    for gait in GAITS:
        for knee in KNEES:
            sample = results.sample(knee_study(gait, knee), "default", "full")
            fell = words(fell_text(sample) if sample.runs else "could not run", "bad" if sample.falls else "")
            columns = (
                ("speed_mean", 1.0),
                ("knee_angle_mean", 180.0 / math.pi),
                ("cost_of_transport", 1.0),
                ("knee_torque_rms", 1.0),
                ("torque_ratio_max", PERCENT),
            )
            cells = (spread_cell(sample.spread(metric), scale) for metric, scale in columns)
            rows.append((words(gait), words(knee), fell, *cells))
    return Table("knees", head, (("", tuple(rows)),))


def survived(results: Results, adaptation: str, direction: str) -> list[int] | None:
    """Impulses of a direction that did not make the robot fall [N s]; None when one of the runs is missing."""
    samples = {i: results.sample(shove(i, direction, adaptation), "default", "pendulum") for i in SHOVE_IMPULSES}
    if not all(sample.complete for sample in samples.values()):
        return None
    return [impulse for impulse, sample in samples.items() if not sample.falls]


def shove_table(results: Results) -> Table:
    """What was survived of strong pushes, with and without adaptation of the footsteps."""
    head = ("adaptation of footsteps", *(f"{direction} [N s]" for direction in SHOVE_DIRECTIONS))
    rows = [
        (words(adaptation), *(_survived_cell(survived(results, adaptation, way)) for way in SHOVE_DIRECTIONS))
        for adaptation in ADAPTATIONS
    ]
    tried = ", ".join(map(str, SHOVE_IMPULSES))
    return Table("shoves", head, (("", tuple(rows)),), f"Largest impulse survived of {tried} N s.")


def _survived_cell(impulses: list[int] | None) -> Cell:
    if impulses is None:
        return words(MISSING, "number")
    if not impulses:
        return words(f"less than {min(SHOVE_IMPULSES)}", "number")
    return Cell(str(max(impulses)), "number", float(max(impulses)))
