"""The cause of a fall stands first on every way to its log: a run, a push by hand, and the log run again."""

import json

import pytest
from typer.testing import CliRunner

import surefoot
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.judge.inspection import inspect

pytestmark = pytest.mark.physics

STAND = {"sensing.source": "truth", "duration": 4.0, "criteria": {"fell": True}}


def first(log):
    return next(one for one in inspect(surefoot.read(log)).health if one.check != "file")


def test_a_push_by_hand_is_the_cause_and_that_of_the_log_run_again(tmp_path):
    with surefoot.Simulation(surefoot.load("stand", STAND), log=tmp_path / "pushed.mcap") as sim:
        while sim.time < 1.0:
            sim.step()
        sim.push((0.0, 1300.0, 0.0), duration=0.1)
        while not sim.done:
            sim.step()
        assert sim.fell
    told = first(tmp_path / "pushed.mcap")
    assert (told.check, told.relation) == ("push", "cause")
    assert told.value == pytest.approx(1.3, rel=0.01)
    assert told.time == pytest.approx(1.0, abs=0.003)
    again = surefoot.run(surefoot.load(tmp_path / "pushed.mcap"), out=tmp_path / "again").log
    assert first(again) == told


def test_the_command_line_prints_the_cause_before_its_effects(tmp_path):
    walk = {
        "sensing.preset": "good",
        "gait.steps": 6,
        "duration": 6.0,
        "pushes": [{"step": 4, "phase": "single", "fraction": 0.5, "impulse": 1.7, "direction": -1.2}],
    }
    log = surefoot.run(surefoot.load("walk-level", walk), out=tmp_path).log
    lines = CliRunner().invoke(app, ["inspect", str(log)]).stdout.splitlines()
    health = [line for line in lines if line.startswith("health: ")]
    assert health[0].startswith("health: cause: push from ")
    assert "N·s/kg" in health[0]
    assert not any(line.startswith("health: cause: ") for line in health[1:])
    assert sum(line.startswith("health: effect: ") for line in health) >= 2
    assert not any("friction" in line or "sensors" in line for line in health)
    found = json.loads(CliRunner().invoke(app, ["inspect", str(log), "--json"]).stdout)["health"]
    assert [one["check"] for one in found if one["relation"] == "cause"] == ["push"]
