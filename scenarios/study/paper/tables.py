"""The tables of the page: what was measured, study by study, and what was run."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from surefoot.scenarios.record.provenance import ABSENT
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, details, escape, number, tag
from surefoot.scenarios.study.paper.results import ExperimentResult, Results, Sample, Spread
from surefoot.scenarios.study.paper.studies import (
    ADAPTATIONS,
    GAITS,
    KNEES,
    SHOVE_DIRECTIONS,
    SHOVE_IMPULSES,
    PaperWorld,
    knee_study,
)

MM, PERCENT = 1e3, 1e2
WORLD_NAMES: dict[PaperWorld, str] = {"cart-table": "cart-table", "pendulum": "pendulum", "full": "full physics"}


class Measured(NamedTuple):
    """A column of a table that shows a metric.

    Attributes:
        heading: with the unit that is shown.
        metric: its name.
        element: of it, None for the whole.
        scale: from its value to what is shown.
    """

    heading: str
    metric: str
    element: int | None = None
    scale: float = 1.0


_BALANCE = (
    Measured("ZMP error RMS x [mm]", "zmp_error_rms", 0, MM),
    Measured("y [mm]", "zmp_error_rms", 1, MM),
    Measured("largest ZMP error x [mm]", "zmp_error_max", 0, MM),
    Measured("y [mm]", "zmp_error_max", 1, MM),
    Measured("beyond the 90 % box [mm]", "zmp_excursion_max", None, MM),
    Measured("ZMP inside it [% of time]", "zmp_inside_fraction", None, PERCENT),
)
_EFFORT = (
    Measured("speed [m/s]", "speed_mean"),
    Measured("knee angle, mean [deg]", "knee_angle_mean", None, 180.0 / math.pi),
    Measured("cost of transport [-]", "cost_of_transport"),
    Measured("knee torque RMS [N m]", "knee_torque_rms"),
    Measured("largest torque [% of limit]", "torque_ratio_max", None, PERCENT),
)


def spread_text(spread: Spread | None, scale: float = 1.0, digits: int = 3) -> str:
    """A median, with its range where that is another text."""
    if spread is None:
        return MISSING
    between = _range(spread, scale, digits)
    return number(spread.median, scale, digits) + (f" ({between})" if between else "")


def spread_cell(spread: Spread | None, scale: float = 1.0, kind: str = "number") -> TableCell:
    """The same as a cell, the range below the median."""
    if spread is None:
        return TableCell(MISSING, kind)
    return TableCell(number(spread.median, scale), kind, spread.median, _range(spread, scale, 3))


def _range(spread: Spread, scale: float, digits: int) -> str:
    """Least and greatest value; empty when both read the same."""
    least, greatest = number(spread.least, scale, digits), number(spread.greatest, scale, digits)
    return "" if least == greatest else f"{least} … {greatest}"


def balance_table(name: str, samples: Iterable[Sample]) -> PageTable:
    """Feasibility, ZMP errors and falls of some samples, study by study."""
    head = ("profile", "world", "fell", "feasible plans [%]", *(column.heading for column in _BALANCE))
    rows: list[TableRow | str] = []
    for sample in samples:
        if sample.study.title not in rows:
            rows.append(sample.study.title)
        rows.append([TableCell(sample.profile), TableCell(WORLD_NAMES[sample.world], "short"), *_balance(sample)])
    return PageTable(name, head, rows)


def _balance(sample: Sample) -> Iterator[TableCell]:
    if not sample.runs:
        yield TableCell("could not run", "bad short")
        yield from (TableCell(MISSING, "number"),) * (1 + len(_BALANCE))
        return
    yield TableCell(_fell_text(sample), "short bad" if sample.falls else "short", None, _first_fall(sample))
    share = sample.feasible
    yield spread_cell(share, PERCENT, "number" if share is None or share.least >= 1.0 else "number bad")
    for column in _BALANCE:
        spread, kind = sample.spread(column.metric, column.element), "number past" if sample.falls else "number"
        outside = column.metric == "zmp_excursion_max" and spread is not None and spread.greatest > 0.0
        yield spread_cell(spread, column.scale, f"{kind} bad" if outside else kind)


def _fell_text(sample: Sample) -> str:
    return f"{sample.falls} of {len(sample.runs)}"


def _first_fall(sample: Sample) -> str:
    return f"from {number(min(sample.values('fall_time')))} s on" if sample.falls else ""


def fell_text(sample: Sample) -> str:
    """How many of how many fell, and when the first of them."""
    return ", ".join(filter(None, (_fell_text(sample), _first_fall(sample))))


def balance_text(samples: Sequence[Sample]) -> str:
    """Falls and excursions of some samples of one profile and world, in a phrase."""
    name = f"{samples[0].profile}, {WORLD_NAMES[samples[0].world]}"
    runs = [outcome for sample in samples for outcome in sample.runs]
    missing = any(len(sample.runs) < len(sample.outcomes) for sample in samples)
    if missing or not runs:
        return f"{name}: could not run" if missing else f"{name}: not run"
    falls = sum(sample.falls for sample in samples)
    fell = fell_text(samples[0]) if len(samples) == 1 else f"{falls} of {len(runs)}"
    found = [value for sample in samples for value in sample.values("zmp_excursion_max")]
    return f"{name}: fell in {fell}; {_excursion_text(max(found, default=None))}"


def _excursion_text(excursion: float | None) -> str:
    """How far the ZMP came out of the 90 % box, in a phrase."""
    if excursion is None:
        return "no ZMP"
    if excursion <= 0.0:
        return f"ZMP at least {number(-excursion, MM)} mm inside the 90 % box"
    return f"ZMP up to {number(excursion, MM)} mm beyond the 90 % box"


def knee_table(results: Results) -> PageTable:
    """Effort with stretched and with bent knees, gait by gait."""
    rows = []
    for gait in GAITS:
        for knee in KNEES:
            sample = results.sample(knee_study(gait, knee), "default", "full")
            fell = TableCell(fell_text(sample) if sample.runs else "could not run", "bad" if sample.falls else "")
            cells = (spread_cell(sample.spread(column.metric), column.scale) for column in _EFFORT)
            rows.append((TableCell(gait), TableCell(knee), fell, *cells))
    return PageTable("knees", ("gait", "knees", "fell", *(column.heading for column in _EFFORT)), rows)


def shove_table(results: Results) -> PageTable:
    """What was survived of strong pushes, with and without adaptation of the footsteps."""
    head = ("adaptation of footsteps", *(f"{direction} [N s]" for direction in SHOVE_DIRECTIONS))
    rows = [
        (TableCell(adaptation), *(_survived_cell(results.survived(adaptation, way)) for way in SHOVE_DIRECTIONS))
        for adaptation in ADAPTATIONS
    ]
    tried = ", ".join(map(str, SHOVE_IMPULSES))
    return PageTable("shoves", head, rows, f"Largest impulse survived of {tried} N s.")


def _survived_cell(impulses: list[int] | None) -> TableCell:
    if not impulses:
        return TableCell(MISSING if impulses is None else f"less than {min(SHOVE_IMPULSES)}", "number")
    return TableCell(str(max(impulses)), "number", float(max(impulses)))


def provenance(results: Results) -> str:
    """Versions that made the logs, and when."""
    found: dict[str, dict[str, None]] = {}
    for outcome in results.outcomes:
        for name, value in outcome.versions.items():
            if value not in ("", ABSENT):
                found.setdefault(name.replace("_", " "), {})[value] = None
    rows = [(escape(name), escape(", ".join(values))) for name, values in found.items()]
    written = sorted(outcome.written.replace("T", " ") for outcome in results.outcomes if outcome.written)
    if written:
        first, last = (date.removesuffix("+00:00") for date in (written[0], written[-1]))
        rows.append(("logs written (UTC)", escape(f"{first} to {last}")))
    return PageTable("versions", ("made by", "version"), rows).html


def runs_table(results: Results) -> str:
    """Every run: how it ended and how to make it again; before them those that could not run, and why."""
    reasons: dict[str, list[str]] = {}
    for outcome in results.failures:
        reasons.setdefault(outcome.failure, []).append(outcome.experiment.folder)
    failed = [(TableCell(", ".join(runs), "bad"), escape(reason)) for reason, runs in reasons.items()]
    rows = [
        (
            escape(outcome.experiment.folder),
            TableCell(_end(outcome), "bad" if outcome.failure or outcome.fell else ""),
            tag("code", escape(outcome.experiment.command)),
        )
        for outcome in results.outcomes
    ]
    failures = PageTable("failures", ("could not run", "why"), failed).html if failed else ""
    table = PageTable("runs-table", ("run", "end", "command"), rows, kind="runs").html
    return failures + details(f"All {len(rows)} runs with their commands", table, name="all-runs")


def _end(outcome: ExperimentResult) -> str:
    if outcome.failure:
        return "could not run"
    if outcome.fell:
        return f"fell at {number(outcome.metrics['fall_time'])} s"
    return f"{outcome.metrics.get('steps_taken', MISSING)} of {outcome.metrics.get('steps_planned', MISSING)} steps"
