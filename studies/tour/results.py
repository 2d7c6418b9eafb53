"""The results of many tours: survival and errors with intervals, the curve of punches, and causes of falls."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from surefoot.maths.chance import wilson
from surefoot.scenarios.judge.metrics import plain
from surefoot.studies.tour.ride import PunchTaken, TourResult
from surefoot.studies.tour.rules import DURATION, SLOT

RESAMPLES = 4000
"""Samples of the tours, from which the interval of a mean is read [-]."""

WIDTH = 0.1
"""Width of a bin of the punches' impulse [N·s/kg]."""

SOON = 2.5
"""After a punch, within which a fall is one from it [s]."""

STEEP = 0.7
"""Vertical share of a punch's direction from which on it is an upward or a downward one [-]."""

LINKS = ("hip", "knee", "ankle", "waist", "shoulder", "elbow", "wrist")
"""Joints on whose links punches come, by a part of their names."""


@dataclass(frozen=True, slots=True)
class Mean:
    """A mean with its 95 % interval, by resampling; nan of nothing.

    Attributes:
        value: the mean.
        low: lower end of the interval.
        high: upper end.
        count: of values.
    """

    value: float
    low: float
    high: float
    count: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Mean":
        """The mean of values; the same ones have the same interval each time."""
        given = np.array(values, dtype=np.float64)
        if not len(given):
            return cls(math.nan, math.nan, math.nan, 0)
        drawn = np.random.default_rng(0).integers(len(given), size=(RESAMPLES, len(given)))
        low, high = np.percentile(given[drawn].mean(axis=1), (2.5, 97.5))
        return cls(float(given.mean()), float(low), float(high), len(given))


@dataclass(frozen=True, slots=True)
class Share:
    """A share, with its 95 % interval by Wilson's score.

    Attributes:
        of: what is counted.
        kept: how many.
        count: of how many.
        low: lower end of the interval [-].
        high: upper end [-].
    """

    of: str
    kept: int
    count: int
    low: float
    high: float

    @classmethod
    def counted(cls, name: str, kept: int, count: int) -> "Share":
        """The share of counts, the second of which is greater than 0."""
        rate = wilson(kept, count)
        return cls(name, kept, count, rate.low, rate.high)


@dataclass(frozen=True, slots=True)
class RowResult:
    """The result of the tours of a row.

    Attributes:
        row: its name.
        tours: how many.
        seconds: after which a tour is over [s].
        survival: [s].
        survival_median: [s].
        completed: tours without a fall.
        position_error: at the places when their time is over [m].
        heading_error: at the places when their time is over [rad].
        energy: of a whole tour at the power of the slots that were brought to their end [kJ].
        punches: survived, by the level impulse, by link, by phase and by direction.
        falls: what they came of, with how many.
        faults: tours that the controller gave up.
    """

    row: str
    tours: int
    seconds: float
    survival: Mean
    survival_median: float
    completed: Share
    position_error: Mean
    heading_error: Mean
    energy: Mean
    punches: dict[str, tuple[Share, ...]]
    falls: tuple[tuple[str, int], ...]
    faults: int

    @classmethod
    def of(cls, results: Sequence[TourResult], seconds: float = DURATION) -> "RowResult":
        """The result of the tours of one row, at least one."""
        falls: dict[str, int] = {}
        for one in results:
            if not one.completed:
                falls[cause(one)] = falls.get(cause(one), 0) + 1
        punches = [punch for one in results for punch in one.punches]
        return cls(
            row=results[0].row,
            tours=len(results),
            seconds=seconds,
            survival=Mean.of([one.survival for one in results]),
            survival_median=float(np.median([one.survival for one in results])),
            completed=Share.counted("tours", sum(one.completed for one in results), len(results)),
            position_error=Mean.of([error for one in results for error in one.position_errors]),
            heading_error=Mean.of([error for one in results for error in one.heading_errors]),
            energy=Mean.of([1e-3 * energy * DURATION / SLOT for one in results for energy in one.energy]),
            punches={name: survived(punches, kind) for name, kind in KINDS.items()},
            falls=tuple(sorted(falls.items(), key=lambda fall: (-fall[1], fall[0]))),
            faults=sum(bool(one.fault) for one in results),
        )


