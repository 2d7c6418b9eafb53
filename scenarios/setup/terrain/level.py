"""Level ground."""

from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.scenarios.setup.terrain.ground import Ground, TerrainKind


class FlatKind(TerrainKind):
    """The bare ground plane."""

    name = "flat"

    def build(self, ground: Ground) -> Terrain:
        """See `TerrainKind`."""
        return flat(ground.keys.friction)


FLAT = FlatKind()
