"""A walk that is told where to go while it goes on: it goes there, its log says so, and the log walks it again."""

import random

import numpy as np
import pytest

import surefoot
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.file.criteria import Bound

pytestmark = pytest.mark.unit

STANDING = {"gait.steps": 0, "gait.initial_stand": 0.1, "fidelity": "pendulum"}
WAYPOINTS = [{"x": 0.5, "y": 0.2, "yaw": 0.4}, {"x": 0.2, "y": -0.3, "yaw": -0.5}]


def told(log, duration, orders, **keys):
    """Step a walk that is told things at times; the log."""
    waiting = dict(orders)
    with surefoot.Simulation(surefoot.load("walk-level", {**STANDING, "duration": duration, **keys}), log=log) as sim:
        while not sim.done:
            for time in [time for time in waiting if sim.time >= time]:
                waiting.pop(time)(sim)
            sim.step()
    return log


def test_a_velocity_is_walked_and_a_zero_one_ends_in_standing(tmp_path):
    orders = {0.5: lambda sim: sim.command(0.3), 5.0: lambda sim: sim.command(0.0)}
    log = told(tmp_path / "told.mcap", 8.5, orders)
    metrics = surefoot.judge(surefoot.read(log)).metrics
    assert metrics["fell"] is False
    assert metrics["steps_planned"] == metrics["steps_taken"] >= 6
    assert metrics["standing_time_final"] > 1.0
    com = surefoot.read(log)["/truth"].field("com")
    assert (com[2300, 0] - com[1300, 0]) / 2.0 == pytest.approx(0.3, rel=0.05)


def test_what_was_told_is_in_the_log_with_what_was_made_of_it(tmp_path):
    orders = {
        0.507: lambda sim: sim.command(3.0),
        1.0: lambda sim: sim.command(swing_height=0.07, double_support=0.2),
        1.5: lambda sim: sim.go_to(1.0, 0.5, 0.3),
    }
    log = surefoot.read(told(tmp_path / "told.mcap", 2.0, orders))
    rows = log["/command"]
    np.testing.assert_allclose(rows.time, [0.52, 1.0, 1.5])
    asked, followed = rows.field("velocity")[0], rows.field("followed_velocity")[0]
    assert (asked == (3.0, 0.0)).all()
    assert 0.3 < followed[0] < 1.0
    np.testing.assert_allclose(rows.field("swing_height"), [0.05, 0.07, 0.07])
    np.testing.assert_allclose(rows.field("double_support"), [0.16, 0.2, 0.2])
    np.testing.assert_allclose([*rows.field("place")[2], rows.field("heading")[2]], [1.0, 0.5, 0.3])
    assert np.isnan(rows.field("velocity")[2]).all()


@pytest.mark.parametrize("until", [None, 2.5])
def test_the_log_walks_the_same_run_again(tmp_path, until, same_content):
    r = random.Random(3)
    orders = {0.1: lambda sim: sim.command(0.2, 0.05)}
    for time in (0.4, 0.71, 1.003, 1.9, 2.2):
        twist = [r.uniform(-0.3, 0.3) for _ in range(3)]
        orders[time] = lambda sim, twist=twist: sim.command(*twist, single_support=r.uniform(0.4, 0.6))
    orders[1.5] = lambda sim: sim.push((20.0, 5.0, 0.0))
    path = tmp_path / "told.mcap"
    with surefoot.Simulation(surefoot.load("walk-level", {**STANDING, "duration": 3.0}), log=path) as sim:
        while not sim.done and (until is None or sim.time < until):
            for time in [time for time in orders if sim.time >= time]:
                orders.pop(time)(sim)
            sim.step()
    again = surefoot.run(path, out=tmp_path / "again").log
    assert same_content(path, again) == []
    assert len(surefoot.read(again)["/command"]) == 6


