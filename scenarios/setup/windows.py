"""The windows of faults on the control clock, and the least size of what acts."""

import math
from dataclasses import dataclass

from surefoot.scenarios.file.schema import Fault, InstrumentFault, Rates

LEAST = 1e-9
"""Least impulse per kilogram that pushes, with which a robot moves by a nanometre in a second, and the least of other
sizes that act: a nanometre, a nanoradian, the mass of a grain of dust [SI]."""

Timed = Fault | InstrumentFault
"""Faults that begin at a time, and last for a duration or to the end."""


@dataclass(frozen=True, slots=True)
class FaultWindow:
    """A fault on the control clock.

    Attributes:
        kind: of the fault.
        start: first control tick at which it holds.
        end: first control tick at which it does not any more; infinite when it lasts.
    """

    kind: str
    start: int
    end: float

    @classmethod
    def of(cls, fault: Timed, control_rate: int) -> "FaultWindow":
        """The window of a fault on a clock of ``control_rate`` [Hz]."""
        end = math.inf if fault.duration is None else round((fault.time + fault.duration) * control_rate)
        return cls(fault.kind, round(fault.time * control_rate), end)

    def holds(self, tick: int) -> bool:
        """Return true if it holds at a control tick."""
        return self.start <= tick < self.end

    def first_act(self, rates: Rates) -> float:
        """Time of the first tick at which it does something, infinite when there is none [s].

        A frozen planner is noticed when the next plan is due, but for the first plan, which is made whatever happens.
        """
        every = rates.control // rates.planner if self.kind == "planner_freeze" else 1
        first = max(math.ceil(self.start / every), 1 if every > 1 else 0) * every
        return first / rates.control if first < self.end else math.inf
