"""A kind of ground of another package: refused where a gait cannot cross it, and stepped over where it can."""

import importlib
import pickle

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import RobotSettings
from surefoot.scenarios.log import read
from surefoot.scenarios.setup.checks.criteria import published
from surefoot.scenarios.setup.keys import scenario_key
from surefoot.scenarios.setup.load import Written, for_robot
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.setup.walk import Walk

WALK = {
    "gait": {"steps": 3, "step_length": 0.3, "step_width": 0.22},
    "terrain": {"kind": "ditch", "riser": 0.1, "tread": 0.15},
    "criteria": {"fell": False, "steps_taken": "steps_planned", "swing_clearance_min": {"min": 0.01}},
}


@pytest.fixture
def ditch(documented, importing, monkeypatch):
    """The kind of docs/extending.md, registered from Python."""
    monkeypatch.syspath_prepend(str(documented.folder))
    kind = KINDS.add("ditch", importlib.import_module("my_package.ground").Ditch())
    yield kind
    KINDS.discard("ditch")


@pytest.mark.unit
def test_it_is_two_banks_with_nothing_between_them(ditch):
    terrain = Walk(surefoot.load("diagonal-walk", {**WALK, "start.yaw": 0.5, "start.x": 2.0})).ground.terrain
    along = np.array([-0.9, 0.0, 0.07, 0.08, 0.22, 0.23, 0.3, 1.8])
    points = np.array([2.0, 0.0]) + along[:, None] * (np.cos(0.5), np.sin(0.5))
    np.testing.assert_allclose(terrain.heights(points), [0.1, 0.1, 0.1, 0.0, 0.0, 0.1, 0.1, 0.1])


@pytest.mark.unit
@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"terrain.riser": 0.0},
            "--set terrain.riser: terrain.riser 0 makes no ditch; use more than 0 m, or kind flat",
        ),
        ({"terrain.tread": 0.24}, "a start foot would not stand on a bank of the ditch; put it between the feet"),
        ({"terrain.start": 0.12}, "footstep 1 would not stand on a bank of the ditch; put it between the feet"),
        ({"terrain.start": 0.5, "terrain.tread": 0.4}, "footstep 2 would not stand on a bank of the ditch"),
        ({"gait.step_length": 0.2}, "a start foot would not stand"),
    ],
)
def test_one_that_no_step_crosses_is_refused_in_its_own_words(ditch, changes, sentence):
    with pytest.raises(ScenarioError) as refused:
        surefoot.load("diagonal-walk", {**WALK, **changes})
    (problem,) = refused.value.problems
    assert sentence in problem


@pytest.mark.unit
def test_keys_that_do_not_shape_it_are_said_to_be_idle(ditch, tmp_path):
    keys = {**WALK, "fidelity": "pendulum", "duration": 0.1, "terrain.angle": 0.1, "criteria": {}}
    notes = surefoot.run(surefoot.load("diagonal-walk", keys), out=tmp_path).verdict.notes
    assert [note for note in notes if "terrain" in note] == ["terrain.angle has no effect on terrain.kind ditch"]


@pytest.mark.unit
def test_a_common_key_acts_where_the_kind_names_it_and_nowhere_else(ditch, tmp_path):
    """Heights are uncertain on a kind that says so; on another a note says that they are not, and they are not."""
    keys = {**WALK, "fidelity": "pendulum", "duration": 0.1, "terrain.height_noise": 0.01, "criteria": {}}
    scenario = surefoot.load("diagonal-walk", keys)

    def ground():
        return Walk(scenario).ground

    assert _same(ground())
    assert ground().unforeseen == {}
    notes = surefoot.run(scenario, out=tmp_path).verdict.notes
    assert "terrain.height_noise has no effect on terrain.kind ditch" in notes
    KINDS.add("ditch", type("Uneven", (type(ditch),), {"keys": (*ditch.keys, "height_noise")})())
    assert not _same(ground())
    assert ground().unforeseen == {"terrain.height_noise": (1,)}  # the bank of the start is known
    notes = surefoot.run(scenario, out=tmp_path).verdict.notes
    assert not any("height_noise has no effect on terrain" in note for note in notes)


def _same(ground):
    pairs = zip(ground.true_terrain.boxes, ground.terrain.boxes, strict=True)
    return all(np.array_equal(one.center, other.center) for one, other in pairs)


