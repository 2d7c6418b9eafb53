"""MuJoCo world: terrain geometry, sensors, pushes, what there is to draw, and rendering."""

from surefoot.sim.errors import SimulationDiverged, WorldError
from surefoot.sim.measurement import Measurement
from surefoot.sim.pushes import Push
from surefoot.sim.world import World

__all__ = ["Measurement", "Push", "SimulationDiverged", "World", "WorldError"]
