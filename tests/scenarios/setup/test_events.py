"""Pushes, faults and commands that never act: refused before the run, and no pass where a fall came first."""

import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup import events
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.windows import FaultWindow

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=2", "criteria={fell: false}")


@pytest.mark.parametrize(
    ("settings", "key", "words"),
    [
        (
            ["pushes=[{time: 60, force: [1, 0, 0]}]"],
            "pushes",
            "pushes.0 begins at 60 s and never acts: the run ends at",
        ),
        (
            ["pushes=[{time: 1, force: [1, 0, 0], duration: 1.0e-10}]"],
            "pushes",
            "rounds to nothing on a clock of 1000 Hz",
        ),
        (["pushes=[{time: 1}]"], "pushes", "pushes.0.force is zero"),
        (["pushes=[{time: 1, impulse: 0}]"], "pushes", "pushes.0.impulse is zero"),
        (
            ["duration=1", "pushes=[{step: 2, phase: single, force: [1, 0, 0]}]"],
            "pushes",
            "never acts: the run ends at 1 s",
        ),
        (["faults=[{kind: state_nan, time: 60}]"], "faults", "faults.0 acts first at 60 s and never acts"),
        (["faults=[{kind: state_nan, time: 1, duration: 1.0e-4}]"], "faults", "ends before the state_nan acts"),
        (["faults=[{kind: planner_freeze, time: 1.004, duration: 0.012}]"], "faults", "at any tick of 50 Hz"),
        (["faults=[{kind: planner_freeze, duration: 0.02}]"], "faults", "at any tick of 50 Hz"),
    ],
)
def test_what_never_acts_is_refused_with_its_place(settings, key, words):
    with pytest.raises(ScenarioError) as refused:
        load("walk-level", [*SHORT, *settings])
    (problem,) = refused.value.problems
    assert words in problem
    assert f"--set {key}" in problem


BACK = "{step: 1, phase: single, impulse: 0.1, direction: 3.141592653589793}"
OPPOSED = "{time: 1, impulse: 0.1}, {time: 1.02, impulse: 0.06, duration: 0.06, direction: 3.141592653589793}"


@pytest.mark.parametrize(
    ("pushes", "idle"),
    [
        ("{time: 1, force: [1, 0, 0]}, {time: 1, force: [-1, 0, 0]}", [0, 1]),
        (f"{{step: 1, phase: single, impulse: 0.1}}, {BACK}", [0, 1]),
        (OPPOSED, [1]),
        (f"{OPPOSED}, {{time: 1.04, force: [0, 1, 0]}}", [1]),
        ("{time: 1, force: [1, 0, 0]}, {time: 1, force: [-1, 0, 0], duration: 0.11}", [0]),
    ],
)
def test_pushes_that_cancel_one_another_are_refused(pushes, idle):
    with pytest.raises(ScenarioError) as refused:
        load("walk-level", [*SHORT, f"pushes=[{pushes}]"])
    found = refused.value.problems
    assert len(found) == len(idle)
    assert all(f"pushes.{index} never acts: other pushes" in found[place] for place, index in enumerate(idle))


def test_pushes_that_cancel_one_another_in_part_or_on_two_bodies_are_taken():
    one = "{time: 1, force: [1, 0, 0]}"
    load("walk-level", [*SHORT, f"pushes=[{one}, {{time: 1.05, force: [-1, 0, 0]}}]"])
    load("walk-level", [*SHORT, f"pushes=[{one}, {{time: 1, force: [-1, 0, 0], live: true}}]"])
    load("walk-level", ["gait.steps=2", f"pushes=[{one}, {{time: 1, force: [-1, 0, 0], body: pelvis}}]"])


@pytest.mark.parametrize("name", ["latency", "imu_latency", "wrench_jitter"])
def test_a_time_that_makes_no_sample_late_is_refused(name):
    with pytest.raises(ScenarioError, match=f"sensing.{name} 1e-09 s is too short to make any sample late"):
        load("walk-level", [f"sensing.{name}=1.0e-9"])
    load("walk-level", [f"sensing.{name}=2.0e-9"])


