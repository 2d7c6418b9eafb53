"""A step: its footstep on the ground that there is, and what its swing over that takes."""

import math
from dataclasses import dataclass, replace

import numpy as np

from surefoot.planner.geometry import frame_rotation
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.course import swing_course
from surefoot.planner.swing.trajectory import SwingCourse, SwingTrajectory, start_swing, swing_times
from surefoot.planner.types import Array, Foot, Footstep
from surefoot.planner.walk.footsteps import Path
from surefoot.planner.walk.gait import GaitParameters, Stride


@dataclass(frozen=True, slots=True)
class Step:
    """A step in sight.

    Attributes:
        number: in the walk, from 1.
        stride: what it does to the path.
        path: where the nominal path comes to with it.
        place: its nominal footstep.
        climb: height of that above where its foot nominally stood before [m].
        lift: by which the lower of both feet, which the body follows, is higher with it than before [m].
        room: by which it may land elsewhere on its face, least and greatest way in its own heading, shape (2, 2) [m].
        course: of its swing over the ground.
        swing: that swing to a footstep one metre ahead, in its own time.
        hardest: greatest acceleration of its foot over edges, times the square of its duration; zero without edges [m].
    """

    number: int
    stride: Stride
    path: Path
    place: Footstep
    climb: float
    lift: float
    room: Array
    course: SwingCourse
    swing: SwingTrajectory
    hardest: float = 0.0

    def beside(self, shift: Array, terrain: Terrain) -> Footstep:
        """The footstep so far from its place as its face goes.

        Args:
            shift: world frame, shape (2,) [m].
            terrain: gives its height and normal there.
        """
        place = self.place
        if not terrain.free_footholds:
            axes = frame_rotation(place.yaw)
            shift = axes @ np.clip(shift @ axes, *self.room)
        xy = place.position[:2] + shift
        return replace(place, position=np.append(xy, terrain.heights(xy[None])), normal=terrain.normals(xy[None])[0])


@dataclass(frozen=True, slots=True)
class Ground:
    """What a queue needs to lay steps.

    Attributes:
        terrain: the ground as the planner believes it to be.
        half_size: half of the sole's length and width, shape (2,) [m].
        parameters: of the planner.
    """

    terrain: Terrain
    half_size: Array
    parameters: PlannerParameters


def lay(stride: Stride, before: tuple[Step, Step], gait: GaitParameters, single: float, ground: Ground) -> Step:
    """The step after two others.

    Args:
        stride: what it does to the path.
        before: the last step of its foot, and that of the other one.
        gait: gives the feet and the swing height.
        single: duration of its single support [samples].
        ground: on which it is laid.

    Raises:
        ParameterError: no swing clears the edges before it.
    """
    (start, stance), parameters, terrain = (step.place for step in before), ground.parameters, ground.terrain
    number = before[1].number + 1
    foot = gait.step_foot(number)
    path, xy = before[1].path.advanced(stride, foot)
    position, normal = np.append(xy, terrain.heights(xy[None])), terrain.normals(xy[None])[0]
    place = Footstep(foot, position, path.yaw, normal)
    course = swing_course(number, start, place, single, terrain, ground.half_size, gait.swing_height, parameters)
    to, off, other = (float(one.position[2]) for one in (place, start, stance))
    # The start feet are measured, which may be a few nanometres off the ground.
    climb, lift = round(to - off, 6), round(min(to, other) - min(other, off), 6)
    swing = unit_swing(single, climb, course, parameters)
    way, over_edges = math.dist(xy, start.position[:2]), climb != 0.0 and not terrain.free_footholds
    room = terrain.room(position, path.yaw, ground.half_size, parameters.size.length)
    hardest = _hardest(swing, way) if over_edges else 0.0
    return Step(number, stride, path, place, climb, lift, room, course, swing, hardest)


def _hardest(swing: SwingTrajectory, way: float) -> float:
    """Greatest acceleration of a unit swing over so much way, times the square of its duration [m]."""
    instants = np.linspace(0.0, swing.touchdown_time, 60, endpoint=False)
    bends = np.abs([swing.evaluate(at)[2, [0, 2]] for at in instants.tolist()]).max(axis=0)
    return float((bends * (way, 1.0)).max()) * swing.touchdown_time**2


def unit_swing(samples: float, climb: float, course: SwingCourse, parameters: PlannerParameters) -> SwingTrajectory:
    """A swing of so many samples from the origin at time 0 to a footstep one metre ahead that lies higher [m]."""
    end, times = np.array([1.0, 0.0, climb, 0.0, 0.0, 0.0]), swing_times(0.0, samples, course, parameters)
    return start_swing(Foot.LEFT, np.zeros(6), end, times, course.height, parameters)
