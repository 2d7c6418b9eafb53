"""The incident of a run: a fall, or a criterion that it missed; and the likeness of two runs."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import known, measure
from surefoot.scenarios.judge.verdict import missed
from surefoot.scenarios.judge.walking import fall_time
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import shown
from surefoot.scenarios.record.provenance import END_RECORD

Array = NDArray[np.float64]

SAME_TIME = 0.3
"""Difference of the times of two falls that count as the same, of the reference robot [s]."""

SAME_WAY = 60.0
"""Angle between the directions of two such falls [deg]."""

_UPRIGHT = 1e-3
"""Way of the CoM from the middle of the feet below which a fall has no direction [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Harm:
    """The incident of a run.

    Attributes:
        time: of the fall, or the end of a run that did not fall [s].
        way: from the middle of the feet to the CoM at the fall, shape (2,) [m]; None where it did not fall.
        missed: criteria that a run missed which did not fall.
        within: time within which another fall counts as the same [s].
        fault: that ended the run, in words; empty where none has.
    """

    time: float
    way: Array | None
    missed: tuple[str, ...]
    within: float
    fault: str = ""

    @property
    def fell(self) -> bool:
        """True of a fall."""
        return self.way is not None

    @property
    def text(self) -> str:
        """The incident in words."""
        if self.fault:
            return f"ends at {self.time:.3f} s by a fault: {self.fault}"
        if not self.fell:
            return f"misses {', '.join(self.missed)}"
        return f"falls at {self.time:.3f} s {self.direction}".rstrip()

    @property
    def direction(self) -> str:
        """The direction of a fall in the world, in words; empty where it goes straight down."""
        if self.way is None or float(np.hypot(*self.way)) < _UPRIGHT:
            return ""
        angle = round(float(np.degrees(np.arctan2(self.way[1], self.way[0]))))
        return f"at {angle} deg from the world's x axis"

    def same(self, other: "Harm | None") -> bool:
        """Return true if another run came to the same: at about the time, and the same way."""
        if other is None or self.fell is not other.fell or bool(self.fault) is not bool(other.fault):
            return False
        if self.fault:
            return abs(self.time - other.time) <= self.within
        if self.way is None or other.way is None:
            return bool(set(self.missed) & set(other.missed))
        if abs(self.time - other.time) > self.within:
            return False
        sizes = float(np.hypot(*self.way) * np.hypot(*other.way))
        return sizes < _UPRIGHT**2 or bool(self.way @ other.way >= sizes * np.cos(np.radians(SAME_WAY)))


def harm_of(log: Log, criteria: Mapping[str, Bound]) -> Harm | None:
    """The incident of a run by its log; None of one that neither fell, nor ended by a fault, nor missed a criterion.

    Criteria on times of the wall's clock are no incident.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(log)
    if not run.has("/truth"):
        raise LogError(f"{shown(log.path)}: shows no motion; give the log of a run")
    time, within = fall_time(run), SAME_TIME * run.constants.similarity.time
    if time is not None:
        row = int(np.searchsorted(run.time, time))
        way = run.field("/truth", "com")[row, :2] - run.soles[row, :, :2].mean(axis=0)
        return Harm(time, way, (), within)
    end = log.metadata.get(END_RECORD, {})
    if end.get("kind") == "fault":
        return Harm(float(run.time[-1]), None, (), within, end.get("reason") or "without a reason")
    values = measure(log).values
    metrics = {name: known(name) for name in criteria}
    lasting = (name for name, metric in metrics.items() if metric is not None and metric.repeatable)
    names = tuple(name for name in lasting if missed(values, {name: criteria[name]}))
    return Harm(float(run.time[-1]), None, names, within) if names else None


@dataclass(frozen=True, slots=True)
class Likeness:
    """The likeness of the motion of a run to that of a log, up to the incident of either.

    Attributes:
        parts: first time at which the CoM or its velocity is another by a bit [s]; None where it never is.
        distance: greatest distance between the CoMs [m].
        later: time of the run's incident less that of the log's [s].
    """

    parts: float | None
    distance: float
    later: float

    @property
    def text(self) -> str:
        """The likeness in words."""
        if self.parts is None:
            return "the CoM moves as in the log, to the bit"
        when = f"{abs(self.later):.3f} s {'later' if self.later > 0.0 else 'earlier'}" if self.later else "as late"
        return f"{when}, the CoM within {1e3 * self.distance:.2g} mm of the log's until then"


def likeness(log: Log, then: Harm, other: Log, now: Harm) -> Likeness:
    """The likeness of the motion in another log to that in a log, at the times that both have."""
    end = round(1e9 * min(then.time, now.time))
    one, two = log["/truth"], other["/truth"]
    common, rows, others = np.intersect1d(one.time_ns, two.time_ns, assume_unique=True, return_indices=True)
    upto = int(np.searchsorted(common, end, side="right"))
    rows, others = rows[:upto], others[:upto]
    apart = [one.field(name)[rows] - two.field(name)[others] for name in ("com", "com_velocity")]
    differ = np.flatnonzero(np.any([part.any(axis=1) for part in apart], axis=0)) if upto else np.zeros(0, int)
    parts = 1e-9 * float(common[differ[0]]) if len(differ) else None
    distance = float(np.linalg.norm(apart[0], axis=1).max(initial=0.0))
    return Likeness(parts, distance, now.time - then.time)
