"""MuJoCo world: terrain geometry, sensors, pushes, what there is to draw, and rendering."""

from typing import TYPE_CHECKING

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.forces import Push
    from surefoot.sim.errors import SimulationDiverged, WorldError
    from surefoot.sim.measurement import Measurement
    from surefoot.sim.world import World

__all__ = ["Measurement", "Push", "SimulationDiverged", "World", "WorldError"]

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            "errors": ("SimulationDiverged", "WorldError"),
            "measurement": ("Measurement",),
            "pushes": ("Push",),
            "world": ("World",),
        },
    )
