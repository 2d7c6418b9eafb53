"""A channel of a log as a table for other tools: CSV, npz or parquet by the file's ending."""

import csv
import io
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import ChannelData, Log

_ROWS_AT_ONCE = 4096


def selected(log: Log, topic: str, start: float | None, end: float | None, field: str | None) -> ChannelData:
    """Messages of a topic in a window of time, with one field or all.

    Args:
        log: the log.
        topic: its topic.
        start: first time [s]; None from the beginning.
        end: last time [s]; None to the end.
        field: the field; None for all.

    Raises:
        LogError: there is no such topic or field, its messages are not of a fixed layout, or no message is left.
    """
    first, last = log.time_range()
    channel = log.window(topic, first if start is None else start, last if end is None else end)
    if not len(channel):
        raise LogError(f"{log.path}: no message of {topic} in that time; the log is from {first:.3f} s to {last:.3f} s")
    return channel if field is None else channel.only(field)


def export(channel: ChannelData, path: Path) -> None:
    """Write a channel to a file; time [s] is the first column, an array's elements are columns ``name_i_j``.

    Raises:
        LogError: the ending is unknown, the file cannot be written, or pyarrow is needed and missing.
    """
    writers: Mapping[str, Callable[[ChannelData], bytes]] = {".csv": _csv, ".npz": _npz, ".parquet": _parquet}
    write = writers.get(path.suffix.lower())
    if write is None:
        raise LogError(f"{path}: unknown kind of file '{path.suffix}'; end its name in {', '.join(writers)}")
    try:
        path.write_bytes(write(channel))
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise LogError(f"{path}: cannot be written, {reason}; choose another directory") from None


def _csv(channel: ChannelData) -> bytes:
    table, text = channel.columns(), io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    for first in range(0, len(channel), _ROWS_AT_ONCE):
        writer.writerows(
            zip(*(column[first : first + _ROWS_AT_ONCE].tolist() for column in table.values()), strict=True)
        )
    return text.getvalue().encode()


def _npz(channel: ChannelData) -> bytes:
    data = io.BytesIO()
    fields: dict[str, Any] = {field.name: channel.field(field.name) for field in channel.fields}
    np.savez_compressed(data, time=channel.time, **fields)
    return data.getvalue()


def _parquet(channel: ChannelData) -> bytes:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise LogError("parquet needs the package pyarrow; `pip install pyarrow`, or export to .csv or .npz") from None
    data = io.BytesIO()
    pyarrow.parquet.write_table(pyarrow.table(channel.columns()), data)
    return data.getvalue()
