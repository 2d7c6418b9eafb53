"""The ground of a scenario: belief and truth, and stairs that are refused before a run."""

import numpy as np
import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.load import read_scenario

pytestmark = pytest.mark.unit

STAIRS = "terrain: {kind: stairs, riser: 0.1, tread: 0.2, count: 3"


def scenario(robots, more="", gait="{steps: 4}"):
    return read_scenario(f"{STAIRS}{more}}}\ngait: {gait}\n", "f.yaml", "f", (), robots)


def test_the_first_footstep_lands_in_the_middle_of_the_first_tread(robots):
    ground = Draft(scenario(robots)).terrain
    assert [ground.height(x, 0.0) for x in (0.0, 0.099, 0.101, 0.299, 0.301, 0.51, 1.0)] == pytest.approx(
        [0.0, 0.0, 0.1, 0.1, 0.2, 0.3, 0.3]
    )


def test_a_walk_down_starts_on_the_highest_platform(robots):
    assert Draft(scenario(robots, ", direction: down")).start_height == pytest.approx(0.3)


def test_truth_differs_from_belief_by_the_noise_but_not_where_the_robot_starts(robots):
    noisy = scenario(robots, ", direction: down, height_noise: 0.02")
    belief, truth = Draft(noisy).terrain, Draft(noisy).true_terrain
    points = np.array([[0.0, 0.0], [0.2, 0.0], [0.4, 0.0]])
    difference = truth.heights(points) - belief.heights(points)
    assert difference[0] == 0.0
    assert 0.0 < np.abs(difference[1:]).max() <= 0.02
    other = noisy.model_copy(update={"seed": 1})
    assert not np.array_equal(Draft(other).true_terrain.heights(points), truth.heights(points))
    assert (
        Draft(scenario(robots)).true_terrain.boxes[0].center.tolist()
        == Draft(scenario(robots)).terrain.boxes[0].center.tolist()
    )


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
