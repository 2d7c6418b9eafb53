"""A store of what was worked out once, in the user's cache folder under a digest of all that it follows from.

Nothing in it is ever stale: the digest is the entry's key, and one that is damaged counts as none. Where the folder
cannot be written, nothing is kept.
"""

import hashlib
import os
import stat
from contextlib import suppress
from pathlib import Path


def place(room: str, key: str) -> Path:
    """Path of an entry of a room, such as ``robots``."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "surefoot" / room / f"{key}.json"


def opened(key: str, data: bytes) -> bytes | None:
    """The text of an entry; None if it is not as it was stored under its key."""
    seal, _, text = data.partition(b"\n")
    return text if seal == _seal(key, text) else None


def read(entry: Path) -> bytes:
    """Read a file, where that is one: a pipe or a device, which may have no end, is not waited for.

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


def _seal(key: str, text: bytes) -> bytes:
    """Digest of an entry under its key, by which one that was changed or moved is known."""
    return hashlib.sha256(f"{key}\n".encode() + text).hexdigest().encode()
