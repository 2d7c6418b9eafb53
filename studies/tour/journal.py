"""Results that are kept as they come, one line of JSON each, with what made them."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason


class Journal:
    """A file of results, to which a process that was killed has added its last line in part at most.

    Args:
        path: of the file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path

    def lines(self) -> Iterator[tuple[Mapping[str, Any], str]]:
        """Its results, each with what made it, in order."""
        if not self._path.is_file():
            return
        for line in self._path.read_text(encoding="utf-8").splitlines():
            try:
                written = json.loads(line)
                yield written, written.pop("made_by")
            except (ValueError, TypeError, KeyError, AttributeError):  # the last line of a process that was killed
                continue

    def add(self, written: Mapping[str, Any], made_by: str) -> None:
        """Keep a result.

        Raises:
            LogError: it cannot be written.
        """
        try:
            with self._path.open("a", encoding="utf-8") as file:
                file.write("" if self._ended() else "\n")
                file.write(json.dumps({**written, "made_by": made_by}) + "\n")
        except OSError as error:
            raise LogError(f"{self._path}: cannot be written, {reason(error)}; choose another --out") from None

    def _ended(self) -> bool:
        """True where the last line is whole; a result that is added to a part of one is lost with it."""
        with self._path.open("rb") as file:
            if not file.seek(0, 2):
                return True
            file.seek(-1, 2)
            return file.read(1) == b"\n"


def digest(written: Mapping[str, Any]) -> str:
    """A short digest of values."""
    return hashlib.sha256(json.dumps(written, sort_keys=True).encode()).hexdigest()[:16]
