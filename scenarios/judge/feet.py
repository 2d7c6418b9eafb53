"""Metrics of the feet: where they land, how high they swing, how they hold."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import corners, headings, rotations, sole_corners
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.types import GRAVITY, Foot, Footstep
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.body import feet_lean
from surefoot.scenarios.judge.digest import GAIT, SENSED, Array, Mask, Rows, RunView
from surefoot.scenarios.judge.metric import DEG, MM, metric
from surefoot.scenarios.judge.placed import to_truth
from surefoot.scenarios.judge.walking import FALL_READS, fall_time, runs_of
from surefoot.wbc.body.leaning import line_centre

_CLEARANCE_TICKS = 5
"""Every how many control ticks the clearance of a swing is looked at."""


def landed(run: RunView) -> Array:
    """True place of each footstep's sole when it was booked, x y z yaw, shape (k, 4) [m, rad].

    Not ``/footstep.actual``, which is where the controller believed it. Of a leaning sole, the line on which it stands;
    of one that rolls, its centre if it lay flat about its edge.
    """
    steps = run.log["/footstep"]
    ticks, left = (
        np.minimum(run.rows_at("/truth", steps.time_ns)[0], run.ticks - 1),
        np.asarray(steps.field("foot")) == 0,
    )
    poses = np.where(left[:, None], run.sole(0)[ticks], run.sole(1)[ticks])
    places, half_width = poses[:, :3], 0.5 * run.constants.foot_width
    if feet_lean(run.constants.roles):
        turned = zip(np.where(left, 0, 1), places, rotations(poses[:, 3:]), strict=True)
        places = np.array([line_centre(int(foot), place, R, half_width) for foot, place, R in turned])
    if run.has("/reference"):
        pitch = run.field("/reference", "roll")[ticks, np.where(left, 0, 1)]
        places = places + 0.5 * run.constants.foot_length * _turned_back(rotations(poses[:, 3:]), pitch)
    return np.column_stack((places, headings(poses[:, 3:])))


def _turned_back(rotation: Array, pitch: Array) -> Array:
    """Way of a sole's centre, in half lengths, as it turns back by a pitch about its edge, shape (k, 3) [-].

    Args:
        rotation: of soles in the world, shape (k, 3, 3).
        pitch: of each, heel up about its toe edge, negative about its heel edge, shape (k,) [rad].
    """
    ahead, up = rotation[:, :, 0], rotation[:, :, 2]
    level = np.cos(pitch)[:, None] * ahead + np.sin(pitch)[:, None] * up
    return np.asarray(np.sign(pitch)[:, None] * (ahead - level))


@metric(
    unit="m",
    shown=MM,
    needs=("/truth", "/footstep", "/reference"),
    reads={"/truth": (), "/footstep": ("planned", "foot"), "/reference": ("roll",)},
    body=True,
    least=0.0,
)
def footstep_error_max(run: RunView) -> float | None:
    """Largest distance of a sole at touchdown from its footstep as last planned before it [m]."""
    steps = run.log["/footstep"]
    planned = steps.field("planned")[:, :3]
    if run.has(SENSED):
        rows = np.minimum(run.rows_at("/truth", steps.time_ns)[0], run.ticks - 1)
        planned = to_truth(run, planned, rows, np.asarray(steps.field("foot")) == 0)
    return float(np.linalg.norm(landed(run)[:, :3] - planned, axis=1).max())


@metric(
    unit="m",
    shown=MM,
    needs=("/truth", "/footstep"),
    reads={"/truth": (), "/footstep": ("foot",), "/reference": ("roll",)},
    tolerance=(0.001, 0.0),
)
def stair_edge_margin_min(run: RunView) -> float | None:
    """Least distance of a landed sole's corner from the edge of its tread, negative beyond it [m]."""
    terrain = terrain_of(run)
    if not terrain.boxes:
        return None
    half_size = 0.5 * np.array([run.constants.foot_length, run.constants.foot_width])
    poses = landed(run)
    normals = terrain.normals(poses[:, :2])
    soles = [Footstep(Foot.LEFT, pose[:3], float(pose[3]), up) for pose, up in zip(poses, normals, strict=True)]
    placed = np.array([sole_corners(sole, half_size) for sole in soles])
    return float(terrain.edge_margins(poses[:, :2], placed).min())


