"""The tables of the page: rows are samples, numbers are the metrics of their logs."""

import math
import statistics
from collections.abc import Iterable

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
from surefoot.scenarios.paper.text import MISSING, Cell, Table, number, spread_cell, words

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
