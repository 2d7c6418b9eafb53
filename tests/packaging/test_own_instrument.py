"""An instrument of another package: under planner and policy, of two robots, in processes of a campaign, run again."""

import json

import numpy as np
import pytest

from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.log import read

SPEED = ("--set", "instruments=[{name: speedometer, period: 10 ms, noise: 1 cm/s, label: v}]")
BRIEF = ("--set", "duration=0.3", "--set", "criteria={fell: false}")
G1 = ("--set", "robot=g1", "--set", "sized_for=humanoid100")


def log_of(documented, *words):
    done = documented.run("run", *words, "--json")
    assert done.returncode == 0, (done.stdout, done.stderr)
    path = documented.folder.parent / json.loads(done.stdout)["log"]
    return path, read(path)


@pytest.mark.unit
@pytest.mark.parametrize(
    "words", [("walk",), ("walk", *G1), ("stand", "--policy", "held")], ids=["humanoid100", "g1", "policy"]
)
def test_it_is_read_beside_whatever_controls_and_its_log_runs_again(documented, words):
    path, log = log_of(documented, *words, *SPEED, *BRIEF)
    found, truth = log["/instrument/v"], log["/truth"]
    assert len(found.time_ns) >= 25
    rows = np.searchsorted(truth.time_ns, found.time_ns)
    errors = found.field("speed") - np.linalg.norm(truth.field("v")[rows, :3], axis=1)
    assert 0.003 < errors.std() < 0.02
    _, again = log_of(documented, str(path))
    assert again["/instrument/v"].content() == found.content()


@pytest.mark.unit
def test_commands_and_the_processes_that_they_spawn_know_its_keys(documented, tmp_path):
    scenario, campaign = tmp_path / "measured.yaml", tmp_path / "noises.campaign.yaml"
    text = "duration: 0.2\ncriteria: {fell: false}\ninstruments: [{name: speedometer, noise: 0.01}]\n"
    scenario.write_text(f"robot: humanoid100\ngait: {{steps: 0}}\n{text}")
    campaign.write_text(f"scenario: {scenario}\ngrid: {{instruments.0.noise: [0.01, 0.02]}}\nseeds: 1\n")
    for words in (("check", scenario), ("sweep", campaign, "--jobs", "2")):
        answer = documented.run(*map(str, words))
        assert "noise" not in answer.stderr and "Traceback" not in answer.stderr, answer.stderr
        assert answer.returncode in (0, 1), (words, answer.stderr, answer.stdout)
    assert "speedometer" in documented.run("list").stdout
    described = json.loads(documented.run("schema").stdout)["$defs"]["InstrumentSettings"]["properties"]
    assert described["name"]["enum"] == [*INSTRUMENTS, "speedometer"]


@pytest.mark.unit
def test_a_log_is_inspected_where_its_package_is_not(documented, at_hand):
    path, _ = log_of(documented, "stand", *SPEED, *BRIEF)
    code, out, err = at_hand("inspect", str(path))
    assert "Traceback" not in err and "speedometer" in out + err
    code, out, err = at_hand("run", str(path))
    assert (code, "speedometer" in err, err.count("Traceback")) == (2, True, 0)
