"""Topics of a log in a stretch of time, and their export to a file, a few seconds of messages at a time."""

import csv
import dataclasses
import importlib
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.columns import Columns, Memory
from surefoot.scenarios.errors import LogError, require
from surefoot.scenarios.log import ChannelData, FieldSpec, Log
from surefoot.scenarios.output import refuse_existing, write_whole

_ROWS_AT_ONCE = 4096


@dataclass(frozen=True, slots=True)
class Selection:
    """Messages of a topic in a stretch of time, which are read when one goes through them.

    Attributes:
        log: that they are of.
        topic: theirs.
        start: time of the first ones, those of the log if None [s].
        end: time of the last ones, those of the log if None [s].
        fields: that are asked for.
    """

    log: Log
    topic: str
    start: float | None
    end: float | None
    fields: tuple[FieldSpec, ...]

    @property
    def memory(self) -> Memory:
        """Bounds on what is held of the log at once."""
        return self.log.memory

    def __iter__(self) -> Iterator[ChannelData]:
        every = len(self.fields) != 1
        for part in self.log.parts(self.topic, self.start, self.end):
            yield part if every else part.only(self.fields[0].name)


@dataclass(frozen=True, slots=True)
class Joined:
    """Messages of several topics as one table: a row for each of the first topic, with the latest of each other one.

    Rows before the first message of another topic are left out. Fields are called by their topics, as ``contact.zmp``.

    Attributes:
        selections: of the topics, two at least, of one log and one stretch of time.
    """

    selections: tuple[Selection, ...]

    @property
    def memory(self) -> Memory:
        """Bounds on what is held of the log at once."""
        return self.selections[0].memory

    @property
    def fields(self) -> tuple[FieldSpec, ...]:
        """Fields of all topics."""
        return tuple(field for one in self.selections for field in prefixed(one.topic, one.fields))

    def __iter__(self) -> Iterator[ChannelData]:
        first, *others = self.selections
        topics = [one.topic for one in self.selections]
        held: dict[str, ChannelData] = {}
        for _, channels in first.log.stretches(topics, first.start, first.end):
            known = {topic: held[topic].joined(found) if topic in held else found for topic, found in channels.items()}
            clock = channels[first.topic].time_ns
            rows = {one.topic: np.searchsorted(known[one.topic].time_ns, clock, side="right") - 1 for one in others}
            there = np.all([found >= 0 for found in rows.values()], axis=0)
            held = {topic: found.from_row(len(found) - 1) for topic, found in known.items() if len(found)}
            if there.any():
                picked = {topic: found[there] for topic, found in rows.items()}
                yield self._table(channels[first.topic], np.flatnonzero(there), known, picked)

    def _table(
        self,
        clock: ChannelData,
        kept: NDArray[np.intp],
        known: dict[str, ChannelData],
        rows: dict[str, NDArray[np.intp]],
    ) -> ChannelData:
        columns = {}
        for one in self.selections:
            source, at = (clock, kept) if one.topic == clock.topic else (known[one.topic], rows[one.topic])
            values = source.values([field.name for field in one.fields])
            for own, field in zip(prefixed(one.topic, one.fields), one.fields, strict=True):
                columns[own.name] = values[field.name][at]
        return ChannelData.of(", ".join(rows), self.fields, clock.time_ns[kept], columns, clock.joints)


def prefixed(topic: str, fields: Sequence[FieldSpec]) -> Iterator[FieldSpec]:
    """Fields that are called by their topic, too."""
    return (dataclasses.replace(field, name=f"{topic.removeprefix('/')}.{field.name}") for field in fields)


def selected(log: Log, topic: str, start: float | None, end: float | None, field: str | None) -> Selection:
    """Choose messages of a topic in a window of time, open where an end is None [s], with one field or all.

    Raises:
        LogError: there is no such topic or field, its messages are not of a fixed layout, or none is in the window.
    """
    if start is not None and end is not None and start > end:
        raise LogError(f"--from {start:g} is after --to {end:g}; give the earlier time as --from")
    found = next(log.parts(topic, start, end), None)
    if found is None:
        first, last = log.time_range()
        raise LogError(f"{log.path}: no message of {topic} in that time; the log is from {first:.3f} s to {last:.3f} s")
    return Selection(log, topic, start, end, (found if field is None else found.only(field)).fields)


def export(selection: Selection | Joined, path: Path, replace: bool = False) -> int:
    """Write messages to a file; time is the first column, the others are those of `ChannelData.columns`.

    CSV has units in its headings, parquet has unit, frame and meaning as metadata of the columns.

    Returns:
        number of messages.

    Raises:
        LogError: the ending is unknown, the file exists or cannot be written, or pyarrow is needed and missing.
    """
    writers: Mapping[str, Callable[[Selection | Joined, Path], int]] = {
        ".csv": _csv,
        ".npz": _npz,
        ".parquet": _parquet,
    }
    write = writers.get(path.suffix.lower())
    if write is None:
        raise LogError(f"{path}: unknown kind of file '{path.suffix}'; end its name in {', '.join(writers)}")
    refuse_existing(path, replace)
    with write_whole(path, replace) as temporary:
        return write(selection, temporary)


def _csv(selection: Selection | Joined, path: Path) -> int:
    count = 0
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for part in selection:
            table, units = part.columns(), {name: note["unit"] for name, note in part.notes().items()}
            if not count:
                writer.writerow(name if units[name] in ("", "-") else f"{name} [{units[name]}]" for name in table)
            for first in range(0, len(part), _ROWS_AT_ONCE):
                rows = (column[first : first + _ROWS_AT_ONCE].tolist() for column in table.values())
                writer.writerows(zip(*rows, strict=True))
            count += len(part)
    return count


def _npz(selection: Selection | Joined, path: Path) -> int:
    names, kept = ("time", *(field.name for field in selection.fields)), Columns(selection.memory)
    for part in selection:
        kept.add("time", part.time)
        for name, values in part.values(names[1:]).items():
            kept.add(name, values)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:  # one after the other: numpy's own way holds all of them
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                np.lib.format.write_array(file, kept[name])
    return kept.rows("time")


def _parquet(selection: Selection | Joined, path: Path) -> int:
    pyarrow = require("pyarrow", "parquet", "parquet", "export to .csv or .npz")
    parquet, count, writer = importlib.import_module("pyarrow.parquet"), 0, None
    try:
        for part in selection:
            table, notes = pyarrow.table(part.columns()), part.notes()
            schema = pyarrow.schema([field.with_metadata(notes[field.name]) for field in table.schema])
            writer = writer or parquet.ParquetWriter(path, schema)
            writer.write_table(table.cast(schema))
            count += len(part)
    finally:
        if writer is not None:
            writer.close()
    return count
