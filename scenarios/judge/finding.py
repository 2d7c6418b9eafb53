"""What a health check finds in a log."""

from dataclasses import asdict
from typing import Any, Literal

import numpy as np

from surefoot.scenarios.judge.digest import Mask, RunView
from surefoot.scenarios.judge.walking import fall_time
from surefoot.values import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        check: its name.
        status: ok or warning.
        time: of the first evidence [s]; None where all is well, and where the evidence is of the whole run.
        value: the evidence at its strongest, in the check's unit.
        cause: what was found and its likely cause; empty when all is well.
    """

    check: str
    status: Literal["ok", "warning"]
    time: float | None
    value: float | None
    cause: str = ""

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        return asdict(self)


def judged(check: str, time: float | None, value: float | None, cause: str) -> Finding:
    """A warning where there is a time of the first evidence; else all is well, and no cause is told."""
    return Finding(check, "ok" if time is None else "warning", time, value, "" if time is None else cause)


def shared(check: str, warn: bool, value: float | None, cause: str) -> Finding:
    """What a check finds in a run as a whole, at no time of its own."""
    return Finding(check, "warning" if warn else "ok", None, value, cause if warn else "")


def first(run: RunView, evidence: Mask) -> float | None:
    """Time of the first tick with evidence [s]; None without any."""
    return float(run.time[np.argmax(evidence)]) if evidence.any() else None


def standing(run: RunView) -> int:
    """Ticks before a fall: what comes after it is no gait."""
    fall = fall_time(run)
    return run.ticks if fall is None else int(np.searchsorted(run.time, fall))
