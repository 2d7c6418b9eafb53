"""Times of pushes and faults are written into the log by setup; the judge reads them, and sets nothing up again."""

import json
import subprocess
import sys

import pytest

import surefoot
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import AGENDA_RECORD, Agenda, Event
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.skeleton import End
from surefoot.scenarios.setup.checks import notes
from surefoot.scenarios.setup.groups.gait import push_time
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

PUSHES = [
    {"time": 0.3, "force": [5, 0, 0], "body": "head"},
    {"step": 2, "phase": "single", "fraction": 0.5, "force": [5, 0, 0], "body": "head"},
    {"time": 9.0, "force": [5, 0, 0], "live": True},
]
FAULTS = [{"kind": "qp_failure", "time": 0.4, "duration": 0.1}]
LATE = "pushes.0 begins at 0.3 s and never acts: the run ends at 0.2 s"


@pytest.fixture
def pushed(two_steps):
    return two_steps.model_copy(update={"pushes": load("walk-level", {"pushes": PUSHES}).pushes})


@pytest.fixture
def cut_off(tmp_path, robot, motion, pushed):
    """A log that ends before its pushes."""
    return read(run_scenario(pushed, tmp_path, None, motion(duration=0.2, end=End("completed", 0.2)), robot).log)


def test_the_log_tells_when_what_acts_on_which_body(tmp_path, robot):
    scenario = load("walk-level", {"pushes": PUSHES, "faults": FAULTS, "planner.rise": "single"})
    agenda = notes.agenda(resolve(scenario, robot))
    middle = push_time(resolve(scenario, robot).gait, scenario.pushes[1])
    assert agenda.events == (
        Event("pushes.0 begins at", 0.3), Event("pushes.1 begins at", middle), Event("faults.0 acts first at", 0.4)
    )  # fmt: skip
    assert agenda.bodies == ("head", robot.torso_body)
    assert agenda.notes == ("planner.rise has no effect on level ground",)
    assert Agenda.from_metadata({AGENDA_RECORD: agenda.to_metadata()}, "a.mcap") == agenda


def test_the_judge_reads_what_was_resolved(cut_off):
    assert LATE in judge(cut_off).reasons
    event = {"what": "pushes.0 begins at", "time": 0.1, "idle": "pushes.0.force is zero"}
    cut_off.metadata[AGENDA_RECORD] |= {"events": json.dumps([event]), "notes": json.dumps(["so it was"])}
    verdict = judge(cut_off)
    assert "pushes.0.force is zero" in verdict.reasons
    assert not any("never acts" in reason for reason in verdict.reasons)
    assert "so it was" in verdict.notes


def test_a_note_on_standing_is_not_of_a_robot_that_was_driven(tmp_path):
    keys = {"fidelity": "pendulum", "duration": 0.2, "gait.steps": 0, "gait.turn": 0.2, "criteria": {"fell": False}}
    log = read(surefoot.run(load("walk-level", keys), out=tmp_path).log)
    said = "gait.turn has no effect on a robot that takes no step"
    assert said in judge(log).notes
    agenda = Agenda.from_metadata(log.metadata, "")
    assert agenda is not None
    assert said in agenda.standing


def test_an_older_log_is_judged_by_what_it_tells(cut_off):
    del cut_off.metadata[AGENDA_RECORD]
    verdict = judge(cut_off)
    assert LATE in verdict.reasons
    assert not any("pushes.1" in reason for reason in verdict.reasons)
    (note,) = [note for note in verdict.notes if "earlier version" in note]
    assert note.endswith("does not tell which of its keys have no effect, nor when pushes.1 was to begin")


def test_a_record_that_cannot_be_read_is_refused(cut_off):
    for events in ("[[", '[{"what": 3}]', "[" * 100_000):
        cut_off.metadata[AGENDA_RECORD] |= {"events": events}
        with pytest.raises(LogError, match="was to happen"):
            judge(cut_off)


def test_who_judges_sets_nothing_up():
    code = "import sys, surefoot.scenarios.judge.inspection; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    above = tuple(f"surefoot.scenarios.{room}" for room in ("setup", "run", "show", "check", "cli"))
    assert [name for name in loaded if name.startswith(above)] == []
