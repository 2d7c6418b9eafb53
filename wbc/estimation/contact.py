"""Which soles the ground carries, by their wrenches, and the wrenches freed of what the sensors add."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from surefoot.native.library import Library, library
from surefoot.readings import Reading
from surefoot.wbc.estimation.parameters import ContactDetection, SensorNoise
from surefoot.wbc.external import SPAN
from surefoot.wbc.types import Array

CUT, QUIET = 100.0, 5.0
"""Highest cut-off of the wrenches' low pass, and the force noise up to which it holds [Hz, N]."""

SLOW_CUT = 15.0
"""Of a slower one, in which a light touch rises out of the noise that hides it from the other [Hz]."""

CARRIES = 0.4
"""Share of the weight above which the other foot carries, while one is tared [-]."""

UNLIKELY = 4.0
"""Deviations of a sensor's bias up to which the force on a swinging foot is taken for one [-]."""

FIRM_EDGE = 1.05
"""Share of the half sole within which its CoP is where it stands still on [-]."""

_SPRUNG = (3, 4, 2)
"""Components of a wrench by which a sole on springs rolls, pitches and rises."""

_FEET = tuple(tuple([bool(bits >> (k + more) & 1) for k in (0, 1)] for more in (0, 2)) for bits in range(16))
"""Which feet are felt, and which are firm, by the bits that the kernel returns; nobody writes to these lists."""


