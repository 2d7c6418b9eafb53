"""Walks in full physics: the catalogue, and variations of one walk with nothing else changed."""

import pytest
from variations import SCENARIO, VARIATIONS

from scenarios import catalogue
from scenarios.file.load import load_scenario
from scenarios.run import run_scenario

EVERY_CHANGE = [variation for variation in VARIATIONS if variation.every_change and variation.overrides]
ON_DEMAND = [variation for variation in VARIATIONS if not variation.every_change]


def verdict(tmp_path, name, overrides=()):
    return run_scenario(load_scenario(name, overrides), tmp_path).verdict


@pytest.mark.physics
@pytest.mark.parametrize("name", catalogue.names())
def test_catalogue(tmp_path, name):
    assert verdict(tmp_path, name).reasons == ()


@pytest.mark.physics
@pytest.mark.parametrize("variation", EVERY_CHANGE, ids=lambda variation: variation.name)
def test_variation(tmp_path, variation):
    assert verdict(tmp_path, SCENARIO, variation.overrides).reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("variation", ON_DEMAND, ids=lambda variation: variation.name)
def test_further_variation(tmp_path, variation):
    assert verdict(tmp_path, SCENARIO, variation.overrides).reasons == ()
