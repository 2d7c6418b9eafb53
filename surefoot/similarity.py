"""Froude similarity: what becomes of any quantity when the same walk is walked by a robot of another size and mass.

Gravity is the same for all, so that times grow with the root of lengths, τ = √λ; lengths and masses are free. A unit
therefore says all: a quantity in m^a s^b kg^c grows with λ^a τ^b μ^c. Here λ is the length and μ the mass of a robot
over those of the reference (R. McNeill Alexander, "Principles of Animal Locomotion", 2003, chapter 4). Every number of
this project that is a length, a time, a force or the like is written down for the reference robot, once, beside its
unit.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields, is_dataclass, replace
from typing import Any, TypeVar

from surefoot.errors import ParameterError

T = TypeVar("T")

GRAVITY = 9.81
"""Gravitational acceleration, of the simulated world as of the models of planner and controller [m/s^2]."""

REFERENCE = "humanoid100"
"""The robot for which numbers are written down."""

LEG_LENGTH, MASS = 0.94, 100.0
"""Its leg from hip centre to sole [m] and its mass [kg]."""

PLANS = 50
"""Plans that the reference robot makes in a second."""

_DECIMALS = 9
"""Sizes are rounded to so many, so that the reference robot has exactly 1 whatever rounding its sums have."""

Exponents = tuple[int, int, int]
"""Exponents of length, time and mass."""

_EXPONENTS: Mapping[str, Exponents] = {
    "m": (1, 0, 0),
    "s": (0, 1, 0),
    "kg": (0, 0, 1),
    "N": (1, -2, 1),
    "J": (2, -2, 1),
    "W": (2, -3, 1),
    "Hz": (0, -1, 0),
    **dict.fromkeys(("", "-", "1", "rad", "deg", "sample"), (0, 0, 0)),
}
"""Exponents of the units that others are made of."""

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
        """The similarity of a robot with this leg [m] and this mass without payload [kg]."""
        return cls(round(leg_length / LEG_LENGTH, _DECIMALS), round(mass / MASS, _DECIMALS))

    @property
    def time(self) -> float:
        """τ, factor of a time: √λ as nearly as rates of planner and controller can be whole numbers [-].

        So each phase of a walk lasts as many samples as that of the reference robot. That is worth more than the last
        half percent: half a sample more in each phase doubles the way of the CoP.
        """
        return PLANS / max(1, round(PLANS / math.sqrt(self.length)))

    def factor(self, unit: str) -> float:
        """Factor by which a quantity of this unit is greater than the reference's, exactly 1 for the reference [-].

        Raises:
            ValueError: the unit is not known.
        """
        length, time, mass = exponents(unit)
        return float(self.length**length * self.time**time * self.mass**mass)

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
            elif (unit := sized_unit(entry)) is not None:
                changed[entry.name] = self.times(value, unit)
        return replace(group, **changed) if changed else group  # type: ignore[type-var]

    def times(self, value: Any, unit: str) -> Any:
        """A number, or a tuple of numbers, of this unit; of several units, one for each, if they differ."""
        if isinstance(value, tuple | list):
            units = [part.strip() for part in unit.split(",")]
            units = units if len(units) == len(value) else units * len(value)
            return type(value)(self.times(part, one) for part, one in zip(value, units, strict=True))
        factor = self.factor(unit)
        return value if value is None or factor == 1.0 else value * factor


def sized_unit(entry: "Field[Any]") -> str | None:
    """The unit by which a dataclass field follows the size of a robot; None where it does not."""
    return entry.metadata.get("unit") if entry.metadata.get("sized", True) else None


def exponents(unit: str) -> Exponents:
    """Exponents of λ, τ and μ of a unit such as "m/s^2", "1/(N·m)^2", "N·s/kg" or "-".

    Raises:
        ValueError: it is none of these.
    """
    length, time, mass = 0, 0, 0
    for index, part in enumerate(_outside(unit.strip(), "/")):
        sign = 1 if index == 0 else -1
        for term in _outside(part.replace(" ", "·"), "·"):
            found = _FACTOR.fullmatch(term)
            group = found["group"] if found else None
            if found is None or (group is None and found["name"] not in _EXPONENTS):
                raise ValueError(f"'{unit}' is no unit that is known; write it with {', '.join(_EXPONENTS)}")
            own = exponents(group) if group is not None else _EXPONENTS[found["name"]]
            power = sign * int(found["power"] or 1)
            length, time, mass = length + power * own[0], time + power * own[1], mass + power * own[2]
    return length, time, mass


def _outside(text: str, mark: str) -> list[str]:
    """Parts of a text between marks that stand in no brackets."""
    return re.split(rf"{re.escape(mark)}(?![^(]*\))", text)


REFERENCE_SIZE = Similarity()
"""Similarity of the reference robot."""


def quantity(default: Any, unit: str) -> Any:
    """A dataclass field with a unit, by which it follows the size of a robot; "-" for none."""
    return field(default=default, metadata={"unit": unit})
