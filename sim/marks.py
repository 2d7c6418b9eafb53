"""Marks drawn into a picture beside what is simulated: points, arrows and lines."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco

Array = NDArray[np.float64]

EMISSION = 0.35
"""Share of a mark's colour that shows in shadow too."""


@dataclass(frozen=True, slots=True)
class Mark:
    """One mark.

    Attributes:
        kind: what it is.
        color: red, green and blue from 0 to 1.
        size: radius of a point or line, or of an arrow's shaft [m].
        ends: in the world: place of a point, tail and head of an arrow, ends of a line, shape (1 or 2, 3) [m].
    """

    kind: Literal["point", "arrow", "line"]
    color: tuple[float, float, float]
    size: float
    ends: Array


_SHAPES = {
    "point": mujoco.mjtGeom.mjGEOM_SPHERE,
    "arrow": mujoco.mjtGeom.mjGEOM_ARROW,
    "line": mujoco.mjtGeom.mjGEOM_CAPSULE,
}


def draw(scene: mujoco.MjvScene, marks: Iterable[Mark]) -> None:
    """Add marks to a scene that was just updated; those that do not fit in are left out."""
    geoms = scene.geoms  # every access makes a list of all of them
    for mark in marks:
        if scene.ngeom >= scene.maxgeom:
            return
        geom = geoms[scene.ngeom]
        scene.ngeom += 1
        shape = _SHAPES[mark.kind].value
        size, color = np.full(3, mark.size), np.array([*mark.color, 1.0], dtype=np.float32)
        mujoco.mjv_initGeom(geom, shape, size, mark.ends[0], np.eye(3).ravel(), color)
        if mark.kind != "point":
            tail, head = mark.ends
            # The engine draws an arrow half as long as the connector says.
            reach = 2.0 * (head - tail) if mark.kind == "arrow" else head - tail
            mujoco.mjv_connector(geom, shape, mark.size, tail, tail + reach)
        geom.emission = EMISSION
