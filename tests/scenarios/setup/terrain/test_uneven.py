"""Sizes that make a kind of ground uneven: level without them, refused where tiny, less on a calmer ground."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.file.group import key
from surefoot.scenarios.file.schema import TerrainSettings
from surefoot.scenarios.file.values import Height, Length
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.setup.terrain.ground import TerrainKind, climb_problems, unreached
from surefoot.scenarios.setup.terrain.stairs import StairsKind
from surefoot.scenarios.setup.walk import Walk

pytestmark = pytest.mark.unit


class KerbSettings(TerrainSettings):
    """The group `terrain` of a kerb."""

    kerb: Height = key(0.1, "height of a kerb")
    begin: Length | None = key(None, "start to the kerb")


class Kerb(StairsKind):
    """Stairs whose risers are called kerbs."""

    name = "kerb"
    keys = ("tread", "count")
    settings = KerbSettings
    uneven = ("kerb",)


@pytest.fixture
def kerb():
    """A kind of ground with sizes of its own, registered from Python."""
    yield KINDS.add("kerb", Kerb())
    KINDS.discard("kerb")


@pytest.mark.parametrize("kind", KINDS)
def test_all_footsteps_are_level_where_all_that_makes_a_kind_uneven_is_zero(kind):
    ground = Walk(surefoot.load("walk-level")).ground
    uneven = dict.fromkeys(KINDS[kind].uneven, 0.0)
    level = replace(ground, keys=ground.keys.model_copy(update={"kind": kind, **uneven}))
    assert np.ptp(level.places[:, 2]) < 1e-12
    assert {*map(tuple, (step.normal for step in level.footsteps))} == {(0.0, 0.0, 1.0)}


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind in KINDS for name in KINDS[kind].uneven])
def test_one_that_nothing_follows_from_is_refused(kind, name):
    with pytest.raises(surefoot.ScenarioError, match=f"terrain.{name} 1e-12 is too small to change anything"):
        surefoot.load("walk-level", {"terrain.kind": kind, f"terrain.{name}": 1e-12})


def test_so_is_one_of_a_kind_of_ones_own(kerb):
    with pytest.raises(surefoot.ScenarioError, match=r"terrain.kerb 1e-12 is too small to change anything"):
        surefoot.load("walk-level", {"terrain.kind": "kerb", "terrain.kerb": 1e-12})


def test_what_legs_cannot_climb_is_named_by_the_key_of_its_kind():
    facts = SimpleNamespace(leg_length=0.92, com_above_hip=0.1)
    ground = SimpleNamespace(standing_height=1.0, keys=KerbSettings(kind="flat", kerb=0.9))
    (problem,) = climb_problems(ground, facts, name="kerb")
    assert problem.key == ("terrain", "kerb")
    assert problem.what.startswith("terrain.kerb 0.9 m is out of reach")
    (problem,) = unreached(Walk(surefoot.load("walk-level")).ground, "kerb", name="begin")
    assert problem.key == ("terrain", "begin")


def test_by_default_the_sizes_are_the_common_ones_that_shape_it():
    assert TerrainKind().uneven == KINDS["flat"].uneven == ()
    assert KINDS["slope"].uneven == ("angle", "height_noise")
    assert KINDS["stairs"].uneven == ("riser", "height_noise")
