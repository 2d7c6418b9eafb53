"""Numbers that one may turn: default, unit, meaning and range of each, written in one place."""

import math
from dataclasses import MISSING, field, fields
from typing import Any

from surefoot.errors import ParameterError


def number(default: Any, unit: str, doc: str, *, positive: bool = False, most: float = math.inf) -> Any:
    """A dataclass field for a number, or for a tuple of numbers of one unit each.

    Args:
        default: its value.
        unit: of the number, "-" for none.
        doc: its meaning, without the unit.
        positive: whether zero is refused; negative numbers always are.
        most: largest value.
    """
    return field(default=default, metadata={"unit": unit, "doc": doc, "positive": positive, "most": most})


def check(group: Any, *path: str) -> None:
    """Refuse a group one of whose numbers is of the wrong kind, not finite or out of its range.

    Args:
        group: dataclass with fields made by `number`; others are left alone.
        path: name of the group, from the outside in.

    Raises:
        ParameterError: its key is the path and the name of the field.
    """
    for entry in fields(group):
        if "unit" not in entry.metadata:
            continue
        value, default = getattr(group, entry.name), entry.default
        right = _fault(value, default, **entry.metadata)
        if right:
            key = (*path, entry.name)
            raise ParameterError(key, f"{'.'.join(key)} is {value}", right)


def _fault(value: Any, default: Any, unit: str, doc: str, positive: bool, most: float) -> str:
    """The rule that a value breaks; empty if it breaks none."""
    assert default is not MISSING
    several = isinstance(default, tuple)
    whole = isinstance(default, int)
    if several and not (isinstance(value, tuple) and len(value) == len(default)):
        return f"it must be {len(default)} numbers"
    for part in value if several else (value,):
        kind = int if whole else (int, float)
        if not isinstance(part, kind) or isinstance(part, bool):
            return "it must be a whole number" if whole else "it must be a number"
        if not (math.isfinite(part) and (part > 0.0 if positive else part >= 0.0) and part <= most):
            least = "greater than 0" if positive else "at least 0"
            return (
                f"it must be {least} and at most {most:g}" if math.isfinite(most) else f"it must be finite and {least}"
            )
    return ""