@pytest.mark.unit
def test_a_key_of_its_own_that_is_refused_is_named_as_it_is(ditch):
    """Also where a parameter of the planner has the same name."""

    def build(self, ground):
        raise surefoot.ParameterError(("terrain", "depth"), "a ditch without a floor", "give it one")

    KINDS.add("ditch", type("Bottomless", (type(ditch),), {"build": build})())
    with pytest.raises(ScenarioError) as refused:
        surefoot.load("diagonal-walk", {**WALK, "terrain.bank": 1.0})
    assert scenario_key(("terrain", "depth")) == ("terrain", "depth")
    assert "a ditch without a floor; give it one" in "\n".join(refused.value.problems)


@pytest.mark.physics
def test_three_steps_go_over_it_in_full_physics_and_no_foot_goes_in(ditch, tmp_path):
    result = surefoot.run(surefoot.load("diagonal-walk", WALK), out=tmp_path)
    assert result.verdict.passed, result.verdict
    soles = read(result.log)["/truth"]
    lowest = np.minimum(soles.field("left_sole")[:, 2], soles.field("right_sole")[:, 2])
    assert lowest.min() > 0.098
    assert soles.field("com")[-1, 0] > 0.55


@pytest.mark.unit
@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"terrain.bank": 0.0}, "terrain.bank is 0.0; it must be more than 0.0 m"),
        ({"terrain.bank": "1.5 s"}, "terrain.bank"),
        ({"terrain.bnak": 1.5}, "unknown key 'bnak'; did you mean 'bank'?"),
        ({"terrain.bank": 1.5, "terrain.kind": "flat"}, "unknown key 'bank'; it is a key of kind ditch"),
    ],
)
def test_a_key_of_its_own_is_checked_as_any_other_and_unknown_elsewhere(ditch, changes, sentence):
    with pytest.raises(ScenarioError) as refused:
        surefoot.load("diagonal-walk", {**WALK, **changes})
    assert sentence in "\n".join(refused.value.problems)


@pytest.mark.unit
def test_a_key_of_its_own_has_units_grows_with_the_robot_and_is_in_the_schema(ditch):
    def width(**more):
        return surefoot.load("diagonal-walk", {**WALK, "terrain.bank": "150 cm", **more})

    assert width().terrain.bank == 1.5
    assert Walk(width()).ground.true_terrain.boxes[0].half_size[1] == 0.75
    length = Robots().facts("g1", RobotSettings()).size.length
    text = Written("terrain: {kind: ditch}\n", "f.yaml", "f")
    sized = for_robot(text, {"terrain.bank": 1.5}, "humanoid100", "g1", Robots())
    assert sized["terrain.bank"] == pytest.approx(1.5 * length)
    assert published()["$defs"]["TerrainSettings"]["properties"]["bank"]["unit"] == "m"


@pytest.mark.unit
def test_a_log_and_another_process_know_its_own_key(ditch, tmp_path):
    brief = {**WALK, "fidelity": "pendulum", "duration": 0.1, "terrain.bank": 1.5, "criteria": {}}
    scenario = surefoot.load("diagonal-walk", brief)
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    result = surefoot.run(scenario, out=tmp_path)
    assert surefoot.load(str(result.log)).terrain.bank == 1.5


@pytest.mark.unit
def test_commands_and_the_processes_that_they_spawn_know_its_own_key(documented, tmp_path):
    ground = "terrain: {kind: ditch, riser: 0.1, tread: 0.15, bank: 1.5}"
    gait = "gait: {steps: 3, step_length: 0.3, step_width: 0.22}"
    scenario = tmp_path / "over.yaml"
    scenario.write_text(f"fidelity: pendulum\nduration: 0.2\n{gait}\n{ground}\ncriteria: {{fell: false}}\n")
    campaign = tmp_path / "banks.campaign.yaml"
    campaign.write_text(f"scenario: {scenario}\ngrid: {{terrain.bank: [1.5, 2.0]}}\nseeds: 1\n")
    for words in (("run", scenario), ("check", scenario), ("sweep", campaign, "--jobs", "2")):
        answer = documented.run(*map(str, words))
        assert "bank" not in answer.stderr and "Traceback" not in answer.stderr, answer.stderr
        assert answer.returncode in (0, 1), (words, answer.stderr, answer.stdout)
