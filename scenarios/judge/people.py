"""Metrics of how much hips, knees and ankles move as those of people: over a stride, beside curves of people.

The curves are means and deviations of 15 healthy adults who walked at their own speed, about 1.3 m/s. They are rounded
to a degree here, from the means that `myogait` 0.9.2 (MIT licence) has of the data set BioCV (Evans et al. 2024,
University of Bath, doi 10.15125/BATH-01258). That data set itself is for research only, and no part of it is here.
Slower people bend and stretch less than these.
"""

from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import rotations
from surefoot.scenarios.judge.body import leg
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.feet import STANCE_READS
from surefoot.scenarios.judge.metric import metric, reduction
from surefoot.scenarios.judge.strides import knee_bends, steady

HIP = (
    (22, 20, 19, 18, 14, 9, 4, -1, -5, -9, -13, -16, -18, -19, -18, -14, -6, 2, 9, 15, 19, 22, 22, 21, 20),
    (7, 7, 7, 7, 7, 6, 6, 5, 5, 4, 4, 4, 4, 4, 5, 6, 6, 6, 5, 5, 4, 4, 4, 4, 4),
)
KNEE = (
    (5, 8, 14, 20, 19, 16, 13, 10, 7, 5, 5, 6, 8, 14, 24, 38, 51, 61, 64, 61, 53, 41, 25, 9, 4),
    (6, 4, 6, 7, 8, 7, 5, 4, 3, 3, 3, 3, 4, 5, 6, 7, 5, 4, 4, 5, 6, 7, 7, 5, 3),
)
ANKLE = (
    (7, -1, -4, -1, 2, 4, 5, 6, 7, 8, 10, 12, 13, 12, 5, -9, -19, -15, -8, -3, 1, 3, 3, 4, 5),
    (8, 6, 5, 4, 4, 4, 4, 3, 3, 3, 4, 5, 5, 6, 8, 9, 7, 5, 5, 4, 3, 3, 3, 4, 3),
)
"""Flexion of people's joints, mean and deviation, at every 4 % of a stride from the landing of the foot on [deg]."""

DEVIATIONS = 2.0
"""Deviations from people's mean within which a joint is like theirs: 95 of 100 people are [-]."""

POINTS = 100
"""Instants of a stride at which it is held against people's [-]."""

MISFIT = 0.05
"""Deviation of an ankle's angle from what hip, knee and sole leave for it, above which a leg is not known [rad]."""


class Curves(NamedTuple):
    """Flexion of hip, knee and ankle over a stride, from the landing of the foot on, shape (3, 100) [rad]."""

    robot: Array
    people: Array
    deviation: Array


def people() -> tuple[Array, Array]:
    """Mean and deviation of people's hip, less its own mean, knee and ankle, shape (3, 100) each [rad]."""
    known = np.radians(np.array([HIP, KNEE, ANKLE], dtype=np.float64))
    at, count = np.linspace(0.0, 1.0, POINTS, endpoint=False), known.shape[2]
    ends = np.arange(count + 1) / count
    curves = np.array([[np.interp(at, ends, (*row, row[0])) for row in joint] for joint in known])
    curves[0, 0] -= curves[0, 0].mean()
    return curves[:, 0], curves[:, 1]


@reduction("/truth", "/measurement")
def leg_angles(run: RunView) -> Array:
    """Pitch of both soles against the base, heel up, then the angles of all joints, shape (n, 2 + nj) [rad]."""
    base, position = rotations(run.field("/truth", "q")[:, 3:7]), run.field("/measurement", "joint_position")
    pitches = []
    for foot in (0, 1):
        ahead = np.einsum("nji,nj->ni", base, rotations(run.sole(foot)[:, 3:])[:, :, 0])
        pitches.append(np.arctan2(-ahead[:, 2], ahead[:, 0]))
    return np.column_stack((*pitches, position))


def _hip(run: RunView, foot: int, ticks: NDArray[np.intp]) -> Array | None:
    """Flexion of a hip at some ticks, but for where it is zero, shape (k,) [rad]; None where no joint fits.

    With the knee's K and the sole's pitch θ against the base, hip and ankle flex by H + D = K - θ. Of the joints before
    the knee the hip's is the one that leaves for D what a joint behind the knee does.
    """
    angles, knee = run.reduced(leg_angles)[ticks], run.knees[foot]
    chain = leg(run.constants.joint_names, run.constants.roles, ("left", "right")[foot])
    both = run.reduced(knee_bends)[ticks, foot] - angles[:, foot]
    above, below = ([j for j in chain if (j < knee) is before and j != knee] for before in (True, False))
    fits = [
        (float(np.std(both - hip * angles[:, 2 + h] - ankle * angles[:, 2 + a])), h, hip)
        for h, a, hip, ankle in product(above, below, (1.0, -1.0), (1.0, -1.0))
    ]
    misfit, joint, sign = min(fits, default=(np.inf, 0, 0.0))
    return np.asarray(sign * angles[:, 2 + joint]) if misfit < MISFIT else None


def curves(run: RunView) -> Curves | None:
    """Hip, less its mean, knee and ankle of the steady strides, in the mean of both legs; None without any."""
    found, shares = [], np.linspace(0.0, 1.0, POINTS, endpoint=False)
    for foot in (0, 1) if len(run.knees) == 2 else ():
        begins = [int(stance.ticks[0]) for stance in run.once(steady) if stance.foot == foot]
        if len(begins) < 2:
            continue
        ticks = np.arange(begins[0], begins[-1] + 1, dtype=np.intp)
        hip, knee = _hip(run, foot, ticks), run.reduced(knee_bends)[ticks, foot]
        if hip is None:
            return None
        flexions = np.stack((hip, knee, knee - run.reduced(leg_angles)[ticks, foot] - hip))
        for begin, end in pairwise(begins):
            at = begin + shares * (end - begin)
            found.append([np.interp(at, ticks, flexion) for flexion in flexions])
    if not found:
        return None
    robot = np.mean(found, axis=0)
    robot[0] -= robot[0].mean()
    return Curves(robot, *people())


@metric(
    shown=(100.0, "% of a stride"), size=3, reads=STANCE_READS, reduces=(knee_bends, leg_angles), body=True, least=0.0,
    most=1.0, tolerance=(0.03, 0.0),
)  # fmt: skip
def human_share(run: RunView) -> list[float] | None:
    """Share of a stride in which hip, less its mean, knee and ankle are within two deviations of people's [-]."""
    found = run.once(curves)
    if found is None:
        return None
    alike = np.abs(found.robot - found.people) <= DEVIATIONS * found.deviation
    return [float(np.mean(joint)) for joint in alike]


@metric(
    size=3, reads=STANCE_READS, reduces=(knee_bends, leg_angles), body=True, least=-1.0, most=1.0, tolerance=(0.02, 0.0)
)
def human_correlation(run: RunView) -> list[float] | None:
    """Correlation of hip, knee and ankle over a stride with those of people [-]."""
    found = run.once(curves)
    if found is None:
        return None
    return [float(np.corrcoef(robot, human)[0, 1]) for robot, human in zip(found.robot, found.people, strict=True)]
