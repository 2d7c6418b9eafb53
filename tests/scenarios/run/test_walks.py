"""Walks in full physics: the catalogue, and variations of one walk with nothing else changed."""

import re
from pathlib import Path

import pytest
from variations import COMMANDED, COMMANDS, SCENARIO, SOUND, VARIATIONS

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

EVERY_CHANGE = [variation for variation in VARIATIONS if variation.every_change and variation.overrides]
ON_DEMAND = [variation for variation in VARIATIONS if not variation.every_change]
CHECKED = re.findall(r"surefoot check (control.+)", (Path(__file__).parents[3] / "Makefile").read_text())[0].split()
"""Walks that ``make test`` holds against their baselines anyway, and with these against their criteria."""
HELD_BY_OTHERS = ("stairs-up", "stairs-down", "paper-walk", "commanded", "walk-level", "walk-brisk")
"""Walks that others stand for: stairs-up-down, paper-noise and paper-push, by test_commanded_walks.

test_sensed_walks and test_instants hold the last two to their criteria, and to more.
"""
LONG_SCENARIOS = sorted({"walk-turn", "walk-curve", "walk-backward", "slope", "blocks", *HELD_BY_OTHERS, *CHECKED})


def verdict(tmp_path, name, overrides=()):
    return run_scenario(load_scenario(name, overrides), tmp_path).verdict


@pytest.mark.physics
@pytest.mark.parametrize("name", [name for name in catalogue.names() if name not in LONG_SCENARIOS])
def test_catalogue(tmp_path, name):
    assert verdict(tmp_path, name).reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("name", LONG_SCENARIOS)
def test_long_scenario(tmp_path, name):
    assert verdict(tmp_path, name).reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("variation", COMMANDS, ids=lambda variation: variation.name)
def test_commanded_walk(tmp_path, variation):
    assert verdict(tmp_path, COMMANDED, (*variation.overrides, SOUND)).reasons == ()


@pytest.mark.physics
@pytest.mark.parametrize(
    ("riser", "tread"),
    [*(pytest.param(*stair, marks=pytest.mark.long) for stair in ((0.2, 0.3), (0.22, 0.31))), (0.235, 0.32)],
)
def test_tall_stairs_down(tmp_path, riser, tread, from_sensors):
    stairs = {"terrain.direction": "down", "terrain.riser": riser, "terrain.tread": tread, "gait.step_length": tread}
    if from_sensors and riser > 0.23:
        # The truth has 4.4 mm already; feet that land 10 ms early, at 0.04 m/s, make it 5.5 mm.
        stairs["criteria.zmp_error_rms"] = {"max": 0.006}
    assert verdict(tmp_path, "stairs-tall", stairs).reasons == ()


@pytest.mark.unit
@pytest.mark.parametrize("heel_off", [0.0, 0.5])
def test_stairs_down_that_an_ankle_cannot_take_are_refused(tmp_path, heel_off):
    stairs = {"terrain.direction": "down", "terrain.riser": 0.25, "gait.heel_off": heel_off}
    with pytest.raises(SetupError, match="ankle_pitch"):
        verdict(tmp_path, "stairs-tall", stairs)


@pytest.mark.physics
@pytest.mark.parametrize("variation", EVERY_CHANGE, ids=lambda variation: variation.name)
def test_variation(tmp_path, variation):
    assert verdict(tmp_path, SCENARIO, variation.overrides).reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("variation", ON_DEMAND, ids=lambda variation: variation.name)
def test_further_variation(tmp_path, variation):
    assert verdict(tmp_path, SCENARIO, variation.overrides).reasons == ()
