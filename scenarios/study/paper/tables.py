"""The tables of the page: what was measured, study by study, and what was run."""

import math
import statistics
from collections.abc import Iterable

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
    shove,
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


MM = 1e3
PERCENT = 1e2
WORLD_NAMES: dict[PaperWorld, str] = {"cart-table": "cart-table", "pendulum": "pendulum", "full": "full physics"}

BALANCE_HEAD = (
    *("profile", "world", "fell", "feasible plans [%]", "ZMP error RMS x [mm]", "y [mm]"),
    *("largest ZMP error x [mm]", "y [mm]", "beyond the 90 % box [mm]", "ZMP inside it [% of time]"),
)


def balance_table(name: str, samples: Iterable[Sample], note: str = "") -> PageTable:
    """Feasibility, ZMP errors and falls of some samples, study by study."""
    rows: list[TableRow | str] = []
    for sample in samples:
        if sample.study.title not in rows:
            rows.append(sample.study.title)
        rows.append(_balance_row(sample))
    return PageTable(name, BALANCE_HEAD, rows, note)


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


def _fell_cell(sample: Sample) -> TableCell:
    first = f"from {number(min(sample.values('fall_time')))} s on" if sample.falls else ""
    return TableCell(f"{sample.falls} of {len(sample.runs)}", "short bad" if sample.falls else "short", None, first)


def _balance_row(sample: Sample) -> tuple[TableCell, ...]:
    head = (TableCell(sample.profile), TableCell(WORLD_NAMES[sample.world], "short"))
    if not sample.runs:
        return (
            *head,
            TableCell("could not run", "bad short"),
            *(TableCell(MISSING, "number"),) * (len(BALANCE_HEAD) - 3),
        )
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


def knee_table(results: Results) -> PageTable:
    """Effort with stretched and with bent knees, gait by gait."""
    head = (
        *("gait", "knees", "fell", "speed [m/s]", "knee angle, mean [deg]", "cost of transport [-]"),
        *("knee torque RMS [N m]", "largest torque [% of limit]"),
    )
    rows = []
    for gait in GAITS:
        for knee in KNEES:
            sample = results.sample(knee_study(gait, knee), "default", "full")
            fell = TableCell(fell_text(sample) if sample.runs else "could not run", "bad" if sample.falls else "")
            columns = (
                ("speed_mean", 1.0),
                ("knee_angle_mean", 180.0 / math.pi),
                ("cost_of_transport", 1.0),
                ("knee_torque_rms", 1.0),
                ("torque_ratio_max", PERCENT),
            )
            cells = (spread_cell(sample.spread(metric), scale) for metric, scale in columns)
            rows.append((TableCell(gait), TableCell(knee), fell, *cells))
    return PageTable("knees", head, rows)


def survived(results: Results, adaptation: str, direction: str) -> list[int] | None:
    """Impulses of a direction that did not make the robot fall [N s]; None when one of the runs is missing."""
    samples = {i: results.sample(shove(i, direction, adaptation), "default", "pendulum") for i in SHOVE_IMPULSES}
    if not all(sample.complete for sample in samples.values()):
        return None
    return [impulse for impulse, sample in samples.items() if not sample.falls]


def shove_table(results: Results) -> PageTable:
    """What was survived of strong pushes, with and without adaptation of the footsteps."""
    head = ("adaptation of footsteps", *(f"{direction} [N s]" for direction in SHOVE_DIRECTIONS))
    rows = [
        (TableCell(adaptation), *(_survived_cell(survived(results, adaptation, way)) for way in SHOVE_DIRECTIONS))
        for adaptation in ADAPTATIONS
    ]
    tried = ", ".join(map(str, SHOVE_IMPULSES))
    return PageTable("shoves", head, rows, f"Largest impulse survived of {tried} N s.")


def _survived_cell(impulses: list[int] | None) -> TableCell:
    if impulses is None:
        return TableCell(MISSING, "number")
    if not impulses:
        return TableCell(f"less than {min(SHOVE_IMPULSES)}", "number")
    return TableCell(str(max(impulses)), "number", float(max(impulses)))


def provenance(results: Results) -> str:
    """Versions that made the logs, and when."""
    rows = [(escape(name), escape(", ".join(values))) for name, values in _versions(results.outcomes).items()]
    written = sorted(outcome.written for outcome in results.outcomes if outcome.written)
    if written:
        rows.append(("logs written (UTC)", escape(f"{_date(written[0])} to {_date(written[-1])}")))
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
            TableCell(_end(outcome), "bad" if outcome.failure or outcome.metrics.get("fell") else ""),
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
    if outcome.metrics.get("fell"):
        return f"fell at {number(outcome.metrics['fall_time'])} s"
    return f"{outcome.metrics.get('steps_taken', MISSING)} of {outcome.metrics.get('steps_planned', MISSING)} steps"


def _versions(outcomes: Iterable[ExperimentResult]) -> dict[str, list[str]]:
    """Every version that occurs, by name."""
    found: dict[str, dict[str, None]] = {}
    for outcome in outcomes:
        for name, value in outcome.versions.items():
            if value not in ("", ABSENT):
                found.setdefault(name.replace("_", " "), {})[value] = None
    return {name: list(values) for name, values in found.items()}


def _date(iso: str) -> str:
    return iso.replace("T", " ").removesuffix("+00:00")
