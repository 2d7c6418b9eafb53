"""Walkers of the tour without its rules: velocities drawn at random, and a push that grows until they fall."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import PartError
from surefoot.joints import JointCommand
from surefoot.planner.types import PhaseKind, Twist
from surefoot.scenarios.run.planning import RunFault
from surefoot.similarity import GRAVITY
from surefoot.streams import Stream, generator
from surefoot.studies.tour.ride import Arms
from surefoot.studies.tour.robot import tour_robot
from surefoot.studies.tour.rules import LOWEST
from surefoot.studies.tour.walker import Entrant
from surefoot.studies.tour.world import RATE, TourWorld

Array = NDArray[np.float64]

MOST = (0.4, 0.25, 0.5)
"""Ranges of the velocities that are drawn: ahead, sideways [m/s], and of the heading [rad/s]."""

VELOCITIES, HELD, SETTLED = 8, 4.0, 2.0
"""Number of them, time for which each is commanded, and time from which on it is judged [-, s, s]."""

AHEAD = 0.3
"""Speed at which a pushed robot walks [m/s]."""

PUSHED_STEP = 5
"""Step in which it is pushed."""

PUSH_TIME = 0.1
"""Duration of the push [s]."""

AFTER = 3.0
"""Time for which it must stay up from then on [s]."""

LATEST = 12.0
"""Time by which that step must have come [s]."""

WEAKEST, STRONGEST, CLOSE = 0.1, 6.4, 0.075
"""Impulse of the first push, the one at which the search ends, and how well the threshold is known [N·s/kg]."""

PHASES = {"mid-swing": (PhaseKind.SINGLE, 0.5), "double support": (PhaseKind.DOUBLE, 0.5)}
"""Moment of a push in the gait: the phase, and the elapsed share of it."""

DIRECTIONS = {"forward": 0.0, "left": 0.5 * math.pi, "backward": math.pi, "right": -0.5 * math.pi}
"""Direction of a push, from the heading of the start [rad]."""


class Drill:
    """A walker that follows commanded velocities, its arms held where the tour begins them.

    Args:
        entrant: that takes part.

    Attributes:
        rate: at which the walker is asked [Hz].
        world: that is simulated.
        walker: in its seat.
        mass: of the robot [kg].
    """

    def __init__(self, entrant: Entrant) -> None:
        self.rate, self.walker = entrant.rate, entrant.walker()
        names = self.walker.robot.joint_names
        self.world = TourWorld(self.walker.robot, tour_robot())
        still = Arms(tour_robot(), self.world, names, lambda joints: np.zeros((1, joints)))
        self._arms = still if entrant.drives_arms else None
        q = self.walker.posture.copy()
        if self._arms is not None:
            q[7:][self._arms.joints] = self._arms.start
        self.world.reset(q)
        self.walker.reset(q)
        self.mass = float(self.walker.robot.mass)

    @property
    def fallen(self) -> bool:
        """True where it has fallen."""
        return bool(self.world.pelvis[2] < LOWEST)

    def step(self, twist: Twist, force: Array | None = None) -> None:
        """Go through one tick of the walker's clock under a velocity, and a force on its torso [N]."""
        arms = None if self._arms is None else self._arms.command(self.world.time)
        try:
            command = self.walker.follow(self.world, twist, arms)
        except (RunFault, PartError):
            command = JointCommand(-self.world.data.qvel[6:].copy())
        if arms is not None and self._arms is not None:
            command = command.with_joints(self._arms.joints, arms)
        for _ in range(RATE // self.rate):
            if force is not None:
                self.world.push("torso_link", force)
            self.world.advance(command, 1.0 / RATE)


@dataclass(frozen=True, slots=True)
class Followed:
    """Errors against velocities drawn at random.

    Attributes:
        fell: whether it fell, whereupon the rest is of what came before.
        velocity_error: of the mean velocity over the settled time of each, ahead and sideways, RMS [m/s].
        yaw_rate_error: the same of the heading [rad/s].
        cost_of_transport: work of all joints, absolute, over weight times the way of the pelvis [-].
        power: that work over the time [W].
        slip: way of the soles where they are pressed, weighed by their load, over the way of the pelvis [-].
        peak_force: largest on both soles together, over the weight [-].
        jerkiness: mean change of the joints' accelerations from one 50th of a second to the next [rad/s^2].
    """

    fell: bool
    velocity_error: float
    yaw_rate_error: float
    cost_of_transport: float
    power: float
    slip: float
    peak_force: float
    jerkiness: float


def followed(entrant: Entrant, seed: int) -> Followed:
    """Let a walker follow the velocities of a seed."""
    drill, sums = Drill(entrant), _Sums()
    errors: list[Array] = []
    for twist in velocities(seed):
        begin, settled = drill.world.time, None
        while drill.world.time < begin + HELD - 1e-9 and not drill.fallen:
            if settled is None and drill.world.time >= begin + SETTLED - 1e-9:
                settled = _pose(drill.world)
            drill.step(twist)
            sums.add(drill)
        if drill.fallen:
            break
        if settled is not None:
            errors.append(_error(settled, _pose(drill.world), HELD - SETTLED, twist))
    return sums.result(drill, errors)


def velocities(seed: int) -> Iterator[Twist]:
    """Velocities of a seed."""
    rng = generator(seed, Stream.TOUR, 3)
    for row in rng.uniform(np.negative(MOST), MOST, (VELOCITIES, 3)):
        yield Twist(*row.tolist())


def _pose(world: TourWorld) -> Array:
    x, y, _ = world.pelvis.tolist()
    return np.array([x, y, world.heading])


def _error(before: Array, after: Array, time: float, twist: Twist) -> Array:
    """Mean velocity in the heading in the middle less the commanded one, shape (3,)."""
    turn = math.remainder(float(after[2] - before[2]), math.tau)
    middle = float(before[2]) + 0.5 * turn
    cos, sin = math.cos(middle), math.sin(middle)
    x, y = (after[:2] - before[:2]).tolist()
    # A path at a steady rate is an arc, whose chord is shorter than its way.
    arc = 0.5 * twist.yaw * time
    bent = 1.0 if abs(arc) < 1e-6 else arc / math.sin(arc)
    way = np.array([cos * x + sin * y, cos * y - sin * x]) * bent
    return np.array([*(way / time - (twist.x, twist.y)), turn / time - twist.yaw])


class _Sums:
    """Sums over the ticks of a drill."""

    def __init__(self) -> None:
        self._way = self._slipped = self._peak = self._change = 0.0
        self._ticks, self._next = 0, 0.0
        self._before: Array | None = None
        self._speed: Array | None = None
        self._acceleration: Array | None = None

    def add(self, drill: Drill) -> None:
        """Count a tick that is over."""
        world, seen = drill.world, drill.world.measure()
        weight, force = drill.mass * GRAVITY, seen.wrench[:, 2]
        self._peak = max(self._peak, float(force.sum()) / weight)
        self._slipped += float(world.slipping(seen.wrench) @ np.clip(force, 0.0, None)) / (weight * drill.rate)
        if self._before is not None:
            self._way += math.dist(world.pelvis[:2], self._before)
        self._before = world.pelvis[:2]
        if world.time >= self._next - 1e-9:
            self._next += 0.02
            self._jerk(np.array(world.data.qvel[6:]))

    def _jerk(self, speed: Array) -> None:
        if self._speed is not None:
            acceleration = (speed - self._speed) / 0.02
            if self._acceleration is not None:
                self._change += float(np.abs(acceleration - self._acceleration).mean())
                self._ticks += 1
            self._acceleration = acceleration
        self._speed = speed

    def result(self, drill: Drill, errors: list[Array]) -> Followed:
        """All together."""
        work, way = float(drill.world.energy.sum()), max(self._way, 1e-3)
        square = np.square(errors).mean(axis=0) if errors else np.full(3, np.nan)
        return Followed(
            fell=drill.fallen,
            velocity_error=float(math.sqrt(0.5 * (square[0] + square[1]))),
            yaw_rate_error=float(math.sqrt(square[2])),
            cost_of_transport=work / (drill.mass * GRAVITY * way),
            power=work / max(drill.world.time, 1e-3),
            slip=self._slipped / way,
            peak_force=self._peak,
            jerkiness=self._change / max(self._ticks, 1),
        )


def survives(entrant: Entrant, phase: str, direction: str, impulse: float) -> bool | None:
    """Push the torso of a walker that goes ahead, and see if it stays up.

    Args:
        entrant: that takes part.
        phase: when in the gait, see `PHASES`.
        direction: see `DIRECTIONS`.
        impulse: over the mass [N·s/kg].

    Returns:
        None where it fell before the push, or that phase never came.
    """
    drill, angle = Drill(entrant), DIRECTIONS[direction]
    kind, share = PHASES[phase]
    force = impulse * drill.mass / PUSH_TIME * np.array([math.cos(angle), math.sin(angle), 0.0])
    ahead = Twist(AHEAD)
    drill.step(ahead)
    while not _is_at(drill, kind, share):
        if drill.fallen or drill.world.time > LATEST:
            return None
        drill.step(ahead)
    begin = drill.world.time
    while drill.world.time < begin + AFTER and not drill.fallen:
        drill.step(ahead, force if drill.world.time < begin + PUSH_TIME - 1e-9 else None)
    return not drill.fallen


def _is_at(drill: Drill, kind: PhaseKind, share: float) -> bool:
    gait = drill.walker.gait
    return gait.step >= PUSHED_STEP and gait.kind is kind and gait.elapsed >= share * gait.duration


def largest(entrant: Entrant, phase: str, direction: str) -> float | None:
    """The largest push that is survived below the first that is not [N·s/kg]; None where none could be given.

    It is doubled from the weakest until the walker falls, and then halved between the two.
    """
    low, high = 0.0, WEAKEST
    while True:
        held = survives(entrant, phase, direction, high)
        if held is None:
            return None
        if not held:
            break
        low, high = high, 2.0 * high
        if low >= STRONGEST:
            return low
    while high - low > CLOSE:
        middle = 0.5 * (low + high)
        if survives(entrant, phase, direction, middle):
            low = middle
        else:
            high = middle
    return low
