"""A log whose chunks can be made unreadable while it is open: what is read from then on is noted as damage."""

import shutil
from collections.abc import Callable
from pathlib import Path

from surefoot.scenarios.log import Log, read
from surefoot.scenarios.log.scan import ChunkPlace


def opened(path: Path, folder: Path) -> Log:
    """A copy of a log in a folder."""
    return read(shutil.copy(path, folder / "spoilt.mcap"))


def spoil(log: Log, spared: Callable[[ChunkPlace], bool] = lambda _: False) -> int:
    """Spoil the chunks in the file that are not spared, and count these."""
    chunks = log.contents.chunks
    with log.path.open("r+b") as file:
        for chunk in chunks:
            if not spared(chunk):
                file.seek(chunk.data.start)
                file.write(bytes(chunk.data.stop - chunk.data.start))
    return sum(map(spared, chunks))
