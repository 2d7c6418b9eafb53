"""Work that a program need not do: faces import names when first asked for, and imports look for no garbage."""

import gc
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any


def face(package: str, homes: Mapping[str, Iterable[str]]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """The functions that a package has as its ``__getattr__`` and ``__dir__``.

    Args:
        package: its name.
        homes: public names by the module that has them, seen from the package: ``a.b`` is below it, ``.a`` beside it.

    Returns:
        both functions.
    """
    places = {name: home for home, names in homes.items() for name in names}

    def get(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        return getattr(import_module(f".{places[name]}", package), name)

    def names() -> list[str]:
        return sorted(places)

    return get, names


@contextmanager
def importing() -> Iterator[None]:
    """Import without looking for garbage: what a program imports meanwhile stays to its end.

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
