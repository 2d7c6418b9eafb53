"""What a run tells while it goes on, and how it ended."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal


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
