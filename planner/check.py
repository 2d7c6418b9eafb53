"""What can be told of a walk before it begins: the rules that hold when a step comes into sight, for all of them."""

from dataclasses import replace

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import HeightProfile, check_height, shortest_support
from surefoot.planner.swing.trajectory import FEWEST_SWING_SAMPLES
from surefoot.planner.types import FeetState
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.phases import Flow
from surefoot.planner.walk.queue import Ground, StepQueue

_AT_ONCE = 2000
"""Samples of a walk that are checked together."""

_DISTINCT = 6
"""Equal steps on bare ground after which all that follow are as those before: the first, one of each foot, the last."""


def check_walk(
    gait: GaitParameters,
    feet: FeetState,
    foot_length: float,
    foot_width: float,
    terrain: Terrain,
    parameters: PlannerParameters,
    height_profile: HeightProfile,
) -> None:
    """Refuse a gait of which `WalkingPlanner` would refuse a step while it walks; arguments as there.

    Raises:
        ParameterError: see `WalkingPlanner`.
    """
    if not gait.bouts and not terrain.has_edges:
        gait = replace(gait, steps=min(gait.steps, _DISTINCT))
    queue = StepQueue(gait, feet, Ground(terrain, 0.5 * np.array([foot_length, foot_width]), parameters))
    clock, last = 0, 0.0
    while clock <= last:
        queue.extend(clock + _AT_ONCE)
        samples = queue.samples(Flow(np.arange(clock, clock + _AT_ONCE, dtype=np.float64)))
        check_height(height_profile, gait, samples, queue.support_heights)
        clock += _AT_ONCE - 2
        last = queue.phases[-1].start
        queue.enter(clock)


def check_durations(gait: GaitParameters, sample_time: float) -> None:
    """Refuse durations in which no foot swings, or in which the CoM would fall too fast from its apexes.

    Args:
        gait: the walk.
        sample_time: of the planner [s].

    Raises:
        ParameterError: a duration is too short; its key is ("command", "single_support" or "double_support").
    """
    shortest = {
        "single_support": max(FEWEST_SWING_SAMPLES * sample_time, shortest_support(gait.apex_ss)),
        "double_support": max(sample_time, shortest_support(gait.apex_ds)),
    }
    for name, least in shortest.items():
        value = getattr(gait, name)
        if value < (1.0 - 1e-9) * least:
            raise ParameterError(("command", name), f"{name} {value:g} s is too short", f"{least:.2g} s is the least")
