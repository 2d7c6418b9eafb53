"""Results of campaigns that pages and pictures show, kept in docs/results.

    surefoot sweep ... --out runs/push-map
    python docs/measured.py push-map runs/push-map

The first line of a kept result is the command that made it, the second the code that it was made by. Campaigns that
serve a page alone have their specification in docs/campaigns. `result_tables.py` makes the tables of pages.
"""

import argparse
import csv
import shlex
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.log import read
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.capturability import Limits
from surefoot.studies.campaigns.spec import Axis
from surefoot.studies.campaigns.thresholds import Found, Threshold

RESULTS = Path(__file__).parent / "results"


class Made(NamedTuple):
    """A campaign and what of it is run: its settings, runs of each, and the columns that are kept of a table."""

    campaign: str
    settings: tuple[str, ...] = ()
    seeds: int | None = None
    columns: tuple[str, ...] = ()

    @property
    def command(self) -> str:
        """Command that makes it."""
        given = [f"--set {shlex.quote(setting)}" for setting in self.settings]
        return " ".join(["surefoot sweep", self.campaign, *given, *([f"--seeds {self.seeds}"] if self.seeds else [])])


_NATURAL = "gait=natural"
_ENDS = "planner.step_adaptation=[none, crossing]"
_STOPPED = ("torque_at_limit_fraction", "cop_ratio_p99", "torque_ratio_max")
_ZMP = tuple(f"zmp_error_rms.{axis}" for axis in (0, 1))
SENSED = (*(f"velocity_estimation_error_rms.{axis}" for axis in (0, 1)), *_ZMP)
_PLANNED = ("planner_infeasible_fraction", *_ZMP, "zmp_inside_fraction")
HEEL_OFF = ("speed_mean", "cost_of_transport", "knee_angle_mean", "knee_torque_rms", "torque_ratio_max")
SPEEDS = (
    *("speed_mean", "knee_stance_mean", "knee_heel_strike", "cost_of_transport", "landing_peak"),
    *("foot_slip_max", "torque_at_limit_fraction"),
)
KNEES = ("speed_mean", "knee_angle_mean", "knee_torque_rms", "cost_of_transport")
PELVIS = ("knee_stance_mean", "cost_of_transport", "landing_peak", "foot_slip_max")
HIDDEN = ("cop_ratio_p99", "step_shift", "ghost_force_max")
WITHOUT = (*(f"com_estimation_error_rms.{axis}" for axis in range(3)), "estimation_drift", "ghost_force_max")
ROUGH = ("speed_mean", "cop_ratio_p99", "torque_ratio_max")
PUSHED, PUNCHED = ("pushes.0.impulse", "status"), ("pushes.0.impulse", "pushes.0.elevation", "pushes.0.body", "status")
_GOOD = ("sensing.source=ekf", "sensing.preset=good")


def _of_page(name: str, *columns: str) -> Made:
    """A campaign that serves a page alone."""
    at = next(index for index, column in enumerate(columns) if column.partition(".")[0] in OWN)
    return Made(f"docs/campaigns/{name}.yaml", columns=(*columns[:at], "status", *columns[at:]))


MADE = {
    "gait-map": Made(
        "gait-map",
        columns=("riser", "step_length", "step_time", "status", *_STOPPED),
    ),
    "push-map-pendulum": Made("push-map", ("fidelity=pendulum", _NATURAL), 1),
    "push-map": Made("push-map", ("fidelity=full", _NATURAL, _ENDS, "phase=[SS 0.5]"), 1),
    "random-pushes": Made("random-pushes", columns=PUSHED),
    "random-pushes-g1": Made("random-pushes", ("robot=g1",), columns=PUSHED),
    "random-pushes-g1-good": Made("random-pushes", ("robot=g1", *_GOOD), columns=PUSHED),
    "random-punches": Made("random-punches", columns=PUNCHED),
    "recovery-numbers": Made("recovery-numbers"),
    "abilities": Made("docs/campaigns/abilities.yaml"),
    "rules": Made("docs/campaigns/rules.yaml"),
    "rolling-pushes": Made("docs/campaigns/rolling-pushes.yaml"),
    "flat-pushes": Made("docs/campaigns/flat-pushes.yaml"),
    "profiles": _of_page("profiles", "profile", "fidelity", *_PLANNED),
    "profiles-on-stairs": _of_page("profiles-on-stairs", "terrain.riser", "planner.profile", *_ZMP),
    "speeds": _of_page("speeds", "terrain.friction", "gait.speed", *SPEEDS),
    "pelvis": _of_page("pelvis", "gait.speed", "pelvis", *PELVIS),
    "knees": _of_page("knees", "gait.speed", "feet", "knees", *KNEES),
    "heel-off": _of_page("heel-off", "gait.heel_off", *HEEL_OFF),
    "rough-ground": _of_page("rough-ground", "ground", *ROUGH),
    "sensor-faults": Made("sensor-faults", columns=("fault", "status", *SENSED, *HIDDEN)),
    "sensor-limits": Made("docs/campaigns/sensor-limits.yaml"),
    "without-foot-sensors": _of_page("without-foot-sensors", "walk", *WITHOUT),
    "hidden": Made("hidden", columns=("hidden", "feet", "status", *HIDDEN)),
}
"""Results by the name of the result."""


def path_of(name: str) -> Path:
    """Path of a result that is kept."""
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
    """Ends of each search, its range, and the limit of the push by the log of its first run."""
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
    """Ends of the searches of a kept result, and its axes."""
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


def main() -> None:
    """Keep the result that is given."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", choices=MADE)
    parser.add_argument("folder", type=Path, help="of the campaign")
    options = parser.parse_args()
    keep(options.name, options.folder)


if __name__ == "__main__":
    sys.exit(main())
