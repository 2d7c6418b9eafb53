"""A robot as a tree of bodies, before it becomes text."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from surefoot.models.actuator import Actuator
from surefoot.models.inertia import Inertial, Vector

AXES: dict[str, Vector] = {"roll": (1.0, 0.0, 0.0), "pitch": (0.0, 1.0, 0.0), "yaw": (0.0, 0.0, 1.0)}
"""Joint axes in the body frame; positive angles follow the right-hand rule."""


class Role(Enum):
    """What a geom is for; the value is its MJCF default class."""

    VISUAL = "visual"
    SOLE = "sole"
    COLLISION = "collision"


@dataclass(frozen=True, slots=True)
class Joint:
    """A revolute joint through the origin of its body, with its motor.

    Attributes:
        name: joint and motor name.
        axis: key of `AXES`.
        lower: lower limit [rad].
        upper: upper limit [rad].
        actuator: the motor.
    """

    name: str
    axis: str
    lower: float
    upper: float
    actuator: Actuator


@dataclass(frozen=True, slots=True)
class Geom:
    """A shape on a body.

    Attributes:
        shape: MJCF geom type.
        size: MJCF sizes [m].
        position: centre in the body frame [m]; ignored with `ends`.
        ends: end points of a capsule's or cylinder's axis, (x1, y1, z1, x2, y2, z2) [m].
        tilt: rotation about the body's y axis [rad]; ignored with `ends`.
        material: colour.
        role: drawn only, drawn and in contact (sole), or in contact only; what is in contact touches terrain and robot.
        name: optional name.
    """

    shape: str
    size: tuple[float, ...]
    position: Vector = (0.0, 0.0, 0.0)
    ends: tuple[float, float, float, float, float, float] | None = None
    tilt: float = 0.0
    material: str = "shell"
    role: Role = Role.VISUAL
    name: str | None = None


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body; its joint, if any, turns it about its own origin.

    Attributes:
        name: name.
        position: origin in the parent's frame at zero joint angle [m].
        inertial: mass properties.
        joint: the joint to the parent; None is the floating base.
        geoms: shapes.
        sites: named points with the axes of the body, (name, position [m]).
        children: bodies hanging on this one, in joint order.
    """

    name: str
    position: Vector
    inertial: Inertial
    joint: Joint | None = None
    geoms: tuple[Geom, ...] = ()
    sites: tuple[tuple[str, Vector], ...] = ()
    children: tuple["Body", ...] = ()

    def walk(self) -> Iterator["Body"]:
        """All bodies from here on, depth first: the order of bodies and joints in both engines."""
        yield self
        for child in self.children:
            yield from child.walk()
