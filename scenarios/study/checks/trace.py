"""The signs of a run, stage by stage, so that it can be said where it first parts from another one, and in what."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from surefoot.planner.geometry import frame_rotation
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.logview import FOOT_NAMES
from surefoot.scenarios.study.checks.signs import COLUMNS, SIGNS, Sign, stages

FAR = 10.0
"""Tolerances by which a run may be better than its baseline: one that is farther off says that something else than the
walk has changed, its judge for instance [-]."""

_LOST = 2.0
"""How far off over what is allowed a value counts that cannot be told any more [-]."""

_LABELS = ["stage", "foot"]
"""First columns of the table."""

_SIDES = (("ahead of", "behind"), ("to the left of", "to the right of"), ("above", "below"))


@dataclass(frozen=True, slots=True)
class Parting:
    """Something in which a run is not as its baseline.

    Attributes:
        text: what, where and by how much, in a sentence without a full stop.
        stage: number of the stage.
        excess: how far they are apart over how far they may be [-].
        figure: of `surefoot plot` that shows it.
        begin: of the stage [s].
        end: of the stage [s]; infinite for the last one.
    """

    text: str
    stage: int
    excess: float
    figure: str
    begin: float
    end: float


@dataclass(frozen=True, slots=True)
class Trace:
    """The signs of a run.

    Attributes:
        labels: of its stages.
        feet: that swing in them: left, right or both, which none does.
        values: by column, each of shape (stages,), NaN where one means nothing.
    """

    labels: tuple[str, ...]
    feet: tuple[str, ...]
    values: Mapping[str, Array]

    @classmethod
    def of(cls, log: Log) -> "Trace":
        """The signs of a log, as far as it has what they need."""
        run = RunView(log)
        parts = stages(run)
        values: dict[str, Array] = {}
        for sign in SIGNS if parts else ():
            if not (sign.body and run.constants.fidelity == "pendulum"):
                values |= dict(zip(sign.columns, sign.measure(run, parts).T, strict=True))
        return cls(tuple(one.label for one in parts), tuple((*FOOT_NAMES, "both")[one.foot] for one in parts), values)

    def partings(self, now: "Trace") -> list[Parting]:
        """Everything in which a run is not as this one, stage by stage, in each in the order of the signs."""
        longest = max(len(self.labels), len(now.labels))
        return [parting for stage in range(longest) for parting in self._partings(now, stage)]

    def _partings(self, now: "Trace", stage: int) -> list[Parting]:
        longer = self if len(self.labels) > stage else now
        begin, *later = longer._begins[stage:]
        window = (begin, min(later, default=math.inf))
        if min(len(self.labels), len(now.labels)) <= stage:
            text = f"{longer.labels[stage]} is {'not there' if longer is self else 'one too many'}"
            return [Parting(text, stage, math.inf, "balance", *window)]
        if (self.labels[stage], self.feet[stage]) != (now.labels[stage], now.feet[stage]):
            which = (f"{one.labels[stage]} with the foot {one.feet[stage]}" for one in (now, self))
            return [Parting(" is in the baseline ".join(which), stage, math.inf, "feet", *window)]
        told = ((sign, self._apart(now, sign, stage)) for sign in SIGNS)
        return [
            Parting(text, stage, excess, sign.figure, *window) for sign, (excess, text) in told if not excess <= 1.0
        ]

    @property
    def _begins(self) -> list[float]:
        return self.values["time"].tolist() if "time" in self.values else [0.0] * len(self.labels)

    def _apart(self, now: "Trace", sign: Sign, stage: int) -> tuple[float, str]:
        """How far a sign is off over what it may be, and that in words."""
        before, after = (self._at(sign, stage), now._at(sign, stage))
        told = np.isfinite(before), np.isfinite(after)
        if not np.any(told) or not self.values.keys() >= set(sign.columns):
            return 0.0, ""
        label, foot = self.labels[stage], self.feet[stage]
        where = {"first tick": "at the first tick", "stand": "before the first step"}.get(label, f"in {label}")
        what = sign.words.format(stage=where, label=label, foot=foot)
        if not np.all(told):
            since = "cannot be told any more" if told[0].all() else "could not be told in the baseline"
            return _LOST, f"{what} {since}"
        yaw = self.values["sole_yaw"][stage] if len(before) == 3 and "sole_yaw" in self.values else 0.0
        if sign.peak:
            before = np.array([np.nanmax(self.values[sign.columns[0]])])
            off = self._over_peak(now, sign, stage, float(before[0]))
        else:
            off = after - before
        if sign.around:
            off = np.remainder(off + math.pi, 2.0 * math.pi) - math.pi
        allowed = sign.tolerance[0] + sign.tolerance[1] * float(np.abs(before).max())
        text = _place_text(off, yaw, sign) if len(off) == 3 else _number_text(after, before, sign)
        return float(np.linalg.norm(off)) / allowed, f"{what}: {text}"

    def _over_peak(self, now: "Trace", sign: Sign, stage: int, peak: float) -> Array:
        """How far a value is over the greatest of all stages; where that one is, how far the run is below, if far."""
        (column,), tolerance = sign.columns, sign.tolerance[0] + sign.tolerance[1] * abs(peak)
        below = peak - float(np.nanmax(now.values[column]))
        if self.values[column][stage] == peak and below > FAR * tolerance:
            return np.array([-below])
        return np.maximum(now.values[column][[stage]] - peak, 0.0)

    def _at(self, sign: Sign, stage: int) -> Array:
        return np.array([self.values[name][stage] if name in self.values else math.nan for name in sign.columns])

    def lines(self) -> list[str]:
        """A table in YAML, a row for each stage."""
        digits = {column: sign.digits for sign in SIGNS for column in sign.columns}
        rows = [[*_LABELS, *self.values]]
        for stage, (label, foot) in enumerate(zip(self.labels, self.feet, strict=True)):
            numbers = ((column, values[stage]) for column, values in self.values.items())
            written = (f"{x:.{digits[column]}f}" if math.isfinite(x) else "~" for column, x in numbers)
            rows.append([label, foot, *written])
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        return [f"[{', '.join(map(str.rjust, row, widths))}]" for row in rows]

    @classmethod
    def from_rows(cls, rows: Any) -> "Trace":
        """Read such a table back.

        Raises:
            ValueError: it is none; says why.
        """
        if not isinstance(rows, list) or not rows or not all(isinstance(row, list) for row in rows):
            raise ValueError("its trace is no table")
        head, *below = rows
        named = all(isinstance(name, str) for name in head) and len(set(head)) == len(head)
        if not named or head[:2] != _LABELS or not set(head[2:]) <= set(COLUMNS):
            raise ValueError(f"its trace has columns other than {', '.join((*_LABELS, *COLUMNS))}")
        if any(len(row) != len(head) for row in below):
            raise ValueError("its trace has rows of other lengths than the first")
        if any(not (x is None or _is_finite(x)) for row in below for x in row[2:]):
            raise ValueError("its trace holds what is no finite number")
        columns = {
            name: np.array([math.nan if row[i] is None else float(row[i]) for row in below])
            for i, name in enumerate(head[2:], 2)
        }
        return cls(tuple(str(row[0]) for row in below), tuple(str(row[1]) for row in below), columns)


def _is_finite(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _place_text(off: Array, yaw: float, sign: Sign) -> str:
    """How far one place is from another, along the direction in which it is farthest in the heading there."""
    along = (*(off[:2] @ frame_rotation(yaw)), off[2])
    axis = int(np.argmax(np.abs(along)))
    return f"{sign.scale * abs(along[axis]):.1f} {sign.unit} {_SIDES[axis][int(along[axis] < 0.0)]} the baseline"


def _number_text(now: Array, before: Array, sign: Sign) -> str:
    values = (f"{sign.scale * float(one[0]):.3g} {sign.unit}".rstrip() for one in (now, before))
    return f"{next(values)}, {'at most ' if sign.peak else ''}{next(values)} in the baseline"
