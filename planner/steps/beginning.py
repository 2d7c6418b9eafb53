"""How a walk begins: its schedule, laid out, which is kept for run after run of a campaign that begins alike."""

import pickle
from dataclasses import field
from functools import lru_cache

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import FeetState
from surefoot.values import dataclass


@dataclass(frozen=True, slots=True)
class _Beginning:
    """What a schedule begins with, equal to one in which every number is the same."""

    numbers: bytes
    gait: GaitParameters = field(compare=False)
    feet: FeetState = field(compare=False)
    ground: Ground = field(compare=False)


def begun(gait: GaitParameters, feet: FeetState, ground: Ground) -> Schedule:
    """The laid-out schedule of a robot that stands, the same object for equal arguments, which are those of `start`.

    Raises:
        ParameterError: see `Schedule.start`.
    """
    if type(ground.terrain) is not Terrain:  # of one that others made nobody knows what it depends on
        return Schedule.start(gait, feet, ground).laid_out()
    told = gait, feet.position, feet.yaw, ground.half_size, ground.parameters, ground.terrain
    return _begun(_Beginning(pickle.dumps(told), gait, feet, ground))


@lru_cache(maxsize=4)
def _begun(beginning: _Beginning) -> Schedule:
    return Schedule.start(beginning.gait, beginning.feet, beginning.ground).laid_out()
