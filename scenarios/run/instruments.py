"""Instruments: what reads the true state into the log beside all else, at its own pace and with its own errors.

Nobody estimates, plans or controls with what they say, so that a run is the same with them as without.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.parts.guard import MisfitError, shown
from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.file.schema import InstrumentSettings
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter
from surefoot.scenarios.setup.groups.instruments import Pace, channel_of
from surefoot.scenarios.setup.parts import fit
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.setup.windows import FaultWindow
from surefoot.sim.measurement import Measurement
from surefoot.streams import Stream, generator

Array = NDArray[np.float64]

Read = Callable[[Measurement], Sequence[Any]]
"""From a true measurement, whose arrays the next tick overwrites, to the values of the channel's fields, in order."""


class Instrument:
    """A kind of instrument: which numbers it reads, and what it makes of the truth.

    To add one is a subclass with an instance in a file of its own, and a line in
    `surefoot.scenarios.file.registries.INSTRUMENTS` that leads to the instance; another package has an entry point of
    the group ``surefoot.instruments`` that leads to it. Its pace, its faults in time and its channel need nothing more.

    Attributes:
        name: value of ``instruments.name``.
        doc: what its channel holds, in one sentence.
        settings: model of an element of ``instruments``, with the keys that only this kind has.
    """

    name: str
    doc: str = ""
    settings: type[InstrumentSettings] = InstrumentSettings

    def fields(self, walk: Walk) -> tuple[FieldSpec, ...]:
        """The fields of its channel, with shapes, units and frames."""
        raise NotImplementedError

    def begin(self, walk: Walk, keys: Any, rng: np.random.Generator) -> Read:
        """One of its kind at the start of a run.

        Args:
            walk: what is run.
            keys: of this one, by the model of its kind.
            rng: of random numbers of its own, which follow from the run's seed and its label.
        """
        raise NotImplementedError


def channel(kind: Instrument, walk: Walk, label: str) -> ChannelSpec:
    """The channel of an instrument with a label."""
    topic, message = channel_of(label)
    return ChannelSpec(topic, message, kind.fields(walk), kind.doc)


class Measured(Protocol):
    """Whatever has the true measurement of a control tick."""

    measurement: Measurement


class Instruments:
    """The instruments of a run, each read into its channel when it is due.

    Args:
        walk: what is run.
        writer: of the log.
        measured: has the true measurement.

    Raises:
        PartError: one of others cannot be made.
    """

    def __init__(self, walk: Walk, writer: LogWriter, measured: Measured) -> None:
        self._measured = measured
        self._all = tuple(_begun(walk, writer, keys) for keys in walk.instruments)

    def tick(self, tick: int, time_ns: int) -> None:
        """Read those that are due at a control tick, which is at a time [ns].

        Raises:
            PartError: one of others fails.
        """
        for one in self._all:
            one.tick(tick, time_ns, self._measured.measurement)


@dataclass(slots=True)
class _Begun:
    """An instrument of a run.

    Attributes:
        read: what it reads.
        append: to its channel.
        pace: at which it is read.
        faults: in time, with the size of those that have one.
        due: first control tick at which it is read next.
        said: what it said last, None at first.
    """

    read: Callable[[Measurement], tuple[Array, ...]]
    append: Callable[..., None]
    pace: Pace
    faults: tuple[tuple[FaultWindow, float], ...]
    due: int = 0
    said: tuple[Array, ...] | None = None

    def tick(self, tick: int, time_ns: int, measurement: Measurement) -> None:
        """Read it if it is due; a fault moves none of the random numbers of what is said after it."""
        if tick < self.due:
            return
        self.due = self.pace.first(tick + 1)
        values = self.read(measurement)
        acting = [(window.kind, size) for window, size in self.faults if window.holds(tick)]
        kinds = {kind for kind, _ in acting}
        jump = math.fsum(size for kind, size in acting if kind == "jump")
        if jump:
            values = tuple([(value + jump).astype(value.dtype) for value in values])
        if "freeze" not in kinds or self.said is None:
            self.said = values
        if "drop" not in kinds:
            self.append(time_ns, *self.said)


def _begun(walk: Walk, writer: LogWriter, keys: InstrumentSettings) -> _Begun:
    label, rate = keys.label or keys.name, walk.rates.control
    rng = generator(walk.seed, Stream.INSTRUMENT, int.from_bytes(label.encode(), "little"))
    guard = INSTRUMENTS.guard(keys.name)
    with guard.making:
        kind: Instrument = INSTRUMENTS[keys.name]
        spec = channel(kind, walk, label)
        read = kind.begin(walk, keys, rng)
        if not callable(read):
            raise MisfitError(f"begins with {shown(read)}, which is no function of a measurement")
    taken = partial(_taken, spec.fields)
    reading = guard.function(read, taken) if guard.who else lambda measurement: taken(read(measurement))
    faults = tuple((FaultWindow.of(fault, rate), fault.size or 0.0) for fault in keys.faults)
    return _Begun(reading, writer.channel(spec).append, Pace.of(keys.period, rate), faults)


def _taken(fields: Sequence[FieldSpec], answer: Any, *_: Any) -> tuple[Array, ...]:
    """Copies of the values of a reading, of which NaN is one that says nothing.

    Raises:
        MisfitError: these are not the values of the fields.
    """
    return tuple(_values(fields, answer))


def _values(fields: Sequence[FieldSpec], answer: Any) -> Iterator[Array]:
    if not isinstance(answer, tuple | list) or len(answer) != len(fields):
        raise MisfitError(f"gave {shown(answer)}, which is no list of {len(fields)} values, one of each field")
    for field, value in zip(fields, answer, strict=True):
        fit(value, field.shape, field.name, finite=False)
        yield np.array(value, dtype=np.int64 if field.kind == "int" else np.float64)
