"""Tables of pages that follow from the results in docs/results, which `measured.py` keeps; see `push_tables`, too."""

import json
import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any

from measured import HEEL_OFF, HIDDEN, KNEES, PELVIS, RESULTS, ROUGH, SENSED, SPEEDS, WITHOUT, head, rows
from page_table import table
from push_tables import (
    beside_table,
    gains_table,
    gaits_table,
    numbers_table,
    push_table,
    random_table,
    rules_table,
    search_table,
)

from surefoot.models.robot_file import magnitudes
from surefoot.scenarios.judge.metrics import OWN
from surefoot.studies.tour.bench import published
from surefoot.studies.tour.results import RowResult, read_tours
from surefoot.studies.tour.ride import TourResult
from surefoot.studies.tour.side import read_table
from surefoot.studies.tour.side_page import markdown

LIMITS = Path(__file__).parents[1] / "benchmarks" / "limits.json"


def runs_table(name: str, labels: Sequence[str], metrics: Sequence[str], of_all: Sequence[str] = ()) -> str:
    """Runs of a campaign: what varies, how many passed, some metrics of all, and others of those that passed.

    Where several runs have the same labels a metric is given from the least to the largest.
    """
    lines = []
    for values, group in groupby(rows(name), lambda row: [row[label] for label in labels]):
        runs = list(group)
        passed = [run for run in runs if run["status"] == "pass"]
        walked = {0: "no", len(runs): "yes"}.get(len(passed), f"{len(passed)} of {len(runs)}")
        cells = (_measured(of, metric) for of, names in ((runs, of_all), (passed, metrics)) for metric in names)
        lines.append([*values, walked, *cells])
    return table([*labels, "walked", *map(_with_unit, (*of_all, *metrics))], lines)


def _with_unit(metric: str) -> str:
    return f"`{metric}`" + (f" [{OWN[metric].shown}]" if OWN[metric].shown else "")


def _measured(runs: Sequence[dict[str, str]], metric: str) -> str:
    """A metric of some runs; empty where there are none."""
    cells = []
    for column in runs[0] if runs else ():
        if re.fullmatch(rf"{metric}(\.\d)?", column):
            values = [OWN[metric].scale * float(run[column]) for run in runs]
            cells.append(" to ".join(dict.fromkeys(f"{end:.3g}" for end in (min(values), max(values)))))
    return ", ".join(cells)


def tour_table() -> str:
    """Walkers that began on the crane with the benchmark's draws, beside what it has published of them."""
    theirs = {row["name"]: row for row in published()["rows"]}
    lines = []
    for name, group in groupby(read_tours([list(rows(TOURS)[0]), *(list(row.values()) for row in rows(TOURS))]), _row):
        tours = list(group)
        lines.append([f"`{name}`", *_tour_cells(tours, RowResult.of(tours), theirs.get(name))])
    heads = ["walker", "tours", "survival [s]", "published", "off", "completed", "published"]
    heads += ["place [cm]", "published", "heading [deg]", "published", "energy [kJ]", "published"]
    return table(heads, lines)


TOURS = "g1-tour-crane"


def _row(tour: TourResult) -> str:
    return tour.row


def _tour_cells(tours: Sequence[TourResult], of: RowResult, theirs: dict[str, Any] | None) -> Iterator[str]:
    """Numbers of a walker, each before the published one; errors as there, with that at the fall."""
    told = theirs or {}
    survival, done = of.survival, of.completed
    yield str(of.tours)
    yield f"{survival.value:.1f} ({survival.low:.1f} to {survival.high:.1f})"
    yield str(told.get("survival", ""))
    yield f"{100 * (survival.value / told['survival'] - 1):+.0f} %".replace("-0 ", "0 ") if told else ""
    yield f"{100 * done.kept / done.count:.0f} % ({100 * done.low:.0f} to {100 * done.high:.0f})"
    yield f"{told['completed']} %" if told else ""
    for at, (name, factor) in enumerate((("position", 100.0), ("heading", math.degrees(1.0)))):
        ended = [error for tour in tours for error in getattr(tour, f"{name}_errors")]
        ended += [tour.left_over[at] for tour in tours if tour.left_over]
        yield f"{factor * sum(ended) / len(ended):.0f}"
        yield str(told.get(name, ""))
    whole = [1e-3 * sum(tour.energy) for tour in tours if tour.completed]
    yield f"{sum(whole) / len(whole):.1f}" if whole else ""
    yield str(told.get("energy", ""))


