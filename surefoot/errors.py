"""Errors that every layer raises alike: they carry the name of the value at fault, not a sentence to parse."""

import math
from collections.abc import Iterable


class ParameterError(ValueError):
    """A value that a part cannot work with.

    A layer names its own parameters; where they came from (a key of a scenario file, say) is for the layer above to
    know, which reads `key` and never the sentence.

    Attributes:
        key: the parameter, from the outside in, in the words of the layer that refuses it: ("gait", "single_support").
        what: the fault, without a full stop.
        right: what would be right, without a full stop.
    """

    def __init__(self, key: Iterable[str | int], what: str, right: str) -> None:
        self.key = tuple(key)
        self.what = what
        self.right = right
        super().__init__(f"{what}; {right}")

    def __reduce__(self) -> tuple[type["ParameterError"], tuple[tuple[str | int, ...], str, str]]:
        """Survive the way between processes."""
        return type(self), (self.key, self.what, self.right)


class PluginError(ValueError):
    """A registration of a package cannot be used.

    Attributes:
        what: the fault, with the names of package and entry, without a full stop.
        right: what would be right, without a full stop.
    """

    def __init__(self, what: str, right: str) -> None:
        self.what, self.right = what, right
        super().__init__(what, right)

    def __str__(self) -> str:
        return f"{self.what}; {self.right}"


class PartError(PluginError):
    """A part that is not Surefoot's own raised, left, or gave something else than it says; its cause is what it raised.

    Attributes:
        what: the part with its package, what it did, and the file and line of its author.
    """


def at_most(value: float, decimals: int = 3) -> str:
    """A bound as a message proposes it, never rounded up, so that it is accepted when it is followed."""
    return f"{math.floor(value * 10**decimals + _DIGITS) / 10**decimals:.{decimals}f}"


def at_least(value: float, decimals: int = 3) -> str:
    """Write a lower bound with so many decimals, never rounded down."""
    return f"{math.ceil(value * 10**decimals - _DIGITS) / 10**decimals:.{decimals}f}"


_DIGITS = 1e-6
"""Distance of a number from a decimal that it is, for its last binary digits [-]."""
