"""The criteria of the catalogue tell a controller that was made worse from the one that was not."""

from pathlib import Path

import pytest
from controllers import SABOTAGES

import surefoot
from surefoot.scenarios.catalogue import names

pytestmark = pytest.mark.long


def reasons(name: str, sabotage: str | None, folder: Path) -> tuple[str, ...]:
    """Why a scenario fails with a controller that was made worse, or with the sound one."""
    parts = surefoot.Parts(controller=SABOTAGES[sabotage]) if sabotage else None
    return surefoot.run(name, out=folder, parts=parts).verdict.reasons


@pytest.mark.parametrize("name", names())
def test_every_scenario_passes_as_it_is_and_catches_a_worse_controller(name, tmp_path):
    assert reasons(name, None, tmp_path) == ()
    caught = [sabotage for sabotage in SABOTAGES if reasons(name, sabotage, tmp_path)]
    assert caught


@pytest.mark.parametrize("sabotage", SABOTAGES)
def test_every_sabotage_is_caught_where_the_robot_is_near_its_limits(sabotage, tmp_path):
    assert reasons("stairs-tall", sabotage, tmp_path)
