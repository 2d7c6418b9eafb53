"""References of a plan at one instant."""

from collections.abc import Mapping
from dataclasses import dataclass

from surefoot.planner.types import Array, Foot

PLACES: Mapping[str, tuple[int, int]] = {
    "zmp_reference": (0, 2),
    "zmp_offset": (2, 2),
    "omega": (4, 1),
    "stiffness": (5, 1),
    "load_left": (6, 1),
    "com": (7, 3),
    "swing": (10, 6),
    "com_velocity": (16, 3),
    "swing_velocity": (19, 6),
    "com_acceleration": (25, 3),
    "swing_acceleration": (28, 6),
    "pendulum_zmp": (34, 2),
    "zmp": (36, 2),
    "dcm": (38, 2),
}
"""The first index of each quantity in the numbers of a sample, and how many numbers it has."""

POINT = 40
"""Numbers of a sample, which are those of all its quantities: seven linear functions of time, then motions [-]."""


def in_point(name: str) -> slice:
    """The indices of a quantity in the numbers of a sample."""
    first, size = PLACES[name]
    return slice(first, first + size)


class _Vector:
    """A quantity of a sample that is an array: the part of its point that holds it."""

    def __init__(self, name: str) -> None:
        self._place = in_point(name)

    def __get__(self, sample: "PlanSample", owner: type) -> Array:
        part: Array = sample.point[self._place]
        return part


class _Number:
    """A quantity of a sample that is a number."""

    def __init__(self, name: str) -> None:
        self._place = in_point(name).start

    def __get__(self, sample: "PlanSample", owner: type) -> float:
        return sample.point.item(self._place)


@dataclass(frozen=True)
class PlanSample:
    """References at one instant; world frame, arrays are fresh at every call.

    Attributes:
        time: instant [s].
        point: the numbers that the quantities below are parts of, shape (POINT,) [SI].
        contacts: planned contacts (left, right).
        swing_foot: the swinging foot, or None; the swing arrays are zero without one.
        com: CoM position, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        com_acceleration: shape (3,) [m/s^2].
        zmp: ZMP of this motion, shape (2,) [m].
        zmp_offset: what the swing leg adds to it, shape (2,) [m].
        pendulum_zmp: the ZMP less that: c - c''/λ, which drives the CoM, shape (2,) [m].
        zmp_reference: ZMP that the footsteps define, shape (2,) [m].
        dcm: ξ = c + c'/ω, shape (2,) [m].
        omega: ω [1/s].
        stiffness: λ [1/s^2].
        load_left: planned share of the weight on the left foot [-].
        swing: swing sole x, y, z [m], yaw, pitch, roll [rad], shape (6,).
        swing_velocity: shape (6,) [m/s, rad/s].
        swing_acceleration: shape (6,) [m/s^2, rad/s^2].
    """

    time: float
    point: Array
    contacts: tuple[bool, bool]
    swing_foot: Foot | None

    com = _Vector("com")
    com_velocity = _Vector("com_velocity")
    com_acceleration = _Vector("com_acceleration")
    zmp = _Vector("zmp")
    zmp_offset = _Vector("zmp_offset")
    pendulum_zmp = _Vector("pendulum_zmp")
    zmp_reference = _Vector("zmp_reference")
    dcm = _Vector("dcm")
    omega = _Number("omega")
    stiffness = _Number("stiffness")
    load_left = _Number("load_left")
    swing = _Vector("swing")
    swing_velocity = _Vector("swing_velocity")
    swing_acceleration = _Vector("swing_acceleration")
