"""Values that are filled before anybody sees them."""

from typing import Any


def opened(cls: type) -> Any:
    """A class with the slots of a frozen dataclass and without its guard.

    Its fields are set by plain assignment, in a fifth of the time. What is made of it becomes a value by
    ``made.__class__ = cls`` before anybody else sees it.
    """
    return type(cls.__name__, (), {"__slots__": vars(cls)["__slots__"]})
