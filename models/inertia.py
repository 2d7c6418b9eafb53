"""Inertials of uniform solids whose principal axes are the body's axes."""

from dataclasses import dataclass, replace

Vector = tuple[float, float, float]

LEAST_MASS = 1e-10
"""Mass [kg] and moment of inertia [kg m^2] up to which a body has none."""

MASSLESS = 1e-12
"""Mass [kg] and moments of inertia [kg m^2] in the text of a link without mass between joints: MuJoCo takes no 0."""


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass, CoM and principal moments of a body.

    Attributes:
        mass: mass [kg].
        com: CoM in the body frame [m].
        moments: moments of inertia about the CoM along the body's x, y and z axes [kg m^2].
    """

    mass: float
    com: Vector
    moments: Vector

    def with_point_mass(self, mass: float) -> "Inertial":
        """The same body with a point mass [kg] at its CoM, which leaves the moments as they are."""
        return replace(self, mass=self.mass + mass)


def ellipsoid(mass: float, semi_axes: Vector, com: Vector = (0.0, 0.0, 0.0)) -> Inertial:
    """Solid ellipsoid with the semi-axes a, b, c along x, y, z [m]."""
    a, b, c = semi_axes
    return Inertial(mass, com, (mass * (b * b + c * c) / 5, mass * (a * a + c * c) / 5, mass * (a * a + b * b) / 5))


def sphere(mass: float, radius: float, com: Vector = (0.0, 0.0, 0.0)) -> Inertial:
    """Solid sphere [m]."""
    return ellipsoid(mass, (radius, radius, radius), com)


def cylinder(mass: float, radius: float, length: float, com: Vector = (0.0, 0.0, 0.0)) -> Inertial:
    """Solid cylinder along z [m]."""
    across = mass * (3 * radius * radius + length * length) / 12
    return Inertial(mass, com, (across, across, mass * radius * radius / 2))


def box(mass: float, size: Vector, com: Vector = (0.0, 0.0, 0.0)) -> Inertial:
    """Solid box with full side lengths along x, y, z [m]."""
    x, y, z = size
    return Inertial(mass, com, (mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12, mass * (x * x + y * y) / 12))


def stacked(lower: Inertial, upper: Inertial) -> Inertial:
    """Two solids above each other as one rigid body (Steiner's theorem; both CoMs on the body's z axis).

    Raises:
        ValueError: a CoM lies off the z axis, so that the result would have products of inertia.
    """
    if any(part.com[:2] != (0.0, 0.0) for part in (lower, upper)):
        raise ValueError("stacked() needs both CoMs on the z axis of the body: give com=(0, 0, z)")
    mass = lower.mass + upper.mass
    z = (lower.mass * lower.com[2] + upper.mass * upper.com[2]) / mass
    steiner = sum(part.mass * (part.com[2] - z) ** 2 for part in (lower, upper))
    x_moment, y_moment, z_moment = (a + b for a, b in zip(lower.moments, upper.moments, strict=True))
    return Inertial(mass, (0.0, 0.0, z), (x_moment + steiner, y_moment + steiner, z_moment))
