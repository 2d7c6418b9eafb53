"""Walks in full physics that are told where to go, and how fast, at random while they go on."""

import random

import numpy as np
import pytest

import surefoot

SOUND = {
    "fell": False, "steps_taken": "steps_planned", "standing_time_final": {"min": 1.0}, "wbc_fallbacks": {"max": 0},
    "self_contact_time": {"max": 0}, "unplanned_flight_time": {"max": 0}, "joint_limit_margin_min": {"min": 0},
    "joint_speed_ratio_max": {"max": 1}, "torque_at_limit_fraction": {"max": 0.001},
    "footstep_error_max": {"max": 0.01}, "foot_slip_max": {"max": 0.01},
}  # fmt: skip
STOP = 6.0
"""Time at the end in which the robot is told to stop and stands [s]."""

SEEDS, MINUTES = 10, 10
"""Stop of the long walks."""

FEET = {
    "human-size feet": ("walk-level", (0.6, 0.25, 0.6), {}),
    "7.5 cm feet": ("paper-walk", (0.2, 0.08, 0.2), {"gait.single_support": 0.8, "gait.double_support": 0.3}),
}


def commands(seed, duration, limits):
    """A command every 0.3 to 2 s, one in five a stop."""
    rng, time, told = random.Random(seed), 1.0, []
    while time < duration - STOP:
        moves = rng.random() > 0.2
        v_x, v_y, yaw_rate = (rng.uniform(-limit, limit) if moves else 0.0 for limit in limits)
        told.append({"time": time, "v_x": v_x, "v_y": v_y, "yaw_rate": yaw_rate})
        time = round(time + rng.uniform(0.3, 2.0), 3)
    return [*told, {"time": duration - STOP, "v_x": 0.0}]


def walk_on_command(feet, seed, duration, out):
    name, limits, keys = FEET[feet]
    given = {"gait.steps": 0, "duration": duration, "commands": commands(seed, duration, limits), "criteria": SOUND}
    return surefoot.run(surefoot.load(name, {**keys, **given, "seed": seed}), out=out)


@pytest.mark.physics
@pytest.mark.parametrize("feet", FEET)
def test_random_commands_are_walked(feet, tmp_path):
    result = walk_on_command(feet, 11, 20.0, tmp_path)
    assert result.verdict.passed, result.verdict.reasons
    assert result.verdict["steps_taken"] > 10


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, SEEDS + 1))
@pytest.mark.parametrize("feet", FEET)
def test_ten_minutes_of_random_commands_are_walked(feet, seed, tmp_path):
    result = walk_on_command(feet, seed, 60.0 * MINUTES, tmp_path)
    result.log.unlink()
    assert result.verdict.passed, result.verdict.reasons


@pytest.mark.physics
@pytest.mark.parametrize(
    ("v_x", "v_y", "yaw_rate"),
    [
        pytest.param(0.6, 0.0, 0.0, id="ahead", marks=pytest.mark.long),
        pytest.param(0.0, 0.25, 0.0, id="sideways", marks=pytest.mark.long),
        pytest.param(0.6, 0.25, 0.6, id="all"),
    ],
)
def test_the_mean_velocity_is_the_one_that_is_followed(v_x, v_y, yaw_rate):
    """Over three gait cycles of the path, which runs midway between the footholds."""
    scenario = surefoot.load("walk-level", {"gait.steps": 0, "gait.initial_stand": 0.2, "duration": 6.5})
    period = scenario.gait.single_support + scenario.gait.double_support
    places = []
    with surefoot.Simulation(scenario) as sim:
        sim.command(v_x, v_y, yaw_rate)
        while not sim.done:
            tick = sim.step()
            left, right = tick.plan.footholds
            places.append((*0.5 * (left.position + right.position)[:2], 0.5 * (left.yaw + right.yaw)))
        followed = sim.orders.followed
    (x, y, yaw), (last_x, last_y, last_yaw) = places[-round(6 * period * 500)], places[-1]
    turned, time = last_yaw - yaw, 6.0 * period
    arc = np.sinc(0.5 * turned / np.pi) * time
    np.testing.assert_allclose(np.hypot(last_x - x, last_y - y) / arc, np.hypot(followed.x, followed.y), rtol=0.05)
    np.testing.assert_allclose(turned / time, followed.yaw, rtol=0.05, atol=0.005)


def retimed(seed, duration):
    """Other durations of single and double support, by up to 30 %, at random moments."""
    rng, time, told = random.Random(seed), 1.3, []
    while time < duration - STOP:
        durations = 0.637 * rng.uniform(0.7, 1.3), 0.171 * rng.uniform(0.7, 1.3)
        told.append({"time": time, "single_support": durations[0], "double_support": durations[1]})
        time = round(time + rng.uniform(0.2, 1.5), 3)
    return [*told, {"time": duration - STOP, "v_x": 0.0}]


TIERS = [pytest.param(1, marks=pytest.mark.physics), *(pytest.param(n, marks=pytest.mark.long) for n in range(2, 11))]


@pytest.mark.parametrize("seed", TIERS)
def test_durations_change_at_any_moment(seed, tmp_path):
    keys = {"gait.single_support": 0.637, "gait.double_support": 0.171, "criteria": SOUND, "seed": seed}
    told = {"duration": 17.0, "commands": retimed(seed, 17.0)}
    result = surefoot.run(surefoot.load("walk-level", {**keys, **told}), out=tmp_path)
    assert result.verdict.passed, result.verdict.reasons
    assert len(surefoot.read(result.log)["/command"]) > 10
