"""Metrics of the feet: where they land, how high they swing, how they hold."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import sole_corners
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.types import Foot, Footstep
from surefoot.scenarios.judge.body import corners, forward
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.walking import FALL_READS, fall_time, runs_of

_CLEARANCE_TICKS = 5
"""Every how many control ticks the clearance of a swing is looked at."""


@metric(unit="m", shown=(1e3, "mm"), reads={"/footstep": ("planned", "actual")}, body=True)
def footstep_error_max(run: RunView) -> float | None:
    """Largest distance of a sole at touchdown from its footstep as last planned [m]."""
    steps = run.log["/footstep"]
    errors = np.linalg.norm(steps.field("actual")[:, :3] - steps.field("planned")[:, :3], axis=1)
    return float(errors.max())


@metric(unit="m", shown=(1e3, "mm"), reads={"/footstep": ("actual",)})
def stair_edge_margin_min(run: RunView) -> float | None:
    """Least distance of a landed sole's corner from the edge of its tread, negative beyond it [m]."""
    terrain = _terrain(run)
    if not terrain.boxes:
        return None
    half_size = 0.5 * np.array([run.constants.foot_length, run.constants.foot_width])
    landed = run.log["/footstep"].field("actual")
    normals = terrain.normals(landed[:, :2])
    soles = [Footstep(Foot.LEFT, pose[:3], float(pose[3]), up) for pose, up in zip(landed, normals, strict=True)]
    placed = np.array([sole_corners(sole, half_size) for sole in soles])
    return float(terrain.edge_margins(landed[:, :2], placed).min())


@metric(unit="m", shown=(1e3, "mm"), reads={"/truth": (), "/reference": ("phase", "stance")}, body=True)
def swing_clearance_min(run: RunView) -> float | None:
    """Least height of a swing sole's corner over the ground, but for the first and last quarter of each swing [m]."""
    stance, least = run.field("/reference", "stance"), []
    for foot in range(2):
        sole = run.sole(foot)
        for start, end in runs_of(run.single_support & (stance == 1 - foot)):
            edge = (end - start) // 4
            least.append(_clearance(run, sole[start + edge : end - edge : _CLEARANCE_TICKS]))
    return min(least, default=None)


def _clearance(run: RunView, poses: Array) -> float:
    """Least height of the corners of soles with these poses, shape (n, 7), over the ground [m]."""
    flat = corners(poses, run.constants.foot_length, run.constants.foot_width).reshape(-1, 3)
    return float((flat[:, 2] - _terrain(run).heights(flat[:, :2])).min(initial=np.inf))


def _terrain(run: RunView) -> Terrain:
    """The true ground."""
    boxes = [np.array(numbers) for numbers in run.constants.boxes]
    return Terrain(tuple(Box(n[:3], n[3:6], n[6:].reshape(3, 3)) for n in boxes))


@dataclass(frozen=True, slots=True)
class Slip:
    """How far a sole moved during a stance.

    Attributes:
        foot: 0 left, 1 right.
        start: tick at which the stance began.
        tick: tick at which the sole was farthest from where it began.
        distance: horizontal distance then [m].
    """

    foot: int
    start: int
    tick: int
    distance: float


def stance_slips(run: RunView) -> list[Slip]:
    """The slip of every stance, planned and felt.

    A foot that rolls moves its sole's centre but not its toe edge, so that of the two counts which moved less.
    """
    contact = (run.field("/contact", "planned") != 0) & (run.field("/contact", "felt") != 0)
    slips = []
    for foot in range(2):
        sole = run.sole(foot)
        for start, end in runs_of(contact[:, foot]):
            centre = sole[start:end, :2]
            toe = centre + 0.5 * run.constants.foot_length * forward(sole[start:end, 3:])
            moved = [np.linalg.norm(at - at[0], axis=1) for at in (centre, toe)]
            distance = np.minimum(*moved)
            farthest = int(np.argmax(distance))
            slips.append(Slip(foot, start, start + farthest, float(distance[farthest])))
    return slips


@metric(unit="m", shown=(1e3, "mm"), reads={"/truth": (), "/contact": ("planned", "felt")}, body=True)
def foot_slip_max(run: RunView) -> float | None:
    """Largest horizontal distance of a sole from where its stance began, over all stances [m]."""
    return max((slip.distance for slip in stance_slips(run)), default=None)


@metric(unit="s", needs=("/truth",), reads={**FALL_READS, "/truth": (*FALL_READS["/truth"], "self_contact")}, body=True)
def self_contact_time(run: RunView) -> float:
    """How long the robot touched itself, before a fall [s]."""
    fallen = fall_time(run)
    touching = run.field("/truth", "self_contact") != 0
    if fallen is not None:
        touching = touching & (run.time < fallen)
    return float(np.count_nonzero(touching) / run.constants.control_rate)
