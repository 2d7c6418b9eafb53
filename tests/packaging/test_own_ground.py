"""A kind of ground of another package: refused where a gait cannot cross it, and stepped over where it can."""

import importlib

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.log import read
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


@pytest.mark.physics
def test_three_steps_go_over_it_in_full_physics_and_no_foot_goes_in(ditch, tmp_path):
    result = surefoot.run(surefoot.load("diagonal-walk", WALK), out=tmp_path)
    assert result.verdict.passed, result.verdict
    soles = read(result.log)["/truth"]
    lowest = np.minimum(soles.field("left_sole")[:, 2], soles.field("right_sole")[:, 2])
    assert lowest.min() > 0.098
    assert soles.field("com")[-1, 0] > 0.55
