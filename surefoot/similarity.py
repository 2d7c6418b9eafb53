"""Froude similarity: what becomes of any quantity when the same walk is walked by a robot of another size and mass.

Gravity is the same for all, so that times grow with the root of lengths; lengths and masses are free. A unit therefore
says all: a quantity in m^a s^b kg^c grows with λ^(a + b/2) μ^c, where λ is the length and μ the mass of a robot over
those of the reference (R. McNeill Alexander, "Principles of Animal Locomotion", 2003, chapter 4). Every number of this
project that is a length, a time, a force or the like is written down for the reference robot, once, beside its unit.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import lru_cache
from typing import Any, TypeVar

from surefoot.errors import ParameterError

T = TypeVar("T")

REFERENCE = "humanoid100"
"""The robot for which numbers are written down."""

LEG_LENGTH, MASS = 0.94, 100.0
"""Its leg from hip centre to sole [m] and its mass [kg]."""

_DECIMALS = 9
"""Sizes are rounded to so many, so that the reference robot has exactly 1 whatever rounding its sums have."""

_EXPONENTS: Mapping[str, tuple[float, float]] = {
    "m": (1.0, 0.0),
    "s": (0.5, 0.0),
    "kg": (0.0, 1.0),
    "N": (0.0, 1.0),
    "J": (1.0, 1.0),
    "W": (0.5, 1.0),
    "Hz": (-0.5, 0.0),
    **dict.fromkeys(("", "-", "1", "rad", "deg", "sample"), (0.0, 0.0)),
}
"""Exponents of length and mass of each unit."""

_FACTOR = re.compile(r"(?:\((?P<group>[^()]*)\)|(?P<name>[A-Za-z]*|-|1))(?:\^(?P<power>[0-9]+))?")


@dataclass(frozen=True, slots=True)
class Similarity:
    """The size of a robot against the reference's; the default is the reference itself, whose factors are exactly 1.

    Attributes:
        length: λ, its leg's length over the reference's [-].
        mass: μ, its mass, without what it carries, over the reference's [-].

    Raises:
        ParameterError: one of them is no positive number.
    """

    length: float = 1.0
    mass: float = 1.0

    def __post_init__(self) -> None:
        for name, value in (("length", self.length), ("mass", self.mass)):
            if not (value > 0.0 and math.isfinite(value)):
                raise ParameterError(("size", name), f"{name} of the robot's size is {value}", "it must be positive")

    @classmethod
    def of(cls, leg_length: float, mass: float) -> "Similarity":
        """That of a robot with this leg [m] and this mass without payload [kg]."""
        return cls(round(leg_length / LEG_LENGTH, _DECIMALS), round(mass / MASS, _DECIMALS))

    @property
    def time(self) -> float:
        """Factor of a time [-]."""
        return math.sqrt(self.length)

    def over(self, other: "Similarity") -> "Similarity":
        """What it is against another one's."""
        return Similarity(self.length / other.length, self.mass / other.mass)

    def factor(self, unit: str) -> float:
        """By what a quantity of this unit is greater than the reference's, exactly 1 for the reference [-].

        Raises:
            ValueError: the unit is not known.
        """
        length, mass = exponents(unit)
        return float(self.length**length * self.mass**mass)

    def scaled(self, group: T) -> T:
        """A dataclass whose fields have units (see `quantity`), for this size: each number times its unit's factor.

        A field that is a `Similarity` becomes this one, a dataclass is scaled itself, others stay as they are.
        """
        changed: dict[str, Any] = {}
        for entry in fields(group):  # type: ignore[arg-type]
            value = getattr(group, entry.name)
            if isinstance(value, Similarity):
                changed[entry.name] = self
            elif is_dataclass(value):
                changed[entry.name] = self.scaled(value)
            elif "unit" in entry.metadata:
                changed[entry.name] = self.times(value, entry.metadata["unit"])
        return replace(group, **changed) if changed else group  # type: ignore[type-var]

    def times(self, value: Any, unit: str) -> Any:
        """A number, or a tuple of numbers, of this unit; of several units, one for each, if they differ."""
        if isinstance(value, tuple | list):
            units = [part.strip() for part in unit.split(",")]
            units = units if len(units) == len(value) else units * len(value)
            return type(value)(self.times(part, one) for part, one in zip(value, units, strict=True))
        factor = self.factor(unit)
        return value if value is None or factor == 1.0 else value * factor


@lru_cache(maxsize=256)
def exponents(unit: str) -> tuple[float, float]:
    """Exponents of λ and μ of a unit such as "m/s^2", "1/(N·m)^2", "N·s/kg" or "-".

    Raises:
        ValueError: it is none of these.
    """
    length, mass, sign = 0.0, 0.0, 1.0
    for index, part in enumerate(_outside(unit.strip(), "/")):
        sign = 1.0 if index == 0 else -1.0
        for term in _outside(part.replace(" ", "·"), "·"):
            found = _FACTOR.fullmatch(term)
            group = found["group"] if found else None
            if found is None or (group is None and found["name"] not in _EXPONENTS):
                raise ValueError(f"'{unit}' is no unit that is known; write it with {', '.join(_EXPONENTS)}")
            own = exponents(group) if group is not None else _EXPONENTS[found["name"]]
            power = sign * float(found["power"] or 1)
            length, mass = length + power * own[0], mass + power * own[1]
    return length, mass


def _outside(text: str, mark: str) -> list[str]:
    """Parts of a text between marks that stand in no brackets."""
    return re.split(rf"{re.escape(mark)}(?![^(]*\))", text)


REFERENCE_SIZE = Similarity()
"""That of the reference robot."""


def quantity(default: Any, unit: str) -> Any:
    """A dataclass field with a unit, by which it follows the size of a robot; "-" for none."""
    return field(default=default, metadata={"unit": unit})
