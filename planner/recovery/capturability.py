"""One-step capturability: the largest push that no controller survives that lands once and stops.

Of a linear inverted pendulum (Koolen et al., Capturability-based analysis and control of legged locomotion, 2012) whose
centre of pressure may be anywhere in the support and whose foot may land wherever it can get.
"""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.types import Array


@dataclass(frozen=True, slots=True)
class Way:
    """A way to land once.

    Attributes:
        supports: until the landing: points whose hull the centre of pressure may be in, shape (n, 2) [m], and from
            when until when [s].
        landed: points in whose hull it may be once the foot has landed where it is best, shape (n, 2) [m].
    """

    supports: tuple[tuple[Array, tuple[float, float]], ...]
    landed: Array

    @property
    def landing(self) -> float:
        """Time until the foot lands [s]."""
        return self.supports[-1][1][1] if self.supports else 0.0

    def summands(self, omega: float) -> list[Array]:
        """Polygons whose Minkowski sum holds each DCM that can be brought to rest, by their points, (n, 2) each [m].

        The DCM obeys dξ/dt = ω (ξ - p). It can be brought to rest after the landing at T exactly if

            ξ = Σ_k p_k (e^{-ω a_k} - e^{-ω b_k}) + e^{-ωT} q

        with p_k in the support from a_k to b_k and q in that after landing.
        """
        shares = [(math.exp(-omega * begin) - math.exp(-omega * end), hull) for hull, (begin, end) in self.supports]
        shares.append((math.exp(-omega * self.landing), self.landed))
        return [share * hull for share, hull in shares if share > 0.0]


@dataclass(frozen=True, slots=True)
class Moment:
    """The state in which a push begins, and what can be done about it.

    Attributes:
        dcm: divergent component of motion, shape (2,) [m].
        omega: rate of its divergence [1/s].
        ways: to land.
        duration: of the push [s].
        direction: of it, from the world's x axis to the left [rad].
    """

    dcm: Array
    omega: float
    ways: tuple[Way, ...]
    duration: float
    direction: float = 0.0

    def limit(self, direction: float) -> float:
        """Largest impulse per mass in a direction that can be captured [N·s/kg]; 0 where not even none can be.

        An acceleration j / d over the duration d moves the DCM, as of now, by j (1 - e^{-ωd}) / (ω² d).

        Args:
            direction: of the push in the world, from x to the left [rad].
        """
        spread = self.omega * self.duration
        gain = -math.expm1(-spread) / spread / self.omega
        to = np.array([math.cos(direction), math.sin(direction)])
        return max(_distance(self.dcm, to, way.summands(self.omega)) for way in self.ways) / gain


def _distance(point: Array, to: Array, summands: list[Array]) -> float:
    """Distance from a point in a direction to the edge of the Minkowski sum of polygons; 0 if it is not in it [m].

    The sum's edges are parallel to those of the polygons, and how far it goes in any direction is the sum of how far
    they do.
    """
    ways = [np.eye(2)]
    for hull in summands:
        first, second = np.triu_indices(len(hull), 1)
        ways.append(hull[first] - hull[second])
    sides = np.vstack(ways)
    sides = np.vstack([sides, sides[:, ::-1] * (1.0, -1.0)])
    sides = sides[np.hypot(*sides.T) > _ROUNDING]
    normals = np.vstack([sides, -sides]) / np.tile(np.hypot(*sides.T), 2)[:, None]
    room = sum((hull @ normals.T).max(axis=0) for hull in summands) - normals @ point
    along = normals @ to
    if (room < -_ROUNDING).any():
        return 0.0
    return float(np.min(np.maximum(room[along > _ROUNDING], 0.0) / along[along > _ROUNDING]))


_ROUNDING = 1e-9
"""Numbers below this count as zero, since sums of shapes are rounded by as much [m, -]."""


def swing_box(here: Array, speed: Array, most: Array, time: float) -> tuple[Array, Array]:
    """Box in which a foot can be at rest after a time: lower and upper corner, shape (2,) each [m].

    It gets farthest by full acceleration for (T - v / a) / 2 and full braking for (T + v / a) / 2.

    Args:
        here: where it is, shape (2,) [m].
        speed: that it has, shape (2,) [m/s].
        most: its greatest acceleration, shape (2,) [m/s^2].
        time: until then [s].
    """
    middle = here + 0.5 * speed * time
    span = 0.25 * most * (time**2 - np.minimum(np.abs(speed) / most, time) ** 2)
    return middle - span, middle + span


def landing_points(stance: Array, sole: tuple[float, float], reach: tuple[Array, Array]) -> Array:
    """Corners of all that a sole can cover that lands within reach, shape (4, 2) [m].

    Args:
        stance: centre and heading of the standing sole, shape (3,) [m, rad].
        sole: half length and half width of the landing one, which keeps the heading [m].
        reach: lower and upper corner of where its centre may land, in the frame of the standing one, shape (2,) [m].
    """
    low, high = reach[0] - sole, reach[1] + sole
    corners = np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])])
    return np.asarray(stance[:2] + corners @ frame_rotation(stance[2]).T)
