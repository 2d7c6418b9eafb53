"""Metrics of strides: how feet land and leave, and how straight their legs are meanwhile.

They are of the steady steps. Those at the begin and at the end of a walk speed it up and slow it down.
"""

from itertools import pairwise

import numpy as np

from surefoot.planner.geometry.plane import corners, rotations
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.feet import STANCE_READS, Stance, stances, terrain_of
from surefoot.scenarios.judge.metric import DEG, MM, metric, reduction

UNSTEADY = 3
"""Steps at the begin and at the end of a walk that are not steady [-]."""

LANDING = 0.12
"""Time from its first load in which a foot lands, of the reference robot [s]."""

RISING = 0.01
"""Time over which the growth of a load is taken, of the reference robot [s]."""

MIDSTANCE = 0.3
"""Share of a stride, from one landing of a foot to its next, at which its leg is in the middle of its stance [-]."""

_AHEAD = (0, 3)
"""Corners of a sole at its toe edge, see `corners` [-]."""


@reduction("/measurement")
def knee_bends(run: RunView) -> Array:
    """Flexion of the left and the right knee at each tick, shape (n, 2) [rad]; NaN for legs without one knee each."""
    position = run.field("/measurement", "joint_position")
    if len(run.knees) != 2:
        return np.full((len(position), 2), np.nan)
    bend = np.abs(position[:, run.knees] - (run.constants.knee_straight or 0.0))
    return np.asarray(bend * (run.constants.knee_turn or 1.0))


def steady(run: RunView) -> list[Stance]:
    """Stances of the steady steps, in the order in which they began."""
    ordered = sorted(run.once(stances), key=lambda stance: int(stance.ticks[0]))
    # The robot stands on both feet before its first step.
    return ordered[2 + UNSTEADY : max(len(ordered) - UNSTEADY, 0)]


def _mean(values: list[float]) -> float | None:
    """Their mean; None of none, or where one is not known."""
    mean = float(np.mean(values)) if values else np.nan
    return mean if np.isfinite(mean) else None


@metric(unit="rad", shown=DEG, reads=STANCE_READS, reduces=(knee_bends,), body=True, tolerance=(0.01, 0.0))
def knee_stance_mean(run: RunView) -> float | None:
    """Mean flexion of the knee of a leg that carries load, over the steady steps [rad]."""
    knees = run.reduced(knee_bends)
    return _mean([float(knees[stance.ticks, stance.foot].mean()) for stance in run.once(steady)])


@metric(unit="rad", shown=DEG, reads=STANCE_READS, reduces=(knee_bends,), body=True, tolerance=(0.02, 0.0))
def knee_heel_strike(run: RunView) -> float | None:
    """Flexion of the knee as its foot first carries load, mean over the steady steps [rad]."""
    knees = run.reduced(knee_bends)
    return _mean([float(knees[stance.ticks[0], stance.foot]) for stance in run.once(steady)])


@metric(unit="rad", shown=DEG, reads=STANCE_READS, reduces=(knee_bends,), body=True, tolerance=(0.02, 0.0))
def knee_midstance(run: RunView) -> float | None:
    """Flexion of the knee at 30 % of the stride, mean over the steady strides [rad]."""
    knees, bends = run.reduced(knee_bends), []
    for foot in range(2):
        begins = [int(stance.ticks[0]) for stance in run.once(steady) if stance.foot == foot]
        bends += [float(knees[round(a + MIDSTANCE * (b - a)), foot]) for a, b in pairwise(begins)]
    return _mean(bends)


def _landings(run: RunView) -> list[Array]:
    """Normal force on each foot from its first load on while it lands, over the weight [-], of the steady steps."""
    force, weight = run.field("/contact", "normal_force"), run.constants.mass * GRAVITY
    count = round(LANDING * run.constants.similarity.time * run.constants.control_rate)
    return [force[stance.ticks[0] :, stance.foot][:count] / weight for stance in run.once(steady)]


@metric(shown=(1.0, "body weights"), reads=STANCE_READS, body=True, least=0.0, tolerance=(0.05, 0.05))
def landing_peak(run: RunView) -> float | None:
    """Greatest normal force on a foot while it lands, over the weight, of the steady steps [-]."""
    return max((float(load.max()) for load in run.once(_landings)), default=None)


@metric(unit="1/s", shown=(1.0, "body weights/s"), reads=STANCE_READS, body=True, least=0.0, tolerance=(5.0, 0.1))
def landing_rate(run: RunView) -> float | None:
    """Greatest growth in 10 ms of the normal force on a foot that lands, over the weight, of the steady steps [1/s]."""
    rate = run.constants.control_rate
    over = max(1, round(RISING * run.constants.similarity.time * rate))
    loads = [load for load in run.once(_landings) if len(load) > over]
    return max((float((load[over:] - load[:-over]).max()) * rate / over for load in loads), default=None)


def _pitch(run: RunView, stance: Stance, at: int) -> float:
    """Pitch of a stance's sole over the ground under it at one of its ticks, heel up positive [rad]."""
    pose = run.sole(stance.foot)[stance.ticks[at]][None]
    ahead, normal = rotations(pose[:, 3:])[0, :, 0], run.once(terrain_of).normals(pose[:, :2])[0]
    return -float(np.arcsin(np.clip(ahead @ normal, -1.0, 1.0)))


@metric(unit="rad", shown=DEG, reads=STANCE_READS, body=True, tolerance=(0.01, 0.0))
def heel_strike_pitch(run: RunView) -> float | None:
    """Pitch of a sole over the ground as it first carries load, toes up positive, mean of the steady steps [rad]."""
    return _mean([-_pitch(run, stance, 0) for stance in run.once(steady)])


@metric(unit="rad", shown=DEG, reads=STANCE_READS, body=True, tolerance=(0.02, 0.0))
def toe_off_pitch(run: RunView) -> float | None:
    """Pitch of a sole over the ground as it last carries load, heel up positive, mean of the steady steps [rad]."""
    return _mean([_pitch(run, stance, -1) for stance in run.once(steady)])


@metric(unit="m", shown=MM, reads=STANCE_READS, body=True, tolerance=(0.001, 0.0))
def toe_clearance_min(run: RunView) -> float | None:
    """Least height of a toe edge over the ground in the middle half of a swing, of the steady steps [m]."""
    least, steps = [], run.once(steady)
    for foot in range(2):
        own = [stance for stance in steps if stance.foot == foot]
        for before, after in pairwise(own):
            leaves, lands = int(before.ticks[-1]), int(after.ticks[0])
            quarter = (lands - leaves) // 4
            poses = run.sole(foot)[leaves + quarter : lands - quarter + 1]
            toes = corners(poses, run.constants.foot_length, run.constants.foot_width)[:, _AHEAD].reshape(-1, 3)
            least.append(float((toes[:, 2] - run.once(terrain_of).heights(toes[:, :2])).min()))
    return min(least, default=None)
