"""Files that commands write: whole or not at all, and never over an existing one without an option that says so."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from surefoot.scenarios.errors import LogError


def refuse_existing(path: Path, replace: bool = False) -> None:
    """Refuse before the work what `write_whole` would refuse after it.

    Raises:
        LogError: there is a file already that shall not be replaced, or a directory.
    """
    if path.is_dir():
        raise LogError(f"{path}: cannot be written, is a directory; choose another file")
    if os.path.lexists(path) and not replace and not _is_device(path):
        raise _existing(path)


@contextlib.contextmanager
def write_whole(path: Path, replace: bool = False) -> Iterator[Path]:
    """A temporary file beside the wanted one, which takes its name when the context ends well.

    The name is taken at once, by an empty file, so that of two processes only one gets it. A device or a pipe holds
    nothing that could be replaced, and is written to as it is.

    Yields:
        path of the file to write, which exists.

    Raises:
        LogError: the file exists already or cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.new")
    reserved = False
    try:
        refuse_existing(path, replace)
        if _is_device(path):
            yield path
            return
        if not replace:
            path.open("xb").close()
            reserved = True
        temporary.touch()
        yield temporary
        temporary.replace(path)
        reserved = False
    except FileExistsError:
        raise _existing(path) from None
    except OSError as error:
        raise LogError(f"{path}: cannot be written, {reason(error)}; choose another file") from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()
        if reserved:
            path.unlink(missing_ok=True)


def reason(error: OSError) -> str:
    """The operating system's reason, to stand within a sentence."""
    return (error.strerror or str(error)).lower()


def shown(path: Path | str) -> str:
    """A path as text; bytes of a name that are no text are escaped."""
    return str(path).encode("utf-8", "backslashreplace").decode()


def _existing(path: Path) -> LogError:
    return LogError(f"{path}: exists already; choose another file, or replace it with --force")


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file() and not path.is_dir()
