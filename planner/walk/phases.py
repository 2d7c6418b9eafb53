"""Support phases on the gait's clock, and what follows from them at the samples of a window."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.types import Array, Foot, PhaseKind
from surefoot.planner.walk.clock import CLOCK_ROUNDING, Flow


class RollSpan(NamedTuple):
    """When a foot rolls about its toe edge, and how far (see `planner.swing.heel_off`).

    Attributes:
        start: when it begins to [samples].
        end: when it is level again [samples].
        angle: its greatest pitch [rad].
    """

    start: float
    end: float
    angle: float


@dataclass(frozen=True, slots=True)
class Phase:
    """One support phase; it covers the clock from `start` to `end`.

    Attributes:
        kind: stand, double or single support.
        start: when it begins [samples].
        samples: how long it lasts, infinite for standing of which no end is known [samples].
        step: number of the step that this phase swings (single support) or has just landed (otherwise); 0 before.
        stance: the only supporting foot of a single support, otherwise None.
        support: support point on which the ZMP reference stands, or which it leaves.
        rest: part of a double support before it leaves [samples].
        roll: of the foot that leaves the ground in it or after it; None for one that stays level.
    """

    kind: PhaseKind
    start: float
    samples: float
    step: int
    stance: Foot | None
    support: int
    rest: float = 0.0
    roll: RollSpan | None = None

    @property
    def end(self) -> float:
        """When it is over."""
        return self.start + self.samples

    @property
    def row(self) -> int:
        """Row of a footstep plan whose foot stands; the other foot goes from the row before to the row after."""
        return self.step + (self.kind is not PhaseKind.SINGLE)


@dataclass(frozen=True, slots=True)
class PhaseSamples:
    """The phases at the n samples of a window.

    The ZMP reference moves along the polyline of the support points (`FootstepPlan.supports`): a point between the feet
    before each bout and at the end, and the stance foot of each step. At sample k it is `fraction[k]` of the
    way from point `index[k]` to the next. It rests while the robot stands, and on the stance foot in single
    support; in every double support it goes on to exactly the next point.

    Attributes:
        phases: those in sight, in order, without gaps.
        which: index into `phases`, shape (n,).
        kind: support phase, shape (n,).
        elapsed: clock since the phase began, shape (n,) [samples].
        length: of the phase, shape (n,) [samples].
        index: support point that the ZMP reference leaves, counted from `first`, shape (n,).
        fraction: share of the way to the next support point, shape (n,), in [0, 1).
        fraction_rate: rate of that share on the clock, within the phase's ramp, shape (n,) [1/s].
        contacts: planned contacts (left, right), shape (n, 2).
        sample_time: length of a sample [s].
        first: support point of the walk from which `index` counts.
        flow: how the clock goes.
    """

    phases: tuple[Phase, ...]
    which: NDArray[np.intp]
    kind: NDArray[np.intp]
    elapsed: Array
    length: Array
    index: NDArray[np.intp]
    fraction: Array
    fraction_rate: Array
    contacts: NDArray[np.bool_]
    sample_time: float
    first: int
    flow: Flow

    @classmethod
    def of(cls, phases: Sequence[Phase], flow: Flow, sample_time: float, first: int) -> "PhaseSamples":
        """The phases in sight where the clock goes over a window, counting support points from `first`."""
        which = np.searchsorted([p.start for p in phases], flow.clock + CLOCK_ROUNDING, side="right") - 1
        which = np.maximum(which, 0)
        contacts = np.array([[p.stance in (None, foot) for foot in Foot] for p in phases])
        columns = ([getattr(p, name) for p in phases] for name in ("kind", "start", "samples", "rest", "support"))
        kind, start, length, rest, support = (np.array(column)[which] for column in columns)
        elapsed = np.maximum(flow.clock - start, 0.0)
        ramp = np.where(kind == PhaseKind.DOUBLE, length - rest, np.inf)
        gone = elapsed - rest
        return cls(
            phases=tuple(phases),
            which=which,
            kind=kind,
            elapsed=elapsed,
            length=length,
            index=support - first,
            fraction=np.maximum(gone / ramp, 0.0),
            fraction_rate=np.where(gone >= 0.0, 1.0 / (ramp * sample_time), 0.0),
            contacts=contacts[which],
            sample_time=sample_time,
            first=first,
            flow=flow,
        )

    @property
    def last_stand(self) -> NDArray[np.bool_]:
        """Where the robot stands and no end of it is known, shape (n,)."""
        return np.isinf(self.length)

    def per_phase(self, values: Sequence[float]) -> Array:
        """Values of the kinds of phases at each sample, shape (n,)."""
        return np.array(values, dtype=np.float64)[self.kind]

    def in_time(self, values: Array) -> Array:
        """Values with their first and second derivatives by the clock, shape (3, n), turned into those by time."""
        if self.flow.rate is None:
            return values
        rate, bend = self.flow.rate
        return np.stack((values[0], values[1] * rate, values[2] * rate**2 + values[1] * bend))
