"""The numbers of docs/falling.md are those of its runs, and what it names is there."""

import importlib.util
import re
from pathlib import Path

import pytest

from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.figures.page import FIGURES

FOLDER = Path(__file__).parents[2] / "docs"
TEXT = (FOLDER / "falling.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"(?m)^surefoot run walk-level (.*)$", TEXT)


@pytest.fixture(scope="module")
def falling():
    spec = importlib.util.spec_from_file_location("falling", FOLDER / "falling.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.physics
def test_the_worked_example_is_what_its_runs_measure(falling, tmp_path):
    assert falling.updated(TEXT, falling.numbers(falling.pair(tmp_path))) == TEXT, "run python docs/falling.py"


@pytest.mark.unit
def test_the_walk_that_is_measured_is_that_of_the_page(falling):
    told = dict(one.split("=", 1) for one in re.findall(r'--set "?(\S+?=(?:\[.*?\]|[^\s"]+))"?', COMMANDS[0]))
    assert load("walk-level", [f"{key}={value}" for key, value in told.items()]) == load("walk-level", falling.SETTINGS)


@pytest.mark.unit
def test_a_number_that_is_another_is_found(falling):
    names = {name: "other" for _, name in re.findall(r"(<!-- fall: ([\w-]+) -->)", TEXT)}
    assert len(names) > 10
    assert falling.updated(TEXT, names) != TEXT


@pytest.mark.unit
def test_settings_that_test_a_cause_are_settings():
    part = TEXT.split("## Test the cause")[1]
    told = [one.split() for one in re.findall(r"(?m)^\| [^|]+ \| (.*) \| [^|]+ \|$", part)][2:]
    settings = [word.strip("`,") for words in told for word in words if "=" in word]
    assert len(settings) >= 12
    for setting in settings:
        load("walk-level", [setting])


@pytest.mark.unit
def test_the_largest_pushes_are_those_of_the_readme():
    told = re.search(r"forward in mid-swing\n?\s*([\d.]+) N·s/kg, at any time ([\d.]+)\.", TEXT).groups()
    readme = (FOLDER.parent / "README.md").read_text(encoding="utf-8")
    assert told == tuple(
        re.search(rf"(?m)^\| {when} \| ([\d.]+) \|", readme)[1] for when in ("in mid-swing", "at any time")
    )


@pytest.mark.unit
def test_figures_and_metrics_of_the_tables_are_there():
    assert set(re.findall(r"plot --what ([\w-]+)", TEXT)) <= set(FIGURES)
    rows = TEXT.split("Some symptoms have no check")[1].split("## Test")[0]
    named = set(re.findall(r"`([a-z]+_[a-z_]+)`", rows))
    assert len(named) >= 5
    assert named <= set(OWN) | {"torque_limits"}
