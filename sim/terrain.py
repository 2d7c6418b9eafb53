"""Terrain as data turned into MJCF geoms.

Terrain has contype 1 and conaffinity 0, robots 2 and 3: a robot touches the terrain and itself, nothing else touches.
Priority 1 makes MuJoCo take friction and contact stiffness from the terrain alone instead of the larger of the two.
"""

from xml.etree import ElementTree

from surefoot.models.mjcf import numbers
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.similarity import REFERENCE_SIZE, Similarity

GROUND = "ground"
"""Name of the ground plane's geom; boxes are `terrain_0`, `terrain_1`, ..."""


SETTLING, SINKING = 0.01, 0.0001
"""Time constant of the ground [s] and depth over which it grows rigid [m], for the reference robot: 5 ms critically
damped, so that a standing sole sinks in by a tenth of a millimetre."""

IMPEDANCE = 0.9, 0.95
"""Impedance of a contact, at its first touch and at that depth [-]; MuJoCo's own.

Its contacts leave out J' v, what a sole is accelerated by with its joints' velocities alone, which shifts the depth at
which the sole bears a load. That depth grows with what the impedance lacks of 1: at 0.95 soles unloaded to 200 N came
up out of contact for a step.
"""


def add_terrain(worldbody: ElementTree.Element, terrain: Terrain, size: Similarity = REFERENCE_SIZE) -> None:
    """Add the ground plane and the boxes to a worldbody element, as stiff for the size of the robot as for others."""
    surface = {
        "contype": "1",
        "conaffinity": "0",
        "condim": "3",
        "priority": "1",
        "group": "0",
        "friction": _friction(terrain.friction),
        "solref": f"{SETTLING * size.time!r} 1",
        "solimp": numbers((*IMPEDANCE, SINKING * size.length)),
    }
    plane = {"name": GROUND, "type": "plane", "size": "0 0 1", "material": "floor"}
    place = {"pos": numbers((0.0, 0.0, terrain.plane))} if terrain.plane != 0.0 else {}
    ElementTree.SubElement(worldbody, "geom", {**plane, **place, **surface})
    for index, box in enumerate(terrain.boxes):
        shape = {
            "name": f"terrain_{index}",
            "type": "box",
            "pos": numbers(box.center),
            "xyaxes": numbers(_axes(box)),
            "size": numbers(box.half_size),
            "material": "step",
        }
        own = {} if box.friction is None else {"friction": _friction(box.friction)}
        ElementTree.SubElement(worldbody, "geom", {**shape, **surface, **own})


def _friction(coefficient: float) -> str:
    """Friction of a geom that neither spins nor rolls with friction."""
    return numbers((coefficient, 0.0, 0.0))


def _axes(box: Box) -> list[float]:
    """First two columns of the rotation, as MJCF wants them."""
    return [float(value) for value in box.rotation[:, :2].T.flat]
