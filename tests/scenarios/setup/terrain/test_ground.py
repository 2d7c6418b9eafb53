"""The ground of a scenario: belief and truth, and stairs that are refused before a run."""

import numpy as np
import pytest

from surefoot.planner.ground.terrain import flat
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.record.provenance import RECORD, RunConstants
from surefoot.scenarios.run.run import run_constants
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.streams import generator

pytestmark = pytest.mark.unit

STAIRS = "terrain: {kind: stairs, riser: 0.1, tread: 0.2, count: 3"


def scenario(robots, more="", gait="{steps: 4}"):
    return read_scenario(f"{STAIRS}{more}}}\ngait: {gait}\n", "f.yaml", "f", (), robots)


def test_the_first_footstep_lands_in_the_middle_of_the_first_tread(robots):
    ground = Walk(scenario(robots)).ground.terrain
    assert [ground.height(x, 0.0) for x in (0.0, 0.099, 0.101, 0.299, 0.301, 0.51, 1.0)] == pytest.approx(
        [0.0, 0.0, 0.1, 0.1, 0.2, 0.3, 0.3]
    )


def test_a_walk_down_starts_on_the_highest_platform(robots):
    assert Walk(scenario(robots, ", direction: down")).ground.start_height == pytest.approx(0.3)


def test_truth_differs_from_belief_by_the_noise_but_not_where_the_robot_starts(robots):
    noisy = scenario(robots, ", direction: down, height_noise: 0.02")
    belief, truth = Walk(noisy).ground.terrain, Walk(noisy).ground.true_terrain
    points = np.array([[0.0, 0.0], [0.2, 0.0], [0.4, 0.0]])
    difference = truth.heights(points) - belief.heights(points)
    assert difference[0] == 0.0
    assert 0.0 < np.abs(difference[1:]).max() <= 0.02
    other = noisy.model_copy(update={"seed": 1})
    assert not np.array_equal(Walk(other).ground.true_terrain.heights(points), truth.heights(points))
    assert (
        Walk(scenario(robots)).ground.true_terrain.boxes[0].center.tolist()
        == Walk(scenario(robots)).ground.terrain.boxes[0].center.tolist()
    )


def test_heights_of_treads_are_not_the_noise_of_the_start_once_more(robots):
    ground = Walk(scenario(robots, ", height_noise: 0.02")).ground
    true, known = (np.array([box.center[2] for box in one.boxes]) for one in (ground.true_terrain, ground.terrain))
    shares = (true - known) / generator(ground.seed).uniform(-0.02, 0.02, len(true))
    assert np.ptp(shares[shares != 0.0]) > 0.1


UNEVEN = "errors.ground_noise=0.01"
ALIVE = "criteria={fell: false}"


@pytest.mark.parametrize("name", ["walk-level", "diagonal-walk", "walk-curve", "walk-sideways", "walk-backward"])
def test_level_ground_is_uneven_in_truth_alone_and_under_every_footstep(name):
    walk = Walk(load_scenario(name, [UNEVEN]))
    assert walk.ground.terrain == flat()
    footsteps = np.array([step.position[:2] for step in walk.ground.level_footsteps])
    heights = walk.ground.true_terrain.heights(footsteps)
    np.testing.assert_array_equal(heights[:2], 0.0)
    assert heights.min() < 0.0
    assert np.abs(heights).max() <= 0.01 == -walk.ground.true_terrain.plane
    assert heights.min() > walk.ground.true_terrain.plane
    assert len(walk.ground.true_terrain.boxes) < 150


def test_uneven_ground_is_that_of_the_seed_and_bears_hidden_steps_as_level_ground_does():
    points = np.random.default_rng(0).uniform(-1.0, 1.0, (50, 2))
    step = "errors.ground=[{x: 0.5, length: 0.2, height: 0.03}]"
    one, same, other, stepped = (
        Walk(load_scenario("walk-level", [UNEVEN, *more])).ground.true_terrain.heights(points)
        for more in (["seed=1"], ["seed=1", "gait.step_length=0.2"], ["seed=2"], ["seed=1", step])
    )
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)
    on = np.abs(points[:, 0] - 0.5) < 0.1
    np.testing.assert_allclose(stepped[on], 0.03)
    np.testing.assert_array_equal(stepped[~on], one[~on])


@pytest.mark.parametrize("level", ["errors.ground_noise=0", "errors.ground_noise=null", "seed=3"])
def test_ground_without_noise_is_what_is_believed(level):
    walk = Walk(load_scenario("walk-level", [level]))
    assert walk.ground.true_terrain is walk.ground.terrain