@metric(unit="m", shown=MM, reads={"/truth": (), GAIT: ("phase", "stance")}, body=True, tolerance=(0.001, 0.0))
def swing_clearance_min(run: RunView) -> float | None:
    """Least height of a swing sole's corner over the ground, but for the first and last quarter of each swing [m]."""
    stance, least = run.field(GAIT, "stance"), []
    for foot in range(2):
        sole = run.sole(foot)
        for start, end in runs_of(run.single_support & (stance == 1 - foot)):
            edge = (end - start) // 4
            least.append(_clearance(run, sole[start + edge : end - edge : _CLEARANCE_TICKS]))
    return min(least, default=None)


def _clearance(run: RunView, poses: Array) -> float:
    """Least height of the corners of soles with these poses, shape (n, 7), over the ground [m]."""
    flat = corners(poses, run.constants.foot_length, run.constants.foot_width).reshape(-1, 3)
    return float((flat[:, 2] - terrain_of(run).heights(flat[:, :2])).min(initial=np.inf))


def terrain_of(run: RunView) -> Terrain:
    """The true ground."""
    boxes = [np.array(numbers) for numbers in run.constants.boxes]
    return Terrain(tuple(Box(n[:3], n[3:6], n[6:].reshape(3, 3)) for n in boxes), plane=run.constants.plane)


LOADED = 0.02
"""Share of the weight from which a foot carries load, what a controller feels as ground [-]."""

DROPOUT = 0.05
"""Time for which a foot that has touched down may lose its load before it counts as back in the air [s]."""

ON_GROUND = 0.005
"""Height over the ground up to which a corner of a loaded sole is on it [m]."""


def loaded(run: RunView) -> Mask:
    """Mark the ticks at which each foot carries load, by the measured force, shape (n, 2)."""
    return np.asarray(run.field("/contact", "normal_force") > LOADED * run.constants.mass * GRAVITY)


@dataclass(frozen=True, slots=True)
class Stance:
    """A foot on the ground, from its first load to the lift-off that was planned.

    Attributes:
        foot: 0 left, 1 right.
        ticks: at which it carried load, in order, shape (k,).
    """

    foot: int
    ticks: Rows


def stances(run: RunView, until: int | None = None) -> list[Stance]:
    """Every stance that carried load, up to a tick.

    A foot that touches down before its time, in the second half of its swing, stands from then on. If it then loses its
    load for longer than a dropout, and the controller does not hold the contact, that was a graze of the swing. Where
    nothing is planned, a stance is a load without a longer dropout in it.
    """
    load = loaded(run)[:until]
    gap, found = DROPOUT * run.constants.similarity.time * run.constants.control_rate, []
    if not run.has("/reference"):
        return [Stance(foot, ticks) for foot in range(2) for ticks in _spells(load[:, foot], gap)]
    planned = run.field("/contact", "planned")[:until] != 0
    released = np.cumsum(run.field("/contact", "active")[:until] == 0, axis=0)
    for foot in range(2):
        lift = 0
        for start, end in runs_of(planned[:, foot]):
            middle = (lift + start + 1) // 2
            ticks = middle + np.flatnonzero(load[middle:end, foot])
            lost = (np.diff(ticks) > gap) & (np.diff(released[ticks, foot]) > 0)
            early = np.flatnonzero((ticks[:-1] < start) & lost)
            ticks, lift = ticks[early[-1] + 1 if len(early) else 0 :], end
            if len(ticks) and ticks[-1] >= start:
                found.append(Stance(foot, ticks))
    return found


def _spells(load: Mask, gap: float) -> list[Rows]:
    """Ticks of each load, between two of which it may be lost for so many ticks."""
    ticks = np.flatnonzero(load)
    parts = np.split(ticks, np.flatnonzero(np.diff(ticks) > gap) + 1)
    return [part for part in parts if len(part)]


@dataclass(frozen=True, slots=True)
class Slip:
    """Way of the farthest corner of a sole (0 left, 1 right) from where it came to the ground, in one stance.

    Attributes:
        foot: 0 left, 1 right.
        ticks: of the stance, shape (k,).
        way: at each of them, shape (k,) [m].
    """

    foot: int
    ticks: Rows
    way: Array

    @property
    def distance(self) -> float:
        """The greatest way of the stance [m]."""
        return float(self.way.max())

    def since(self, way: float) -> int:
        """The first tick at which the foot has slipped farther than so many metres; that of the stance if never."""
        return int(self.ticks[np.argmax(self.way > way)])


