"""Verdicts of logs of which a flight recorder has kept a part: nobody says more than was measured."""

import pytest

import surefoot
from surefoot.scenarios.judge.metrics import METRICS, OWN, compute
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import Kept, read
from surefoot.scenarios.log.recorder import KEPT_RECORD
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

WALK = {
    "fidelity": "pendulum",
    "gait.steps": 2,
    "duration": 4.0,
    "criteria": {"steps_taken": "steps_planned", "fell": False},
}
ENDS = {"criteria": {"fell": False}}
FALL = {"pushes": [{"time": 3.0, "duration": 0.2, "force": [0, 3000, 0]}]}
KEEP = {"log.keep": "1 s"}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Runs a walk with some keys, each set of them once."""
    folder, made = tmp_path_factory.mktemp("runs"), {}

    def result(*keys):
        asked = {name: value for more in (WALK, *keys) for name, value in more.items()}
        if str(asked) not in made:
            made[str(asked)] = run_scenario(surefoot.load("walk-level", asked), folder)
        return made[str(asked)]

    return result


def test_a_pass_is_said_of_what_was_measured_alone(run):
    assert run().verdict.passed
    kept = run(KEEP).verdict
    assert not kept.passed
    (reason,) = kept.reasons
    assert reason.startswith("not measured, since the log has nothing before 2.")
    assert "steps_taken" in reason
    assert "fell" not in reason
    assert kept.notes[0].startswith("the log keeps the run from 2.")
    assert run(KEEP, ENDS).verdict.passed
    assert not run(KEEP, ENDS, FALL).verdict.passed


def test_a_run_that_is_kept_whole_is_judged_as_ever(run):
    whole, kept = run(), run({"log.keep": 60})
    assert KEPT_RECORD not in read(kept.log).metadata
    assert kept.verdict.passed
    clock = {name for name, metric in OWN.items() if not metric.repeatable}
    for name, value in whole.verdict.metrics.items():
        assert name in clock or kept.verdict.metrics[name] == value


@pytest.mark.parametrize(
    "keys", [{}, FALL, {"commands": [{"time": 3.5, "place": {"x": 0.9, "y": 0.0}}], "duration": 4.1}]
)
def test_what_the_end_tells_is_what_the_whole_run_tells_and_nothing_else_is_told(run, keys):
    """The law of `at_end`; each metric has a value, or none, in one of these runs."""
    whole, kept = run(keys), run(keys, KEEP)
    assert KEPT_RECORD in read(kept.log).metadata
    for name, value in compute(read(kept.log)).items():
        assert value == (whole.verdict.metrics[name] if METRICS[name].at_end else None), name
    if keys is FALL:
        assert kept.verdict["fell"] is True
        assert kept.verdict["fall_time"] > 3.0
    if "commands" in keys:
        assert kept.verdict["place_error"] is not None


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"pushes": [{"time": 1.0, "duration": 0.1, "force": [5, 0, 0]}]}, "pushes.0 begins at 1 s, and whether it"),
        ({"commands": [{"time": 1.0, "swing_height": 0.06}]}, "commands.0 came at 1 s, and whether it acted"),
        ({"gait.waypoints": [{"x": 0.3, "y": 0.0}]}, "gait.waypoints begin at 0 s, and whether"),
    ],
)
def test_what_was_to_act_before_was_not_measured(run, keys, words):
    verdict = run(KEEP, ENDS, keys).verdict
    assert not verdict.passed
    assert any(reason.startswith(words) for reason in verdict.reasons), verdict.reasons


def test_what_acts_in_the_part_that_is_kept_is_measured(run):
    push = {"pushes": [{"time": 3.5, "duration": 0.1, "force": [5, 0, 0]}]}
    assert run(KEEP, ENDS, push).verdict.passed


def test_a_log_that_hides_what_it_has_dropped_passes_nothing(run):
    result = run(KEEP, ENDS)
    for change in (None, {"from": "1.0"}):
        log = read(result.log)
        told = log.metadata.pop(KEPT_RECORD)
        if change is not None:
            log.metadata[KEPT_RECORD] = {**told, **change}
        verdict = judge(log)
        assert not verdict.passed
        assert any("begin at 2." in reason for reason in verdict.reasons), verdict.reasons


def test_it_is_walked_again_to_the_bit(run, tmp_path, same_content):
    first = run(KEEP).log
    again = run_scenario(surefoot.load(str(first)), tmp_path).log
    assert not same_content(first, again)
    assert read(first).metadata[KEPT_RECORD] == read(again).metadata[KEPT_RECORD]


def test_what_was_given_by_hand_is_kept_and_given_again(tmp_path, same_content):
    scenario = surefoot.load("walk-level", {**WALK, **KEEP, **ENDS})
    with surefoot.Simulation(scenario, log=tmp_path / "log.mcap") as sim:
        while not sim.done:
            if sim.time in (1.0, 3.5):
                sim.push((8.0, 0.0, 0.0), duration=0.1)
            sim.advance()
    log = read(tmp_path / "log.mcap")
    kept = Kept.from_metadata(log.metadata, "log")
    assert kept is not None
    assert {"push 1", "push 2"} <= log.metadata.keys()
    again = run_scenario(surefoot.load(str(log.path)), tmp_path)
    assert not same_content(log.path, again.log)
