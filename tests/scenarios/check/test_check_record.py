"""A check as one JSON object, and as what GitHub shows beside a file."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from surefoot.scenarios.check.annotations import annotations
from surefoot.scenarios.check.baseline import read_baseline, write_baseline
from surefoot.scenarios.cli.program import app

pytestmark = pytest.mark.unit

WALK = """
name: stroll
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.5, double_support: 0.1, initial_stand: 0.2}
duration: 2.2
rates: {control: 100}
criteria: {fell: false, speed_mean: {min: 0.01}}
"""


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """Text of the baseline of a scenario."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("first"))
        Path("stroll.yaml").write_text(WALK)
        assert checked("stroll.yaml", "--update").exit_code == 0
        return Path("baselines/stroll.baseline.yaml").read_text()


@pytest.fixture
def here(first, tmp_path, monkeypatch):
    """A repository with a scenario and its baseline, in which commands are given."""
    monkeypatch.chdir(tmp_path)
    Path("walks/baselines").mkdir(parents=True)
    Path("walks/stroll.yaml").write_text(WALK)
    Path("walks/baselines/stroll.baseline.yaml").write_text(first)
    return Path("walks/baselines/stroll.baseline.yaml")


def checked(*words):
    return CliRunner().invoke(app, ["check", "--jobs", "1", *words])


def spoil(file):
    """A baseline with another speed and another place of a CoM."""
    baseline = read_baseline(file)
    baseline.trace.values["com_x"][2] += 0.05
    metrics = {**baseline.metrics, "speed_mean": 2.0 * baseline.metrics["speed_mean"]}
    write_baseline(file, replace(baseline, metrics=metrics))


def test_a_check_is_one_object_of_what_ran_and_what_came_of_it(here):
    result = checked("walks", "--json")
    found = json.loads(result.stdout)
    assert (result.exit_code, found["exit_code"], found["passed"]) == (0, 0, True)
    assert {"surefoot", "mujoco", "machine", "git_revision"} <= found["versions"].keys()
    (one,) = found["scenarios"]
    assert (one["scenario"], one["status"], one["moves"], one["partings"]) == ("stroll", "same", [], [])
    assert (one["reference"], one["baseline"], one["log"]) == ("walks/stroll.yaml", str(here), None)
    assert one["metrics"]["speed_mean"] == pytest.approx(read_baseline(here).metrics["speed_mean"], rel=1e-5)
    assert one["metrics"]["real_time_factor"] > 0.0  # what no baseline keeps
    assert one["took"] > 0.0


def test_what_moved_is_in_the_object_with_its_numbers(here):
    spoil(here)
    result = checked("walks", "--json")
    (one,) = json.loads(result.stdout)["scenarios"]
    assert (result.exit_code, one["status"], one["passed"]) == (1, "moved", False)
    (move,) = one["moves"]
    assert (move["metric"], move["direction"], move["unit"]) == ("speed_mean", "worse", "m/s")
    assert move["before"] - move["now"] > move["allowed"] > 0.0
    (parting,) = one["partings"]
    assert (parting["stage"], parting["figure"]) == (2, "balance")
    assert Path(one["log"]).is_file()


def test_what_could_not_run_is_in_the_object_too(here):
    result = checked("walks", "--json", "--out", str(here))
    (one,) = json.loads(result.stdout)["scenarios"]
    assert (result.exit_code, one["status"], one["metrics"]) == (2, "could not run", {})
    assert one["reasons"]


def test_annotations_name_the_file_and_escape_what_github_would_read(here):
    assert "::error" not in checked("walks", "--annotations").stdout
    spoil(here)
    assert "::" not in checked("walks").stdout
    (line,) = (line for line in checked("walks", "--annotations").stdout.splitlines() if line.startswith("::"))
    head, _, said = line.removeprefix("::").partition("::")
    assert head == "error file=walks/stroll.yaml,title=stroll%3A moved"
    assert said.startswith("parts first: CoM at the end of step 1: 50.0 mm behind the baseline%0Aspeed_mean: ")
    assert "%0A" in said


def test_a_better_run_is_a_warning_and_a_scenario_of_the_catalogue_has_no_file(here):
    from surefoot.scenarios.check.check import Case, Checked
    from surefoot.scenarios.setup.load import load

    case = Case("walk", load("walk"), here)
    (line,) = annotations([Checked(case, "better", ("100 % of it",)), Checked(case, "same")])
    assert line == "::warning title=walk%3A better::100 %25 of it"


def test_annotations_do_not_get_into_the_object(here):
    assert "give it without --annotations" in str(checked("walks", "--json", "--annotations").exception)


def test_seeds_run_in_processes_beside_this_one_and_are_taken_over_by_the_next_check(here):
    Path("walks/stroll.yaml").write_text(f"{WALK}sensing: {{com_noise: 0.003}}\n")
    first = checked("walks", "--seeds", "3", "--update")
    assert (first.exit_code, "3 of 3 seeds met their criteria: 100 %" in first.stdout) == (0, True)
    journal = Path("runs/check/seeds/runs.jsonl")
    lines = journal.read_text()
    again = json.loads(checked("walks", "--json").stdout)["scenarios"][0]
    assert (again["status"], again["seeds"]["seeds"], again["seeds"]["passed"]) == ("same", [0, 1, 2], [True] * 3)
    assert journal.read_text() == lines
