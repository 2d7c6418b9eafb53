"""Thresholds of a campaign held against those of an earlier time, from the table that it wrote."""

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many.points import Outcome
from surefoot.scenarios.output import reason
from surefoot.studies.campaigns.campaign import Campaign
from surefoot.studies.campaigns.points import Cell

BASELINE = "baseline"
"""Stands for the table that comes with Surefoot."""

THRESHOLD = "threshold"
"""Name of the column of what was found, before its unit; the columns before it say of what."""

FALLEN = 0.05
"""Share of the mean by which thresholds may be lower without being worse [-]."""

Labels = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Moved:
    """A threshold then and now: 0 where the whole range was too much, infinite where all of it passed.

    Attributes:
        labels: of what it is.
        before: then.
        now: now.
    """

    labels: Labels
    before: float
    now: float


@dataclass(frozen=True, slots=True)
class Against:
    """Thresholds then and now.

    Attributes:
        moved: those that both have, in the order of now.
        missing: of now, how many the table lacks.
        tolerance: up to which the search finds one.
    """

    moved: tuple[Moved, ...]
    missing: int
    tolerance: float

    @property
    def means(self) -> tuple[float, float]:
        """Mean of those that are finite both times, then and now."""
        both = [(one.before, one.now) for one in self.moved if math.isfinite(one.before) and math.isfinite(one.now)]
        return (_mean([before for before, _ in both]), _mean([now for _, now in both]))

    @property
    def worst(self) -> tuple[float, float]:
        """Least of them, then and now."""
        return min(one.before for one in self.moved), min(one.now for one in self.moved)

    @property
    def worse(self) -> bool:
        """True if the mean has fallen by more than a twentieth, or the least by more than the search resolves.

        Worse is, too, what was above the whole range and is found within it or below: no mean has both.
        """
        mean, least = self.means, self.worst
        if any(math.isinf(one.before) and math.isfinite(one.now) for one in self.moved):
            return True
        return mean[1] < (1.0 - FALLEN) * mean[0] or least[1] < least[0] - 1.5 * self.tolerance

    def lines(self) -> Iterator[str]:
        """Lines on what has changed, for a person."""
        (mean, mean_now), (least, least_now) = self.means, self.worst
        yield f"mean {mean:.3f} -> {mean_now:.3f}, least {least:.3f} -> {least_now:.3f}"
        for one in self.moved:
            if not math.isclose(one.now, one.before, abs_tol=1e-4):
                named = ", ".join(value for _, value in one.labels)
                yield f"  {named}: {one.before:.3f} -> {one.now:.3f}"
        if self.missing:
            yield f"{self.missing} thresholds are not in the table"


class Table:
    """Thresholds of an earlier time.

    Args:
        path: of the ``thresholds.csv`` of a sweep.

    Raises:
        ScenarioError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._then = path, _read(path)

    def against(self, outcomes: Sequence[Outcome]) -> Against:
        """Hold what searches found against it.

        Raises:
            ScenarioError: both have nothing in common.
        """
        moved, missing, tolerance = [], 0, 0.0
        for outcome in outcomes:
            cell, found = outcome.cell, outcome.threshold
            if found is None or not isinstance(cell, Cell):
                continue
            labels = _labels({name: str(value) for name, value in cell.labels.items()})
            bisect = cell.campaign.bisect(cell.keys)
            tolerance = max(tolerance, bisect.tolerance or 0.0 if bisect else 0.0)
            if labels in self._then:
                now = found.value if found.value is not None else math.inf if found.side == "above" else 0.0
                moved.append(Moved(labels, self._then[labels], float(now)))
            else:
                missing += 1
        if not moved:
            what = f"{self._path}: has no threshold of what was searched"
            raise ScenarioError([f"{what}; give the table of the same campaign"])
        return Against(tuple(moved), missing, tolerance)


def table(campaign: Campaign, named: str) -> Table:
    """The table that a campaign is to be held against.

    Args:
        campaign: that is run.
        named: path of a table, or ``baseline`` for that which comes with Surefoot.

    Raises:
        ScenarioError: the campaign searches nothing, or there is no such table.
    """
    name = campaign.spec.name
    if campaign.spec.bisect is None:
        raise ScenarioError([f"{campaign.place}: searches no thresholds to hold against a table; give it a bisect"])
    if named != BASELINE:
        return Table(Path(named))
    path = Path(__file__).parent / "baselines" / f"{name}.csv"
    if not path.is_file():
        raise ScenarioError([f"campaign '{name}' comes with no table of its thresholds; give the path of one"])
    return Table(path)


def _read(path: Path) -> dict[Labels, float]:
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        heading = [name.partition(" [")[0] for name in rows[0]]
        at, side = heading.index(THRESHOLD), heading.index("side")
        found = {}
        for row in rows[1:]:
            value = float(row[at]) if row[at] else math.inf if row[side] == "above" else 0.0
            found[_labels(dict(zip(heading[:at], row[:at], strict=True)))] = value
    except OSError as error:
        raise ScenarioError([f"{path}: cannot be read, {reason(error)}; give a thresholds.csv"]) from None
    except (ValueError, IndexError, csv.Error):
        raise ScenarioError([f"{path}: is no table of thresholds; give a thresholds.csv"]) from None
    return found


def _labels(named: Mapping[str, str]) -> Labels:
    return tuple(sorted(named.items()))


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values) if values else math.nan
