"""Output files that are whole or not there."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from scenarios.errors import LogError


@contextlib.contextmanager
def write_whole(path: Path) -> Iterator[Path]:
    """A temporary file beside the wanted one, which it replaces when the context ends well.

    Args:
        path: the wanted file.

    Yields:
        path of the temporary file, which exists and can be written.

    Raises:
        LogError: the file cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.new")
    try:
        if path.is_dir():
            raise IsADirectoryError(0, "is a directory")
        temporary.touch()
        yield temporary
        temporary.replace(path)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise LogError(f"{path}: cannot be written, {reason}; choose another file") from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()