def side_tables() -> str:
    """Walkers beside each other, and who is best in how many lines."""
    told = rows("g1-side")
    return markdown(read_table([list(told[0]), *(list(row.values()) for row in told)])).rstrip("\n")


def fastest_table() -> str:
    """The longest step that walks by its time on each riser of the gait map, and what stops a longer one."""
    runs = [row for row in rows("gait-map") if row["status"] != "refused"]
    times = sorted({float(row["step_time"]) for row in runs})
    lines = []
    for riser in sorted({float(row["riser"]) for row in runs}):
        cells = []
        for time in times:
            passed = [
                float(row["step_length"])
                for row in runs
                if (float(row["riser"]), float(row["step_time"]), row["status"]) == (riser, time, "pass")
            ]
            cells.append(f"{max(passed):g} m, {max(passed) / time:.2f} m/s" if passed else "none")
        lines.append(["flat ground" if riser == 0.0 else f"stairs of {riser:g} m", *cells])
    return table(["", *(f"{time:g} s" for time in times)], lines)


def plain_table(name: str) -> str:
    """A result whose columns are those of the page."""
    kept = rows(name)
    return table(list(kept[0]), [list(row.values()) for row in kept])


def faults_table() -> str:
    """Table of walks with one fault of their sensors each, and how they end."""
    heads = "fault", "status", "velocity error x, y", "ZMP error x, y", "CoP at p99", "force found that nobody gave"
    lines = []
    for row in rows("sensor-faults"):
        velocity, zmp = (
            ", ".join(f"{1e3 * float(row[name]):.1f}" for name in pair) for pair in (SENSED[:2], SENSED[2:])
        )
        cop, ghost = float(row["cop_ratio_p99"]), float(row["ghost_force_max"])
        lines.append([row["fault"], row["status"], f"{velocity} mm/s", f"{zmp} mm", f"{cop:.2f}", f"{ghost:.0f} N"])
    return table(heads, lines)


def limits_table() -> str:
    """Table of how poor each term may be alone: the rung asked for, and the last survived before one that was not."""
    lines = []
    for row in rows("sensor-limits"):
        term, _, unit = row["term"].removesuffix("]").partition(" [")
        unit = "" if unit == "-" else f" {unit}"
        above = "at least " if row["side"] == "above" else ""
        most = float(f"{float(row['threshold']):.2g}")
        lines.append([term, f"{row['low']}{unit}", f"{above}{most:g}{unit}"])
    return table(("term", "first rung", "survived up to"), lines)


def without_table() -> str:
    """Table of every walk without force sensors in its feet; of several runs the worst."""
    heads = "walk", "passed", "CoM against the stance foot x, y, z", "drift", "force found that nobody gave"
    lines = []
    for walk, group in groupby(rows("without-foot-sensors"), lambda row: row["walk"]):
        runs = list(group)
        passed = sum(run["status"] == "pass" for run in runs)
        *com, drift, ghost = (max(float(run[name] or 0.0) for run in runs) for name in WITHOUT)
        error = ", ".join(f"{1e3 * most:.1f}" for most in com)
        cells = f"{passed} of {len(runs)}", f"{error} mm", f"{1e2 * drift:.2f} %", f"{ghost:.0f} N"
        lines.append([f"`{walk}`", *cells])
    return table(heads, lines)


def hidden_table() -> str:
    """Table of walks with one thing each that the robot does not know, on both feet; of several runs the worst."""
    heads = "hidden", "feet", "survived", "CoP at p99", "step moved", "force found that nobody gave"
    lines = []
    for (hidden, feet), group in groupby(rows("hidden"), lambda row: (row["hidden"], row["feet"])):
        runs = list(group)
        survived = sum(run["status"] == "pass" for run in runs)
        cop, shift, ghost = (max(float(run[name]) for run in runs) for name in HIDDEN)
        cells = f"{survived} of {len(runs)}", f"{cop:.2f}", f"{1e3 * shift:.0f} mm", f"{ghost:.0f} N"
        lines.append([hidden, feet, *cells])
    return table(heads, lines)


