"""Falls of ten kinds come back from their logs, by fewer causes; `check` is red with them and green without."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from needs import POLICY

import surefoot
from surefoot.studies.incident.harm import harm_of
from surefoot.studies.incident.regression import Incident, Trials, regression
from surefoot.wbc.controller import WholeBodyController

sys.path.append(str(Path(__file__).parents[2] / "incidents"))

from falls import FALLS, scenario_of
from kinds import told

pytestmark = pytest.mark.physics

FEW = ("push", "G1, a policy")
"""Kinds that are tried with every change: two robots, one under a policy."""

ALL_NEEDED = ("late motors",)
"""Kinds that take all that acted."""


def comes_back(kind, folder, seconds=None):
    """Hold what all incidents have in common."""
    if kind.endswith("a policy"):
        POLICY.or_skip()
    one = told(kind, folder, seconds)
    found = one.found
    assert found.comes_back, kind
    assert one.again.same, kind
    assert (len(found.needed) < len(found.causes)) is (kind not in ALL_NEEDED), kind
    assert not any(found.without(cause).same for cause in found.needed), kind
    assert one.red.status == "failed", kind
    assert any(first.passed and second.status == "same" for _, first, second in one.green), kind
    return one


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=() if kind in FEW else pytest.mark.long) for kind in FALLS])
def test_a_fall_comes_back_by_fewer_causes(kind, tmp_path):
    one = comes_back(kind, tmp_path)
    assert one.found.begin == 0.0
    assert one.found.again.likeness.parts is None, "run again it is the same to the bit"


@pytest.mark.parametrize("kind", ["push", pytest.param("G1, a rule left out", marks=pytest.mark.long)])
def test_it_begins_in_the_state_of_the_log(kind, tmp_path):
    one = comes_back(kind, tmp_path, 1.0)
    assert one.found.begin == pytest.approx(one.found.incident.harm.time - 1.0, abs=1e-6)
    assert one.found.again.likeness.distance < 1e-3
    keys = yaml.safe_load(one.path.read_text())["plant"]
    assert keys["options"]["until"] == one.found.begin
    assert not Path(keys["options"]["log"]).is_absolute()


def test_live_pushes_come_back_by_the_command_in_a_process_of_its_own(tmp_path):
    scenario = surefoot.load("walk-level", {"gait.steps": 4, "sensing.source": "truth"})
    with surefoot.Simulation(scenario, log=tmp_path / "live.mcap") as sim:
        while sim.time < 1.6:
            sim.step()
        sim.push((0.0, 5.0, 0.0), duration=0.1)
        while sim.time < 2.2:
            sim.step()
        sim.push((0.0, -1700.0, 0.0), duration=0.1)
        while not sim.done:
            sim.step()
        assert sim.fell
    (tmp_path / "my tests").mkdir()
    words = ["scenario", "from", "live.mcap", "--out", "my tests/thrown over.yaml", "--json"]
    done = subprocess.run(
        [sys.executable, "-m", "surefoot", *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    told_by_it = json.loads(done.stdout)
    assert told_by_it["starts"][0]["likeness"]["to_the_bit"]
    assert [one["needed"] for one in told_by_it["causes"] if one["cause"].startswith("pushes")] == [False, True]
    loaded = surefoot.load(str(tmp_path / "my tests/thrown over.yaml"))
    assert loaded.name == "thrown-over"
    assert loaded.duration > told_by_it["incident"]["time"] + 1.5
    assert len(loaded.pushes) == 1
    again = subprocess.run(
        [sys.executable, "-m", "surefoot", *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert again.returncode == 2
    assert "exists already" in again.stderr


def of_a_program(**changed):
    """Parts of a program whose whole-body controller has other gains of balance, which no log tells."""

    def made(**given):
        parameters = given["parameters"]
        balance = replace(parameters.balance, **changed)
        return WholeBodyController(**{**given, "parameters": replace(parameters, balance=balance)})

    return surefoot.Parts(controller=made)


def test_a_fault_of_a_program_does_not_come_back_with_sound_parts(tmp_path):
    values = {"gait.steps": 5, "sensing.source": "truth", "motors.noise": 0.05}
    parts = of_a_program(height_stiffness=8000.0, height_damping=0.01)
    log = surefoot.run(surefoot.load("walk-level", values), out=tmp_path, parts=parts).log
    before = harm_of(surefoot.read(log), {})
    assert before is not None
    words = ["scenario", "from", str(log), "--out", "weak.yaml", "--json"]
    done = subprocess.run(
        [sys.executable, "-m", "surefoot", *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    found = json.loads(done.stdout)
    assert "parts of a program (controller)" in found["notes"][0]
    begins = [one["begin"] for one in found["starts"]]
    assert done.returncode == 1, "the sound controller does not fall, from wherever it takes over"
    assert begins == sorted(begins)
    assert before.time - 1.5 < begins[-1] < before.time - 0.5, "half a second before balance was lost"
    assert not any(one["same"] for one in found["starts"])
    assert not (tmp_path / "weak.yaml").exists()


def test_a_run_that_cannot_be_repeated_begins_where_it_comes_closest(tmp_path):
    push = [{"time": 2.4, "impulse": 1.7, "direction": 1.3}, {"time": 0.1, "impulse": 0.05}]
    values = {"gait.steps": 4, "sensing.source": "truth", "pushes": push}
    parts = of_a_program(height_stiffness=70.0)
    log = surefoot.run(surefoot.load("walk-level", values), out=tmp_path, parts=parts).log
    incident = Incident.of(log)
    found = regression(incident, Trials(incident, "closest"))
    apart = {begin: trial.likeness.distance for begin, trial in found.starts if trial.same}
    assert set(apart) >= {0.0, found.begin}
    assert found.comes_back
    assert 0.0 < found.begin < incident.lost
    assert apart[found.begin] == min(apart.values()) < apart[0.0]
    assert [cause.keys for cause in found.needed] == [(("pushes", 0),)]
    assert len(found.causes) == 1, "the push that was over by then is in the log"


def test_a_fault_that_ends_a_run_is_an_incident(tmp_path):
    faults = [{"kind": "state_nan", "time": 0.4}, {"kind": "planner_freeze", "time": 0.1, "duration": 0.1}]
    values = {"sensing.source": "truth", "duration": 0.8, "faults": faults, "criteria": {"fell": False}}
    log = surefoot.run(surefoot.load("stand", values), out=tmp_path).log
    incident = Incident.of(log)
    assert incident.harm.fault
    found = regression(incident, Trials(incident, "fault"))
    assert found.comes_back
    assert found.again.likeness.parts is None
    assert [cause.keys for cause in found.needed] == [(("faults", 0),)]
    assert found.without(found.needed[0]).harm is None


def test_what_falls_otherwise_is_another_incident(tmp_path):
    """The control of the tests above: the same push the other way is no return of the fall."""
    scenario = scenario_of("push", tmp_path)
    log = surefoot.read(surefoot.run(scenario, out=tmp_path / "one").log)
    pushes = [one.model_dump(exclude_none=True) for one in scenario.pushes]
    turned = [pushes[0], {**pushes[1], "direction": pushes[1]["direction"] + np.pi}]
    other = surefoot.load(str(log.path), {"pushes": turned})
    fallen = surefoot.read(surefoot.run(other, out=tmp_path / "two").log)
    one, two = harm_of(log, {}), harm_of(fallen, {})
    assert one is not None
    assert not one.same(two)
