"""What every closed loop has in common: it goes tick by tick until its time is over, it falls or it meets a fault."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal, Protocol

from surefoot.planner.types import PhaseInfo, PhaseKind
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.file.schema import Fault


@dataclass(frozen=True, slots=True)
class Progress:
    """Where a run is.

    Attributes:
        time: simulated [s].
        duration: that it will take at most, simulated [s].
        phase: in words, such as "single support, step 2".
        real_time_factor: simulated over wall-clock time so far [-].
    """

    time: float
    duration: float
    phase: str
    real_time_factor: float


@dataclass(frozen=True, slots=True)
class End:
    """How a run ended.

    Attributes:
        kind: completed; fall; fault (NaN, divergence, solver failure); interrupted by the user.
        time: simulated [s].
        reason: in words; empty when completed.
    """

    kind: Literal["completed", "fall", "fault", "interrupted"]
    time: float
    reason: str = ""


OnProgress = Callable[[Progress], None]


class FaultSchedule:
    """Time windows of the scenario's faults on the control clock."""

    def __init__(self, faults: Sequence[Fault], control_rate: int) -> None:
        """Faults with times in seconds, on a clock of ``control_rate`` [Hz]."""
        self._windows = tuple(
            (fault.kind, round(fault.time * control_rate), _end(fault, control_rate)) for fault in faults
        )

    def active(self, kind: str, tick: int) -> bool:
        """Whether a fault of that kind acts at that control tick."""
        return any(name == kind and start <= tick < end for name, start, end in self._windows)


def _end(fault: Fault, control_rate: int) -> float:
    return float("inf") if fault.duration is None else round((fault.time + fault.duration) * control_rate)


AFTER_FALL = 0.3
"""How long a run goes on after a fall, so that the log shows it [s]."""

_PHASE_NAMES = {PhaseKind.STAND: "standing", PhaseKind.DOUBLE: "double support", PhaseKind.SINGLE: "single support"}


class RunFault(Exception):  # noqa: N818  the event, not a mistake of the caller
    """What ends a run before its time, in words."""


@contextmanager
def refusing() -> Iterator[None]:
    """Turn the refusal of a part to be built as the scenario asks into an error that the user can mend.

    Raises:
        SetupError: instead of a ValueError.
    """
    try:
        yield
    except ValueError as refusal:
        raise SetupError(str(refusal)) from refusal


class Loop(Protocol):
    """A closed loop."""

    def tick(self, tick: int) -> bool:
        """Go through one control tick; returns whether the robot has fallen.

        Raises:
            RunFault: the run cannot go on.
        """
        ...

    @property
    def phase(self) -> PhaseInfo:
        """Where the gait stands; asked only after a tick."""
        ...


@dataclass(slots=True)
class Watch:
    """Splits wall-clock time into laps.

    Attributes:
        last: end of the last lap [s].
    """

    last: float

    @classmethod
    def start(cls) -> "Watch":
        """A watch whose first lap begins now."""
        return cls(time.perf_counter())

    def lap(self) -> float:
        """Time since the last lap ended [s]."""
        now = time.perf_counter()
        passed = now - self.last
        self.last = now
        return passed


def run_ticks(loop: Loop, rate: int, duration: float, on_progress: OnProgress) -> End:
    """Run a closed loop to the end, to shortly after a fall, or to a fault.

    Args:
        loop: the closed loop, at its start.
        rate: of its ticks [Hz].
        duration: simulated time [s].
        on_progress: is told where the run is, every simulated tenth of a second.
    """
    started = time.perf_counter()
    ticks = round(duration * rate)
    end, last = End("completed", ticks / rate), ticks
    tick = 0
    try:
        while tick < last:
            if loop.tick(tick) and end.kind == "completed":
                end = End("fall", tick / rate, f"the robot fell at {tick / rate:.3f} s")
                last = min(last, tick + round(AFTER_FALL * rate))
            tick += 1
            if tick % (rate // 10 or 1) == 0:
                on_progress(_progress(loop.phase, tick / rate, ticks / rate, time.perf_counter() - started))
    except RunFault as fault:
        return End("fault", tick / rate, str(fault))
    return end


def _progress(phase: PhaseInfo, now: float, duration: float, wall: float) -> Progress:
    name = _PHASE_NAMES[phase.kind]
    if phase.kind is PhaseKind.SINGLE:
        name = f"{name}, step {phase.step}"
    return Progress(now, duration, name, now / wall if wall > 0.0 else 0.0)