def pythons_table() -> str:
    """Table of the empty environments in which a walk passed, and what they take of the disk."""
    columns = ("python", "distribution", "MB", "largest")
    return table(("Python", "from", "MB", "of it"), ([row[column] for column in columns] for row in rows("pythons")))


def made_table() -> str:
    """Table of the command and the code by which each result was made."""
    made = [(path.name, *head(path.stem)) for path in sorted(RESULTS.glob("*.csv"))]
    return table(["result", "made by", "code"], [[f"`{name}`", f"`{command}`", code] for name, command, code in made])


def _section(name: str) -> tuple[list[str], list[list[Any]]]:
    """Headings and rows of a section of `python -m benchmarks`."""
    found = json.loads((RESULTS / "benchmarks.json").read_text(encoding="utf-8"))["sections"][name]
    return found["columns"], found["rows"]


def startup_table() -> str:
    """Table of what commands cost before they do anything."""
    _, lines = _section("startup")
    limits = json.loads(LIMITS.read_text(encoding="utf-8"))["surefoot's modules that a command imports"]
    cells = [[f"`surefoot {name}`", f"{seconds:.2f} s", str(limits.get(name, ""))] for name, seconds, *_ in lines]
    return table(["command", "processor time", "modules, at most"], cells)


def tick_table() -> str:
    """Parts of a control tick as shares of its mean, and what it takes over the engines alone."""
    _, lines = _section("tick")
    means = {name: mean for name, *_, mean in lines}
    whole, floor = means.pop("whole tick"), means.pop("floor: engines alone")
    parts = sorted(means.items(), key=lambda part: (part[0] == "rest", -part[1]))
    cells = [[name, f"{100 * mean / whole:.0f} %"] for name, mean in parts]
    return table(["part", "share of the mean tick"], [*cells, ["engines alone", f"{100 * floor / whole:.0f} %"]])


def solvers_table() -> str:
    """Solvers on the same problems."""
    columns, lines = _section("solvers")
    shown = ("solver", "over daqp", "failures", "KKT residual", "largest |x - x_daqp|")
    kept = [[line[columns.index(name)] for name in shown] for line in lines]
    cells = [[name, f"{over:.2f}", str(failed), kkt, away] for name, over, failed, kkt, away in kept]
    return table(["solver", "median", "failures", "KKT residual", "largest difference to DAQP"], cells)


def magnitudes_table() -> str:
    """Each law on the sizes of a robot, with the public humanoid that comes nearest to its bounds."""
    nearest = {row["law"]: row for row in rows("magnitudes")}
    laws = ((name, law) for name, law in vars(magnitudes).items() if isinstance(law, magnitudes.Law))
    cells = ([_said(law), law.over.format("y"), _bounds(law), law.then, _nearest(nearest[name])] for name, law in laws)
    return table(("what is said", "x over", "may be", "otherwise", "nearest"), cells)


def models_held() -> str:
    """Number of public models that the laws on sizes were held against."""
    return max((row["models"] for row in rows("magnitudes")), key=int)


def _said(law: magnitudes.Law) -> str:
    return law.said.format(what="NAME", value=f"x {law.unit}")


def _bounds(law: magnitudes.Law) -> str:
    if law.most == math.inf:
        return f"at least {law.least:g}"
    return f"{law.least:g} to {law.most:g}" if law.least else f"at most {law.most:g}"


def _nearest(row: dict[str, str]) -> str:
    return f"{row['ratio']}, {row['model']}"


def known_table() -> str:
    """Table of how often the first line of `surefoot inspect` is the known cause of a fall."""
    known, lines = rows("known-falls"), []
    campaigns = list(dict.fromkeys(row["campaign"] for row in known))
    for cause in (*dict.fromkeys(row["cause"] for row in known), "all"):
        of_cause = [row for row in known if cause in (row["cause"], "all")]
        cells = []
        for campaign in campaigns:
            right = [row["right"] == "yes" for row in of_cause if row["campaign"] == campaign]
            cells.append(f"{sum(right)} of {len(right)}" if right else "")
        lines.append([cause.replace("_", " "), *cells])
    return table(["cause", *(f"`{campaign}`" for campaign in campaigns)], lines)


