"""Touchdowns that come before or after the plan's: ground that the planner does not know of."""

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.stances.start import SOLE_SINKAGE

pytestmark = pytest.mark.physics

STRAIGHT = ["gait.lateral_step=0", "gait.step_width=0.2"]


def hidden_step(height, start, end):
    """A step from x = start to x = end: one foot lands early on it, a later one late behind it."""
    middle, length = 0.5 * (start + end), end - start
    return f"errors.ground=[{{x: {middle}, length: {length}, width: 4, height: {height}}}]"


@pytest.mark.parametrize(
    ("scenario", "overrides", "step"),
    [
        pytest.param("diagonal-walk", STRAIGHT, (0.01, 0.3, 0.66), marks=pytest.mark.long),
        ("diagonal-walk", STRAIGHT, (0.02, 0.3, 0.66)),
        ("walk-level", ["gait.steps=10"], (0.02, 0.75, 1.65)),
    ],
)
def test_a_hidden_step_is_felt_and_walked_over(scenario, overrides, step, tmp_path):
    result = run_scenario(load_scenario(scenario, [*overrides, hidden_step(*step)]), tmp_path)
    metrics, footsteps = result.verdict.metrics, read(result.log)["/footstep"]
    assert not metrics["fell"]
    assert metrics["steps_taken"] == metrics["steps_planned"]
    assert metrics["standing_time_final"] >= 1.0
    # What was planned knows nothing of the step, though the planner went on from where the foot was felt.
    assert footsteps.field("planned")[0, 2] == 0.0
    assert metrics["footstep_error_max"] >= 0.95 * step[0]


def test_ground_a_centimetre_off_is_felt_and_walked_over(tmp_path):
    """It is felt: the same walk on tiles that are all as high as believed has none of it."""
    settings = ["gait.steps=3", "seed=3", "duration=4.5"]
    rough, flush = (
        run_scenario(load_scenario("walk-level", [*settings, f"errors.ground_noise={noise}"]), tmp_path)
        for noise in (0.01, 1e-7)
    )
    metrics = rough.verdict.metrics
    assert not metrics["fell"]
    assert metrics["steps_taken"] == metrics["steps_planned"]
    landed, level = (np.abs(read(result.log)["/footstep"].field("actual")[:, 2]).max() for result in (rough, flush))
    assert level < 1e-3 < 5e-3 < landed
    soles = read(rough.log)["/truth"].field("left_sole")[0, 2], read(rough.log)["/truth"].field("right_sole")[0, 2]
    np.testing.assert_allclose(soles, -SOLE_SINKAGE, atol=1e-6)  # the start is as believed


def test_a_step_of_ten_centimetres_fells_who_does_not_adapt(tmp_path):
    scenario = load_scenario("diagonal-walk", [*STRAIGHT, hidden_step(0.1, 0.3, 0.66), "planner.step_adaptation=none"])
    assert run_scenario(scenario, tmp_path).verdict.metrics["fell"]
