"""A log file on disk: every write is whole or undone, and a name ending in .mcap is always a readable log."""

import os
from pathlib import Path

from scenarios.errors import LogError


class Output:
    """An unbuffered file that keeps only whole records.

    The beginning goes to a temporary name, so that a file that cannot be begun neither appears nor replaces an older
    log.

    Attributes:
        path: where the log is.
        position: bytes written.
    """

    __slots__ = ("_file", "_temporary", "path", "position")

    def __init__(self, path: Path, beginning: bytes) -> None:
        """Create the file with its beginning.

        Raises:
            LogError: it cannot be created or the beginning does not fit.
        """
        self.path = path
        self.position = 0
        temporary = path.with_name(f".{path.name}.{os.getpid()}.new")
        try:
            self._file = temporary.open("wb", buffering=0)
        except OSError as error:
            raise LogError(f"{path}: cannot be created, {_reason(error)}; choose another directory") from None
        try:
            self._write(beginning)
            temporary.replace(path)
        except OSError as error:
            self._file.close()
            temporary.unlink(missing_ok=True)
            raise LogError(f"{path}: cannot be written, {_reason(error)}; no log was created") from None

    def write(self, data: bytes) -> None:
        """Append whole records.

        Raises:
            LogError: they could not be written; the file then holds what came before, under the name ``*.incomplete``.
        """
        try:
            self._write(data)
        except OSError as error:
            kept = self._set_aside()
            message = f"{self.path}: cannot be written on, {_reason(error)}; what was written is kept in {kept.name}"
            raise LogError(message) from None

    @property
    def closed(self) -> bool:
        """Whether nothing more can be written."""
        return self._file.closed

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _write(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            rest = rest[self._file.write(rest) :]
        self.position += len(data)

    def _set_aside(self) -> Path:
        """Cut off the record that did not fit and take away the name of a log."""
        kept = self.path.with_name(f"{self.path.name}.incomplete")
        self._file.truncate(self.position)
        self._file.close()
        self.path.replace(kept)
        return kept


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()