def given_up_table() -> str:
    """Table of counts of plans that warn of falls which come, and of those which do not."""
    heads = [
        "walks",
        "told by",
        "taken back by",
        "wrong",
        "told when it came",
        "0.2 s before",
        "taken back in the last second",
    ]
    lines = [
        [
            *(row["kind"], row["tell"], row["back"], f"{row['wrong']} in {int(row['walked']) + int(row['falls'])}"),
            *(f"{row[name]} of {row['falls']}" for name in ("told", "early")),
            row["lost"],
        ]
        for row in rows("given-up")
    ]
    return table(heads, lines)


TABLES: dict[str, tuple[str, Callable[[], str]]] = {
    "magnitudes": ("robot-files.md", magnitudes_table),
    "push-map-pendulum": ("campaigns.md", partial(push_table, "push-map-pendulum")),
    "push-map": ("campaigns.md", partial(push_table, "push-map")),
    "push-gains": ("campaigns.md", partial(gains_table, "push-map-pendulum")),
    "random": ("campaigns.md", random_table),
    "recovery-numbers": ("recovery-results.md", numbers_table),
    "known-falls": ("falling.md", known_table),
    "given-up": ("recovery.md", given_up_table),
    "rules": ("recovery-results.md", rules_table),
    "abilities": ("recovery-results.md", partial(search_table, "abilities")),
    "rolling-pushes": ("fast-walking.md", partial(gaits_table, "rolling-pushes", "flat-pushes")),
    "profiles-walk": (
        "profiles.md",
        partial(
            runs_table,
            "profiles",
            ("profile", "fidelity"),
            ("zmp_error_rms", "zmp_inside_fraction"),
            ("planner_infeasible_fraction",),
        ),
    ),
    "profiles-on-stairs": (
        "profiles.md",
        partial(runs_table, "profiles-on-stairs", ("terrain.riser", "planner.profile"), ("zmp_error_rms",)),
    ),
    "fastest": ("fast-walking.md", fastest_table),
    "heel-off": ("fast-walking.md", partial(runs_table, "heel-off", ("gait.heel_off",), HEEL_OFF)),
    "pelvis": ("fast-walking.md", partial(runs_table, "pelvis", ("gait.speed", "pelvis"), PELVIS)),
    "knees": ("paper.md", partial(runs_table, "knees", ("gait.speed", "feet", "knees"), KNEES)),
    "speeds": ("fast-walking.md", partial(runs_table, "speeds", ("terrain.friction", "gait.speed"), SPEEDS)),
    "rough-ground": ("scenarios.md", partial(runs_table, "rough-ground", ("ground",), ROUGH)),
    "sensor-faults": ("sensors.md", faults_table),
    "sensor-limits": ("sensors.md", limits_table),
    "without-foot-sensors": ("sensors.md", without_table),
    "hidden": ("sensors.md", hidden_table),
    **{
        name: (page, partial(plain_table, name))
        for name, page in (
            ("foreign", "sensors.md"),
            ("poor-line", "serve.md"),
            ("policy-faults", "policies.md"),
            ("policies-catalogue", "policies-beside.md"),
            ("steered", "policies-beside.md"),
            ("sabotage", "checking.md"),
            ("power", "checking.md"),
            ("incidents", "incidents.md"),
            ("criteria", "scenarios.md"),
            ("public-humanoids", "robots.md"),
            ("robustness", "campaigns.md"),
            ("mechanisms", "recovery-results.md"),
            ("mechanisms-walking", "recovery-results.md"),
        )
    },
    "g1-tour-crane": ("benchmark-g1.md", tour_table),
    "g1-side": ("policies-beside.md", side_tables),
    "ladder-beside": ("policies-beside.md", beside_table),
    "startup": ("benchmarks.md", startup_table),
    "tick": ("benchmarks.md", tick_table),
    "solvers": ("benchmarks.md", solvers_table),
    "pythons": ("how-to/install.md", pythons_table),
    "made": ("campaigns.md", made_table),
}
"""Tables by name: the page, and what makes the table."""
