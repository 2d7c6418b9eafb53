"""The range of a model's numbers: each finite, and no larger than any walking machine has it."""

from collections.abc import Callable
from dataclasses import dataclass

from surefoot.models.robot_file.document import Node, number, refuse

LENGTH, MASS, INERTIA = 1e3, 1e5, 1e7
"""Largest length [m], mass [kg] and moment of inertia [kg m^2] of a part."""

TURN = 6.35
"""Largest angle of an orientation: a turn, and what is lost in rounding [rad]."""

NONE = 1e17
"""Limits as large stand for none in models that other programs wrote."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """The range and unit of an attribute.

    Attributes:
        most: largest absolute value.
        unit: for messages.
        count: how many numbers; 0 for one or more, None where the engine looks.
        least: smallest value; None for minus the largest.
    """

    most: float
    unit: str = ""
    count: int | None = None
    least: float | None = None

    @property
    def rule(self) -> str:
        """The rule for the attribute, for messages."""
        how_many = {1: "a decimal number"}.get(self.count or 0, f"{self.count or ''} decimal numbers".lstrip())
        return f"give {how_many} from {self.smallest:g} to {self.most:g} {self.unit}".rstrip()

    @property
    def smallest(self) -> float:
        """Least value."""
        return -self.most if self.least is None else self.least


_SIZE = Quantity(LENGTH, "m", 1, 0.0)
_LIMIT = Quantity(NONE, "", 1)

URDF = {
    "origin": {"xyz": Quantity(LENGTH, "m", 3), "rpy": Quantity(TURN, "rad, not degrees", 3)},
    "axis": {"xyz": Quantity(1e6, "", 3)},
    "mass": {"value": Quantity(MASS, "kg", 1, 0.0)},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), Quantity(INERTIA, "kg m^2", 1)),
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), _LIMIT),
    "box": {"size": Quantity(LENGTH, "m", 3, 0.0)},
    "sphere": {"radius": _SIZE},
    "cylinder": {"radius": _SIZE, "length": _SIZE},
    "capsule": {"radius": _SIZE, "length": _SIZE},
    "mesh": {"scale": Quantity(1e6, "", 3)},
    "color": {"rgba": Quantity(1e3, "", 4)},
}
"""Quantities by element and attribute, where a robot is read from."""

REQUIRED = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "mesh": ("filename",),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "axis": ("xyz",),
}
"""Attributes of a URDF without which an element says nothing."""

HOLDS = {"inertial": ("mass", "inertia")}
"""Elements of a URDF without which one says nothing."""

MJCF = {
    **dict.fromkeys(("pos", "fromto", "refpos"), Quantity(LENGTH, "m")),
    "size": Quantity(10 * LENGTH, "m"),
    **dict.fromkeys(("mass", "shellinertia", "boundmass", "settotalmass"), Quantity(MASS, "kg")),
    **dict.fromkeys(("diaginertia", "fullinertia", "boundinertia", "armature"), Quantity(INERTIA, "kg m^2")),
    "density": Quantity(1e6, "kg/m^3"),
    "scale": Quantity(1e6),
    "gear": Quantity(1e6),
    "params": Quantity(100.0),
}
"""Quantities by attribute, wherever it stands."""


_SRDF = {"mass": Quantity(MASS, "kg", 1), "gear_ratio": Quantity(1e5, "", 1), "value": Quantity(1e4, "", 0)}


def of_urdf(tag: str, attribute: str) -> Quantity | None:
    """The quantity of an attribute of a URDF; None where nothing reads it as a number."""
    return URDF.get(tag, {}).get(attribute)


def of_srdf(_tag: str, attribute: str) -> Quantity | None:
    """The quantity of an attribute of an SRDF; None where nothing reads it as a number."""
    return _SRDF.get(attribute)


def of_mjcf(_tag: str, attribute: str) -> Quantity | None:
    """The quantity of an attribute of an MJCF, if it holds numbers; None for names."""
    return None if attribute == "name" else MJCF.get(attribute, Quantity(NONE))


def check_numbers(node: Node, allowed: Callable[[str, str], Quantity | None], owner: str = "") -> None:
    """Refuse numbers that are none, not finite, too large or not as many as they have to be.

    Raises:
        RobotError: says file, line, owner and attribute.
    """
    if name := node.get("name"):
        owner = f" of {node.tag} '{name}'"
    within = owner if name else f" of {node.tag}{owner.replace(' of ', ' in ', 1)}"
    for attribute, text in node.attrib.items():
        quantity = allowed(node.tag, attribute)
        if quantity is not None and not _fits(text, quantity):
            shown = text if len(text) <= 40 else f"{text[:40]}..."
            refuse(node, f"{attribute}{within} is '{shown}'", quantity.rule)
    for child in node.nodes:
        check_numbers(child, allowed, owner)


def _fits(text: str, quantity: Quantity) -> bool:
    tokens = text.split()
    if quantity.count is not None and len(tokens) != (quantity.count or max(len(tokens), 1)):
        return False
    for token in tokens:
        value = number(token)
        if value is None and (quantity.count is not None or _means_number(token)):
            return False
        if value is not None and not quantity.smallest <= value <= quantity.most:
            return False
    return True


def _means_number(token: str) -> bool:
    """Return true if an engine might take for a number what is no decimal one."""
    try:
        float(token)
    except ValueError:
        return token.lstrip("+-")[:2].lower() == "0x" or "," in token
    return True
