"""The options of a world: what its text says otherwise is told, by its name and by no other."""

import re

import pytest

from surefoot.models import RobotOptions, describe
from surefoot.planner.ground.terrain import Terrain
from surefoot.sim.options import world_options
from surefoot.sim.scene import world_mjcf

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def text():
    """A world with the reference robot on flat ground."""
    return world_mjcf(describe("humanoid100", RobotOptions()), Terrain(friction=0.8), 0.001)


def test_they_are_those_of_the_compiled_model(text):
    options = world_options(text)
    assert (options["gravity"], options["timestep"], options["mass"]) == (
        [0.0, 0.0, -9.81],
        0.001,
        pytest.approx(100.0),
    )
    assert options["disabled"] == ["mjDSBL_EULERDAMP", "mjDSBL_AUTORESET", "mjDSBL_ISLAND"]
    assert options["ground_friction"] == [0.8, 0.0, 0.0]
    assert options["pairs_ground"] == options["robot_geoms"] == 20
    assert options == world_options(text)


@pytest.mark.parametrize(
    ("old", "new", "names"),
    [
        ('gravity="0 0 -9.81"', 'gravity="0 0 -9.6"', {"gravity"}),
        ('timestep="0.001"', 'timestep="0.0005"', {"timestep"}),
        ('cone="elliptic"', 'cone="pyramidal"', {"cone"}),
        ('impratio="20"', 'impratio="1"', {"impratio"}),
        ('island="disable"', 'contact="disable"', {"disabled"}),
        ('friction="0.8 0.0 0.0"', 'friction="1.2 0.0 0.0"', {"ground_friction"}),
        ('solref="0.01 1"', 'solref="0.02 1"', {"ground_solref"}),
        ('solimp="0.9 0.95', 'solimp="0.9 0.99', {"ground_solimp"}),
        ('conaffinity="3"', 'conaffinity="1"', {"pairs_self"}),
        ('body1="pelvis" body2="torso"', 'body1="pelvis" body2="left_foot"', {"pairs_self"}),
        ('armature="', 'armature="1', {"joint_armature"}),
        ('ctrlrange="-140.0 140.0" forcerange="-140.0 140.0"', "", {"motor_force", "motor_control"}),
    ],
)
def test_what_changes_is_named(text, old, new, names):
    changed = re.sub(re.escape(old), new, text)
    assert changed != text
    before, now = world_options(text), world_options(changed)
    assert {name for name in before if before[name] != now[name]} == names
