"""The table of docs/standing.md: what is reached, how it was measured, how sure that is, and what makes it again."""

import csv
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import asked
import page_table
import yaml

from surefoot.scenarios.judge.metrics import OWN

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent


class Row(NamedTuple):
    """A line of the table."""

    what: str
    value: str
    sure: str
    command: str


OF_BASELINES: tuple[tuple[str, str, str], ...] = (
    ("walk on bent knees", "walk-brisk", "speed_mean"),
    ("walk, knee of the leg that carries", "walk", "knee_stance_mean"),
    ("walk, cost of transport", "walk", "cost_of_transport"),
    ("walk on straight legs, from start to stop", "walk-fast", "speed_mean"),
    ("walk on straight legs, knee of the leg that carries", "walk-fast", "knee_stance_mean"),
    ("walk on straight legs, cost of transport", "walk-fast", "cost_of_transport"),
    ("stairs of the tallest risers, edge under the sole", "stairs-tall", "stair_edge_margin_min"),
    ("stairs of the tallest risers, worst torque", "stairs-tall", "torque_ratio_max"),
    ("walk on level feet, ZMP against its reference", "walk-level", "zmp_error_rms"),
    ("walk on level feet, footsteps against the plan", "walk-level", "footstep_error_max"),
    ("walk on level feet, cost of transport", "walk-level", "cost_of_transport"),
    ("walk on level feet, bend of the knees", "walk-level", "knee_angle_mean"),
)
"""In words, the scenario, and the metric of its baseline."""

PUSHES = ("forward", "backward", "to the swing foot", "over the stance foot")
ONE_RUN = "one run, the same to the bit on one machine"
LADDER = "one run each at 70, 85 and 100 % of it"
PUSH_TEST = "pytest -m long tests/scenarios/run/test_push_tables.py"


def table() -> str:
    """The table in Markdown."""
    rows = [*_walks(), *_pushes(), *_sensors(), *_tour(), *_compute()]
    lines = ([row.what, row.value, row.sure, f"`{row.command}`"] for row in rows)
    return page_table.table(("what", "value", "measured by", "again by"), lines)


def _walks() -> Iterator[Row]:
    for what, scenario, name in OF_BASELINES:
        yield Row(what, _measured(scenario, name), f"`{name}`, {ONE_RUN}", f"surefoot check {scenario}")
    terrain = scenario_file("stairs-tall")["terrain"]
    size = f"{terrain['riser']} m risers on {terrain['tread']} m treads"
    yield Row("stairs, one foot per tread", size, ONE_RUN, "surefoot check stairs-tall")


def _pushes() -> Iterator[Row]:
    for phase, most in asked.largest().items():
        text = ", ".join(f"{value:g} {where}" for where, value in zip(PUSHES, most, strict=True))
        yield Row(f"push of 0.1 s {phase} [N·s/kg]", text, LADDER, PUSH_TEST)


def _sensors() -> Iterator[Row]:
    with (FOLDER / "sensors.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            what = f"walk from sensors, `{row['preset']}`, error of {row['quantity']}"
            value = f"{row['error_rms']} {row['unit']}"
            command = f"python -m benchmarks.sensed --seeds {row['seeds']} --out sensors.csv"
            yield Row(what, value, f"RMS of a number over {row['seeds']} seeds, NEES {row['nees']}", command)


def _tour() -> Iterator[Row]:
    result = json.loads((FOLDER / "benchmark-g1.json").read_text(encoding="utf-8"))
    for row in result["rows"]:
        mean = row["survival"]
        value = f"{mean['value']:.1f} of {row['seconds']:.0f} s"
        sure = f"mean of {row['tours']} tours, {mean['low']:.1f} to {mean['high']:.1f} s"
        yield Row(f"the G1 tour, `{row['row']}`", value, sure, f"surefoot bench g1-tour --seeds {row['tours']}")


def _compute() -> Iterator[Row]:
    ticks = json.loads((ROOT / "benchmarks" / "limits.json").read_text())["diagonal-walk"]
    for kind in ("without a plan", "with a plan"):
        most = f"at most {ticks[f'calls of a tick {kind}']}"
        yield Row(
            f"calls of Python functions in a tick {kind}", most, "counted in a test", "python -m benchmarks counts"
        )
    shown = re.search(r"(?m)^real_time_factor +(.+?)  ", (ROOT / "README.md").read_text(encoding="utf-8"))
    assert shown is not None
    sure = "range of runs on an idle core"
    yield Row("speed of `diagonal-walk`", f"{shown[1]} times real time", sure, "surefoot run diagonal-walk")


def scenario_file(name: str) -> Any:
    """A scenario of the catalogue as its file has it."""
    return yaml.safe_load((ROOT / "scenarios" / "catalogue" / f"{name}.yaml").read_text(encoding="utf-8"))


def measured(scenario: str, name: str) -> Any:
    """A metric of a baseline in the unit in which it is shown."""
    path = ROOT / "scenarios" / "baselines" / f"{scenario}.baseline.yaml"
    value, scale = yaml.safe_load(path.read_text(encoding="utf-8"))["metrics"][name], OWN[name].scale
    return [scale * number for number in value] if isinstance(value, list) else scale * value


def _measured(scenario: str, name: str) -> str:
    """A metric of a baseline as it is shown."""
    value = measured(scenario, name)
    numbers = value if isinstance(value, list) else [value]
    return f"{', '.join(f'{number:.3g}' for number in numbers)} {OWN[name].shown}".strip(" -")
