"""Metrics of the walk as a whole: falls, steps and standing."""

import numpy as np

from surefoot.planner.model.dcm import dcm
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.body import lies, lost
from surefoot.scenarios.judge.digest import GAIT, Mask, RunView
from surefoot.scenarios.judge.metric import MM, metric

STILL_SPEED = 0.02
"""CoM speed of a robot that stands still [m/s]."""

FALL_READS: Reads = {
    "/truth": ("com", "com_velocity", "torso_tilt", "nonfoot_contact"),
    "/contact": ("zmp",),
    "/reference": ("omega",),
}
"""Fields that tell a fall; of a body those of the first topic alone."""

_STILL_READS: Reads = {"/truth": ("com_velocity",), "/contact": ("felt",)}


@metric(needs=("/truth",), reads=FALL_READS, at_end=True)
def fell(run: RunView) -> bool:
    """True if the robot fell."""
    return fall_time(run) is not None


@metric(unit="s", needs=("/truth",), reads=FALL_READS, least=0.0, tolerance=(0.011, 0.0), at_end=True)
def fall_time(run: RunView) -> float | None:
    """First time at which the robot has fallen [s].

    A body: its CoM is low over the lower foot, its torso lies, or more than its feet touches. A pendulum: its DCM is
    out of reach of any foot. A cart-table never falls.
    """
    return run.once(_fall_time)


def _fall_time(run: RunView) -> float | None:
    fallen = np.flatnonzero(_lost(run) if run.constants.fidelity == "pendulum" else _lying(run))
    return float(run.time[fallen[0]]) if len(fallen) else None


@metric(unit="s", reads={**FALL_READS, "/plan": ("falling",)}, tolerance=(0.05, 0.0))
def fall_warning(run: RunView) -> float | None:
    """Time before a fall at which the planner announced it for good, negative for a fall that did not come [s]."""
    plan, fallen = run.log["/plan"], fall_time(run)
    spells = runs_of(plan.field("falling") != 0)
    if fallen is None:
        return float(plan.time[spells[0][0]]) - float(run.time[-1]) if spells else None
    made = int(np.searchsorted(plan.time, fallen, side="right"))
    return next((fallen - float(plan.time[begin]) for begin, end in spells if begin < made <= end), None)


@metric(unit="s", reads={"/truth": ()}, least=0.0, tolerance=(0.001, 0.0))
def duration(run: RunView) -> float:
    """Simulated time [s]."""
    return float(run.time[-1] - run.time[0]) + 1 / run.constants.control_rate


@metric(
    needs=(),
    reads={"/command": ("yaw_rate", "heading"), "/reference": ("step", "phase")},
    least=0.0,
    planned=True,
)
def steps_planned(run: RunView) -> int:
    """Footsteps asked for, with those that a recovery added; those begun of a walk that is commanded meanwhile."""
    return _begun(run) if _led(run) else max(run.constants.steps_planned, _begun(run))


def steps_added(run: RunView) -> int:
    """Footsteps begun beyond those asked for, by a recovery; none of a walk that is commanded meanwhile."""
    return 0 if _led(run) else max(0, _begun(run) - run.constants.steps_planned)


def _begun(run: RunView) -> int:
    begun = run.field("/reference", "step")[run.single_support] if run.has("/reference") else np.zeros(0)
    return int(begun.max(initial=0))


_PLACE_READS: Reads = {"/truth": ("left_sole", "right_sole"), "/command": ("place", "heading")}


@metric(
    unit="m", needs=("/truth", "/command"), shown=MM, reads=_PLACE_READS, least=0.0, tolerance=(0.001, 0.0), at_end=True
)
def place_error(run: RunView) -> float | None:
    """Distance at the end from the middle of the stance to the place where the robot was commanded to go last [m]."""
    place = _last_place(run)
    if place is None:
        return None
    return float(np.hypot(*(0.5 * run.soles[-1, :, :2].sum(axis=0) - place[:2])))


@metric(unit="rad", needs=("/truth", "/command"), reads=_PLACE_READS, least=0.0, tolerance=(0.002, 0.0), at_end=True)
def heading_error(run: RunView) -> float | None:
    """Difference at the end of the mean heading of the soles from the commanded one [rad]."""
    place = _last_place(run)
    if place is None:
        return None
    turned = run.sole_yaw[-1] - place[2]
    return float(abs(np.angle(np.exp(1j * turned).sum())))


AT_WAYPOINT = 0.05
"""Distance of a sole from where it would stand at a waypoint within which the robot has come there [m]."""

WAYPOINT_HEADING = 0.1
"""Difference of its heading from the one asked for there within which it has come there [rad]."""


@metric(needs=("/truth", "/contact"), reads={"/contact": ("felt",)}, least=0.0)
def waypoints_missed(run: RunView) -> int | None:
    """Waypoints that no foot on the ground came to with the heading asked for, each after the one before it."""
    places = run.constants.waypoints
    if not places:
        return None
    tick, missed = 0, 0
    for place in places:
        there = np.flatnonzero(_stands_at(run, place)[tick:])
        missed += not len(there)
        tick += int(there[0]) if len(there) else 0
    return missed