def test_a_scenario_may_hold_what_is_told(tmp_path):
    keys = {
        **STANDING,
        "commands": [
            {"time": 0.5, "v_x": 0.2},
            {"time": 3.0, "place": {"x": 0.2, "y": 0.1, "yaw": 0.2}},
            {"time": 12.0, "v_x": 0.0},
        ],
    }
    log = surefoot.read(surefoot.run(surefoot.load("walk-level", keys), out=tmp_path).log)
    before_stop = int(12.0 * 500) - 1
    soles = np.array([log["/truth"].field(f"{side}_sole")[before_stop] for side in ("left", "right")])
    np.testing.assert_allclose(soles[:, :2].mean(axis=0), [0.2, 0.1], atol=0.005)


def test_waypoints_are_passed_one_after_another(tmp_path):
    result = surefoot.run(
        surefoot.load("walk-level", {**STANDING, "gait.waypoints": WAYPOINTS, "start.yaw": 1.0}), out=tmp_path
    )
    metrics = result.verdict.metrics
    assert metrics["place_error"] < 0.003
    assert metrics["heading_error"] < 0.003
    assert metrics["steps_taken"] == metrics["steps_planned"] > 0
    assert metrics["standing_time_final"] > 1.0
    steps = surefoot.read(result.log)["/footstep"].field("planned")
    c, s = np.cos(1.0), np.sin(1.0)
    first = np.array([c * 0.5 - s * 0.2, s * 0.5 + c * 0.2])
    middles = 0.5 * (steps[1:, :2] + steps[:-1, :2])
    assert np.hypot(*(middles - first).T).min() < 0.15


def test_a_walk_that_ends_before_its_place_fails_though_it_was_asked_for_nothing(tmp_path):
    keys = {**STANDING, "gait.waypoints": WAYPOINTS, "duration": 4.0}
    bare = surefoot.load("walk-level", keys).model_copy(update={"criteria": {}})
    reasons = surefoot.run(bare, out=tmp_path / "short").verdict.reasons
    assert "m from where it was commanded to go last" in reasons[0]
    assert "never came to" in reasons[-1]
    bounds = {name: Bound(max=9.0) for name in ("place_error", "heading_error", "waypoints_missed")}
    far = surefoot.load("walk-level", keys).model_copy(update={"criteria": bounds})
    assert surefoot.run(far, out=tmp_path / "far").verdict.passed


def test_a_robot_that_is_pushed_off_its_way_still_arrives(tmp_path):
    orders = {0.2: lambda sim: sim.go_to(0.8, 0.0, 0.0), 2.5: lambda sim: sim.push((60.0, 90.0, 0.0), 0.2)}
    metrics = surefoot.judge(surefoot.read(told(tmp_path / "told.mcap", 9.0, orders))).metrics
    assert metrics["fell"] is False
    assert metrics["place_error"] < 0.02


def test_a_walk_that_goes_on_may_be_told_otherwise_and_durations_alone_change_no_place(tmp_path):
    keys = {"gait.steps": 6, "planner.step_adaptation": "none"}
    plain = surefoot.read(told(tmp_path / "plain.mcap", 6.0, {}, **keys))
    slower = {1.0: lambda sim: sim.command(single_support=0.6)}
    slow = surefoot.read(told(tmp_path / "slow.mcap", 7.0, slower, **keys))
    places = [log["/footstep"].field("planned")[:, :3] for log in (plain, slow)]
    np.testing.assert_allclose(places[1], places[0], atol=1e-6)
    assert slow["/footstep"].time[-1] > plain["/footstep"].time[-1] + 0.4
    stopped = told(tmp_path / "stopped.mcap", 6.0, {1.5: lambda sim: sim.command(0.0)}, **{"gait.steps": 6})
    assert 1 <= len(surefoot.read(stopped)["/footstep"]) <= 3


