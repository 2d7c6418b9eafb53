"""The limit of a push by one-step capturability: what no controller survives that lands once, on the clock, and stops.

Of a linear inverted pendulum (Koolen et al., Capturability-based analysis and control of legged locomotion, 2012) whose
centre of pressure may be anywhere in the support and whose foot may land anywhere that the legs reach. Neither the
torso's rotation, nor a second step, nor another clock is in it: a controller that has these may survive more.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linprog

from surefoot.errors import ParameterError
from surefoot.planner.geometry import sole_corners
from surefoot.planner.types import GRAVITY, Array, Foot, Footstep
from surefoot.planner.walk.reach import reach_box
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import read
from surefoot.scenarios.setup.gait import push_time
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.scenarios.show.logview import LogView, MissingError

_TICK = 1e-6
"""Of two times nearer than this, neither is earlier [s]."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The state in which a push begins, and what can be done about it.

    Attributes:
        dcm: divergent component of motion, shape (2,) [m].
        omega: rate of its divergence [1/s].
        supports: until the landing: points whose hull the centre of pressure may be in, shape (n, 2) [m], and from
            when until when [s].
        landed: points in whose hull it may be once the foot has landed where it is best, shape (n, 2) [m].
        duration: of the push [s].
        direction: of it, from the world's x axis to the left [rad].
    """

    dcm: Array
    omega: float
    supports: tuple[tuple[Array, tuple[float, float]], ...]
    landed: Array
    duration: float
    direction: float = 0.0

    @property
    def landing(self) -> float:
        """Time until the foot lands [s]."""
        return self.supports[-1][1][1] if self.supports else 0.0

    def limit(self, direction: float) -> float:
        """Largest impulse per mass in a direction that can be captured [N·s/kg]; 0 where not even none can be.

        The DCM obeys dξ/dt = ω (ξ - p) + a / ω. It can be brought to rest after the landing at T exactly if

            ξ + j (1 - e^{-ωd}) / (ω² d) = Σ_k p_k (e^{-ω a_k} - e^{-ω b_k}) + e^{-ωT} q

        with j the impulse per mass over the duration d, p_k in the support from a_k to b_k and q in that after landing:
        a linear program in j and in the weights of the points.

        Args:
            direction: of the push in the world, from x to the left [rad].
        """
        omega, spread = self.omega, self.omega * self.duration
        gain = -math.expm1(-spread) / spread / omega
        shares = [math.exp(-omega * begin) - math.exp(-omega * end) for _, (begin, end) in self.supports]
        hulls = [*(points for points, _ in self.supports), self.landed]
        scales = [*shares, math.exp(-omega * self.landing)]
        push = -gain * np.array([math.cos(direction), math.sin(direction)])
        points = [scale * (hull - self.dcm).T for scale, hull in zip(scales, hulls, strict=True)]  # scales add up to 1
        sums = np.zeros((len(hulls), 1 + sum(map(len, hulls))))
        for row, (begin, end) in enumerate(pairwise(np.cumsum([1, *map(len, hulls)]))):
            sums[row, begin:end] = 1.0
        conditions = np.vstack([np.column_stack([push, *points]), sums])
        values = np.concatenate([np.zeros(2), np.ones(len(hulls))])
        found = linprog(np.eye(1, sums.shape[1])[0] * -1.0, A_eq=conditions, b_eq=values)
        return float(found.x[0]) if found.success else 0.0


def landing_points(stance: Array, support: Array, sole: tuple[float, float], reach: tuple[Array, Array]) -> Array:
    """Points whose hull is all that feet can span, of which one stands and one lands within reach, shape (n, 2) [m].

    Args:
        stance: centre and heading of the standing sole, shape (3,) [m, rad].
        support: its corners, shape (4, 2) [m].
        sole: half length and half width of the landing one, which keeps the heading [m].
        reach: lower and upper corner of where its centre may land, in the frame of the standing one, shape (2,) [m].
    """
    low, high = reach[0] - sole, reach[1] + sole
    corners = np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])])
    c, s = math.cos(stance[2]), math.sin(stance[2])
    return np.vstack([support, stance[:2] + corners @ np.array([[c, s], [-s, c]])])


def moment_of(log: Path, push: int) -> Moment | None:
    """The state of a run as a push begins; None where there is none of the kind that has a limit.

    It has one on flat ground, in a walk with its steps on the clock, before the last foot has landed.

    Args:
        log: of the run.
        push: its number, from 0.
    """
    try:
        scenario = load(log)
        walk = resolve(scenario)
        return _moment(scenario, walk, LogView(read(log)), push) if walk.terrain_kind == "flat" else None
    except (ScenarioError, SetupError, ParameterError, LogError, MissingError, IndexError):
        return None


def _moment(scenario: Scenario, walk: Walk, view: LogView, push: int) -> Moment | None:
    gait = walk.gait
    begin = push_time(gait, scenario.pushes[push])
    ends = ((step, gait.lift_off(step) + gait.single_support) for step in range(1, gait.steps + 1))
    step = next((step for step, end in ends if end > begin + _TICK), None)
    times = view.time("/reference")
    row = int(np.searchsorted(times, begin - _TICK))
    if step is None or row >= len(times):
        return None
    com, speed = (view.field("/truth", name, 3)[row, :2] for name in ("com", "com_velocity"))
    omega = math.sqrt(GRAVITY / gait.com_height)
    seen = int(np.searchsorted(view.time("/footsteps"), begin + _TICK)) - 1
    poses = [view.field("/footsteps", f"current_{foot}", 4)[max(seen, 0)][[0, 1, 3]] for foot in ("left", "right")]
    swing = gait.step_foot(step)
    half = (0.5 * walk.sole[0], 0.5 * walk.sole[1])
    soles = [_corners(foot, pose, half) for foot, pose in zip(Foot, poses, strict=True)]
    stance, alone = poses[swing.other], soles[swing.other]
    lift = max(gait.lift_off(step) - begin, 0.0)
    land = gait.lift_off(step) + gait.single_support - begin
    supports = ((np.vstack(soles), (0.0, lift)), (alone, (lift, land)))
    reach = _reach(walk, 1.0 if swing is Foot.LEFT else -1.0)
    landed = landing_points(stance, alone, half, reach)
    pushed = scenario.pushes[push]
    return Moment(com + speed / omega, omega, supports, landed, pushed.duration, pushed.direction or 0.0)


def _reach(walk: Walk, side: float) -> tuple[Array, Array]:
    """Lower and upper corner of the box in which a foot may land, in the frame of the standing one, shape (2,) [m]."""
    legs = walk.legs.adapting(walk.parameters.step_adaptation) if walk.profile.catches else None
    if legs is None:
        return reach_box(walk.parameters, side)
    lows, highs = zip(*legs.boxes(side), strict=True)
    return np.min(lows, axis=0), np.max(highs, axis=0)


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
        """Whether there is any."""
        return bool(self._moments)

    def at(self, labels: Mapping[str, Any], direction: float | None) -> float | None:
        """The limit of a search, None where it is not known [N·s/kg].

        Args:
            labels: of the search.
            direction: of the push, None for its own [rad].
        """
        moment = self._moments.get(self._name(labels))
        return None if moment is None else moment.limit(moment.direction if direction is None else direction)

    def _name(self, labels: Mapping[str, Any]) -> str:
        return str([(name, value) for name, value in labels.items() if name != self._angle])
