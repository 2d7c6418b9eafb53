"""The reference of a tick in numbers, as the compiled laws read it."""

import math
from operator import attrgetter

import numpy as np

from surefoot.wbc.types import ARRAYS, WbcReference

_VECTORS = attrgetter(*(name for name, (_, shape) in ARRAYS.items() if len(shape) == 1))
_PLAIN = attrgetter("omega", "stiffness", "heading", "heading_rate")


class Setpoint:
    """A `WbcReference` in memory of its own; names and units are those of its fields.

    Attributes:
        reference: which it took last.
    """

    def __init__(self) -> None:
        self._numbers = np.zeros(_SIZE)
        parts = [self._numbers[start : start + math.prod(shape)].reshape(shape) for start, shape in ARRAYS.values()]
        (
            self.com, self.com_velocity, self.com_acceleration, self.zmp, self.zmp_offset,
            self.swing_position, self.swing_velocity, self.swing_acceleration,
            self.swing_angular_velocity, self.swing_angular_acceleration, self.swing_rotation, self.ground_normal,
        ) = parts  # fmt: skip
        self._rest = self._numbers[43:]

    def take(self, reference: WbcReference) -> None:
        """Take the reference of this tick."""
        r = self.reference = reference
        if r.numbers is None:
            rest = (*_PLAIN(r), *r.load_share, *r.roll, r.swing_foot, r.rolling_foot, r.catching)
            parts = (*_VECTORS(r), r.swing_rotation.ravel(), r.ground_normal.ravel(), rest)
            np.concatenate(parts, out=self._numbers)
        else:
            self._numbers[...] = r.numbers
        self._name()

    def _name(self) -> None:
        """Give the plain numbers their names."""
        rest = self._rest
        self.omega, self.stiffness, self.heading, self.heading_rate = rest[0], rest[1], rest[2], rest[3]
        self.load_left, self.load_right = rest[4], rest[5]
        self.roll_rate, self.roll_acceleration = rest[7], rest[8]
        self.swing_foot, self.rolling_foot, self.catching = int(rest[9]), int(rest[10]), bool(rest[11] != 0.0)


_SIZE = 55
"""Numbers of a reference: its arrays, then the plain ones."""
