"""Values of what is drawn: forces as arrows, soles and polygons as outlines."""

import math

import numpy as np
from numpy.typing import NDArray

from planner.plan import WalkPlan
from planner.types import Footstep
from scenarios.viewer.templates import LOOPS

Array = NDArray[np.float64]

METRES_PER_NEWTON = 1e-3
"""Length of a force's arrow over the force."""

LIFT = 0.002
"""Outlines are drawn this far above the ground, so that they are not hidden by it [m]."""

_VERTICES = sum(vertices for _, vertices, _ in LOOPS)

NOWHERE = (0.0, 0.0, -1000.0)
"""Where a point is drawn that does not exist now, such as the ZMP of a robot in flight; out of sight [m]."""


def force_arrow(origin: Array, force: Array) -> tuple[float, ...]:
    """Values of an arrow: x y z [m], qx qy qz qw of the rotation that takes x to the force, length [m].

    Args:
        origin: where the force acts, world frame, shape (3,) [m].
        force: world frame, shape (3,) [N].
    """
    x, y, z = force.tolist()
    size = math.sqrt(x * x + y * y + z * z)
    if not size > 0.0:
        return (*origin.tolist(), 0.0, 0.0, 0.0, 1.0, 0.0)
    # Half-way rotation from x to the unit force d: q ~ (x cross d, 1 + x . d); straight back turns about z.
    w = 1.0 + x / size
    turn = (0.0, 0.0, 1.0, 0.0) if w < 1e-9 else (0.0, -z / size, y / size, w)
    norm = math.sqrt(sum(part * part for part in turn))
    return (*origin.tolist(), *(part / norm for part in turn), METRES_PER_NEWTON * size)


class Outlines:
    """The support polygon and the footsteps to come, as the values of their template.

    Attributes:
        values: x y z of every vertex of `LOOPS`, flat [m].
        ground: height of the lower foothold [m].
    """

    def __init__(self, half_length: float, half_width: float) -> None:
        """For soles of this half size [m]."""
        self._corners = [(a * half_length, b * half_width) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        self.values: list[float] = []
        self.ground = 0.0

    def update(self, plan: WalkPlan) -> None:
        """Take over a plan; a footstep that is not there shrinks to a point of the last one."""
        self.ground = min(float(foot.position[2]) for foot in plan.footholds)
        height, polygon = self.ground + LIFT, plan.support_polygon.tolist()
        vertices = [(x, y, height) for x, y in polygon]
        vertices += vertices[-1:] * (LOOPS[0][1] - len(polygon))
        for step in plan.footsteps:
            vertices += self._outline(step.footstep)
        vertices += vertices[-1:] * (_VERTICES - len(vertices))
        self.values = [part for vertex in vertices for part in vertex]

    def _outline(self, footstep: Footstep) -> list[tuple[float, float, float]]:
        """Corners of a sole."""
        x, y, z = footstep.position.tolist()
        c, s = math.cos(footstep.yaw), math.sin(footstep.yaw)
        slope_x, slope_y = (-footstep.normal[:2] / footstep.normal[2]).tolist()
        offsets = [(c * a - s * b, s * a + c * b) for a, b in self._corners]
        return [(x + u, y + v, z + slope_x * u + slope_y * v + LIFT) for u, v in offsets]