def _stands_at(run: RunView, place: tuple[float, float, float]) -> Mask:
    """Ticks in which a loaded foot is where it would stand in a stance at a place, as wide as the one at the start."""
    (x, y, yaw), near = place, run.constants.similarity.times(AT_WAYPOINT, "m")
    left = 0.5 * np.hypot(*(run.soles[0, 0, :2] - run.soles[0, 1, :2])) * np.array([-np.sin(yaw), np.cos(yaw)])
    stands = np.zeros(run.ticks, dtype=np.bool_)
    for foot, beside in ((0, left), (1, -left)):
        away = run.sole(foot)[:, :2] - np.add((x, y), beside)
        turned = np.abs(np.angle(np.exp(1j * (run.sole_yaw[:, foot] - yaw))))
        loaded = run.field("/contact", "felt")[:, foot] != 0
        stands |= loaded & (np.hypot(*away.T) < near) & (turned < WAYPOINT_HEADING)
    return stands


def _led(run: RunView) -> bool:
    """Return true if the robot was commanded where to go."""
    if not run.has("/command"):
        return False
    log = run.log["/command"]
    return not bool(np.isnan([log.field("yaw_rate"), log.field("heading")]).all())


def _last_place(run: RunView) -> tuple[float, float, float] | None:
    """Last place that the robot was commanded to; None if it was commanded to follow a velocity then."""
    log = run.log["/command"]
    (x, y), yaw = log.field("place")[-1], log.field("heading")[-1]
    return None if np.isnan(x) else (float(x), float(y), float(yaw))


@metric(needs=("/truth",), reads={**FALL_READS, "/footstep": ()}, least=0.0)
def steps_taken(run: RunView) -> int:
    """Footsteps whose foot touched the ground, before a fall."""
    if "/footstep" not in run.log:
        return 0
    end = fall_time(run)
    times = run.log["/footstep"].time
    return len(times) if end is None else int(np.count_nonzero(times < end))


@metric(reads={**FALL_READS, "/reference": ("omega", "phase", "stance")}, least=0.0)
def touchdowns_missed(run: RunView) -> int:
    """Swings that were over before a fall, but whose foot never touched the ground."""
    return len(swings_ended(run)) - steps_taken(run)


def swings_ended(run: RunView) -> list[tuple[int, int]]:
    """Begin and end of each planned single support that was over before a fall and the end of the log, in ticks."""
    fall = fall_time(run)
    end = run.ticks if fall is None else int(np.searchsorted(run.time, fall))
    single, stance = run.single_support[:end], run.field("/reference", "stance")[:end]
    return sorted(swing for foot in (0, 1) for swing in runs_of(single & (stance == foot)) if swing[1] < end)


@metric(unit="s", reads=_STILL_READS, least=0.0, tolerance=(0.05, 0.0))
def standing_time_final(run: RunView) -> float:
    """Time at the end of the run with the CoM still and both feet loaded [s]."""
    moving = np.flatnonzero(~_still(run))
    first = moving[-1] + 1 if len(moving) else 0
    return (run.ticks - int(first)) / run.constants.control_rate


@metric(unit="s", reads={**_STILL_READS, GAIT: ()}, least=0.0, tolerance=(0.05, 0.0))
def standing_time_between(run: RunView) -> float:
    """Longest time between two steps with the CoM still and both feet loaded, 0 when the walk never stops [s]."""
    return (
        max((end - start for start, end in runs_of(_still(run)[run.walking])), default=0) / run.constants.control_rate
    )


def _still(run: RunView) -> Mask:
    speed = np.linalg.norm(run.field("/truth", "com_velocity"), axis=1)
    return np.asarray(
        (speed < run.constants.similarity.times(STILL_SPEED, "m/s")) & (run.field("/contact", "felt") != 0).all(axis=1)
    )


def _lying(run: RunView) -> Mask:
    lower = np.minimum(*(run.sole(foot)[:, 2].copy() for foot in (0, 1)))
    height = run.field("/truth", "com")[:, 2] - lower
    tilt, touching = run.field("/truth", "torso_tilt"), run.field("/truth", "nonfoot_contact")
    return np.asarray(lies(height, run.constants.com_height, tilt, touching))


def _lost(run: RunView) -> Mask:
    if run.constants.plant == "cart_table" or not run.has("/contact", "/reference"):
        return np.zeros(run.ticks, dtype=np.bool_)
    omega = run.field("/reference", "omega")[:, None]
    true_dcm = dcm(run.field("/truth", "com")[:, :2], run.field("/truth", "com_velocity")[:, :2], omega)
    return np.asarray(lost(true_dcm, run.field("/contact", "zmp")[:, :2], run.constants.similarity.length))


def runs_of(mask: Mask) -> list[tuple[int, int]]:
    """Begin and end of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
