"""Results of campaigns that pages and pictures show, kept in docs/results, and the tables that follow from them.

    surefoot sweep ... --out runs/push-map
    python docs/measured.py push-map runs/push-map

The first line of a kept result is the command that made it, the second the code that it was made by.
"""

import argparse
import csv
import shlex
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from surefoot.scenarios.log import read
from surefoot.scenarios.study.campaigns.campaign import read_campaign
from surefoot.scenarios.study.campaigns.capturability import Limits
from surefoot.scenarios.study.campaigns.spec import Axis, text
from surefoot.scenarios.study.campaigns.thresholds import Found, Threshold

RESULTS = Path(__file__).parent / "results"


class Made(NamedTuple):
    """A campaign and what of it is run: its settings, runs of each, and the columns that are kept of a table."""

    campaign: str
    settings: tuple[str, ...] = ()
    seeds: int | None = None
    columns: tuple[str, ...] = ()

    @property
    def command(self) -> str:
        """What makes it."""
        given = [f"--set {shlex.quote(setting)}" for setting in self.settings]
        return " ".join(["surefoot sweep", self.campaign, *given, *([f"--seeds {self.seeds}"] if self.seeds else [])])


_NATURAL = "gait=natural"
_ENDS = "planner.step_adaptation=[none, crossing]"
_STOPPED = ("torque_at_limit_fraction", "cop_ratio_p99", "torque_ratio_max")
_DRAWN = ("terrain.friction", *(f"errors.torso_com.{axis}" for axis in range(3)), "errors.payload.mass")
_SENSED = tuple(f"{name}.{axis}" for name in ("velocity_estimation_error_rms", "zmp_error_rms") for axis in (0, 1))
_PUSHED = ("errors.payload.body", "pushes.0.impulse", "pushes.0.direction", "pushes.0.time")

MADE = {
    "gait-map": Made(
        "gait-map",
        columns=("riser", "step_length", "step_time", "status", *_STOPPED),
    ),
    "push-map-pendulum": Made("push-map", ("fidelity=pendulum", _NATURAL), 1),
    "push-map": Made("push-map", ("fidelity=full", _NATURAL), 1),
    "push-map-mid-swing": Made("push-map", ("fidelity=full", _NATURAL, _ENDS, "phase=[SS 0.5]"), 1),
    "sensor-faults": Made(
        "sensor-faults", columns=("fault", "status", *_SENSED, "cop_ratio_p99", "step_shift", "ghost_force_max")
    ),
    "robustness": Made("robustness", columns=("gait", "status", *_DRAWN, *_PUSHED)),
}
"""By the name of the result."""


def path_of(name: str) -> Path:
    """Where a result is kept."""
    return RESULTS / f"{name}.csv"


def head(name: str) -> tuple[str, str]:
    """The command that made a result, and the code that it was made by."""
    with path_of(name).open(encoding="utf-8") as file:
        command, code = (next(file).removeprefix("# ").strip() for _ in range(2))
    return command, code


@lru_cache
def rows(name: str) -> tuple[dict[str, str], ...]:
    """Rows of a result that is kept."""
    with path_of(name).open(newline="", encoding="utf-8") as file:
        return tuple(csv.DictReader(line for line in file if not line.startswith("# ")))


