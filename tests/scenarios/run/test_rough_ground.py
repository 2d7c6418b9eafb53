"""Slopes and stepping blocks: what a scenario makes of them, what is refused, and walks in full physics."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from variations import SOUND_ON_STEPS

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.walk import Walk

FAST = "robot_options: {foot_length: 0.22, foot_width: 0.11}\n"
GAIT = "gait: {steps: 6, step_length: 0.3, com_height: 0.94%s}\n"
SLOPE = FAST + GAIT % "" + "terrain: {kind: slope, angle: 0.17%s}"
BLOCKS = FAST + GAIT % "" + "terrain: {kind: blocks, riser: 0.05, angle: 0.14%s}"

REFUSED = {
    SLOPE % ", start: 0.3": "footstep 1 would stand across the edge of the slope; put the edge between two footsteps",
    SLOPE % ", start: 0.05": "a start foot would stand across the edge of the slope",
    SLOPE % ", start: -0.2": "the walk would start on the slope; use at least 0.110 m",
    SLOPE % ", friction: 0.1": "terrain.angle 0.17 rad is steeper than terrain.friction 0.1 holds; use less than 0.099",
    SLOPE % ", height_noise: 0.01": "terrain.height_noise on a slope, which has one face only; use 0",
    "terrain: {kind: slope}": "terrain.angle 0 makes no slope; use more or less than 0 rad, or kind flat",
    "terrain: {kind: slope, angle: 0.6}": "terrain.angle 0.6 rad is too steep; use at most 0.35 rad",
    "terrain: {kind: blocks, angle: -0.1}": "terrain.angle -0.1 rad is no half range; use at least 0 rad",
    BLOCKS % ", tread: 0.2": "would not have the whole sole on its block; use more than the foot's 0.22 m",
    BLOCKS % ", tread: 0.45": "would not have the whole sole on its block",
    "gait: {steps: 300}\nterrain: {kind: blocks}": "a field of so many blocks; take at most 200 steps",
    "gait: {velocity: [{time: 0, v_x: .1}, {time: 9}]}\nterrain: {kind: blocks}": "gait.velocity on blocks, which are",
    FAST + "terrain: {kind: blocks, riser: 0.3}": "terrain.riser 0.3 m is out of reach of legs 0.920 m long; use at",
}  # fmt: skip

NEIGHBOURS = {
    "slope": (
        "terrain.angle=-0.1745", "terrain.angle=0.12", "gait.step_length=0.35", "start.yaw=0.7",
        "gait.single_support=0.44", "terrain.angle=-0.262",
    ),
    "blocks": (*(f"seed={seed}" for seed in range(1, 10)), "gait.step_length=0.35", "gait.single_support=0.6"),
}  # fmt: skip


@pytest.mark.unit
@pytest.mark.parametrize("text", REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_walked_is_refused_with_the_reason(robots, text):
    with pytest.raises(ScenarioError) as refusal:
        read_scenario(text, "f.yaml", "f", (), robots)
    assert REFUSED[text] in str(refusal.value)


@pytest.mark.unit
def test_a_walk_starts_on_level_ground_at_its_height(robots):
    for text in (SLOPE % "", (SLOPE % "").replace("0.17", "-0.17"), BLOCKS % ""):
        scenario = read_scenario(text, "f.yaml", "f", (), robots)
        terrain = Walk(scenario).ground.terrain
        np.testing.assert_allclose(
            terrain.heights(np.array([[0.0, 0.1], [0.1, -0.1]])), Walk(scenario).ground.start_height
        )
        np.testing.assert_array_equal(terrain.normal(0.0, 0.1), [0.0, 0.0, 1.0])


@pytest.mark.unit
def test_the_seed_is_that_of_the_blocks(robots):
    scenario = read_scenario(BLOCKS % "", "f.yaml", "f", (), robots)
    fields = [Walk(scenario.model_copy(update={"seed": seed})).ground.terrain for seed in (0, 0, 1)]
    tops = [[box.center.tolist() for box in field.boxes] for field in fields]
    assert tops[0] == tops[1] != tops[2]
    noisy = read_scenario(BLOCKS % ", height_noise: 0.01", "f.yaml", "f", (), robots)
    points = np.array([box.center[:2] for box in Walk(noisy).ground.terrain.boxes])
    wrong = Walk(noisy).ground.true_terrain.heights(points) - Walk(noisy).ground.terrain.heights(points)
    assert wrong[0] == 0.0
    assert 0.0 < np.abs(wrong).max() < 0.0105


@pytest.mark.physics
@pytest.mark.parametrize("angle", [0.1745, pytest.param(-0.1745, marks=pytest.mark.long)])
def test_the_soles_lie_flat_on_a_slope(tmp_path, angle):
    overrides = (f"terrain.angle={angle}", "gait.steps=4")
    result = run_scenario(load_scenario("slope", overrides), tmp_path)
    assert result.verdict.reasons == ()
    truth = read(result.log)["/truth"]
    for sole in ("left_sole", "right_sole"):
        R = Rotation.from_quat(truth.field(sole)[-500:, 3:]).as_matrix()
        normal = [-math.sin(angle), 0.0, math.cos(angle)]
        np.testing.assert_allclose(R[:, :, 2], np.tile(normal, (500, 1)), atol=1e-3)


@pytest.mark.physics
def test_blocks_are_walked(tmp_path):
    assert run_scenario(load_scenario("blocks", ("gait.steps=7", "seed=4")), tmp_path).verdict.reasons == ()


@pytest.mark.long
@pytest.mark.parametrize(("name", "override"), [(name, v) for name, many in NEIGHBOURS.items() for v in many], ids=str)
def test_neighbours_walk(tmp_path, name, override):
    assert run_scenario(load_scenario(name, (override, SOUND_ON_STEPS)), tmp_path).verdict.reasons == ()
