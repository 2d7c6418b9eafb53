"""Walks of one number in full physics, from sensors: straight legs, and what they save."""

from itertools import pairwise

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.planner.geometry.plane import rotations
from surefoot.scenarios.check.check import cases, check, updated
from surefoot.scenarios.log.reader import read
from surefoot.scenarios.many.engine import local_workers
from surefoot.scenarios.many.journal import Journal, outcome_of
from surefoot.scenarios.many.points import Base, Point, Single
from surefoot.scenarios.many.slots import run_cells
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load, written

SOUND = {
    "fell": False,
    "steps_taken": "steps_planned",
    "wbc_fallbacks": {"max": 0},
    "self_contact_time": {"max": 0},
    "standing_time_final": {"min": 1.0},
}


def walked(tmp_path, speed, steps=16, criteria=None, **overrides):
    gait = {"speed": speed, "steps": steps}
    keys = {"gait": gait, "criteria": {**SOUND, **(criteria or {})}, **overrides}
    return run_scenario(load("walk-level", keys), tmp_path).verdict


ALIKE = {
    "human_share": {"min": [0.65, 0.4, 0.6]},
    "human_correlation": {"min": [0.82, 0.7, -1.0]},
    "heel_strike_pitch": {"min": 0.19},
    "toe_off_pitch": {"min": 0.26},
}
"""Bounds within which joints move as people's do."""


@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    """A walk at 0.8 m/s, with what else is asked of it."""
    return walked(tmp_path_factory.mktemp("straight"), 0.8, criteria=ALIKE)


@pytest.mark.physics
def test_hips_knees_and_ankles_move_as_peoples(straight):
    assert straight.reasons == ()


@pytest.mark.physics
def test_a_walk_of_one_number_has_straight_knees_and_costs_less_than_a_bent_one(straight, tmp_path):
    assert straight.reasons == ()
    length, single, double = 0.461, 0.438, 0.138
    bent = {"steps": 16, "step_length": length, "single_support": single, "double_support": double}
    flat = run_scenario(
        load("walk-level", {"gait": {**bent, "com_height": 0.98, "heel_off": 0.5}, "criteria": SOUND}),
        tmp_path / "bent",
    ).verdict
    assert flat.reasons == ()
    assert straight.metrics["knee_stance_mean"] < 0.36 < 0.6 < flat.metrics["knee_stance_mean"]
    assert straight.metrics["knee_heel_strike"] < 0.31
    assert straight.metrics["landing_peak"] < 1.7
    assert straight.metrics["cost_of_transport"] < 0.9 * flat.metrics["cost_of_transport"]
    assert straight.metrics["heel_strike_pitch"] > 0.19


@pytest.mark.physics
@pytest.mark.parametrize(("speed", "straighter", "saved"), [(0.8, 0.005, 0.05), (1.06, 0.025, -0.01)])
def test_the_knee_task_straightens_knees_and_saves_work_or_costs_none(straight, tmp_path, speed, straighter, saved):
    steps = 16 if speed == 0.8 else 12
    task = (straight if speed == 0.8 else walked(tmp_path / "task", speed, steps)).metrics
    none = walked(tmp_path / "none", speed, steps, wbc={"knees": {"weight": 0.0}}).metrics
    assert task["knee_stance_mean"] < none["knee_stance_mean"] - straighter
    assert task["cost_of_transport"] < (1.0 - saved) * none["cost_of_transport"]


@pytest.mark.physics
def test_another_robot_walks_by_its_speed(tmp_path):
    verdict = walked(tmp_path, 0.8, 14, robot="g1")
    assert verdict.reasons == ()
    assert verdict.metrics["knee_stance_mean"] < 0.45


def pelvis_of(log):
    """Yaw and roll of the pelvis."""
    R = rotations(log["/truth"].field("q")[:, 3:7])
    return np.arctan2(R[:, 1, 0], R[:, 0, 0]), np.arctan2(R[:, 2, 1], R[:, 2, 2])


