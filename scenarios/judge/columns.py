"""Arrays that grow part by part while a log is read: in memory when they are small, else in files without a name."""

import tempfile
from collections.abc import Hashable, Iterator
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason

HELD_BYTES = 16 << 20
"""What all columns together may take in memory: a minute of a walk."""


class Columns:
    """Arrays by key, each joined of its parts.

    From a file an array is mapped anew whenever it is asked for, so that its memory is free again as soon as it is
    dropped, however long the log.
    """

    def __init__(self) -> None:
        self._parts: dict[Hashable, list[NDArray[Any]]] = {}
        self._files: dict[Hashable, IO[bytes]] = {}
        self._kinds: dict[Hashable, tuple[tuple[int, ...], np.dtype[Any]]] = {}
        self._rows: dict[Hashable, int] = {}
        self._unlike: set[Hashable] = set()
        self._held, self._spilled = 0, False

    def __contains__(self, key: Hashable) -> bool:
        return key in self._kinds

    def __iter__(self) -> Iterator[Hashable]:
        return iter(self._kinds)

    def add(self, key: Hashable, values: NDArray[Any]) -> None:
        """Append a part, which is copied; a key whose parts cannot be joined is forgotten.

        Raises:
            LogError: there is no room for the files.
        """
        kind, sound = (values.shape[1:], values.dtype), values.ndim > 0 and not values.dtype.hasobject
        if key in self._unlike or not sound or self._kinds.setdefault(key, kind) != kind:
            self.forget(key)
            return
        self._rows[key] = self._rows.get(key, 0) + len(values)
        if self._spilled:
            self._write(key, values)
            return
        self._parts.setdefault(key, []).append(np.array(values))
        self._held += values.nbytes
        if self._held > HELD_BYTES:
            self._spill()

    def forget(self, key: Hashable) -> None:
        """Drop what there is of a key, and what comes."""
        self._unlike.add(key)
        for table in (self._parts, self._files, self._kinds):
            table.pop(key, None)

    def __len__(self) -> int:
        return len(self._kinds)

    def rows(self, key: Hashable) -> int:
        """Length of an array."""
        return self._rows.get(key, 0)

    def __getitem__(self, key: Hashable) -> NDArray[Any]:
        """The array of a key; it cannot be written to."""
        shape, dtype = self._kinds[key]
        if not self._spilled:
            self._parts[key] = [np.concatenate(self._parts[key])]
            (values,) = self._parts[key]
            values.flags.writeable = False
            return values
        if not self._rows[key] or 0 in shape:
            return np.empty((self._rows[key], *shape), dtype)
        self._files[key].flush()
        return np.asarray(np.memmap(self._files[key], dtype, "r", shape=(self._rows[key], *shape)))

    def _spill(self) -> None:
        self._spilled = True
        for key, parts in self._parts.items():
            for part in parts:
                self._write(key, part)
        self._parts.clear()

    def _write(self, key: Hashable, values: NDArray[Any]) -> None:
        try:
            if key not in self._files:
                self._files[key] = tempfile.TemporaryFile(prefix="surefoot-")  # noqa: SIM115  open as long as it is used
            self._files[key].write(values.tobytes())
        except OSError as error:
            what = f"{tempfile.gettempdir()}: no place to digest a long log, {reason(error)}"
            raise LogError(f"{what}; set TMPDIR to a directory with more room") from None