def test_a_push_waits_for_its_point_of_the_gait(tmp_path):
    push = {"step": 3, "phase": "single", "fraction": 0.5, "duration": 0.02, "force": [40.0, 0.0, 0.0]}
    begun = []
    for name, orders in {"plain": {}, "slow": {0.6: lambda sim: sim.command(single_support=0.65)}}.items():
        log = surefoot.read(told(tmp_path / f"{name}.mcap", 5.0, orders, **{"gait.steps": 5, "pushes": [push]}))
        at = int(np.flatnonzero(log["/truth"].field("external_force")[:, 0])[0])
        reference = log["/reference"]
        assert (reference.field("phase")[at], reference.field("step")[at]) == (PhaseKind.SINGLE, 3)
        share = reference.field("phase_time")[at] / reference.field("phase_duration")[at]
        assert share == pytest.approx(0.5, abs=0.01)
        begun.append(at)
    assert begun[1] > begun[0] + 50


def test_a_push_whose_point_never_comes_is_a_fault(tmp_path):
    keys = {**STANDING, "duration": 2.0, "commands": [{"time": 0.1, "v_x": 0.1}]}
    push = {"step": 30, "phase": "single", "force": [40.0, 0.0, 0.0]}
    result = surefoot.run(surefoot.load("walk-level", {**keys, "pushes": [push]}), out=tmp_path)
    assert not result.verdict.passed
    assert "never came to fraction 0 of the single support of step 30" in " ".join(result.verdict.reasons)


@pytest.mark.parametrize(
    ("scenario", "order", "message"),
    [
        ("walk-level", lambda sim: sim.command(float("nan")), "v_x"),
        ("walk-level", lambda sim: sim.command(single_support=0.05), r"too short.*is the least"),
        ("walk-level", lambda sim: sim.command(swing_height=-1.0), "swing_height"),
        ("walk-level", lambda sim: sim.go_to(1e9, 0.0, 0.0), "x"),
        ("stairs-up", lambda sim: sim.command(0.3), "edges"),
    ],
)
def test_what_cannot_be_obeyed_is_refused_and_changes_nothing(scenario, order, message):
    with surefoot.Simulation(scenario) as sim:
        before = sim.orders
        with pytest.raises(surefoot.ParameterError, match=message):
            order(sim)
        sim.step()
        assert sim.orders == before


def test_a_run_without_a_given_duration_walks_again_and_what_never_came_is_left_out(tmp_path, same_content):
    late = {"pushes": [{"time": 3.0, "force": [10.0, 0.0, 0.0]}], "gait.steps": 3, "fidelity": "pendulum"}
    keys = {**late, "gait.initial_stand": 0.1}
    for name, until in {"whole": 99.0, "part": 1.5}.items():
        path = tmp_path / f"{name}.mcap"
        with surefoot.Simulation(surefoot.load("walk-level", keys), log=path) as sim:
            sim.command(swing_height=0.06)
            while not sim.done and sim.time < until:
                if sim.time == 1.0:
                    sim.command(0.2)
                sim.step()
            if not sim.done:
                sim.command(0.1)
        assert same_content(path, surefoot.run(path, out=tmp_path / f"{name}-again").log) == []


def test_of_two_orders_at_a_time_the_live_one_holds_in_both(tmp_path, same_content):
    keys = {"commands": [{"time": 0.5, "v_x": 0.3}]}
    path = told(tmp_path / "told.mcap", 2.0, {0.5: lambda sim: sim.command(-0.2)}, **keys)
    rows = surefoot.read(path)["/command"]
    assert rows.field("velocity")[-1, 0] == -0.2
    assert same_content(path, surefoot.run(path, out=tmp_path / "again").log) == []


def test_a_place_on_the_way_is_reached_though_steps_are_asked_for_anew(tmp_path):
    waypoints = [{"x": 1.5, "y": 0.0, "yaw": 0.0}, {"x": 1.5, "y": 1.2, "yaw": 1.57}]
    keys = {"gait.waypoints": waypoints, "gait.step_length": 0.3}
    orders = {2.6: lambda sim: sim.command(swing_height=0.051), 3.2: lambda sim: sim.command(single_support=0.45)}
    log = surefoot.read(told(tmp_path / "told.mcap", 12.0, orders, **keys))
    steps = log["/footstep"].field("planned")
    middles = 0.5 * (steps[1:, :2] + steps[:-1, :2])
    assert np.hypot(*(middles - (1.5, 0.0)).T).min() < 0.05
    assert surefoot.judge(log).metrics["place_error"] < 0.003


