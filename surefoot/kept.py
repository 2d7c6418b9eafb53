"""What was worked out once, in the user's cache folder under a digest of all that it follows from.

Nothing in it is ever stale: an entry whose sources have changed since is made anew, as is one that is damaged. Where
the folder cannot be written, nothing is kept.
"""

import hashlib
import json
import os
import stat
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

_SOURCES = ("surefoot", "pydantic.version")
"""Packages and modules from whose sources a text may follow; pydantic writes JSON Schema."""


def place(room: str, key: str) -> Path:
    """Where an entry of a room, such as ``robots``, is kept."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "surefoot" / room / f"{key}.json"


def opened(key: str, data: bytes) -> bytes | None:
    """The text of an entry; None if it is not as it was stored under its key."""
    seal, _, text = data.partition(b"\n")
    return text if seal == _seal(key, text) else None


def read(entry: Path) -> bytes:
    """What is in a file, where that is one: a pipe or a device, which may have no end, is not waited for.

    Raises:
        OSError: it is none, or cannot be read.
    """
    with os.fdopen(os.open(entry, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(f"{entry} is no regular file")
        return file.read()


def store(room: str, key: str, text: bytes, most: int) -> None:
    """Keep a text, at once or not at all, and of a room's entries no more than so many, of which the oldest go."""
    entry = place(room, key)
    with suppress(OSError):
        entry.parent.mkdir(parents=True, exist_ok=True)
        unfinished = entry.with_suffix(f".{os.getpid()}")
        unfinished.unlink(missing_ok=True)
        with unfinished.open("xb") as file:  # which waits for nobody, whatever lies there
            file.write(_seal(key, text) + b"\n" + text)
        unfinished.replace(entry)
        for old in sorted(entry.parent.glob("*.json"), key=lambda file: file.lstat().st_mtime)[:-most]:
            old.unlink()


def from_sources(name: str, make: Callable[[], str]) -> str:
    """A text that follows from this package's sources alone, made where it is not kept of these very sources.

    The sources are those of all modules of the package that are imported once it is made.

    Args:
        name: what the text is, for its entry.
        make: makes it.
    """
    key = hashlib.sha256(repr((name, __file__, sys.prefix, sys.version)).encode()).hexdigest()
    with suppress(OSError, RuntimeError):
        kept = opened(key, read(place("texts", key)))
        if kept is not None:
            found = json.loads(kept)
            if all(_digest(file) == digest for file, digest in found["sources"].items()):
                return str(found["text"])
    text = make()
    with suppress(OSError, RuntimeError):  # a module without a file; a user without a home
        sources = {file: _digest(file) for file in _imported()}
        store("texts", key, json.dumps({"sources": sources, "text": text}).encode(), most=16)
    return text


def _imported() -> list[str]:
    """Files of the modules from which a text may follow."""
    named = (
        module for name, module in sys.modules.items() if name in _SOURCES or name.partition(".")[0] == _SOURCES[0]
    )
    return sorted({str(module.__file__) for module in named if getattr(module, "__file__", None)})


def _digest(file: str) -> str:
    return hashlib.sha256(read(Path(file))).hexdigest()


def _seal(key: str, text: bytes) -> bytes:
    """Digest of an entry under its key, by which one that was changed or moved is known."""
    return hashlib.sha256(f"{key}\n".encode() + text).hexdigest().encode()
