"""The findings of a health check in a log."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from surefoot.scenarios.judge.digest import Array, Mask, RunView
from surefoot.scenarios.judge.walking import fall_time

Relation = Literal["cause", "effect"]


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        check: its name.
        status: ok or warning.
        time: of the first evidence [s]; None where all is well, and where the evidence is of the whole run.
        value: the evidence at its strongest, in the check's unit.
        found: what was found; empty when all is well.
        likely: why, as far as is known.
        relation: to the fall of the run: a cause acted before balance was lost, or is not as believed. An effect comes
            after a cause, or after the loss of balance. None of a run that did not fall, and where neither is known.
    """

    check: str
    status: Literal["ok", "warning"]
    time: float | None
    value: float | None
    found: str = ""
    likely: str = ""
    relation: Relation | None = None

    @property
    def cause(self) -> str:
        """The finding and its likely cause."""
        return ": ".join(filter(None, (self.found, self.likely)))

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        return {
            "check": self.check,
            "status": self.status,
            "time": self.time,
            "value": self.value,
            "relation": self.relation,
            "cause": self.cause,
        }


def judged(check: str, time: float | None, value: float | None, found: str = "", likely: str = "") -> Finding:
    """A warning where there is a time of the first evidence; else all is well, and nothing is reported."""
    if time is None:
        return Finding(check, "ok", None, value)
    return Finding(check, "warning", time, value, found, likely)


def shared(check: str, warn: bool, value: float | None, found: str = "", likely: str = "") -> Finding:
    """Make the finding of a check in a run as a whole, at no time of its own."""
    return Finding(check, "warning", None, value, found, likely) if warn else Finding(check, "ok", None, value)


def first(run: RunView, evidence: Mask) -> float | None:
    """Time of the first tick with evidence [s]; None without any."""
    return float(run.time[np.argmax(evidence)]) if evidence.any() else None


def standing(run: RunView) -> int:
    """Ticks before a fall: what comes after it is no gait."""
    fall = fall_time(run)
    return run.ticks if fall is None else int(np.searchsorted(run.time, fall))


def pushes(run: RunView) -> Array:
    """Sum of the pushes at each tick, zero where it was not measured, shape (n, 3) [N]."""
    topic = "/measurement" if run.has("/measurement") else "/truth"
    return np.nan_to_num(run.field(topic, "external_force"))
