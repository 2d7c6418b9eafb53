"""How a walk begins: its schedule, laid out, which is kept for run after run of a campaign that begins alike."""

import math
import pickle
from dataclasses import dataclass, field
from functools import lru_cache

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import FeetState


@dataclass(frozen=True, slots=True)
class _Beginning:
    """What a schedule begins with, equal to one in which every number is the same."""

    numbers: bytes
    window: float
    gait: GaitParameters = field(compare=False)
    feet: FeetState = field(compare=False)
    ground: Ground = field(compare=False)


def begun(gait: GaitParameters, feet: FeetState, ground: Ground, window: float = 0.0) -> Schedule:
    """The laid-out schedule of a robot that stands, the same object for equal arguments.

    Args:
        gait: as of `Schedule.start`.
        feet: likewise.
        ground: likewise.
        window: how far the plans of its first phase look ahead, all of which is in sight [samples].

    Raises:
        ParameterError: see `Schedule.extended`.
    """
    if type(ground.terrain) is not Terrain:  # of one that others made nobody knows what it depends on
        return _seen(gait, feet, ground, window)
    told = gait, feet.position, feet.yaw, ground.half_size, ground.parameters, ground.terrain
    return _begun(_Beginning(pickle.dumps(told), window, gait, feet, ground))


@lru_cache(maxsize=4)
def _begun(beginning: _Beginning) -> Schedule:
    return _seen(beginning.gait, beginning.feet, beginning.ground, beginning.window)


def _seen(gait: GaitParameters, feet: FeetState, ground: Ground, window: float) -> Schedule:
    schedule = Schedule.start(gait, feet, ground).laid_out()
    return in_sight(schedule, 0.0, window) if window else schedule


def in_sight(schedule: Schedule, now: float, window: float) -> Schedule:
    """The schedule with all that a plan of the phase at an instant may look at over a window; errors as of `extended`.

    Args:
        schedule: the steps in sight so far.
        now: the instant [samples].
        window: how far a plan looks ahead [samples].
    """
    schedule = schedule.extended(now + window, now)
    end = schedule.phase(now).end
    return schedule.extended(end + window, now) if end < math.inf else schedule
