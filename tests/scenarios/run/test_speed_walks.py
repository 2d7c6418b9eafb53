"""Walks of one number in full physics, from sensors: straight legs, and what they save."""

import pytest

from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load

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


@pytest.mark.physics
def test_a_walk_of_one_number_has_straight_knees_and_costs_less_than_a_bent_one(tmp_path):
    straight = walked(tmp_path / "straight", 0.8)
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
def test_the_knee_task_straightens_knees_and_saves_work_or_costs_none(tmp_path, speed, straighter, saved):
    task, none = (
        walked(tmp_path / str(weight), speed, 12, wbc={"knees": {"weight": weight}}).metrics for weight in (0.006, 0.0)
    )
    assert task["knee_stance_mean"] < none["knee_stance_mean"] - straighter
    assert task["cost_of_transport"] < (1.0 - saved) * none["cost_of_transport"]


@pytest.mark.physics
def test_another_robot_walks_by_its_speed(tmp_path):
    verdict = walked(tmp_path, 0.8, 14, robot="g1")
    assert verdict.reasons == ()
    assert verdict.metrics["knee_stance_mean"] < 0.45


ROWS = {
    0.5: {"knee_stance_mean": 0.32, "knee_heel_strike": 0.30, "cost_of_transport": 0.38, "landing_peak": 1.5},
    0.8: {"knee_stance_mean": 0.36, "knee_heel_strike": 0.29, "cost_of_transport": 0.40, "landing_peak": 1.7},
    1.06: {"knee_stance_mean": 0.47, "knee_heel_strike": 0.38, "cost_of_transport": 0.57, "landing_peak": 1.9},
}


NEIGHBOURS = [(speed, share, friction) for speed in ROWS for share in (0.9, 1.0, 1.1) for friction in (0.8, 0.5)]
NEIGHBOURS.remove((1.06, 1.1, 0.5))  # loses its footing, and catches itself with more steps


@pytest.mark.long
@pytest.mark.parametrize(("speed", "share", "friction"), NEIGHBOURS)
def test_the_table_of_speeds_and_its_neighbours(tmp_path, speed, share, friction):
    looser = 1.0 if share == 1.0 else 1.1
    bounds = {name: {"max": looser * most} for name, most in ROWS[speed].items()}
    criteria = {**bounds, "foot_slip_max": {"max": 0.005}, "torque_at_limit_fraction": {"max": 0.01}}
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
    """Each of these felled the walk when catching steps were as short as straight legs span them."""
    push = {"step": 5, "phase": phase, "fraction": 0.5, "duration": 0.1, "impulse": impulse, "direction": direction}
    gone_on = {"fell": False, "steps_taken": "steps_planned", "standing_time_final": {"min": 1.0}}
    keys = {"gait": {"speed": 0.8, "steps": 12}, "criteria": gone_on, "pushes": [push]}
    assert run_scenario(load("walk", keys), tmp_path).verdict.reasons == ()