def test_a_log_says_where_the_plane_lies_only_where_it_lies_lower():
    uneven, level = (run_constants(resolve(load_scenario("walk-level", more))) for more in ([UNEVEN], []))
    assert "plane" not in level.to_metadata()
    for constants in (uneven, level):
        assert RunConstants.from_metadata({RECORD: constants.to_metadata()}, "log") == constants
    assert uneven.plane == -0.01


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            ["walk-level", "gait.steps=400"],
            "errors.ground_noise under 400 steps needs more than 1000 tiles; take fewer steps",
        ),
        (["stair-climbing"], "errors.ground_noise on terrain.kind stairs; use terrain.height_noise"),
        (["blocks"], "errors.ground_noise on terrain.kind blocks; use terrain.height_noise"),
        (["slope"], "errors.ground_noise on terrain.kind slope; use kind flat"),
    ],
)
def test_ground_that_cannot_be_uneven_is_refused_with_the_key_that_is_right(settings, message):
    with pytest.raises(ScenarioError, match=message):
        load_scenario(settings[0], [*settings[1:], UNEVEN])


def test_a_pendulum_is_told_that_it_does_not_feel_the_ground():
    walk = Walk(load_scenario("walk-level", ["fidelity=pendulum", UNEVEN, ALIVE]))
    assert "errors.ground_noise has no effect on a pendulum" in notes(walk)
    assert walk.ground.true_terrain is walk.ground.terrain


@pytest.mark.parametrize(
    ("more", "gait", "message"),
    [
        (", start: 0.01", "{}", "terrain.start: the feet would start"),
        ("", "{step_length: 0.15}", "over the edge of its tread; give gait.step_length the depth of terrain.tread"),
        (", height_noise: 0.1", "{}", "may swallow risers of 0.1 m; use less than terrain.riser"),
    ],
)
def test_impossible_stairs_are_refused(robots, more, gait, message):
    with pytest.raises(ScenarioError) as refusal:
        scenario(robots, more, gait)
    assert message.split(": ")[-1] in str(refusal.value)


def test_risers_out_of_reach_are_refused():
    for riser, message in (("0", "makes no stairs"), ("0.5", "out of reach of legs")):
        with pytest.raises(ScenarioError, match=message):
            load_scenario("stair-climbing", [f"terrain.riser={riser}"])


FLIGHT = "robot_options: {foot_length: 0.22, foot_width: 0.11}\nterrain: {kind: stairs, riser: 0.15, tread: 0.28%s}\n%s"
SMALL_FEET = "terrain: {kind: stairs, riser: %s, tread: 0.14}\ngait: {step_length: 0.28}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "terrain: {kind: stairs, riser: 0.6}",
            "terrain.riser 0.6 m is out of reach of legs 0.920 m long; use at most 0.426",
        ),
        (
            "terrain: {kind: stairs, riser: 15}",
            "out of reach of legs 0.920 m long; use at most 0.426 m; for 15 cm write",
        ),
        (
            SMALL_FEET % 0.1,
            "footstep 2 would take 2 risers of 0.1 m at once; give gait.step_length the depth of terrain.tread",
        ),
        (
            SMALL_FEET % 0.25,
            "footstep 2 would take 2 risers of 0.25 m at once; give gait.step_length the depth of terrain.",
        ),
        (
            FLIGHT % ("", "gait: {step_length: 0.2}"),
            "of the first stair; give gait.step_length the depth of terrain.tread",
        ),
        (FLIGHT % (", start: 0.05", ""), "would start 0.060 m over the edge of the first stair; use at least 0.110 m"),
        (
            FLIGHT % (", direction: up_down, count: 2, landing: 0.5", "gait: {steps: 8}"),
            "with terrain.landing 0.5 m; use 0.2",
        ),
        (FLIGHT % (", direction: up_down, count: 2, landing: 0.7", "gait: {steps: 8}"), "use 0.56 m or 0.84 m"),
        (FLIGHT % ("", "gait: {turn: 0.2}"), "over the edge of its tread, as the walk turns; use 0 on stairs"),
    ],
)
def test_what_does_not_fit_on_stairs_names_the_key_that_would_mend_it(robots, text, message):
    with pytest.raises(ScenarioError) as refusal:
        read_scenario(text, "f.yaml", "f", (), robots)
    assert len(refusal.value.problems) == 1
    assert message in refusal.value.problems[0]


@pytest.mark.parametrize("landing", [0.28, 0.56, 0.84])
def test_a_landing_of_whole_steps_fits(robots, landing):
    text = FLIGHT % (f", direction: up_down, count: 2, landing: {landing}", "gait: {steps: 8}")
    assert read_scenario(text, "f.yaml", "f", (), robots).terrain.landing == landing


def test_on_stairs_a_step_is_as_long_as_a_tread_unless_it_is_given(robots):
    assert read_scenario(FLIGHT % ("", ""), "f", "f", (), robots).gait.step_length == 0.28
    given = read_scenario("terrain: {kind: stairs, tread: 0.2}\ngait: {step_length: 0.21}", "f", "f", (), robots)
    assert given.gait.step_length == 0.21
    assert read_scenario("terrain: {tread: 0.28}", "f", "f", (), robots).gait.step_length == 0.2
