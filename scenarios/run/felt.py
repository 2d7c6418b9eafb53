"""The gait of a robot as its feet feel it, where nothing is planned."""

import math

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.types import Foot, PhaseInfo, PhaseKind
from surefoot.scenarios.judge.feet import LOADED
from surefoot.similarity import GRAVITY, REFERENCE_SIZE, Similarity

GRAZE = 0.02
"""Time for which a foot loses or gains its load until that counts, of the reference robot [s]."""

STILL = 0.5
"""Time for which both feet carry load until the robot stands, of the reference robot [s]."""

USUAL = {PhaseKind.SINGLE: 0.4, PhaseKind.DOUBLE: 0.1}
"""Usual duration of a phase before there was one of its kind, of the reference robot [s]."""


class FeltGait:
    """The phases of a gait by the normal forces on the soles: standing, double and single support, and flight.

    A step is begun when a foot leaves the ground. A flight counts as a single support without a stance foot.

    Args:
        mass: of the robot [kg].
        size: of it.

    Attributes:
        contact: feet that carry load, (left, right).
        landed: foot that has come to the ground at the last update; None where none has.
        step: number of steps begun.
    """

    def __init__(self, mass: float, size: Similarity = REFERENCE_SIZE) -> None:
        self._least = LOADED * mass * GRAVITY
        self._graze, self._still = GRAZE * size.time, STILL * size.time
        self._usual = {kind: time * size.time for kind, time in USUAL.items()}
        self.contact, self.step = (True, True), 0
        self._other: list[float | None] = [None, None]
        self._began, self._now, self._kind = 0.0, 0.0, PhaseKind.STAND
        self.landed: Foot | None

    def update(self, now: float, forces: NDArray[np.float64]) -> None:
        """Feel an instant [s]; normal forces on the left and the right sole, shape (2,) [N]."""
        self._now, self.landed = now, None
        contact = self._settled(0, forces.item(0)), self._settled(1, forces.item(1))
        if contact != self.contact:
            self._change(contact)
        elif self._kind is PhaseKind.DOUBLE and now - self._began > self._still:
            self._kind = PhaseKind.STAND

    def _change(self, contact: tuple[bool, bool]) -> None:
        """Begin the phase of other contacts; standing is ended by a foot that leaves the ground."""
        before, self.contact = self.contact, contact
        for foot in Foot:
            if contact[foot] and not before[foot]:
                self.landed = foot
            if before[foot] and not contact[foot]:
                self.step += 1
        if self._kind in self._usual:
            self._usual[self._kind] = max(self._now - self._began, self._graze)
        self._began, self._kind = self._now, PhaseKind.DOUBLE if all(contact) else PhaseKind.SINGLE

    def _settled(self, foot: int, force: float) -> bool:
        """Return true if a foot carries load, once it has done so, or not done so, for a while."""
        loaded, was = force > self._least, self.contact[foot]
        if loaded is was:
            self._other[foot] = None
            return was
        since = self._other[foot]
        if since is None:
            self._other[foot] = since = self._now
        if self._now - since < self._graze:
            return was
        self._other[foot] = None
        return loaded

    @property
    def phase(self) -> PhaseInfo:
        """The gait's phase now; phases are taken to last as long as the last ones of their kind."""
        kind = self._kind
        if kind is PhaseKind.STAND:
            return PhaseInfo(kind, None, self.step, self._now - self._began, math.inf, 0, math.inf)
        stance = None if self.contact[0] is self.contact[1] else Foot.LEFT if self.contact[0] else Foot.RIGHT
        elapsed, duration = self._now - self._began, self._usual[kind]
        leads_to = self.step if kind is PhaseKind.SINGLE else self.step + 1
        return PhaseInfo(kind, stance, self.step, elapsed, duration, leads_to, max(duration - elapsed, 0.0))
