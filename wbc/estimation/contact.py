"""The soles that the ground carries, by their wrenches, and the wrenches freed of what the sensors add."""

import math
from collections.abc import Sequence

import numpy as np

from surefoot.maths import algebra
from surefoot.readings import Reading
from surefoot.wbc.contact.external import SPAN
from surefoot.wbc.estimation.parameters import ContactDetection, SensorNoise
from surefoot.wbc.types import Array

CUT, QUIET = 100.0, 5.0
"""Highest cut-off of the wrenches' low pass, and the force noise up to which it holds [Hz, N]."""

SLOW_CUT = 15.0
"""Cut-off of a slower one, in which a light touch rises out of the noise that hides it from the other [Hz]."""

CARRIES = 0.4
"""Share of the weight above which the other foot carries, while one is tared [-]."""

UNLIKELY = 4.0
"""Deviations of a sensor's bias up to which the force on a swinging foot is taken for one [-]."""

FIRM_EDGE = 1.05
"""Share of the half sole within which its CoP is where it stands still on [-]."""

_ON_EDGE = (2.0, 0.0, 2.0)
"""Roll, pitch and rise of an edge over those of a sole [-]."""

_SPRUNG = (3, 4, 2)
"""Components of a wrench by which a sole on springs rolls, pitches and rises."""


class SoleContact:
    """Contact of both soles, decided once for filter, controller and planner.

    A normal force above a threshold is felt after some ticks, until it falls below a lower one. A smaller force is felt
    when it lasts. While a foot swings high its sensor is tared in all six axes, by a slow low pass.

    Args:
        parameters: thresholds.
        sensors: noise of the wrenches.
        weight: of the robot [N].
        half_size: half of the sole's length and width [m].
        period: control period [s].
        deviation: of forces and of moments that are filtered already; None for those of sensors [N, N·m].

    Attributes:
        wrench: filtered and tared, shape (2, 6) [N, N·m].
        felt: which soles the ground carries, left first.
        firm: which of these stand still: loaded, with the CoP well inside the sole, or on a toe edge on which it rolls.
        tare: by how much the sensors are taken to be off, shape (2, 6) [N, N·m].
        tared: how long each sensor was tared [s].
        deviation: of a force and of a moment, both soles together, in the mean of a span of the load observer [N, N·m].
        threshold: normal force from which on a contact is felt [N].
        age: time since the wrench acted, the low pass included [s].
    """

    def __init__(
        self,
        parameters: ContactDetection,
        sensors: SensorNoise,
        weight: float,
        half_size: tuple[float, float],
        period: float,
        deviation: tuple[float, float] | None = None,
    ) -> None:
        self._parameters, self._period, self.weight = parameters, period, weight
        self._half_length, self._half_width = half_size
        noise, turning = deviation or (sensors.wrench_force, sensors.wrench_moment)
        # Twice the noise takes a filter of about a third of the bandwidth to feel as soon and as surely.
        cut = CUT * min(QUIET / noise, 1.0) ** (2.0 / 3.0) if noise > 0.0 else math.inf
        self._share, left = _low_pass(math.inf if deviation else cut, period)
        self.age = self._late = period * (1.0 - self._share) / self._share
        self._slow_share, slowly = _low_pass(SLOW_CUT, period)
        self._tare_share = 1.0 - math.exp(-period / parameters.tare_time)
        # What is filtered already is no white noise, of which a mean has less.
        mean = math.sqrt(2.0) if deviation else math.sqrt(2.0 * min(period / SPAN, 1.0))
        self.deviation = noise * mean, turning * mean
        self._settled = noise * math.sqrt(0.5 * period / parameters.tare_time)
        self.threshold = parameters.force + parameters.certain * noise * left
        self._lasting = parameters.force + parameters.certain * noise * slowly
        self._released, self._ticks = parameters.released, math.ceil(parameters.ticks)
        self._anchored, self._edge = parameters.anchor * weight, parameters.edge
        self._tare_time, self._tare_height = parameters.tare_time, parameters.tare_height
        self._bias, self._tared_after, self._begun = sensors.wrench_bias, parameters.tared_after, False
        self._filtered, self.tare, self._slow = np.zeros((2, 6)), np.zeros((2, 6)), np.full(2, 0.5 * weight)
        self._wrenches = self._wrench = self.wrench = np.zeros((2, 6))
        self._count, self.tared = np.zeros(2, dtype=np.intp), np.zeros(2)
        self._tare, self._tared = self.tare, self.tared
        self.felt, self.firm = [True, True], [True, True]

    @property
    def bias(self) -> float:
        """Deviation of what a force is off for long: a sensor's bias until it was tared, then that of the tare [N]."""
        if self._bias == 0.0:
            return 0.0
        tared = min(self._tared[0], self._tared[1])
        return math.hypot(self._bias * math.exp(-tared / self._tare_time), self._settled)

    def update(self, reading: Reading, still: Sequence[bool], above: Array, edge: tuple[int, int] = (0, 0)) -> None:
        """Take the wrenches of a tick.

        Args:
            reading: of the sensors in the feet.
            still: soles that the controller means to stand still, on an edge or flat.
            above: how far each sole is over the ground, shape (2,) [m].
            edge: on which each rolls: 1 the toe edge, -1 the heel edge, 0 none [-].
        """
        share = self._share if reading.fresh else 0.0
        if not self._begun:
            share, self._begun = 1.0, True
        self.age = reading.age + self._late
        self._filter(reading.values, share)
        for k in (0, 1):
            self._feel(k)
            self._tare_foot(k, above[k])
        carrying = 1 if self._force(1) > self._force(0) else 0
        if not (self.felt[0] or self.felt[1]) and self._force(carrying) > self.threshold:
            self.felt[carrying] = True
        for k in (0, 1):
            self.firm[k] = bool(self.felt[k] and self._settled_on(k, edge[1] if k else edge[0]) and still[k])
        if not (self.firm[0] or self.firm[1]):
            self.firm[carrying] = self.felt[carrying]
        self.wrench = self._wrenches.copy()

    def _filter(self, reading: Array, share: float) -> None:
        """Let the wrenches follow a share of a reading, and a slower force follow them."""
        for k in range(2):
            for i in range(6):
                if share > 0.0:
                    self._filtered[k, i] += share * (reading[k, i] - self._filtered[k, i])
                self._wrench[k, i] = self._filtered[k, i] - self._tare[k, i]
            self._slow[k] += self._slow_share * (self._force(k) - self._slow[k])

    def _force(self, k: int) -> float:
        """Normal force on a sole [N]."""
        force: float = self._wrench[k, 2]
        return force

    def _feel(self, k: int) -> None:
        # A sensor that was not tared yet says the force of its bias, too.
        more = 2.0 * self._bias if self._tared[k] < self._tared_after else 0.0
        force = self._force(k)
        if self.felt[k]:
            touches = force > self._released * (self.threshold + more)
        else:
            touches = force > self.threshold + more or self._slow[k] > self._lasting + more
        self._count[k] = self._count[k] + 1 if touches != self.felt[k] else 0
        if self._count[k] >= self._ticks:
            self.felt[k], self._count[k] = bool(touches), 0

    def _settled_on(self, k: int, edge: int) -> bool:
        """Return true if a sole that is felt is settled: its CoP is well inside it, or it is all that carries.

        A sole that rolls over its toes turns about that edge, wherever the CoP is, if that is not at the other one. One
        that comes down on its heel arrives with a speed that its edge has yet to lose. Taken for still, such edges let
        the robot lose its balance at 1.4 m/s.
        """
        load = self._force(k)
        if self._force(1 - k) < self.threshold:
            return True
        if edge < 0:
            return False
        if not load > self._anchored * (0.5 if self.firm[k] else 1.0):
            return False
        reach = FIRM_EDGE if self.firm[k] else self._edge
        # The CoP is behind the centre where the moment is positive.
        pitch, roll = self._wrench[k, 4] * edge if edge else abs(self._wrench[k, 4]), abs(self._wrench[k, 3])
        inside: bool = pitch < reach * self._half_length * load and roll < reach * self._half_width * load
        return inside

    def _tare_foot(self, k: int, above: float) -> None:
        swings = above > self._tare_height and not self.felt[k] and self._force(1 - k) > CARRIES * self.weight
        if not swings or self._bias == 0.0:
            return
        # A foot that strikes something is pushed, whichever way: that is no bias, and would be felt ever after.
        left = UNLIKELY * self._bias * math.exp(-self._tared[k] / self._tare_time)
        force = algebra.row(self._wrench, k)
        if math.sqrt(algebra.inner(force, force)) < self.threshold + left:
            self._tared[k] += self._period
            for i in range(6):
                self._tare[k, i] += self._tare_share * self._wrench[k, i]


