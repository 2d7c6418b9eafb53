"""The dual method for strictly convex QPs of Goldfarb and Idnani (Mathematical Programming 27, 1983), their algorithm.

It begins at the minimiser x without inequalities. While one is violated, of the normal n⁺ and the slack s⁺ < 0, it goes
along z, on which the active ones stay as they are, and changes their multipliers u by -r:

    t₁ = min u_k / r_k over r_k > 0,    t₂ = -s⁺ / zᵀn⁺,    t = min(t₁, t₂),    x += t z,    u -= t r.

After a full step, t = t₂, the inequality is active; after a partial one that which blocked is so no longer. A class
below says how z and r come from what is active.
"""

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra

Array = NDArray[np.float64]


class DualMethod:
    """The iteration, for inequalities that a class below numbers as it likes.

    Args:
        inequalities: how many there are.
        most: no more than these may be active.
        most_rounds: it gives up after so many steps.
        dependent: share of a normal, squared, that may be left beside those of what is active and counts as none.

    Attributes:
        count: how many are active.
        active: their numbers, shape (most,).
        is_active: whether each one is, shape (inequalities,).
        u: their multipliers, shape (most,).
        r: their changes of sign, as above, shape (most,).
        slack: s⁺ of the inequality that is looked at.
        curvature: zᵀn⁺ of it.
        whole: the same if nothing were active.
    """

    def __init__(self, inequalities: int, most: int, most_rounds: int, dependent: float) -> None:
        self._most, self._most_rounds, self._dependent = most, most_rounds, dependent
        self.count, self._rounds = 0, 0
        self.active, self.is_active = np.zeros(most, dtype=np.intp), np.zeros(inequalities, dtype=np.intp)
        self.u, self.r = np.zeros(most), np.zeros(most)
        self.slack, self.curvature, self.whole = 0.0, 0.0, 0.0

    def iterate(self) -> int:
        """Steps until all inequalities hold; -1 where it gives up, as where there is no solution."""
        self.count, self._rounds = 0, 0
        self.is_active[:] = 0
        number = self._violated()
        while number >= 0:
            if not self._satisfy(number):
                return -1
            number = self._violated()
        return self._rounds

    def _satisfy(self, number: int) -> bool:
        """Go until an inequality holds, and is active; returns whether that goes."""
        if self.count == self._most:
            return False
        multiplier, is_full = 0.0, False
        while not is_full:
            if self._rounds == self._most_rounds or self.slack != self.slack:
                return False
            self._rounds += 1
            self._project()
            blocking = self._blocking()
            partial = self.u[blocking] / self.r[blocking] if blocking >= 0 else algebra.INFINITY
            independent = self.curvature > self._dependent * self.whole
            full = -self.slack / self.curvature if independent else algebra.INFINITY
            is_full = full <= partial
            step = full if is_full else partial
            if step == algebra.INFINITY:
                return False
            if full < algebra.INFINITY:
                self._move(step)
                self.slack += step * self.curvature
            for k in range(self.count):
                self.u[k] -= step * self.r[k]
            multiplier += step
            if is_full:
                self._activate(number, multiplier)
            else:
                self._release(blocking)
        return True

    def _blocking(self) -> int:
        """Place of the active inequality whose multiplier is zero first; -1 for none."""
        found, least = -1, algebra.INFINITY
        for k in range(self.count):
            if self.r[k] > 0.0 and self.u[k] / self.r[k] < least:
                found, least = k, self.u[k] / self.r[k]
        return found

    def _activate(self, number: int, multiplier: float) -> None:
        self._take()
        self.active[self.count], self.u[self.count] = number, multiplier
        self.is_active[number] = 1
        self.count += 1

    def _release(self, place: int) -> None:
        self.is_active[self.active[place]] = 0
        self.count -= 1
        for k in range(place, self.count):
            self.active[k], self.u[k] = self.active[k + 1], self.u[k + 1]
        self._leave(place)

    def _violated(self) -> int:
        """The inequality that is violated most and is not active, whose normal and slack it notes; -1 for none."""
        raise NotImplementedError

    def _project(self) -> None:
        """Find z, r, and the curvatures with and without what is active."""
        raise NotImplementedError

    def _move(self, step: float) -> None:
        """Go that step along z."""
        raise NotImplementedError

    def _take(self) -> None:
        """Let the normal that is looked at be the last one in the factors of what is active."""
        raise NotImplementedError

    def _leave(self, place: int) -> None:
        """Take the normal at a place out of the factors; `count` is that without it."""
        raise NotImplementedError
