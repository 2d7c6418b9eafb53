"""A controller on the readings of a log, held against a baseline: the first tick and field that part are named."""

import json
import os
import subprocess
import sys

import pytest

import surefoot
from surefoot.apps.bridge.against import held, known, update
from surefoot.apps.bridge.shadow import walk_in_shadow
from surefoot.scenarios.errors import LogError

pytestmark = pytest.mark.physics

ROBOTS = {"humanoid100": {"sensing.source": "truth"}, "g1": {"robot": "g1"}}


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """A short walk of each robot."""
    folder = tmp_path_factory.mktemp("walks")
    return {
        name: surefoot.run(surefoot.load("walk-level", {"gait.steps": 1, **values}), out=folder).log
        for name, values in ROBOTS.items()
    }


def in_shadow(log, out, **changes):
    return walk_in_shadow(log, surefoot.load(str(log), changes), out).log


@pytest.mark.parametrize("robot", ROBOTS)
def test_without_a_change_it_agrees_with_what_was_done_then(logs, robot, tmp_path):
    found = held(surefoot.read(logs[robot]), in_shadow(logs[robot], tmp_path), tolerance=0.0)
    assert found.agrees
    assert {"/plan", "/reference", "/wbc", "/torque", "/estimate"} <= set(found.compared)
    assert next(found.lines()).startswith("as in ")


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_gain_of_the_swing_parts_at_the_first_swing_in_the_controller(logs, robot, tmp_path):
    log = logs[robot]
    before = surefoot.read(log)
    now = in_shadow(log, tmp_path, **{"wbc.gains.swing": [420.0, 41.0]})
    found = held(before, now)
    first = found.parted[0]
    reference = before["/reference"]
    lift_off = reference.time[reference.field("phase") == 2][0]
    assert first.topic in ("/wbc", "/torque")
    assert first.beyond == pytest.approx(lift_off, abs=0.02)
    said = next(found.lines())
    assert said.startswith(
        f"parts first: {first.topic} {first.tolerated.field} at tick {round(first.beyond * found.rate)}"
    )
    assert held(before, now, tolerance=1e6).agrees, "the tolerance is heeded"


def test_a_change_of_the_plan_parts_in_the_plan_at_the_first_tick(logs, tmp_path):
    log = logs["humanoid100"]
    found = held(surefoot.read(log), in_shadow(log, tmp_path, **{"gait.com_height": 0.985}))
    assert found.parted[0].beyond == 0.0
    assert {"/plan", "/torque"} <= {one.topic for one in found.parted}


def test_a_channel_that_is_lost_does_not_agree(logs, tmp_path):
    by_sensors = surefoot.read(logs["g1"])
    of_truth = in_shadow(logs["g1"], tmp_path, sensing={"source": "truth"})
    found = held(by_sensors, of_truth, tolerance=1e9)
    assert found.lost == ("/estimation",)
    assert not found.agrees


def test_a_baseline_is_read_written_and_refused(logs, tmp_path):
    new = tmp_path / "new.mcap"
    assert known(new, update=True) is None
    with pytest.raises(LogError, match=r"new\.mcap"):
        known(new, update=False)
    update(new, logs["humanoid100"])
    assert known(new, update=False).count("/torque") > 0
    with pytest.raises(LogError, match="not a tolerance"):
        held(known(new, update=False), logs["humanoid100"], tolerance=float("nan"))


def test_the_command_fails_where_it_parts_and_writes_what_is_now(logs, tmp_path):
    log = os.path.relpath(logs["humanoid100"], tmp_path)
    change = ["--set", "wbc.gains.swing=[420.0, 41.0]"]

    def command(*words):
        asked = [sys.executable, "-m", "surefoot", "walk", "--shadow", log, *words]
        done = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    assert command("--against", log)[0] == 0
    code, said, _ = command("--against", log, *change, "--json")
    found = json.loads(said)
    assert (code, found["agrees"], found["parted"][0]["channel"]) == (1, False, "/wbc")
    assert command("--against", "new.mcap", *change)[0] == 2
    code, said, _ = command("--against", "new.mcap", *change, "--update")
    assert code == 0
    assert "written: new.mcap" in said
    assert command("--against", "new.mcap", *change)[0] == 0
    assert command("--against", "new.mcap")[0] == 1
    for words in (["--update"], ["--tolerance", "1e-3"], ["--against", log, "--update"]):
        assert command(*words)[0] == 2, words