def survived(punches: Sequence[PunchTaken], kind: Callable[[PunchTaken], str]) -> tuple[Share, ...]:
    """Shares of the punches of each kind that were survived."""
    kinds = sorted({kind(punch) for punch in punches})
    sorted_in = {name: [punch.survived for punch in punches if kind(punch) == name] for name in kinds}
    return tuple(Share.counted(name, sum(kept), len(kept)) for name, kept in sorted_in.items())


def strength(punch: PunchTaken) -> str:
    """The bin of its level impulse [N·s/kg]."""
    low = math.floor(punch.level / WIDTH) * WIDTH
    return f"{low:.1f} to {low + WIDTH:.1f}"


def link(punch: PunchTaken) -> str:
    """Link that it hits."""
    return next(name for name in LINKS if name in punch.joint)


def phase(punch: PunchTaken) -> str:
    """Phase of the gait at which it comes: double support, or a third of single support."""
    third = min(int(3.0 * punch.fraction), 2)
    return "double" if punch.phase == "double" else f"single, {('first', 'middle', 'last')[third]} third"


def direction(punch: PunchTaken) -> str:
    """Direction of the punch, as the gait sees it."""
    x, y, z = punch.direction
    if abs(z) > STEEP:
        return "upward" if z > 0.0 else "downward"
    if abs(x) >= abs(y):
        return "forward" if x > 0.0 else "backward"
    if punch.stance == "none":
        return "sideways in double support"
    return "over the stance foot" if (y > 0.0) == (punch.stance == "left") else "to the swing foot"


KINDS: dict[str, Callable[[PunchTaken], str]] = {
    "level impulse": strength,
    "link": link,
    "phase": phase,
    "direction": direction,
}


def cause(result: TourResult) -> str:
    """Cause of the fall of a tour."""
    last = result.punches[-1] if result.punches else None
    if last is None or result.survival - last.time > SOON:
        return "no punch"
    limb = "arm" if link(last) in ("shoulder", "elbow", "wrist") else "leg or waist"
    return f"{direction(last)}, on {limb}"


SLOTS = {"position_errors": "m", "heading_errors": "rad", "energy": "J"}
"""Numbers of each slot of a tour that was brought to its end, with its unit."""

COLUMNS = (
    "row",
    "seed",
    "survival [s]",
    "completed",
    *(f"{name} [{unit}]" for name, unit in SLOTS.items()),
    "left_over",
)
"""Columns of the table of tours; what is left over is a distance [m] and an angle [rad]."""


def tours_table(tours: Sequence[TourResult]) -> Iterator[Sequence[Any]]:
    """Rows of cells, of which the first is the heading; numbers of slots stand in one cell, with spaces."""
    yield COLUMNS
    for tour in tours:
        lists = (" ".join(f"{number:.4g}" for number in getattr(tour, name)) for name in SLOTS)
        over = " ".join(f"{number:.4g}" for number in tour.left_over or ())
        yield tour.row, tour.seed, f"{tour.survival:.6g}", int(tour.completed), *lists, over


def read_tours(rows: Iterable[Sequence[str]]) -> list[TourResult]:
    """Tours of such a table, without their punches.

    Raises:
        ValueError: it is none.
    """
    head, *rest = rows
    if tuple(head) != COLUMNS:
        raise ValueError(f"columns {', '.join(head)}, not {', '.join(COLUMNS)}")
    found = []
    for row, seed, survival, completed, *cells in rest:
        position, heading, energy, over = (tuple(map(float, cell.split())) for cell in cells)
        left_over = (over[0], over[1]) if over else None
        errors = (position, heading, energy)
        found.append(TourResult(row, int(seed), float(survival), completed == "1", *errors, (), "", 0, None, left_over))
    return found


def punches_table(rows: Sequence[RowResult]) -> Iterator[Sequence[Any]]:
    """Rows of the table of punches: how many of each kind were survived."""
    yield "row", "kind", "of", "survived", "punches"
    for row in rows:
        for kind, shares in row.punches.items():
            yield from ((row.row, kind, share.of, share.kept, share.count) for share in shares)


def to_json(result: RowResult) -> dict[str, Any]:
    """Object for `json`, what is nothing as None."""
    record: dict[str, Any] = plain(asdict(result))
    return record
