"""The rules of a tour: places to go to, punches on the way, and arms that somebody else moves."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.streams import Stream, generator

Array = NDArray[np.float64]

DURATION, SLOT = 90.0, 5.0
"""Durations of a tour, and of the time for each of its places [s]."""

CENTRE, RADIUS = (0.3, 0.0), 0.75
"""Disc from which places are drawn, in the frame of the pelvis at the start [m]."""

DELAY, PUNCH_TIME = 0.1, 0.08
"""From the beginning of a slot to its punch, and how long that lasts [s]."""

STRONGEST, WEAKEST, RAMP = 500.0, 1.0 / 3.0, 60.0
"""Greatest force of a punch [N], the share of it that is the greatest at the start [-], and until when it grows [s]."""

LEAST = 0.5
"""Least share of the greatest force of its time that a punch has [-]."""

LOWEST = 0.20
"""Height of the pelvis below which the robot has fallen [m]."""

ARM_SLOT, ARM_STEPS, ARM_STEP, ARM_DRAWS = 0.5, 25, 0.06, 8
"""Time after which the arms get another pose [s], steps to it, half range of each [rad], and how often one is drawn
where the hands would be behind the body or above the head [-]."""


@dataclass(frozen=True, slots=True)
class Punch:
    """A force on a link.

    Attributes:
        time: of its beginning [s].
        joint: index of the joint whose child link it acts on, at the joint's anchor.
        direction: in the frame of that link, or of the one that it hangs from, of length 1, shape (3,).
        force: [N].
        of_parent: whether the direction is fixed to the latter.
    """

    time: float
    joint: int
    direction: Array
    force: float
    of_parent: bool = False

    @property
    def impulse(self) -> float:
        """Force times duration [N·s]."""
        return self.force * PUNCH_TIME

    def acts(self, time: float) -> bool:
        """Return true if it acts at an instant [s]."""
        return self.time <= time + _ROUNDING < self.time + PUNCH_TIME


_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class Tour:
    """All that is drawn from the seed of a tour.

    Attributes:
        seed: of it.
        places: where to go, one row a slot: x, y, heading in the frame of the pelvis at the start, shape (n, 3) [m, m,
            rad].
        punches: one in each slot.
    """

    seed: int
    places: Array
    punches: tuple[Punch, ...]

    def slot(self, time: float) -> int:
        """Number of the place to go to at an instant [s]."""
        return min(int((time + _ROUNDING) / SLOT), len(self.places) - 1)

    def punch(self, time: float) -> Punch | None:
        """The punch that acts at an instant [s]; None of a tour without punches, too."""
        if not self.punches:
            return None
        punch = self.punches[self.slot(time)]
        return punch if punch.acts(time) else None


def greatest(time: float) -> float:
    """Greatest force of a punch at an instant [N]."""
    grown = min((time - DELAY) / RAMP, 1.0)
    return STRONGEST * (WEAKEST + (1.0 - WEAKEST) * grown)


def drawn(seed: int, joints: int, most: Callable[[float], float] = greatest) -> Tour:
    """The tour of a seed for a robot with so many joints; ``most`` is the greatest force at an instant [N]."""
    slots = round(DURATION / SLOT)
    rng = generator(seed, Stream.TOUR, 0)
    radius, bearing = RADIUS * np.sqrt(rng.random(slots)), rng.uniform(0.0, math.tau, slots)
    x, y = CENTRE[0] + radius * np.cos(bearing), CENTRE[1] + radius * np.sin(bearing)
    places = np.column_stack((x, y, rng.uniform(-math.pi, math.pi, slots)))
    rng = generator(seed, Stream.TOUR, 1)
    return Tour(seed, places, tuple(_punch(SLOT * k + DELAY, joints, rng, most) for k in range(slots)))


def _punch(time: float, joints: int, rng: np.random.Generator, most: Callable[[float], float]) -> Punch:
    joint = int(rng.integers(joints))
    z, turn = rng.uniform(-1.0, 1.0), rng.uniform(0.0, math.tau)
    level = math.sqrt(1.0 - z * z)
    direction = np.array([level * math.cos(turn), level * math.sin(turn), z])
    return Punch(time, joint, direction, most(time) * rng.uniform(LEAST, 1.0))


class ArmWalk:
    """The left arm's angles as somebody else moves them; the right arm mirrors them.

    Args:
        steps: draws the steps to the next pose of so many joints, shape (steps, joints) [rad].
        start: angles at the start, shape (7,) [rad].
        lower: lower limits of the joints, shape (7,) [rad].
        upper: upper limits of the joints, shape (7,) [rad].
        allowed: whether both hands may be where these angles put them.
    """

    def __init__(
        self,
        steps: Callable[[int], Array],
        start: Array,
        lower: Array,
        upper: Array,
        allowed: Callable[[Array], bool],
    ) -> None:
        self._steps = steps
        self._lower, self._upper, self._allowed = lower, upper, allowed
        self._from, self._to, self._slot = start.copy(), start.copy(), -1

    def angles(self, time: float) -> Array:
        """Targets at an instant, which goes on from call to call, shape (7,) [rad]."""
        slot = int((time + _ROUNDING) / ARM_SLOT)
        while self._slot < slot:
            self._slot, self._from = self._slot + 1, self._to
            self._to = self._drawn(self._from)
        share = min((time - slot * ARM_SLOT) / ARM_SLOT + 1.0 / ARM_STEPS, 1.0)
        moved: Array = self._from + share * (self._to - self._from)
        return moved

    def _drawn(self, angles: Array) -> Array:
        """The next pose, or the same where none was found."""
        for _ in range(ARM_DRAWS):
            moved = angles
            for step in self._steps(len(angles)):
                moved = np.clip(moved + step, self._lower, self._upper)
            if self._allowed(moved):
                return moved
        return angles
