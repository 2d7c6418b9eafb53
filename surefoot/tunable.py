"""Numbers that one may turn: default, unit, meaning and range of each, written in one place."""

import math
from collections.abc import Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from typing import Any, get_args

from surefoot.errors import ParameterError


@dataclass(frozen=True, slots=True)
class Range:
    """The values that a number may have.

    Attributes:
        least, most: ends of the range, which belong to it if they are finite.
        positive: whether zero is left out.
        endless: whether infinity is a value too.
    """

    least: float = 0.0
    most: float = math.inf
    positive: bool = False
    endless: bool = False

    def holds(self, value: float) -> bool:
        """True if a value lies in it."""
        if not (math.isfinite(value) or (self.endless and value == math.inf)):
            return False
        return self.least <= value <= self.most and not (self.positive and value == 0.0)

    def __str__(self) -> str:
        """The range in words, such as "greater than 0 and at most 1"."""
        least = "greater than 0" if self.positive else f"at least {self.least:g}" if math.isfinite(self.least) else ""
        most = f"at most {self.most:g}" if math.isfinite(self.most) else ""
        finite = "" if most or self.endless else "finite"
        return " and ".join(part for part in (finite, least, most) if part)


def number(default: Any, unit: str, doc: str, *, sized: bool = True, **within: Any) -> Any:
    """A dataclass field for a number, or for a tuple of numbers of one unit each.

    Args:
        default: its value.
        unit: of the number, "-" for none.
        doc: its meaning, without the unit.
        sized: whether it follows the size of a robot (see `surefoot.similarity`).
        within: its `Range`, field by field.
    """
    return field(default=default, metadata={"unit": unit, "doc": doc, "range": Range(**within), "sized": sized})


def positive(default: Any, unit: str, doc: str, **more: Any) -> Any:
    """A `number` that is greater than zero."""
    return number(default, unit, doc, positive=True, **more)


def choice(default: str, names: Sequence[str], doc: str) -> Any:
    """A dataclass field for one of some names.

    Args:
        default: its value.
        names: those there are.
        doc: its meaning.
    """
    return field(default=default, metadata={"doc": doc, "names": tuple(names)})


def check(group: Any, *path: str, of: str = "") -> None:
    """Refuse a group one of whose numbers is of the wrong kind or out of its range, or a name that there is not.

    Args:
        group: dataclass with fields made by `number` and `choice`; others are left alone.
        path: name of the group, from the outside in.
        of: the group in words, for a path that is none of a scenario.

    Raises:
        ParameterError: its key is the path and the name of the field.
    """
    for entry in fields(group):
        value = getattr(group, entry.name)
        right = _fault(value, entry)
        if right:
            key = (*path, entry.name)
            subject = f"{entry.name} of {of}" if of else ".".join(key)
            raise ParameterError(key, f"{subject} is {value}", right)


def _fault(value: Any, entry: "Field[Any]") -> str:
    """The rule that a value breaks; empty if it breaks none."""
    if names := entry.metadata.get("names"):
        return "" if value in names else f"choose one of {', '.join(sorted(names))}"
    if "range" not in entry.metadata:
        return ""
    assert entry.default is not MISSING
    several = isinstance(entry.default, tuple)
    kinds = int if isinstance(entry.default, int) else (int, float)
    if several and not _counts(value, entry):
        return f"it must be {len(entry.default)} numbers"
    for part in value if several else (value,):
        if not isinstance(part, kinds) or isinstance(part, bool):
            return "it must be a whole number" if kinds is int else "it must be a number"
        if not entry.metadata["range"].holds(part):
            return f"it must be {entry.metadata['range']}"
    return ""


def _counts(value: Any, entry: "Field[Any]") -> bool:
    """True of a tuple with as many numbers as the default, or with any number of them where the type says so."""
    assert isinstance(entry.default, tuple)
    return isinstance(value, tuple) and (... in get_args(entry.type) or len(value) == len(entry.default))