def sprung(changed: Array, half_size: tuple[float, float], give: float, edge: tuple[int, int] = (0, 0)) -> Array:
    """Motion of soles on springs under their corners under a change of their wrenches.

    Springs that give by a depth g under a force of 1 N turn under a moment M by M g / h², with h the half size across
    its axis: the corners are at plus and minus h. An edge has half of them, and turns about itself at will.

    Args:
        changed: wrenches now less those before, of the ground on the soles in their axes, shape (2, 6) [N, N·m].
        half_size: half of the sole's length and width [m].
        give: g, of a sole [m/N].
        edge: on which each rolls, 0 none [-].

    Returns:
        roll and pitch of each sole, and how far it or its edge rises, shape (2, 3) [rad, rad, m].
    """
    length, width = half_size
    moved = changed.take(_SPRUNG, axis=1)
    # Where the ground presses more, the sole sinks.
    moved *= (-give / width**2, -give / length**2, -give)
    for k in (0, 1):
        if edge[k]:
            moved[k] *= _ON_EDGE
    return moved


def _low_pass(cut: float, period: float) -> tuple[float, float]:
    """Share of a new value in a low pass of first order, and what it leaves of white noise [-]."""
    share = 1.0 - math.exp(-math.tau * cut * period) if cut < math.inf else 1.0
    return share, math.sqrt(share / (2.0 - share))