class SoleContact:
    """Contact of both soles, decided once for filter, controller and planner.

    A normal force above a threshold is felt after some ticks, and until it falls below a lower one; a smaller one is
    felt when it lasts. While a foot swings high its sensor is tared in all six axes, by a slow low pass.

    Args:
        parameters: thresholds.
        sensors: noise of the wrenches.
        weight: of the robot [N].
        half_size: half of the sole's length and width [m].
        period: control period [s].
        deviation: of forces and of moments that are filtered already; None for those of sensors [N, N·m].

    Attributes:
        wrench: filtered and tared, shape (2, 6) [N, N·m].
        felt: which soles the ground carries.
        firm: which of these stand still: loaded, with the CoP well inside the sole.
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
        self._parameters, self._period, self.weight, self._half = parameters, period, weight, half_size
        noise, turning = deviation or (sensors.wrench_force, sensors.wrench_moment)
        # Twice the noise takes a filter of about a third of the bandwidth to feel as soon and as surely.
        cut = CUT * min(QUIET / noise, 1.0) ** (2.0 / 3.0) if noise > 0.0 else math.inf
        cut = math.inf if deviation else cut
        self._share, left = _low_pass(cut, period)
        self.age = self._late = period * (1.0 - self._share) / self._share
        slow_share, slowly = _low_pass(SLOW_CUT, period)
        self._tare_share = 1.0 - math.exp(-period / parameters.tare_time)
        # What is filtered already is no white noise, of which a mean has less.
        mean = math.sqrt(2.0) if deviation else math.sqrt(2.0 * min(period / SPAN, 1.0))
        self.deviation = noise * mean, turning * mean
        self._settled = noise * math.sqrt(0.5 * period / parameters.tare_time)
        self.threshold, self._lasting = (parameters.force + parameters.certain * noise * x for x in (left, slowly))
        self._slow, self._slow_share = np.full(2, 0.5 * weight), slow_share
        self._bias, self._begun = sensors.wrench_bias, False
        self._filtered, self._tare, self.wrench = (np.zeros((2, 6)) for _ in range(3))
        self._count, self.tared = np.zeros(2, dtype=np.int64), np.zeros(2)
        self.felt, self.firm = [True, True], [True, True]
        kernels = library()
        self._update = self._compiled(kernels) if kernels else None

    def _compiled(self, kernels: Library) -> Callable[[float, int], int]:
        p, force = self._parameters, self.weight
        self._reading, self._above, self._seen = np.zeros((2, 6)), np.zeros(2), np.zeros((2, 6))
        update: Callable[[float, int], int] = kernels.bind(
            "sole_contact_update",
            ticks=math.ceil(p.ticks),
            slow_share=self._slow_share,
            threshold=self.threshold,
            lasting=self._lasting,
            released=p.released,
            bias=self._bias,
            tared_after=p.tared_after,
            anchored=p.anchor * force,
            edge=p.edge,
            firm_edge=FIRM_EDGE,
            half_length=self._half[0],
            half_width=self._half[1],
            carries=CARRIES * force,
            unlikely=UNLIKELY,
            period=self._period,
            tare_time=p.tare_time,
            tare_share=self._tare_share,
            tare_height=p.tare_height,
            reading=self._reading,
            above=self._above,
            filtered=self._filtered,
            tare=self._tare,
            wrench=self._seen,
            slow=self._slow,
            tared=self.tared,
            count=self._count,
            felt=np.ones(2, dtype=np.int64),
            firm=np.ones(2, dtype=np.int64),
        )
        return update

    @property
    def bias(self) -> float:
        """Deviation of what a force is off for long: a sensor's bias until it was tared, then that of the tare [N]."""
        if self._bias == 0.0:
            return 0.0
        return math.hypot(self._bias * math.exp(-float(self.tared.min()) / self._parameters.tare_time), self._settled)

    def update(self, reading: Reading, still: Sequence[bool], above: Array | Sequence[float]) -> None:
        """Take the wrenches of a tick.

        Args:
            reading: of the sensors in the feet.
            still: soles that the controller means to stand still.
            above: how far each sole is over the ground, shape (2,) [m].
        """
        share = self._share if reading.fresh else 0.0
        if not self._begun:
            share, self._begun = 1.0, True
        self.age = reading.age + self._late
        if self._update is not None:
            self._reading[:], self._above[:] = reading.values, above
            bits = self._update(share, still[0] + 2 * still[1])
            self.wrench, (self.felt, self.firm) = self._seen.copy(), _FEET[bits]
            return
        self._filtered += share * (reading.values - self._filtered)
        self.wrench = wrench = self._filtered - self._tare
        self._slow += self._slow_share * (wrench[:, 2] - self._slow)
        force = wrench[:, 2].tolist()
        for k in (0, 1):
            self._feel(k, force)
            self._tare_foot(k, force, above[k])
        if not any(self.felt) and max(force) > self.threshold:
            self.felt[int(force[1] > force[0])] = True
        for k in (0, 1):
            self.firm[k] = self.felt[k] and self._flat(k, force) and still[k]
        if not any(self.firm):
            carrying = int(force[1] > force[0])
            self.firm[carrying] = self.felt[carrying]

    def _feel(self, k: int, force: list[float]) -> None:
        p = self._parameters
        # A sensor that was not tared yet says the force of its bias, too.
        more = 2.0 * self._bias if self.tared[k] < p.tared_after else 0.0
        if self.felt[k]:
            touches = force[k] > p.released * (self.threshold + more)
        else:
            touches = bool(force[k] > self.threshold + more or self._slow[k] > self._lasting + more)
        self._count[k] = self._count[k] + 1 if touches != self.felt[k] else 0
        if self._count[k] >= p.ticks:
            self.felt[k], self._count[k] = touches, 0

    def _flat(self, k: int, force: list[float]) -> bool:
        p, load = self._parameters, force[k]
        anchored = load > p.anchor * self.weight * (0.5 if self.firm[k] else 1.0)
        if not anchored or force[1 - k] < self.threshold:
            return anchored or force[1 - k] < self.threshold
        moment = self.wrench[k, 3:5].tolist()
        reach = FIRM_EDGE if self.firm[k] else p.edge
        return bool(abs(moment[1]) < reach * self._half[0] * load and abs(moment[0]) < reach * self._half[1] * load)

    def _tare_foot(self, k: int, force: list[float], above: float) -> None:
        p, x = self._parameters, self.wrench[k, :2]
        swings = above > p.tare_height and not self.felt[k] and force[1 - k] > CARRIES * self.weight
        if not swings or self._bias == 0.0:
            return
        # A foot that strikes something is pushed, whichever way: that is no bias, and would be felt ever after.
        left = UNLIKELY * self._bias * math.exp(-self.tared[k] / p.tare_time)
        if math.hypot(x.item(0), x.item(1), force[k]) < self.threshold + left:
            self.tared[k] += self._period
            self._tare[k] += self._tare_share * self.wrench[k]


def sprung(changed: Array, half_size: tuple[float, float], give: float) -> Array:
    """How soles on springs under their corners move under a change of their wrenches.

    Springs that give by a depth g under a force of 1 N turn under a moment M by M g / h², with h the half size across
    its axis: the corners are at plus and minus h.

    Args:
        changed: wrenches now less those before, of the ground on the soles in their axes, shape (2, 6) [N, N·m].
        half_size: half of the sole's length and width [m].
        give: g, of a sole [m/N].

    Returns:
        roll and pitch of each sole, and how far it rises, shape (2, 3) [rad, rad, m].
    """
    length, width = half_size
    moved = changed.take(_SPRUNG, axis=1)
    # Where the ground presses more, the sole sinks.
    moved *= (-give / width**2, -give / length**2, -give)
    return moved


def _low_pass(cut: float, period: float) -> tuple[float, float]:
    """Share of a new value in a low pass of first order, and what it leaves of white noise [-]."""
    share = 1.0 - math.exp(-math.tau * cut * period) if cut < math.inf else 1.0
    return share, math.sqrt(share / (2.0 - share))