def stance_slips(run: RunView, until: int | None = None) -> list[Slip]:
    """The slip of every stance up to a tick.

    It is of those corners of the sole that are on the ground, each from where it came to it. So yaw counts, and a foot
    that rolls over one of its edges does not; a sole with no corner on the ground, as on an edge, counts by its centre.
    """
    slips, terrain = [], run.once(terrain_of)
    for stance in run.once(stances) if until is None else stances(run, until):
        poses = run.sole(stance.foot)[stance.ticks]
        points = corners(poses, run.constants.foot_length, run.constants.foot_width)
        height = points[..., 2] - terrain.heights(points[..., :2].reshape(-1, 2)).reshape(-1, 4)
        touching = height < ON_GROUND * run.constants.similarity.length
        touching = np.column_stack((touching, ~touching.any(axis=1)))
        points = np.concatenate((points, poses[:, None, :3]), axis=1)[..., :2]
        begin = points[np.argmax(touching, axis=0), np.arange(5)]
        moved = points - begin
        way = np.where(touching, np.sqrt(np.add.reduce(moved * moved, axis=2)), 0.0).max(axis=1)
        slips.append(Slip(stance.foot, stance.ticks, way))
    return slips


STANCE_READS: Reads = {"/truth": (), "/contact": ("planned", "active", "normal_force")}
"""Fields that tell the stances."""


@metric(unit="m", shown=MM, reads=STANCE_READS, body=True, least=0.0)
def foot_slip_max(run: RunView) -> float | None:
    """Largest horizontal way of a corner of a sole on the ground from where it came to it, over all stances [m]."""
    return max((slip.distance for slip in stance_slips(run)), default=None)


@metric(unit="rad", shown=DEG, reads=STANCE_READS, body=True, least=0.0)
def stance_twist_max(run: RunView) -> float | None:
    """Largest yaw of a loaded stance foot away from its yaw at first load, over all stances [rad]."""
    yaw = run.sole_yaw
    yaws = (np.unwrap(yaw[stance.ticks, stance.foot]) for stance in run.once(stances))
    return max((float(np.abs(yaw - yaw[0]).max()) for yaw in yaws), default=None)


@metric(
    unit="rad",
    shown=DEG,
    needs=tuple(STANCE_READS),
    reads={**STANCE_READS, "/reference": ("roll",)},
    body=True,
    least=0.0,
)
def stance_tilt_max(run: RunView) -> float | None:
    """Largest angle of a loaded stance sole to the ground under it [rad].

    Only sideways while it is planned to roll; only ahead of a foot that no joint rolls, which leans as its leg does.
    """
    leaning = feet_lean(run.constants.roles)
    terrain = run.once(terrain_of)
    rolling = np.zeros((run.ticks, 2), dtype=np.bool_)
    if run.has("/reference"):
        rolling = run.field("/reference", "roll") != 0.0
    largest = []
    for stance in run.once(stances):
        poses = run.sole(stance.foot)[stance.ticks]
        axes = np.einsum("nij,ni->nj", rotations(poses[:, 3:]), terrain.normals(poses[:, :2]))
        axes[rolling[stance.ticks, stance.foot], 0] = 0.0
        axes[:, 1] *= not leaning
        largest.append(float(np.arcsin(np.minimum(np.hypot(axes[:, 0], axes[:, 1]), 1.0)).max()))
    return max(largest, default=None)


@metric(
    shown=(1.0, "body weights"), reads={"/contact": ("normal_force",)}, body=True, least=0.0, tolerance=(0.02, 0.02)
)
def contact_force_peak(run: RunView) -> float:
    """Greatest normal force on both soles together, over the weight [-]."""
    return float(run.field("/contact", "normal_force").sum(axis=1).max() / (run.constants.mass * GRAVITY))


@metric(unit="s", needs=(*STANCE_READS, "/reference"), reads=STANCE_READS, body=True, least=0.0)
def unplanned_flight_time(run: RunView) -> float:
    """Time, after the first load, in which no foot carried load though one was planned in contact [s]."""
    standing, planned = loaded(run).any(axis=1), (run.field("/contact", "planned") != 0).any(axis=1)
    flying = np.logical_or.accumulate(standing) & ~standing & planned
    return float(np.count_nonzero(flying) / run.constants.control_rate)


@metric(
    unit="s",
    needs=("/truth",),
    reads={**FALL_READS, "/truth": (*FALL_READS["/truth"], "self_contact")},
    body=True,
    least=0.0,
)
def self_contact_time(run: RunView) -> float:
    """Time in which the robot touched itself, before a fall [s]."""
    fallen = fall_time(run)
    touching = run.field("/truth", "self_contact") != 0
    if fallen is not None:
        touching = touching & (run.time < fallen)
    return float(np.count_nonzero(touching) / run.constants.control_rate)