def test_a_velocity_is_kept_when_steps_take_other_times(tmp_path):
    orders = {0.2: lambda sim: sim.command(0.3), 4.0: lambda sim: sim.command(single_support=0.35, double_support=0.12)}
    log = surefoot.read(told(tmp_path / "told.mcap", 8.0, orders, **{"gait.single_support": 0.7}))
    com = log["/truth"].field("com")[:, 0]
    assert (com[3500] - com[2500]) / 2.0 == pytest.approx(0.3, rel=0.1)


def test_a_walk_that_was_not_led_owes_all_its_steps_and_a_push_may_end_a_phase(tmp_path):
    keys = {"duration": 2.5, "gait.steps": 12, "gait.initial_stand": 0.1, "fidelity": "pendulum"}
    push = {"step": 1, "phase": "single", "fraction": 1.0, "force": [1.0, 0.0, 0.0]}
    given = {**keys, "commands": [{"time": 1.0, "swing_height": 0.06}], "pushes": [push]}
    result = surefoot.run(surefoot.load("walk-level", given), out=tmp_path)
    assert result.verdict["steps_planned"] == 12
    assert surefoot.read(result.log).metadata["end"]["kind"] == "completed"
    with (
        surefoot.Simulation(surefoot.load("walk-level", keys)) as sim,
        pytest.raises(surefoot.ParameterError, match="nothing"),
    ):
        sim.command()


VALUES = (
    {"v_x": 0.2, "yaw_rate": 0.1},
    {"march": True},
    {"v_y": 0.05, "single_support": 0.5, "double_support": 0.2, "swing_height": 0.06},
    {"v_x": 0.0},
)


def test_a_command_is_one_value_for_simulation_and_controller(tmp_path, same_content):
    by_words = {0.3 + 0.4 * k: lambda sim, words=words: sim.command(**words) for k, words in enumerate(VALUES)}
    by_value = {
        0.3 + 0.4 * k: lambda sim, words=words: sim.command(surefoot.Command.of(**words, time=9.0))
        for k, words in enumerate(VALUES)
    }
    one = told(tmp_path / "words.mcap", 2.0, {**by_words, 1.8: lambda sim: sim.go_to(0.4, 0.1, 0.2)})
    place = surefoot.Command(places=(surefoot.Twist(0.4, 0.1, 0.2),))
    other = told(tmp_path / "value.mcap", 2.0, {**by_value, 1.8: lambda sim: sim.command(place)})
    assert same_content(one, other) == []
    again = surefoot.run(str(other), out=tmp_path / "again")
    assert same_content(one, again.log) == []
    # What a walk does of it is such a value, too, which goes on with it.
    with surefoot.Simulation(surefoot.load("walk-level", STANDING)) as sim:
        sim.command(surefoot.Command.of(v_x=0.2, march=True))
        sim.step()
        sim.command(sim.orders)
        assert surefoot.Command.of(v_x=0.2, march=True) == surefoot.Command(surefoot.Twist(0.2), march=True)


def test_what_a_command_value_cannot_tell_is_refused():
    with surefoot.Simulation(surefoot.load("walk-level", STANDING)) as sim:
        with pytest.raises(surefoot.ParameterError, match=r"beside a Command.*Command\.of"):
            sim.command(surefoot.Command.of(v_x=0.2), 0.1)
        with pytest.raises(surefoot.ParameterError, match="2 places"):
            sim.command(surefoot.Command(places=(surefoot.Twist(), surefoot.Twist(1.0))))
        with pytest.raises(surefoot.ParameterError, match="says nothing"):
            sim.command(surefoot.Command())
        with pytest.raises(surefoot.ParameterError, match="v_x"):
            sim.command(surefoot.Command.of(v_x=1e9))
