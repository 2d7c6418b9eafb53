"""What a program need not do: faces import names when they are first asked for, and a process is not taken apart."""

import atexit
import gc
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from importlib import import_module
from typing import Any


def face(package: str, homes: Mapping[str, Iterable[str]]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """What a package has as its ``__getattr__`` and ``__dir__``.

    Args:
        package: its name.
        homes: public names by the module, below the package, that has them.

    Returns:
        both functions.
    """
    places = {name: home for home, names in homes.items() for name in names}

    def get(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        return getattr(import_module(f"{package}.{places[name]}"), name)

    def names() -> list[str]:
        return sorted(places)

    return get, names


@contextmanager
def importing() -> Iterator[None]:
    """What a program imports meanwhile stays to its end, and nobody looks through it for garbage.

    Looking takes a seventh of the time of importing all of the package, and finds next to nothing.
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


@contextmanager
def ending_at_once() -> Iterator[None]:
    """The program of a process: once it has ended by `SystemExit`, nobody takes its modules and engines apart.

    That would take a tenth of a second; the operating system has all of it back at once. Threads are waited for, and
    what others want done at the end is done, as ever.
    """
    codes: list[int] = []
    atexit.register(leave, codes)  # what is registered first is done last
    try:
        yield
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            codes.append(end.code or 0)
        raise


def leave(codes: list[int]) -> None:
    """End the process, with the exit code that there is, if there is one."""
    if not codes:
        return
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception, SystemExit):
            stream.flush()
    os._exit(codes[0])
