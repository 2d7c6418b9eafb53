"""Numbers with units: what a key is measured in, and how a value may be written beside a bare SI number."""

import math
import re
from collections.abc import Mapping
from decimal import Decimal
from typing import Any, get_args, get_origin

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

_DEGREE = "deg"
_SPELLINGS: Mapping[str, tuple[str, Mapping[str, Decimal]]] = {
    "m": ("length", {"m": Decimal(1), "cm": Decimal("0.01"), "mm": Decimal("0.001"), "km": Decimal(1000)}),
    "s": ("time", {"s": Decimal(1), "ms": Decimal("0.001"), "us": Decimal("1e-6"), "min": Decimal(60)}),
    "rad": ("angle", {"rad": Decimal(1), "mrad": Decimal("0.001"), _DEGREE: Decimal(1)}),
    "N": ("force", {"N": Decimal(1), "kN": Decimal(1000)}),
    "kg": ("mass", {"kg": Decimal(1), "g": Decimal("0.001")}),
    "Hz": ("rate", {"Hz": Decimal(1), "kHz": Decimal(1000)}),
    "m/s": ("speed", {"m/s": Decimal(1), "cm/s": Decimal("0.01"), "km/h": 1 / Decimal("3.6")}),
    "rad/s": ("turning speed", {"rad/s": Decimal(1), f"{_DEGREE}/s": Decimal(1)}),
}
"""Quantities of the SI units, and the factor of each unit that may be written; degrees are turned into radians."""

_KINDS = {spelling: kind for kind, spellings in _SPELLINGS.values() for spelling in spellings}
_NUMBER = r"[-+]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?"
_QUANTITY = re.compile(f"({_NUMBER}) ?([a-zA-Z][a-zA-Z/^0-9]*)")


class Unit:
    """The SI unit of a key; a string with a unit of the same kind is turned into the SI number before it is checked.

    Args:
        si: the unit; one in which no string may be written (such as m/s^3) is only shown.
    """

    def __init__(self, si: str) -> None:
        self.si = si

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Check the number as without a unit."""
        return core_schema.no_info_before_validator_function(self.number, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """A number in its range, or a string of a number and a unit."""
        number = handler(schema)
        if self.si not in _SPELLINGS:
            return {**number, "unit": self.si}
        names = "|".join(map(re.escape, _SPELLINGS[self.si][1]))
        return {"anyOf": [number, {"type": "string", "pattern": f"^{_NUMBER} ?(?:{names})$"}], "unit": self.si}

    def number(self, value: Any) -> Any:
        """The SI number that a string means; what is no string goes as it is.

        Raises:
            PydanticCustomError: it is no number with a unit of this kind.
        """
        if not isinstance(value, str) or self.si not in _SPELLINGS:
            return value
        kind, factors = _SPELLINGS[self.si]
        found = _QUANTITY.fullmatch(value)
        if found is None or found[2] not in factors:
            other = _KINDS.get(found[2]) if found else None
            named = f", {_with_article(other)}" if other else ""
            right = f"give {_with_article(kind)}: a number [{self.si}], or one with its unit, {' or '.join(factors)}"
            raise PydanticCustomError("quantity", "{named}{right}", {"named": named, "right": right})
        return _si(Decimal(found[1]) * factors[found[2]], found[2])


def _si(value: Decimal, spelling: str) -> float | int:
    if spelling.startswith(_DEGREE):
        return math.radians(float(value))
    return int(value) if value == value.to_integral_value() and abs(value) < 10**15 else float(value)


def is_number(value: Any) -> bool:
    """Return true if a value is a number, be it NaN or infinite, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _with_article(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


METRE, SECOND, RADIAN = map(Unit, ("m", "s", "rad"))


def meant(value: float, si: str, most: float) -> str:
    """The probable meaning of a number in SI beyond the most of a key, as a sentence's end; or empty."""
    for spelling in {"m": ("cm", "mm"), "s": ("ms",), "rad": (_DEGREE,), "rad/s": (f"{_DEGREE}/s",)}.get(si, ()):
        factor = _SPELLINGS[si][1][spelling]
        if (
            max(1.0, 1.5 * most) <= abs(value) < 1e6
            and abs(_si(Decimal(repr(float(value))) * factor, spelling)) <= most
        ):
            return f"; for {value:g} {spelling} write '{value:g} {spelling}'"
    return ""


def unit_of(annotation: Any, metadata: list[Any], elements: bool = True) -> str:
    """SI unit of a key, or else of the elements of a list; empty when it has none."""
    found = next((one.si for one in metadata if isinstance(one, Unit)), "")
    parts = () if get_origin(annotation) is tuple and not elements else get_args(annotation)
    inner = (unit_of(part, list(getattr(part, "__metadata__", ())), elements) for part in parts)
    return found or next(filter(None, inner), "")