@pytest.mark.parametrize(
    "settings",
    [
        ["pushes=[{time: 1, force: [1, 0, 0], duration: 1.0e-8}]"],
        ["faults=[{kind: state_nan, time: 1, duration: 0.0011}]"],
        ["faults=[{kind: planner_freeze, time: 1.004, duration: 0.02}]"],
        ["faults=[{kind: planner_freeze, duration: 0.04}]"],
    ],
)
def test_what_acts_however_shortly_is_taken(settings):
    scenario = load("walk-level", [*SHORT, *settings])
    assert len(scenario.pushes) + len(scenario.faults) == 1


@pytest.mark.parametrize(("start", "duration", "first"), [(0.0, None, 0.02), (0.02, None, 0.02), (0.024, 0.02, 0.04)])
def test_a_frozen_planner_is_noticed_when_a_plan_is_due(start, duration, first):
    scenario = load("walk-level", [f"faults=[{{kind: planner_freeze, time: {start}, duration: {duration or 'null'}}}]"])
    window = FaultWindow.of(scenario.faults[0], scenario.rates.control)
    assert window.first_act(scenario.rates) == pytest.approx(first)


def test_a_command_that_is_over_before_a_foot_lifts_off_is_refused():
    keys = "gait.velocity=[{time: 0, v_x: 0.3}, {time: 2.0, v_x: 0.1}, {time: 2.02, v_x: 0.3}, {time: 4}]"
    with pytest.raises(ScenarioError) as refused:
        load("stop-and-go", ["criteria={fell: false}", keys])
    (problem,) = refused.value.problems
    assert "gait.velocity.1 is over at 2.02 s, before any foot lifts off by it, and never acts" in problem
    load("stop-and-go", ["criteria={fell: false}", keys.replace("2.02", "3.0")])


def test_many_commands_are_looked_at_once(monkeypatch):
    """Each that is in force as a foot lifts off acts, and is not tried by a walk without it."""
    looks, real = [], events.velocity_bouts
    monkeypatch.setattr(events, "velocity_bouts", lambda *given: looks.append(1) or real(*given))
    moves = ", ".join(f"{{time: {1.32 * i:.2f}, v_x: {0.1 + 0.1 * (i % 2):.1f}}}" for i in range(60))
    load("stop-and-go", ["criteria={fell: false}", f"gait.velocity=[{moves}, {{time: 80}}]"])
    assert len(looks) == 2  # and one without the command that only begins the walk


def test_a_push_after_a_fall_is_no_pass(tmp_path):
    """The fall is what is asked for, and comes before the second push could act."""
    pushes = "pushes=[{time: 1, force: [2000, 0, 0], duration: 0.5}, {time: 6, force: [1, 0, 0]}]"
    both = load("walk-level", ["fidelity=pendulum", "gait.steps=8", pushes, "criteria={fell: true}"])
    verdict = run_scenario(both, tmp_path).verdict
    assert verdict.metrics["fell"] is True
    assert not verdict.passed
    (reason,) = verdict.reasons
    assert reason.startswith("pushes.1 begins at 6 s and never acts: the run ends at")
    alone = both.model_copy(update={"pushes": both.pushes[:1]})
    assert run_scenario(alone, tmp_path).verdict.passed


def test_a_fault_that_ends_the_run_at_once_has_acted(tmp_path):
    faults = "faults=[{kind: state_nan, time: 0.1}, {kind: planner_freeze, time: 0.2}]"
    verdict = run_scenario(load("stand", ["fidelity=pendulum", "duration=0.5", faults]), tmp_path).verdict
    unacted = [reason for reason in verdict.reasons if "never acts" in reason]
    assert unacted == ["faults.1 acts first at 0.2 s and never acts: the run ends at 0.1 s"]
