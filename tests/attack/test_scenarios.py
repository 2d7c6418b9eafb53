"""Wounded scenarios of the catalogue end as a scenario or as a refusal that a person can read, soon."""

import json
import subprocess
import sys
import time
from typing import get_args

import pytest
from mutations import TEXTS, text_of, trial

from surefoot.scenarios.errors import LONGEST_SENTENCE, ScenarioError
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.walk import Walk

MOST_LINES = 25


def outcome(make, seed):
    """Outcome of a trial, after a look at what a person would read."""
    begin = time.process_time()
    try:
        scenario = make()
    except ScenarioError as error:
        said = str(error)
        assert error.problems, f"seed {seed}: nothing is said"
        assert len(said.splitlines()) <= MOST_LINES, f"seed {seed}: {said}"
        for problem in error.problems:
            assert problem.startswith(("f.yaml:", "--set ", "catalogue/")), f"seed {seed}: no place: {problem}"
            assert "; " in problem, f"seed {seed}: says not what would be right: {problem}"
            assert "Traceback" not in problem, f"seed {seed}: {problem}"
            assert len(problem) <= LONGEST_SENTENCE + 10, f"seed {seed}: {problem}"
        result = "refused"
    except Exception as error:
        pytest.fail(f"seed {seed}: {type(error).__name__}: {error}")
    else:
        assert isinstance(scenario, Scenario)
        again = read_scenario(scenario_yaml(scenario), "f.yaml", "f", (), Robots())
        assert again == scenario, f"seed {seed}: the scenario as run is another"
        assert Walk(again).duration > 0.0, f"seed {seed}"
        result = "scenario"
    assert time.process_time() - begin < 2.0, f"seed {seed}: took too long"
    return result


def attack(seeds):
    robots = Robots()
    found = []
    for seed in seeds:
        text = text_of(seed)
        found.append(outcome(lambda text=text: read_scenario(text, "f.yaml", "f", (), robots), seed))
        if seed % 4 == 0:
            given = {"gait": trial(seed).get("gait"), "terrain.kind": TEXTS[seed % len(TEXTS)]}
            found.append(outcome(lambda given=given: load("walk-level", given, robots), seed))
    return found


@pytest.mark.unit
def test_every_trial_is_a_scenario_or_a_sentence():
    assert set(attack(range(100))) == {"scenario", "refused"}


def numbers(group, *path):
    """The path of every key that takes a number, through groups and the first element of lists."""
    for name, field in group.model_fields.items():
        inner = [one for one in (field.annotation, *get_args(field.annotation)) if hasattr(one, "model_fields")]
        if inner:
            yield from numbers(inner[0], *path, f"{name}.0" if "tuple" in str(field.annotation) else name)
        elif "float" in str(field.annotation) or "int" in str(field.annotation):
            yield ".".join((*path, name))


def extremes(values, texts=("{}",)):
    robots, found = Robots(), []
    for text in texts:
        for key in numbers(Scenario):
            for value in values:
                given = {key: value}
                found.append(
                    outcome(lambda text=text, given=given: read_scenario(text, "f.yaml", "f", given, robots), key)
                )
    return found


@pytest.mark.unit
def test_every_number_far_beyond_its_range():
    assert set(extremes((1e300,))) == {"refused"}


@pytest.mark.long
def test_every_number_at_its_extremes_on_every_ground():
    feet = "robot_options: {foot_length: 0.22, foot_width: 0.11}\n"
    grounds = (
        feet + "terrain: {kind: stairs}",
        feet + "terrain: {kind: slope, angle: 0.1}\ngait: {com_height: 0.95}",
        feet + "terrain: {kind: blocks, riser: 0.02}\ngait: {com_height: 0.95}",
        "gait: {velocity: [{time: 1, v_x: 0.1}, {time: 5}]}\npushes: [{time: 1}]\nfaults: [{kind: state_nan}]",
    )
    values = (-1e300, -1e3, -1, 0, 1e-300, 1e-5, 1, 1e3, 2**31, 1e300)
    assert set(extremes(values, grounds)) == {"scenario", "refused"}


@pytest.mark.long
def test_every_trial_of_many():
    assert set(attack(range(100, 3000))) == {"scenario", "refused"}


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5000, 5012))
def test_a_trial_on_the_command_line(tmp_path, seed):
    """The same through the program: exit code 2 and no traceback, or a run of half a second on a pendulum."""
    file = tmp_path / "f.yaml"
    file.write_text(text_of(seed), encoding="utf-8", errors="surrogatepass")
    short = ("--set", "fidelity=pendulum", "--set", "duration=0.5")
    command = [sys.executable, "-m", "surefoot", "run", str(file), *short, "--out", str(tmp_path)]
    told = subprocess.run(command, capture_output=True, text=True, timeout=120)
    ran = list(tmp_path.glob("*/verdict.json"))
    verdicts = {"pass": 0, "fail": 1}
    expected = verdicts[json.loads(ran[0].read_text())["verdict"]] if ran else 2
    assert told.returncode == expected, f"seed {seed}: {told.stderr}"
    assert "Traceback" not in told.stderr, f"seed {seed}: {told.stderr}"
    if told.returncode == 2:
        assert told.stdout == ""
        assert 1 <= len(told.stderr.splitlines()) <= MOST_LINES, f"seed {seed}: {told.stderr}"
