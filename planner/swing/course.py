"""The course of a swing foot over edges: the times of its glide and of its apex, so that the whole sole is clear."""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.geometry.plane import sole_pose
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Array, Foot, Footstep

EDGE_CLEARANCE = 0.02
"""Height of every part of the sole above ground that is neither its lift-off nor its landing place [m]."""

EDGE_DISTANCE = 0.003
"""The sole is taken as larger by this on every side, so that it passes risers at a distance [m]."""

_STARTS = (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35)
"""Shares of a swing at which its way over the ground may begin, so that it first rises before a riser [-]."""

_ENDS = (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65)
"""Shares at which it may end, so that it then sinks beside one [-]."""

_GLIDES = tuple(product(_STARTS, _ENDS))
_APEXES = (0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7)
"""Shares at which it may be highest: the nearer to an edge, the lower [-]."""

_FINER = np.ldexp(1.0 / 80, [-4, -3, -2, -1])
_WAY = np.sort(np.concatenate((np.linspace(0.0, 1.0, 81), _FINER, 1.0 - _FINER)))
"""Shares of the way at which the ground is looked at; denser near both ends, where a riser may be close [-]."""

_INSTANTS = 200
"""Instants of a swing at which its way is compared with the ground: steps of half a centimetre [-]."""

_LEVEL = 1e-3
"""Difference of height, of the reference robot, up to which ground is level, as its boxes are rounded [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """The ground that steps are placed on, and the soles that are placed on it.

    Attributes:
        terrain: the ground as the planner believes it to be.
        half_size: half of the sole's length and width, shape (2,) [m].
        parameters: of the planner.
    """

    terrain: Terrain
    half_size: Array
    parameters: PlannerParameters


def swing_course(
    number: int, leaving: Footstep, landing: Footstep, samples: float, clearance: float, ground: Ground
) -> SwingCourse:
    """Course of a step.

    On level ground the foot glides all the time and is highest when the parameters say. Where edges are in the way it
    takes the gentlest course that clears them: the one with the least sum of peak accelerations.

    Args:
        number: of the step, from 1.
        leaving: foothold that its foot leaves.
        landing: where it lands.
        samples: duration of single support [samples].
        clearance: least height of the apex above lift-off and touchdown [m].
        ground: what lies before the foot, and the apex of a swing over level ground.

    Raises:
        ParameterError: no course clears the edges of the step.
    """
    terrain, parameters = ground.terrain, ground.parameters
    plain = SwingCourse(parameters.apex_share, 0.0, 1.0, clearance)
    if not terrain.has_edges:
        return plain
    start, end = (sole_pose(place.position, place.yaw, place.normal) for place in (leaving, landing))
    length = parameters.size.length
    needed = _ground(start, end, terrain, ground.half_size, length)
    if np.ptp(needed) <= _LEVEL * length:
        return plain
    course = _gentlest(start, end, needed, clearance, samples, parameters)
    if course is None:
        what = f"footstep {number} cannot be swung {EDGE_CLEARANCE * length:g} m clear of the edges before it"
        raise ParameterError(("terrain",), what, "put the edges farther apart, or give the swing more height")
    return course


def _ground(start: Array, end: Array, terrain: Terrain, half_size: Array, length: float) -> Array:
    """Least height of the sole's centre around each point of its way, on which it turns too, shape (89,) [m]."""
    sides = (-1.0, -0.5, 0.0, 0.5, 1.0)
    outline = (half_size + EDGE_DISTANCE * length) * np.array(
        [(u, v) for u, v in product(sides, sides) if max(abs(u), abs(v)) == 1.0]
    )
    poses = start + _WAY[:, None] * (end - start)
    spread = np.array([outline @ sole_rotation(*pose[3:].tolist())[:, :2].T for pose in poses])
    points = poses[:, None, :2] + spread[:, :, :2]
    heights = terrain.heights(points.reshape(-1, 2)).reshape(spread.shape[:2])
    needed = np.max(heights - spread[:, :, 2], axis=1)
    level = _LEVEL * length
    at_home = _on_face(points, heights, start, level) | _on_face(points, heights, end, level)
    needed = np.where(at_home, needed, needed + EDGE_CLEARANCE * length)
    # An edge may lie anywhere between two points.
    around = np.maximum(needed, np.maximum(np.append(needed[1:], -np.inf), np.append(-np.inf, needed[:-1])))
    around[[0, -1]] = start[2], end[2]
    return np.asarray(around)


def _on_face(points: Array, heights: Array, pose: Array, level: float) -> NDArray[np.bool_]:
    """Return true if all ground under a sole, points (n, k, 2) of heights (n, k), is the plane of its pose, (n,)."""
    normal = sole_rotation(*pose[3:].tolist())[:, 2]
    above = heights - pose[2] + (points - pose[:2]) @ (normal[:2] / normal[2])
    return np.asarray(np.max(np.abs(above), axis=1) < level)


def _gentlest(
    start: Array, end: Array, ground: Array, clearance: float, samples: float, parameters: PlannerParameters
) -> SwingCourse | None:
    """The gentlest course above the ground, None if there is none.

    Courses are looked at as trajectories that are flown. Their height follows from the apex alone, and their way over
    the ground from the glide alone, so that one trajectory for each apex and each glide tells of all pairs.
    """
    higher = max(float(start[2]), float(end[2]))
    top = max(higher + clearance, float(ground.max()))
    rises = [SwingCourse(apex, *_GLIDES[0], top - higher) for apex in _APEXES]
    height = np.array([_flown(start, end, course, samples, parameters)[:, 2] for course in rises])
    needed = np.interp(_shares(samples, parameters), _WAY, ground) - _LEVEL * parameters.size.length
    clear = np.all(height[:, None] >= needed[None], axis=2)
    up, down, way = top - float(start[2]), top - float(end[2]), float(np.hypot(*(end - start)[:2]))
    apex, glide = np.array(_APEXES), np.array(_GLIDES)
    effort = (up / apex**2 + down / (1.0 - apex) ** 2)[:, None] + way / (glide[:, 1] - glide[:, 0]) ** 2
    effort[~clear] = np.inf
    a, g = np.unravel_index(np.argmin(effort), effort.shape)
    return SwingCourse(_APEXES[a], *_GLIDES[g], top - higher) if clear[a, g] else None


def _shares(samples: float, parameters: PlannerParameters) -> Array:
    """Share of the way over the ground that each glide has done, of any step, shape (64, 200)."""
    ahead = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    courses = [SwingCourse(_APEXES[0], *glide, 0.0) for glide in _GLIDES]
    return np.array([_flown(np.zeros(6), ahead, course, samples, parameters)[:, 0] for course in courses])


def _flown(start: Array, end: Array, course: SwingCourse, samples: float, parameters: PlannerParameters) -> Array:
    """Positions of a swing on a course from its lift-off to its touchdown, shape (200, 6).

    It comes to rest there, as if the touchdown had no speed: with it the sole is higher by part of a millimetre.
    """
    at_rest = replace(parameters, search=replace(parameters.search, touchdown_speed=0.0))
    swing = start_swing(Foot.LEFT, (start, end), (0.0, samples), course, at_rest)
    return swing.positions(np.linspace(0.0, swing.touchdown_time, _INSTANTS))