def keep(name: str, folder: Path) -> None:
    """Keep the result of a campaign."""
    made = MADE[name]
    kept = list(_thresholds(folder) if not made.columns else _runs(folder, made.columns))
    (log, *_) = sorted(folder.glob("logs/*/log.mcap"))
    code = read(log).metadata["versions"]
    RESULTS.mkdir(exist_ok=True)
    with path_of(name).open("w", newline="", encoding="utf-8") as file:
        file.write(f"# {made.command}\n# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
        writer = csv.DictWriter(file, kept[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(kept)


def _table(path: Path) -> Iterator[dict[str, str]]:
    """Rows of a table, by the names of its columns without units."""
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            yield {column.partition(" [")[0]: value for column, value in row.items()}


def _runs(folder: Path, columns: Sequence[str]) -> Iterator[dict[str, str]]:
    """Some columns of the runs, numbers with four digits."""
    for row in _table(folder / "table.csv"):
        yield {column: _short(row[column]) for column in columns}


def _short(value: str) -> str:
    try:
        return f"{float(value):.4g}"
    except ValueError:
        return value


def _thresholds(folder: Path) -> Iterator[dict[str, str]]:
    """Where each search ended, its range, and the limit of the push by the log of its first run."""
    campaign = read_campaign(str(folder / "campaign.yaml"))
    search = campaign.spec.bisect
    assert search is not None
    names = list(campaign.axes)
    ranges = {
        tuple(map(str, labels.values())): (own.low, own.high)
        for labels, keys in campaign.combinations()
        if (own := campaign.bisect(keys)) is not None
    }
    table = list(_table(folder / "thresholds.csv"))
    labels = [{name: row[name] for name in names} for row in table]
    limits = Limits(
        search.key, [(one, folder / row["log"]) for one, row in zip(labels, table, strict=True) if row["log"]], ""
    )
    for one, row in zip(labels, table, strict=True):
        limit = limits.at(one, None)
        low, high = ranges[tuple(one.values())]
        ended = {"threshold": _short(row["threshold"]), "side": row["side"], "low": f"{low:g}", "high": f"{high:g}"}
        yield {**one, **ended, "limit": "" if limit is None else f"{limit:.4g}"}


def searches(name: str) -> tuple[list[Found], list[Axis]]:
    """Where the searches of a kept result ended, and its axes."""
    kept = rows(name)
    names = list(kept[0])[: list(kept[0]).index("threshold")]
    axes = [Axis(axis, tuple(dict.fromkeys(row[axis] for row in kept))) for axis in names]
    found = [
        Found(
            {axis: row[axis] for axis in names},
            Threshold(float(row["threshold"]) if row["threshold"] else None, row["side"]),  # type: ignore[arg-type]
            (float(row["low"]), float(row["high"])),
        )
        for row in kept
    ]
    return found, axes


def limit_of(name: str, labels: Mapping[str, Any]) -> float | None:
    """The limit of a push by one-step capturability, as it is kept with the search of these labels."""
    for row in rows(name):
        if all(row[axis] == value for axis, value in labels.items()):
            return float(row["limit"]) if row["limit"] else None
    return None


def push_table(name: str) -> str:
    """Thresholds of all adaptations in one cell, and the limit of the last, by phase and direction."""
    found, axes = searches(name)
    *_, columns, shades, groups = axes
    cells: dict[str, dict[Any, list[str]]] = {}
    for one in sorted(found, key=lambda one: shades.values.index(one.labels[shades.name])):
        sign = {"below": "< ", "above": "≥ "}.get(one.threshold.side, "")
        limit = limit_of(name, one.labels) if one.labels[shades.name] == shades.values[-1] else None
        shown = f"{sign}{one.shown:.2f}" + ("" if limit is None else f" ({limit:.2f})")
        cells.setdefault(text(one.labels[groups.name]), {}).setdefault(one.labels[columns.name], []).append(shown)
    lines = ["| N·s/kg | " + " | ".join(map(text, columns.values)) + " |", "|---" * (1 + len(columns.values)) + "|"]
    for phase, by_column in cells.items():
        lines.append(f"| {phase} | " + " | ".join(", ".join(by_column[column]) for column in columns.values) + " |")
    return "\n".join(lines)


def gains_table(name: str) -> str:
    """By how much each adaptation multiplies the threshold of the one before it, least and most, by direction."""
    found, axes = searches(name)
    *_, columns, shades, groups = axes
    inside = {
        tuple(one.labels[axis.name] for axis in (columns, shades, groups)): one.shown for one in found if not one.beyond
    }
    lines = ["| adaptation | over | " + " | ".join(columns.values) + " |", "|---" * (2 + len(columns.values)) + "|"]
    for before, after in zip(shades.values, shades.values[1:], strict=False):
        cells = []
        for column in columns.values:
            pairs = [
                (inside.get((column, before, group)), inside.get((column, after, group))) for group in groups.values
            ]
            ratios = [b / a for a, b in pairs if a and b]
            cells.append(f"{min(ratios):.1f} to {max(ratios):.1f}" if ratios else "")
        lines.append(f"| `{after}` | `{before}` | {' | '.join(cells)} |")
    return "\n".join(lines)


def faults_table() -> str:
    """What walks with one fault of their sensors each, and how."""
    lines = [
        "| fault | status | velocity error x, y | ZMP error x, y | CoP at p99 | force found that nobody gave |",
        "|---" * 6 + "|",
    ]
    for row in rows("sensor-faults"):
        velocity, zmp = (
            ", ".join(f"{1e3 * float(row[name]):.1f}" for name in pair) for pair in (_SENSED[:2], _SENSED[2:])
        )
        cop, ghost = float(row["cop_ratio_p99"]), float(row["ghost_force_max"])
        lines.append(f"| {row['fault']} | {row['status']} | {velocity} mm/s | {zmp} mm | {cop:.2f} | {ghost:.0f} N |")
    return "\n".join(lines)


def pythons_table() -> str:
    """In which empty environments a walk passed, and what they take of the disk."""
    lines = [f"| {row['python']} | {row['distribution']} | {row['MB']} | {row['largest']} |" for row in rows("pythons")]
    return "\n".join(["| Python | from | MB | of it |", "|---|---|---|---|", *lines])


def made_table() -> str:
    """By what command each result was made, and by which code."""
    lines = [f"| `{name}.csv` | `{head(name)[0]}` | {head(name)[1]} |" for name in MADE if path_of(name).exists()]
    return "\n".join(["| result | made by | code |", "|---|---|---|", *lines])


def main() -> None:
    """Keep the result that is given."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", choices=MADE)
    parser.add_argument("folder", type=Path, help="of the campaign")
    told = parser.parse_args()
    keep(told.name, told.folder)


if __name__ == "__main__":
    sys.exit(main())
