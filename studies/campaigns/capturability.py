"""The limit of a push by one-step capturability (`surefoot.planner.recovery.capturability`), by the logs of a campaign.

A foot may land wherever and whenever the steps may be adapted to, as far as the legs reach and the hips can swing it.
"""

import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.errors import ParameterError, PluginError
from surefoot.planner.geometry.plane import frame_rotation, sole_corners
from surefoot.planner.model.dcm import dcm
from surefoot.planner.parameters import StepAdaptation
from surefoot.planner.recovery.capturability import Moment, Way, landing_points, swing_box
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.swing.step_region import reach_box
from surefoot.planner.types import GRAVITY, Array, Foot, Footstep
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import read
from surefoot.scenarios.setup.groups.gait import push_time
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

LIMIT_NOTE = (
    "Limit: one-step capturability. The largest impulse after which some centre of pressure within the soles until the "
    "landing, and some landing, bring a linear inverted pendulum to rest: where and when the adaptation of steps may "
    "put it, within reach of the legs and of how hard hips can swing them. Its state is that in which the push began "
    "in a run of the same kind, by its log. Turning the torso and a second step are not in it; a threshold beyond it "
    "uses one of these."
)
"""Note on the limit, for a page."""

_TICK = 1e-6
"""Difference of times below which neither is earlier [s]."""

_EVERY, _LATER = 0.02, 0.2
"""Spacing of the times at which a foot is tried to land, and by how much that may be after the clock's [s]."""


def moment_of(log: Path, push: int) -> Moment | None:
    """The state of a run as a push begins, counted from 0; None where there is none of the kind that has a limit.

    It has one on flat ground, before the last foot has landed, where the push is level.
    """
    try:
        scenario = load(log)
        walk = resolve(scenario)
        level = walk.ground.keys.kind == "flat" and not scenario.pushes[push].elevation
        return _moment(scenario, walk, LogView(read(log)), push) if level else None
    except (ScenarioError, SetupError, ParameterError, PluginError, LogError, MissingError, IndexError):
        return None


def _moment(scenario: Scenario, walk: Walk, view: LogView, push: int) -> Moment | None:
    gait = walk.gait
    begin = push_time(gait, scenario.pushes[push])
    ends = ((step, gait.lift_off(step) + gait.single_support) for step in range(1, gait.steps + 1))
    step = next((step for step, end in ends if end > begin + _TICK), None)
    times = view.time("/truth")
    row = int(np.searchsorted(times, begin + _TICK)) - 1  # the last tick that knows nothing of the push
    if step is None or not 0 < row < len(times) - 1:
        return None
    omega = math.sqrt(GRAVITY / gait.com_height)
    lift = max(gait.lift_off(step) - begin, 0.0)
    single = min(gait.lift_off(step) - begin, 0.0) + gait.single_support
    pushed = scenario.pushes[push]
    com, speed = (view.field("/truth", name, 3)[row - 1 : row + 1, :2] for name in ("com", "com_velocity"))
    before, now = dcm(com, speed, omega)
    since = begin - times[row]
    struck = now + since / (times[row] - times[row - 1]) * (now - before)
    ways = tuple(_ways(walk, view, gait.step_foot(step), (row, since), (lift, single)))
    return Moment(struck, omega, ways, pushed.duration, pushed.direction or 0.0)


