import pytest

from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import Walk

pytestmark = pytest.mark.unit

_LANDING = "terrain.landing=0.56"


@pytest.mark.parametrize(
    ("name", "override", "key"),
    [
        ("walk-level", "terrain.riser=0.2", "riser"),
        ("walk-level", "terrain.height_noise=0.01", "height_noise"),
        ("slope", "terrain.direction=down", "direction"),
        ("blocks", "terrain.count=7", "count"),
        ("stairs-up", "terrain.angle=0.1", "angle"),
    ],
)
def test_keys_of_other_terrain_are_noted(name: str, override: str, key: str) -> None:
    scenario = load_scenario(name, [override])
    assert notes(Walk(scenario)) == (f"terrain.{key} has no effect on terrain.kind {scenario.terrain.kind}",)


@pytest.mark.parametrize(("name", "idle"), [("stairs-up", True), ("stairs-down", True), ("stairs-up-down", False)])
def test_a_landing_is_noted_where_stairs_go_one_way(name: str, idle: bool) -> None:
    told = any(note.startswith("terrain.landing has no") for note in notes(Walk(load_scenario(name, [_LANDING]))))
    assert told == idle


@pytest.mark.parametrize("name", ["walk-level", "slope", "blocks", "stairs-up", "stairs-up-down", "stair-climbing"])
def test_the_catalogue_sets_no_idle_key(name: str) -> None:
    assert notes(Walk(load_scenario(name))) == ()
