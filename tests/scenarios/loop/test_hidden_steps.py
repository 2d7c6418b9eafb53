"""Touchdowns that come before or after the plan's: ground that the planner does not know of."""

import numpy as np
import pytest

from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load_scenario
from surefoot.sim.world import World

pytestmark = pytest.mark.physics

STRAIGHT = ["gait.lateral_step=0", "gait.step_width=0.2"]


def hidden_step(height, start, end):
    """A world with a step from x = start to x = end: one foot lands early on it, a later one late behind it."""

    class Hidden(World):
        def __init__(self, description, terrain, physics_rate, pushes=()):
            center, half = (
                np.array([0.5 * (start + end), 0.0, 0.5 * height]),
                np.array([0.5 * (end - start), 2.0, 0.5 * height]),
            )
            super().__init__(
                description, Terrain((Box(center, half, np.eye(3)),), terrain.friction), physics_rate, pushes
            )

    return Hidden


@pytest.mark.parametrize(
    ("scenario", "overrides", "step"),
    [
        ("diagonal-walk", STRAIGHT, (0.01, 0.3, 0.66)),
        ("diagonal-walk", STRAIGHT, (0.02, 0.3, 0.66)),
        ("walk", ["gait.steps=10"], (0.02, 0.75, 1.65)),
    ],
)
def test_a_hidden_step_is_felt_and_walked_over(scenario, overrides, step, tmp_path, monkeypatch):
    monkeypatch.setattr("surefoot.scenarios.loop.full.World", hidden_step(*step))
    result = run_scenario(load_scenario(scenario, overrides), tmp_path)
    metrics = result.verdict.metrics
    assert not metrics["fell"]
    assert metrics["steps_taken"] == metrics["steps_planned"]
    assert metrics["standing_time_final"] >= 1.0


def test_a_step_of_ten_centimetres_cannot_be_hidden(tmp_path, monkeypatch):
    monkeypatch.setattr("surefoot.scenarios.loop.full.World", hidden_step(0.1, 0.3, 0.66))
    assert run_scenario(load_scenario("diagonal-walk", STRAIGHT), tmp_path).verdict.metrics["fell"]