def _ways(walk: Walk, view: LogView, swing: Foot, at: tuple[int, float], left: tuple[float, float]) -> Iterator[Way]:
    """Ways to land: as planned, and as steps may be adapted; ``at`` a row and a time after it, supports left [s]."""
    row, since = at
    seen = max(int(np.searchsorted(view.time("/footsteps"), view.time("/truth")[row] + _TICK)) - 1, 0)
    poses = [view.field("/footsteps", f"current_{foot}", 4)[seen][[0, 1, 3]] for foot in FOOT_NAMES]
    planned = view.field("/footsteps", "next", 3, 4)[seen, 0][[0, 1, 3]]
    half = (0.5 * walk.sole[0], 0.5 * walk.sole[1])
    both = np.vstack([_corners(foot, pose, half) for foot, pose in zip(Foot, poses, strict=True)])
    stance = poses[swing.other]
    alone = _corners(swing.other, stance, half)

    def way(double: float, single: float, landed: Array) -> Way:
        return Way(((both, (0.0, double)), (alone, (double, double + single))), np.vstack([alone, landed]))

    yield way(*left, _corners(swing, planned, half))
    here, speed = view.field("/truth", f"{swing.name.lower()}_sole", 7)[row, :2] - stance[:2], np.zeros(2)
    if not left[0]:
        speed = view.field("/reference", "swing_velocity", 3)[row, :2]
    here, speed = (here + since * speed) @ frame_rotation(stance[2]), speed @ frame_rotation(stance[2])
    most = np.array(walk.legs.acceleration)
    for double, single in itertools.product(*_times(walk, left)):
        foot = swing_box(here, speed, most, single)
        for box in _boxes(walk, swing.side):
            low, high = np.maximum(box[0], foot[0]), np.minimum(box[1], foot[1])
            if (low <= high).all():
                yield way(double, single, landing_points(stance, half, (low, high)))


def _times(walk: Walk, left: tuple[float, float]) -> tuple[Array, Array]:
    """Double and single support that may be left [s]."""
    if not walk.formulation.profile.catches or walk.parameters.step_adaptation is StepAdaptation.LOCATION:
        return np.array(left[:1]), np.array(left[1:])
    scale, numbers = walk.size.time, walk.parameters.recovery
    earliest = min(left[0], numbers.least_double), min(left[1], numbers.least_single)
    ends = left[0], left[1] + _LATER * scale
    double, single = (np.arange(begin, end, _EVERY * scale) for begin, end in zip(earliest, ends, strict=True))
    return np.append(double, left[0]), np.append(single, left[1])


def _boxes(walk: Walk, side: float) -> list[tuple[Array, Array]]:
    """Boxes, in the frame of the standing foot, in one of which the other may land: lower and upper corners [m]."""
    if walk.parameters.step_adaptation is StepAdaptation.NONE:
        return []
    legs = walk.legs.adapting(walk.parameters) if walk.formulation.profile.catches else None
    if legs is None:
        return [reach_box(walk.parameters, side)]
    return [(low, high) for low, high in legs.allowed(side, ANYWHERE, True)]


def _corners(foot: Foot, pose: Array, half: tuple[float, float]) -> Array:
    sole = Footstep(foot, np.array([pose[0], pose[1], 0.0]), float(pose[2]))
    return np.asarray(sole_corners(sole, np.array(half)))


class Limits:
    """The limits of a campaign that searches for the impulse of a push.

    The state in which the push begins is the same for all its directions; it is taken from the first log that is kept.

    Args:
        key: that was searched.
        logs: labels of searches with logs of runs of theirs.
        angle: name of the axis that gives the direction; empty where it is not varied.
    """

    def __init__(self, key: str, logs: Iterable[tuple[Mapping[str, Any], Path]], angle: str) -> None:
        self._angle = angle
        self._moments: dict[str, Moment] = {}
        push = re.fullmatch(r"pushes\.(\d+)\.impulse", key)
        if push is None or (angle and angle != f"pushes.{push[1]}.direction"):
            return
        for labels, log in logs:
            name = self._name(labels)
            moment = None if name in self._moments else moment_of(log, int(push[1]))
            if moment is not None:
                self._moments[name] = moment

    def __bool__(self) -> bool:
        """Return true if there is any."""
        return bool(self._moments)

    def at(self, labels: Mapping[str, Any], direction: float | None) -> float | None:
        """The limit of a search in a direction, None for its push's own [rad]; None where it is not known [N·s/kg]."""
        moment = self._moments.get(self._name(labels))
        return None if moment is None else moment.limit(moment.direction if direction is None else direction)

    def _name(self, labels: Mapping[str, Any]) -> str:
        return str([(name, value) for name, value in labels.items() if name != self._angle])
