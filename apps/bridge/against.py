"""A controller on the readings of a log, held against what it made of them before: its outputs, tick by tick."""

import math
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import shown, write_whole
from surefoot.scenarios.show.compare import TOLERANCE, distinct_texts
from surefoot.scenarios.show.differences import ChannelDifference, compare_channels, disagreeing

OUTPUTS = (
    *("/estimate", "/estimation", "/planner_state", "/plan", "/footsteps", "/footstep", "/reference", "/wbc"),
    *("/torque", "/gait", "/controller", "/command"),
)
"""Channels of what a controller makes of its readings."""


@dataclass(frozen=True, slots=True)
class Held:
    """The outputs of a controller, held against those of a baseline.

    Attributes:
        baseline: path of the log with the outputs that are expected.
        log: path of the log of the controller now.
        tolerance: of values that agree, relative, and absolute below 1 [-].
        rate: of the control ticks [Hz].
        compared: channels that both have.
        parted: those that do not agree, in the order in which they part, of equal times the nearest to the cause first.
        lost: channels of the baseline that are there no more.
    """

    baseline: Path
    log: Path
    tolerance: float
    rate: int
    compared: tuple[str, ...]
    parted: tuple[ChannelDifference, ...]
    lost: tuple[str, ...]

    @property
    def agrees(self) -> bool:
        """True if every output of the baseline is there, within the tolerance."""
        return not self.parted and not self.lost

    def lines(self) -> Iterator[str]:
        """The findings for a person, the answer first."""
        if self.agrees:
            yield f"as in {self.baseline}: {len(self.compared)} channels, within {self.tolerance:g}"
            return
        for number, one in enumerate(self.parted):
            yield f"{'parts first' if number == 0 else 'then'}: {self._text(one)}"
        yield from (f"no more there: {topic}" for topic in self.lost)
        yield f"baseline: {self.baseline}; --update writes what is now in its place"

    def _text(self, one: ChannelDifference) -> str:
        if one.tolerated is not None and one.tolerated.time == one.beyond:
            first = one.tolerated
            before, now = distinct_texts(first.a, first.b)
            return (
                f"{one.topic} {first.field} at tick {self._tick(first.time)}, {first.time:.3f} s: {before}, now {now}"
            )
        if one.only_one is not None:
            only = one.only_one
            return f"{one.topic} at tick {self._tick(only)}, {only:.3f} s: a message in one of both only"
        counts = " and ".join(map(str, one.messages))
        return f"{one.topic}: {'; '.join(one.layout) or f'{counts} messages'}"

    def _tick(self, time: float) -> int:
        return round(time * self.rate)

    def to_json(self) -> dict[str, Any]:
        """The findings as one JSON object."""
        parted = [
            {
                "channel": one.topic,
                "time": one.beyond,
                "tick": None if one.beyond is None else self._tick(one.beyond),
                "field": None if one.tolerated is None else one.tolerated.field,
                "baseline": None if one.tolerated is None else _number(one.tolerated.a),
                "now": None if one.tolerated is None else _number(one.tolerated.b),
                "layout": list(one.layout),
            }
            for one in self.parted
        ]
        return {
            "agrees": self.agrees,
            "baseline": str(self.baseline),
            "log": str(self.log),
            "tolerance": self.tolerance,
            "compared": list(self.compared),
            "parted": parted,
            "lost": list(self.lost),
        }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def known(baseline: Path, update: bool) -> Log | None:
    """The log of a baseline; None where there is none yet, and it is to be written.

    Raises:
        LogError: it cannot be read, or has no outputs of a controller.
    """
    if update and not baseline.exists():
        return None
    found = read(baseline)
    if not any(topic in found.numeric for topic in OUTPUTS):
        raise LogError(f"{shown(baseline)}: has no outputs of a controller; give a log of one in full physics")
    return found


def held(before: Log, log: Path, tolerance: float = TOLERANCE) -> Held:
    """Hold the outputs in a log against those of a baseline, as far as the baseline has them.

    Args:
        before: the baseline.
        log: of the controller now.
        tolerance: of values that agree, relative, and absolute below 1 [-].

    Raises:
        LogError: the log cannot be read, or the tolerance is no such number.
    """
    if not 0.0 <= tolerance < math.inf:
        raise LogError(f"--tolerance {tolerance}: not a tolerance; give a number from 0 on, such as {TOLERANCE}")
    now = read(log)
    expected = tuple(topic for topic in OUTPUTS if topic in before.numeric and before.count(topic))
    there = tuple(topic for topic in expected if topic in now.numeric)
    channels = (one for one in compare_channels(before, now, tolerance) if one.topic in there)
    lost = tuple(topic for topic in expected if topic not in there)
    rate = RunView(now).constants.control_rate
    return Held(before.path, log, tolerance, rate, there, disagreeing(channels), lost)


def update(baseline: Path, log: Path) -> None:
    """Let a log be the baseline from now on.

    Raises:
        LogError: it cannot be written.
    """
    with write_whole(baseline, replace=True) as temporary:
        shutil.copyfile(log, temporary)
