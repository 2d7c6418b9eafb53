"""Ground that nobody believes in: tilted from the first step on, or slippery in a patch."""

from xml.etree import ElementTree

import numpy as np
import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim.scene import world_mjcf

pytestmark = pytest.mark.unit

PATCH = "errors.ground=[{x: 0.5, length: 0.6, height: 0.001, friction: 0.3}, {x: 2, length: 0.5, height: 0.01}]"


def frictions(walk):
    root = ElementTree.fromstring(world_mjcf(walk.true_robot, walk.ground.true_terrain, 0.001))
    geoms = {geom.get("name"): geom.get("friction") for geom in root.iter("geom")}
    return {name: float(geoms[name].split()[0]) for name in ("ground", "terrain_0", "terrain_1")}


def test_a_box_may_have_friction_of_its_own():
    assert frictions(resolve(load("walk-level", [PATCH, "terrain.friction=0.7"]))) == {
        "ground": 0.7, "terrain_0": 0.3, "terrain_1": 0.7
    }  # fmt: skip


def test_the_controller_believes_in_the_grounds_friction():
    assert resolve(load("walk-level", [PATCH])).friction == resolve(load("walk-level")).friction


def test_ground_is_believed_level_and_is_tilted_where_the_walk_goes():
    walk = resolve(load("walk-level", ["errors.ground_pitch=2 deg", "errors.ground_roll=-1 deg"]))
    assert not walk.ground.terrain.boxes
    true, stance = walk.ground.true_terrain, walk.ground.stance.position
    assert [true.height(*place[:2]) for place in stance] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert true.height(1.15, 0.0) == pytest.approx(np.tan(np.radians(2.0)))
    assert walk.unforeseen == {"errors.ground_pitch": (1, 2), "errors.ground_roll": (1, 2)}


def test_the_level_strip_goes_with_the_robot():
    small = resolve(load("walk-level", {"robot": "g1", "sized_for": "humanoid100", "errors.ground_pitch": 0.02}))
    strip, ahead, _ = small.ground.true_terrain.boxes
    assert strip.half_size[0] == pytest.approx(0.15 * small.size.length)
    assert ahead.friction is None


@pytest.mark.parametrize("nothing", ["errors.ground_pitch=0", "errors.ground_roll=0"])
def test_no_tilt_is_the_ground_as_believed(nothing):
    ground = resolve(load("walk-level", [nothing])).ground
    assert ground.true_terrain is ground.terrain


@pytest.mark.parametrize(
    ("others", "words"),
    [
        (["terrain.kind=stairs"], "errors.ground_pitch on terrain.kind stairs; use kind flat"),
        (["errors.ground_noise=0.005"], "errors.ground_pitch beside errors.ground_noise; give one of them"),
        ([PATCH], "errors.ground_pitch beside errors.ground; give one of them"),
    ],
)
def test_tilt_beside_other_ground_is_refused(others, words):
    name = "stairs-up" if "stairs" in others[0] else "walk-level"
    with pytest.raises(ScenarioError, match=words):
        load(name, ["errors.ground_pitch=0.03", *others])
