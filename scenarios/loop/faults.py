"""Faults: those that end a run, and those that a scenario injects."""

from collections.abc import Sequence

from surefoot.scenarios.file.schema import Fault


class RunFault(Exception):  # noqa: N818  the event, not a mistake of the caller
    """What ends a run before its time, in words."""


class FaultSchedule:
    """Time windows of injected faults on the control clock."""

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
