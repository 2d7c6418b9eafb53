"""The refusal of walks before they are walked: of heights and durations, and of steps that are not yet in sight."""

from dataclasses import replace

import numpy as np

from surefoot.errors import ParameterError, at_least
from surefoot.planner.references.com_height import (
    STEEPEST_FALL,
    HeightProfile,
    Rise,
    shortest_support,
)
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import GaitSource
from surefoot.planner.swing.trajectory import FEWEST_SWING_SAMPLES
from surefoot.planner.types import Array

_AT_ONCE = 2000
"""Samples of a walk that are checked together, so that a long one takes no more memory [-]."""

_DISTINCT = 6
"""Equal steps on bare ground after which all that follow are as those before: the first, one of each foot,
the last [-]."""


def check_walk(schedule: Schedule, height_profile: HeightProfile) -> None:
    """Refuse a gait of which `WalkingPlanner` would refuse a step while it walks.

    Args:
        schedule: of the planner before its first plan; steps that it has laid out are not laid again.
        height_profile: vertical CoM motion.

    Raises:
        ParameterError: see `WalkingPlanner`.
    """
    schedule, gait = schedule.with_steps(schedule.steps[:2], stands=True), schedule.gait
    if not gait.bouts and not schedule.ground.terrain.has_edges:
        gait = replace(gait, steps=min(gait.steps, _DISTINCT))
    schedule = replace(schedule, gait=gait, source=GaitSource(gait))
    clock, last = 0, 0.0
    while clock <= last:
        schedule = schedule.extended(clock + _AT_ONCE)
        samples = schedule.samples(np.arange(clock, clock + _AT_ONCE, dtype=np.float64))
        check_height(height_profile, gait, samples, schedule.support_points[:, 2])
        clock += _AT_ONCE - 2
        last = schedule.phases[-1].start
        schedule = schedule.forgotten(clock)


def check_height(profile: HeightProfile, gait: GaitParameters, samples: PhaseSamples, support_height: Array) -> None:
    """Refuse a height that the body could only follow by nearly free fall, or that goes into the ground.

    Args:
        profile: law of the height.
        gait: the walk.
        samples: its phases over a window.
        support_height: heights of the support points in sight, shape (m,) [m].

    Raises:
        ParameterError: names the acceleration or the height that is out of bounds. The impulses of an impulsive law
            last a sample and depend on its length; they are not refused.
    """
    step = np.append(np.diff(support_height), 0.0)[samples.index]
    ground = support_height[samples.index] + samples.fraction * step
    height = profile.height(gait, samples, support_height)[:, 1:-1]
    lowest = float(np.min(height[0] - ground[1:-1]))
    if lowest <= 0.0:
        what = f"the CoM comes within {lowest:.2f} m of the ground under it"
        raise ParameterError(("gait", "com_height"), what, "it must stay above it")
    fall = float(np.min(height[2]))
    if fall < -STEEPEST_FALL and not profile.impulsive:
        in_double = getattr(profile, "rise", Rise.DOUBLE) is Rise.DOUBLE
        support = "double_support" if in_double else "single_support"
        remedy = f"give {support.replace('_', ' ')} more time" + in_double * ", or let the CoM rise in single support"
        what = f"the CoM falls off with {-fall:.1f} m/s^2 where two footsteps differ in height"
        raise ParameterError(("gait", support), what, f"{STEEPEST_FALL:.1f} m/s^2 is the most; {remedy}")


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
            raise ParameterError(
                ("command", name), f"{name} {value:g} s is too short", f"{at_least(least)} s is the least"
            )
