"""How a swing foot gets over edges: when it glides forward and when it is highest, so that the whole sole is clear."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from planner.footsteps import FootstepPlan
from planner.frames import frame_rotation
from planner.parameters import PlannerParameters
from planner.polynomial import quintic
from planner.terrain import Terrain
from planner.types import Array

EDGE_CLEARANCE = 0.02
"""Height of every part of the sole above ground that is neither its lift-off nor its landing place [m]."""

EDGE_DISTANCE = 0.005
"""The sole is taken as larger by this on every side, so that it passes risers at a distance [m]."""

_STARTS = (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35)
_ENDS = (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65)
_APEXES = (0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7)
_WAY = np.linspace(0.0, 1.0, 61)
_TIME = np.linspace(0.0, 1.0, 61)
_LEVEL = 1e-3


@dataclass(frozen=True, slots=True)
class SwingCourse:
    """How a swing divides its time, as shares of it.

    Attributes:
        apex: when the sole is highest [-].
        glide_start: when it begins to move forward, sideways and to turn [-].
        glide_end: when that is done [-].
        height: of the apex above the higher of lift-off and touchdown [m].
    """

    apex: float
    glide_start: float
    glide_end: float
    height: float


def swing_courses(
    footsteps: FootstepPlan, terrain: Terrain, half_size: Array, clearance: float, parameters: PlannerParameters
) -> tuple[SwingCourse, ...]:
    """Courses of all steps of a plan, in their order.

    On level ground the foot glides all the time and is highest when the parameters say. Where edges are in the way it
    takes the gentlest course that clears them: the one with the least sum of peak accelerations.

    Args:
        footsteps: footholds.
        terrain: the ground as the planner believes it to be.
        half_size: half of the sole's length and width, shape (2,) [m].
        clearance: least height of the apex above lift-off and touchdown [m].
        parameters: give the apex of a swing over level ground.

    Raises:
        ValueError: no course clears the edges of a step.
    """
    plain = SwingCourse(parameters.apex_share, 0.0, 1.0, clearance)
    if not terrain.boxes:
        return (plain,) * footsteps.steps
    courses = []
    for row in range(2, footsteps.steps + 2):
        start, end = (np.append(footsteps.position[r], footsteps.yaw[r]) for r in (row - 2, row))
        course = _gentlest(start, end, _ground(start, end, terrain, half_size + EDGE_DISTANCE), plain)
        if course is None:
            raise ValueError(
                f"Footstep {row - 1} cannot be swung over the edges before it with {EDGE_CLEARANCE:g} m of clearance;"
                " give terrain.tread more depth, or gait.swing_height more height."
            )
        courses.append(course)
    return tuple(courses)


def _ground(start: Array, end: Array, terrain: Terrain, half_size: Array) -> Array:
    """Least height of the sole's centre at each point of its way, shape (61,) [m]."""
    sides = (-1.0, -0.5, 0.0, 0.5, 1.0)
    outline = half_size * np.array([(u, v) for u, v in product(sides, sides) if max(abs(u), abs(v)) == 1.0])
    poses = start + _WAY[:, None] * (end - start)
    points = np.concatenate([pose[:2] + outline @ frame_rotation(float(pose[3])).T for pose in poses])
    heights = terrain.heights(points).reshape(len(_WAY), -1)
    highest = heights.max(axis=1)
    at_home = np.ptp(heights, axis=1) < _LEVEL
    at_home &= np.minimum(abs(highest - start[2]), abs(highest - end[2])) < _LEVEL
    at_home[[0, -1]] = True
    return np.asarray(np.where(at_home, highest, highest + EDGE_CLEARANCE))


def _gentlest(start: Array, end: Array, ground: Array, plain: SwingCourse) -> SwingCourse | None:
    """The gentlest course above the ground, None if there is none."""
    if np.ptp(ground) < _LEVEL:
        return plain
    higher = max(float(start[2]), float(end[2]))
    top = max(higher + plain.height, float(ground.max()))
    up, down, way = top - float(start[2]), top - float(end[2]), float(np.hypot(*(end - start)[:2]))
    apex, glide = np.array(_APEXES), np.array(list(product(_STARTS, _ENDS)))
    height = np.array([_height(up, down, share) for share in _APEXES]) + end[2]
    needed = np.interp(_progress(glide), _WAY, ground) - _LEVEL
    clear = np.all(height[:, None] >= needed[None], axis=2)
    effort = (up / apex**2 + down / (1.0 - apex) ** 2)[:, None] + way / (glide[:, 1] - glide[:, 0]) ** 2
    effort[~clear] = np.inf
    a, g = np.unravel_index(np.argmin(effort), effort.shape)
    if not clear[a, g]:
        return None
    return SwingCourse(_APEXES[a], float(glide[g, 0]), float(glide[g, 1]), top - higher)


def _progress(glide: Array) -> Array:
    """Share of the way over a swing of unit time, for glides from start to end, shape (k, 2); shape (k, 61)."""
    s = np.clip((_TIME - glide[:, :1]) / (glide[:, 1:] - glide[:, :1]), 0.0, 1.0)
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s**2))


def _height(up: float, down: float, apex: float) -> Array:
    """Height above touchdown over a swing of unit time, as `planner.swing` shapes it, shape (61,) [m]."""
    left = 1.0 - apex
    top = np.array([[down], [0.0], [-4.0 * min(up / apex**2, down / left**2)]])
    rise = quintic(np.array([[down - up], [0.0], [0.0]]), top, apex)
    fall = quintic(top, np.zeros((3, 1)), left)
    powers = np.arange(6)
    rising, falling = _TIME[:, None] ** powers @ rise, np.maximum(_TIME - apex, 0.0)[:, None] ** powers @ fall
    return np.where(apex > _TIME, rising[:, 0], falling[:, 0])
