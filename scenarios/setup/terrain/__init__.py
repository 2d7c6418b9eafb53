"""The kinds of terrain that a scenario may name: what their keys mean, and what makes them impossible."""

from typing import TYPE_CHECKING

from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.plugins import Registry
from surefoot.scenarios.setup.terrain.blocks import BlocksKind
from surefoot.scenarios.setup.terrain.kind import TerrainKind
from surefoot.scenarios.setup.terrain.slope import SlopeKind
from surefoot.scenarios.setup.terrain.stairs import StairsKind

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft


class FlatKind(TerrainKind):
    """The bare ground plane."""

    name = "flat"

    def build(self, draft: "Draft") -> Terrain:
        """See `TerrainKind`."""
        return flat(draft.keys.terrain.friction)


_OWN: tuple[TerrainKind, ...] = (FlatKind(), StairsKind(), BlocksKind(), SlopeKind())

KINDS = Registry("surefoot.terrains", TerrainKind, {kind.name: kind for kind in _OWN})
"""Every kind of terrain by its name: these, and those of other packages (see `surefoot.plugins`)."""

__all__ = ["KINDS", "TerrainKind"]