def swayed(folder, **gait):
    """Verdict of a walk, and yaw and roll of its pelvis as each foot is planned to land, and that foot."""
    keys = {"gait": {"speed": 0.8, "steps": 14, **gait}, "criteria": SOUND}
    result = run_scenario(load("walk", keys), folder)
    log = read(result.log)
    yaw, roll = pelvis_of(log)
    ticks, feet = np.nonzero(np.diff(log["/contact"].field("planned").astype(int), axis=0) > 0)
    steady = slice(4, -4)
    return result.verdict, yaw[ticks + 1][steady], feet[steady], np.ptp(roll[len(roll) // 3 : len(roll) // 2])


@pytest.mark.physics
def test_the_pelvis_turns_and_lists_with_the_steps_and_saves_work(tmp_path):
    verdict, yaw, feet, lists = swayed(tmp_path / "usual")
    assert verdict.reasons == ()
    assert len(yaw) >= 4
    # The hip of the foot that lands is ahead: the pelvis has turned to the other side.
    assert (np.where(feet == 0, -1.0, 1.0) * yaw > 0.04).all()
    assert 0.04 < lists < 0.08
    still, turned = (swayed(tmp_path / str(most), pelvis_yaw=most, pelvis_list=0.0) for most in (0.0, 0.06))
    assert np.abs(still[1]).max() < 0.01
    assert turned[0].metrics["cost_of_transport"] < 0.99 * still[0].metrics["cost_of_transport"]
    assert verdict.metrics["knee_stance_mean"] < still[0].metrics["knee_stance_mean"] - 0.04


SWAY = {"pelvis_yaw": 0.08, "pelvis_list": 0.05}
BEGIN = {"speed": 0.6, "steps": 3, "initial_stand": 0.1}
WALKERS = [("humanoid100", "full"), ("g1", "full"), ("talos", "full"), ("humanoid100", "pendulum"), ("g1", "pendulum")]


def begin(robot="humanoid100", fidelity="full", **gait):
    """Keys of the begin of a walk of one number, whose pelvis sways."""
    keys = {"robot": robot, "fidelity": fidelity, "gait": {**BEGIN, **SWAY, **gait}, "duration": 1.1}
    return {**keys, "criteria": {"fell": False}}


def begun(folder, *arguments, **gait):
    return surefoot.run(load("walk-level", begin(*arguments, **gait)), out=folder)


def configurations(arguments):
    return read(begun(*arguments).log)["/truth"].field("q")


@pytest.mark.physics
@pytest.mark.parametrize(("robot", "fidelity"), WALKERS)
def test_its_log_runs_again_to_the_bit_and_tells_the_same_notes(robot, fidelity, same_content, tmp_path):
    result, other = (
        begun(tmp_path / str(list_), robot, fidelity, pelvis_list=list_) for list_ in (SWAY["pelvis_list"], 0.04)
    )
    again = surefoot.run(str(result.log), out=tmp_path / "again")
    assert result.verdict.passed, result.verdict.reasons
    assert same_content(result.log, again.log) == []
    assert again.verdict.notes == result.verdict.notes
    said = {f"gait.{name} has no effect on a pendulum" for name in SWAY}
    assert said & set(result.verdict.notes) == (said if fidelity == "pendulum" else set())
    assert ("/truth" in same_content(result.log, other.log)) is (fidelity == "full")


@pytest.mark.physics
def test_a_process_of_its_own_walks_it_alike(tmp_path):
    with processes() as pool:
        (there,) = pool.map(configurations, [(tmp_path / "there", "talos")])
    np.testing.assert_array_equal(there, configurations((tmp_path / "here", "talos")))


@pytest.mark.physics
def test_it_is_held_to_its_baseline_in_two_processes(tmp_path):
    files = [tmp_path / f"{robot}.yaml" for robot in ("humanoid100", "g1")]

    def checked(jobs, **gait):
        for file in files:
            file.write_text(yaml.safe_dump(begin(file.stem, **gait)))
        return check(cases(list(map(str, files))), tmp_path / "runs", jobs=jobs)

    first = checked(2)
    assert [updated(one).status for one in first] == ["written"] * 2
    assert [one.status for one in checked(1)] == ["same"] * 2
    assert "same" not in [one.status for one in checked(1, pelvis_yaw=0.0)]


@pytest.mark.physics
def test_a_campaign_over_its_list_is_the_same_in_two_processes(same_content, tmp_path):
    (tmp_path / "walk.yaml").write_text(yaml.safe_dump(begin()))
    base = Base("walk.yaml", written(str(tmp_path / "walk.yaml")))
    points = [Single(Point(base, {"gait.pelvis_list": list_}, {}, f"list-{list_}")) for list_ in (0.0, 0.05)]

    def swept(jobs):
        folder = tmp_path / str(jobs)
        with Journal(folder) as journal:
            run_cells(iter(points), journal, local_workers(folder, jobs, keep_all=True))
            records = [outcome_of(point, journal).runs for point in points]
        assert [record.status for ((_, record),) in records] == ["pass"] * 2
        return sorted(folder.rglob("log.mcap"))

    alone, beside = swept(1), swept(2)
    assert [same_content(one, other) for one, other in zip(alone, beside, strict=True)] == [[]] * 2
    assert all(same_content(one, other) for one, other in pairwise(alone))


@pytest.mark.physics
@pytest.mark.parametrize("robot", ["humanoid100", "talos"])
def test_who_is_driven_sways_as_well_and_the_log_walks_it_again(robot, same_content, tmp_path):
    path = tmp_path / "driven.mcap"
    scenario = load("walk-level", {**begin(robot, steps=0), "duration": 2.5})
    with surefoot.Simulation(scenario, log=path) as simulation:
        simulation.command(v_x=0.4)
        while not simulation.done:
            simulation.advance()
    assert simulation.end.kind == "completed"
    yaw, _ = pelvis_of(read(path))
    assert 1.2 * SWAY["pelvis_yaw"] > np.abs(yaw).max() > 0.6 * SWAY["pelvis_yaw"]
    assert same_content(path, surefoot.run(path, out=tmp_path / "again").log) == []


ROWS = {
    0.5: {"knee_stance_mean": 0.32, "knee_heel_strike": 0.30, "cost_of_transport": 0.38, "landing_peak": 1.5},
    0.8: {"knee_stance_mean": 0.36, "knee_heel_strike": 0.29, "cost_of_transport": 0.40, "landing_peak": 1.7},
    1.06: {"knee_stance_mean": 0.47, "knee_heel_strike": 0.38, "cost_of_transport": 0.57, "landing_peak": 1.9},
    1.4: {"knee_stance_mean": 0.70, "knee_heel_strike": 0.59, "cost_of_transport": 0.80, "landing_peak": 2.2},
}


NEIGHBOURS = [(speed, share, friction) for speed in ROWS for share in (0.9, 1.0, 1.1) for friction in (0.8, 0.5)]


@pytest.mark.physics
def test_arms_take_up_the_yaw_momentum_that_a_ground_of_little_friction_cannot(tmp_path):
    """At 1.4 m/s legs alone ask a foot for 62 N·m about the vertical, of which a friction of 0.5 bears about 50."""
    sound = {**{name: {"max": most} for name, most in ROWS[1.4].items()}, "foot_slip_max": {"max": 0.005}}
    momentum = {}
    for swing in (0.6, 0.0):
        keys = {"gait": {"speed": 1.4, "steps": 11}, "terrain.friction": 0.5, "wbc.arm_swing": swing}
        result = run_scenario(load("walk", {**keys, "criteria": {**SOUND, **sound}}), tmp_path / str(swing))
        momentum[swing] = np.percentile(np.abs(read(result.log)["/truth"].field("angular_momentum")[:, 2]), 99)
        assert result.verdict.reasons == () or not swing
    assert momentum[0.6] < 2.2 < 3.5 < momentum[0.0]


@pytest.mark.long
@pytest.mark.parametrize(("speed", "share", "friction"), NEIGHBOURS)
def test_the_table_of_speeds_and_its_neighbours(tmp_path, speed, share, friction):
    looser = 1.0 if share == 1.0 else 1.1
    bounds = {name: {"max": looser * most} for name, most in ROWS[speed].items()}
    criteria = {**bounds, "foot_slip_max": {"max": looser * 0.005}, "torque_at_limit_fraction": {"max": 0.01}}
    for seed in (1, 2, 3):
        given = {"terrain.friction": friction, "seed": seed}
        verdict = walked(tmp_path / str(seed), share * speed, 24, criteria, **given)
        assert verdict.reasons == (), (speed, share, friction, seed)


FORWARD, LEFT, RIGHT = 0.0, 1.5708, -1.5708


@pytest.mark.physics
@pytest.mark.parametrize(
    ("phase", "direction", "impulse"),
    [("double", FORWARD, 0.8), ("single", FORWARD, 1.0), ("double", LEFT, 0.8), ("double", RIGHT, 0.6)],
)
def test_straight_legs_catch_a_pushed_body_with_steps_beyond_their_own(phase, direction, impulse, tmp_path):
    """Pushes forward and to both sides, in double and in single support."""
    push = {"step": 5, "phase": phase, "fraction": 0.5, "duration": 0.1, "impulse": impulse, "direction": direction}
    gone_on = {"fell": False, "steps_taken": "steps_planned", "standing_time_final": {"min": 1.0}}
    # With time for the steps that a push adds, and to stand after them.
    keys = {"gait": {"speed": 0.8, "steps": 9}, "duration": 13.0, "criteria": gone_on, "pushes": [push]}
    assert run_scenario(load("walk", keys), tmp_path).verdict.reasons == ()


@pytest.mark.physics
@pytest.mark.parametrize("robot", ["g1", "talos", "alexander"])
def test_walk_is_walked_by_robots_of_the_core(robot, tmp_path):
    assert run_scenario(load("walk", {"robot": robot, "gait.steps": 10}), tmp_path).verdict.reasons == ()
