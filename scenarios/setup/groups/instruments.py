"""The instruments of a scenario: when they are read, where they write, and which of their keys cannot act."""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pydantic import BaseModel

from surefoot.scenarios.errors import Key, Problem, dotted
from surefoot.scenarios.file.schema import InstrumentFault, InstrumentSettings
from surefoot.scenarios.setup.windows import LEAST, FaultWindow

_ROUNDING = 1e-6
"""Share of a control tick that an instant may be off one."""


@dataclass(frozen=True, slots=True)
class Pace:
    """The control ticks at which an instrument is read: for each of its periods the first that is not before it.

    Attributes:
        every: its period, at least 1 [control ticks].
    """

    every: float

    @classmethod
    def of(cls, period: float | None, rate: int) -> "Pace":
        """The pace of a period [s], None for a control tick, where there are so many in a second [Hz]."""
        return cls(1.0 if period is None else period * rate)

    def first(self, tick: int) -> int:
        """The first tick at which it is read, from a tick on."""
        number = max(0, math.floor((tick - 1 + _ROUNDING) / self.every) + 1)
        return math.ceil(number * self.every - _ROUNDING)


def channel_of(label: str) -> tuple[str, str]:
    """Topic and message type of the channel of an instrument with a label."""
    return f"/instrument/{label}", "Instrument_" + re.sub(r"\W", "_", label)


def instrument_problems(instruments: Sequence[InstrumentSettings], rate: int, duration: float) -> Iterator[Problem]:
    """List keys of instruments that cannot act, or that two of them share.

    Args:
        instruments: of a scenario.
        rate: control ticks in a second [Hz].
        duration: of the run [s].
    """
    labels: dict[str, int] = {}
    for index, one in enumerate(instruments):
        key, topic = ("instruments", index), channel_of(one.label or one.name)[0]
        first = labels.setdefault(topic, index)
        if first != index:
            what = f"instruments.{index} has the channel {topic}, as instruments.{first} has"
            yield Problem(key, what, "give one of them a label of its own")
        if one.period is not None and one.period * rate < 1.0 - _ROUNDING:
            what = f"instruments.{index}.period {one.period:g} s is less than a control tick"
            yield Problem((*key, "period"), what, f"use at least {1.0 / rate:g} s, or leave it out")
            continue
        yield from _slight(one, key)
        for number, fault in enumerate(one.faults):
            yield from _idle(fault, (*key, "faults", number), Pace.of(one.period, rate), rate, duration)


def _slight(group: BaseModel, key: Key) -> Iterator[Problem]:
    """List numbers that are not zero and so small that nothing follows from them."""
    for name, value in group:
        if isinstance(value, float) and 0.0 < abs(value) < LEAST:
            what = f"{dotted((*key, name))} {value:g} is too small to change anything"
            yield Problem((*key, name), what, f"use 0, or at least {LEAST:g}")


def _idle(fault: InstrumentFault, key: Key, pace: Pace, rate: int, duration: float) -> Iterator[Problem]:
    """List why a fault does nothing, or not all that it says."""
    name, window = dotted(key), FaultWindow.of(fault, rate)
    first, last = pace.first(window.start), min(window.end, round(duration * rate))
    if fault.kind == "freeze" and first == 0:
        first = pace.first(1)  # the first reading is what it says for ever
    if (fault.kind == "jump") == (fault.size is None):
        what = f"{name} is a {fault.kind} with{'out a' if fault.size is None else ' a'} size"
        yield Problem(key, what, "give its size" if fault.size is None else "leave it out")
    elif fault.size == 0.0:
        yield Problem((*key, "size"), f"{name}.size 0 is no jump", "give more or less, or leave the fault out")
    elif first >= last:
        what = f"{name} acts on no reading: none of {fault.time:g} s or later is read before {last / rate:g} s"
        yield Problem((*key, "time"), what, "let it begin before, or last for a period")
    elif math.isfinite(window.end) and window.end > round(duration * rate):
        what = f"{name} would last until {window.end / rate:g} s, and the end of the run at {duration:g} s cuts it off"
        yield Problem((*key, "duration"), what, f"give it at most {duration - fault.time:.6g} s, or no duration")
    else:
        yield from _slight(fault, key)
