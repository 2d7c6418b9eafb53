"""Files that this process opens, as the audit events of Python tell."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

_HEARING: list[list[tuple[Path, bool]]] = []


def _hear(event: str, given: tuple[Any, ...]) -> None:
    if event == "open" and _HEARING and isinstance(given[0], str | Path):
        mode = given[1] or ""
        for heard in _HEARING:
            heard.append((Path(given[0]), not set(mode).isdisjoint("wxa+")))


sys.addaudithook(_hear)


@contextmanager
def opened_files() -> Iterator[list[tuple[Path, bool]]]:
    """Files that are opened meanwhile, each with true where it may be written."""
    heard: list[tuple[Path, bool]] = []
    _HEARING.append(heard)
    try:
        yield heard
    finally:
        _HEARING.remove(heard)
