"""A walking body over samples of its walk: from CoM and soles to the points of its links, and to its angular momentum.

The trunk does not tilt, and each knee bends to where its ankle lets it. Then the hips follow from the CoM, and the
knees from hips and soles.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from surefoot.planner.model.leg_points import ANKLES, BESIDE, FEET, HIPS, KNEES, LEFT, MIDDLE, RIGHT, TRUNK, Vector
from surefoot.planner.types import Array

if TYPE_CHECKING:
    from surefoot.planner.model.leg_chain import LegChain

_BEND = 0.01
"""Share of its length by which a leg that comes to straight, or to a sole out of reach, stays bent [-].

The knee of a straight leg would move infinitely fast. With two per cent the ZMP of ordinary walks is off by a
millimetre more. With 0.8 the paper's gait falls of two pushes that it survives with one."""

_GUESS = -0.1
"""Height of the middle of the hips from the CoM where its search begins: below it, as in any walk [m]."""


class Body:
    """The body at samples of a walk: points of its links, from the CoM, and what moving them does.

    Args:
        chain: lengths and masses.
        toe: toe edge from the sole's centre, which the heel edge is as far behind [m].
        count: samples for which there is room.

    Attributes:
        points: hips, knees, ankles and feet, left and right each, the trunk, and maybe what is `BESIDE`, shape
            (p, 3, count) [m].
        bends: their accelerations from the sample after the first one on, times the square of the sample time, shape
            (p, 3, count) [m].
        rate: rate of angular momentum about the CoM over the body's mass from there on, shape (3, count) [m^2/s^2].
    """

    def __init__(self, chain: "LegChain", toe: float, count: int) -> None:
        thigh, shank = chain.thigh, chain.shank
        self._half_width, self._trunk, self._outward = chain.hip_half_width, chain.trunk, chain.foot_outward
        self._lever_beside, self._lever_above = chain.hip_lever
        x, y, z = chain.ankle
        self._toe, self._ankle, self._to_foot = toe, (x, y, z), chain.foot_centre
        self._thigh, self._shank = thigh.length, shank.length
        self._least_reach = abs(thigh.length - shank.length) + 1e-6
        self._rolls_first, self._links_beside = chain.rolls_first, chain.links_beside
        self._thigh_ahead, self._thigh_outward = thigh.ahead, thigh.outward
        self._shank_ahead, self._shank_outward = shank.ahead, shank.outward
        self._at_hip, self._at_ankle, self._trunk_mass = chain.shares
        self._at_knee, self._carried, self._corrections = chain.at_knee, chain.carried, chain.corrections
        self._thigh_pull, self._shank_pull = thigh.mass * thigh.ahead, shank.mass * shank.ahead
        x, y, z = (
            self._trunk_mass * way + 2.0 * chain.foot_mass * foot
            for way, foot in zip(chain.trunk, chain.foot_centre, strict=True)
        )
        self._own = x, y, z
        pairs = [*chain.mass_pairs()]
        self._pairs = np.array([pair[:2] for pair in pairs], dtype=np.intp)
        self._masses = np.array([mass for *_, mass in pairs])
        self.points = np.zeros((BESIDE + 4 if chain.links_beside else BESIDE, 3, count))
        self.bends, self.rate = np.zeros(self.points.shape), np.zeros((3, count))
        self._points, self._bends, self._rate = self.points, self.bends, self.rate
        self._ahead, self._spare = np.zeros((3, count)), np.zeros(count)
        # Cosine and sine of headings and of pitches.
        self._c, self._s = np.zeros((3, count)), np.zeros((3, count))
        self._cp, self._sp = np.zeros((2, count)), np.zeros((2, count))

    def turn_legs(self, heading: Array, pitch: Array, count: int) -> None:
        """Take headings of knees and feet and pitches of soles over samples, shape (2, n) each [rad]."""
        for k in range(count):
            self._spare[k] = 0.5 * (heading[LEFT, k] + heading[RIGHT, k])
        turn(self._spare, count, self._c[MIDDLE], self._s[MIDDLE])
        for leg in range(2):
            turn(heading[leg], count, self._c[leg], self._s[leg])
            turn(pitch[leg], count, self._cp[leg], self._sp[leg])

    def place(self, com: Array, soles: Array, count: int) -> None:
        """Place the points over samples.

        The middle of the pelvis is corrected by what the CoM is off with it, some times.

        Args:
            com: CoM, shape (n, 3) [m].
            soles: centres of the soles if they were level, shape (2, n, 3) [m].
            count: n.
        """
        for k in range(count):
            for leg in range(2):
                self._place_foot(leg, k, com, soles)
            self._put(TRUNK, k, (0.0, 0.0, _GUESS))
        for _ in range(self._corrections):
            self._place_legs(count)
            self._correct(count)
        self._place_legs(count)
        for k in range(count):
            self._settle(k)

    def _place_foot(self, leg: int, k: int, com: Array, soles: Array) -> None:
        """Ankle and CoM of a foot that is pitched about an edge of its sole."""
        edge, ankle = (-self._toe if self._sp[leg, k] < 0.0 else self._toe), self._ankle
        way = self._pitched((ankle[0] - edge, ankle[1], ankle[2]), edge, 0.0, leg, k)
        x = soles[leg, k, 0] - com[k, 0] + way[0]
        y = soles[leg, k, 1] - com[k, 1] + way[1]
        z = soles[leg, k, 2] - com[k, 2] + way[2]
        self._put(ANKLES + leg, k, (x, y, z))
        way = self._pitched(self._to_foot, 0.0, -self._outward if leg else self._outward, leg, k)
        self._put(FEET + leg, k, (x + way[0], y + way[1], z + way[2]))

    def _pitched(self, way: Vector, ahead: float, outward: float, leg: int, k: int) -> Vector:
        """A way in a foot that is pitched heel up about a point so far ahead."""
        c, s = self._c[leg, k], self._s[leg, k]
        cp, sp = self._cp[leg, k], self._sp[leg, k]
        x, y = ahead + cp * way[0] + sp * way[2], way[1] + outward
        return x * c - y * s, x * s + y * c, cp * way[2] - sp * way[0]

    def _place_legs(self, count: int) -> None:
        """Hips beside the middle of the pelvis, where the trunk's point is placed, and knees."""
        for leg in range(2):
            self._place_hip(leg, count)
            for k in range(count):
                self._ahead[0, k], self._ahead[1, k], self._ahead[2, k] = self._c[leg, k], self._s[leg, k], 0.0
            self._bend_knee(leg, count)
            if self._rolls_first:
                self._turn_ahead(leg, count)
                self._bend_knee(leg, count)

    def _place_hip(self, leg: int, count: int) -> None:
        """A hip beside the middle of the pelvis.

        A leg with a lever rolls about its axis until its plane, so far beside the axis, goes through the ankle.
        """
        beside, above, side = self._lever_beside, self._lever_above, -1.0 if leg else 1.0
        half = side * self._half_width
        for k in range(count):
            c, s, middle = self._c[MIDDLE, k], self._s[MIDDLE, k], self._point(TRUNK, k)
            self._put(HIPS + leg, k, (middle[0] - half * s, middle[1] + half * c, middle[2]))
        if beside == 0.0 and above == 0.0:
            return
        for k in range(count):
            c, s = self._c[MIDDLE, k], self._s[MIDDLE, k]
            hip, ankle = self._point(HIPS + leg, k), self._point(ANKLES + leg, k)
            y, z = side * (c * (ankle[1] - hip[1]) - s * (ankle[0] - hip[0])), ankle[2] - hip[2]
            square = y * y + z * z
            share, down = 1.0 / square, math.sqrt(max(0.0, square - beside * beside))
            cosine, sine = (y * beside - z * down) * share, (z * beside + y * down) * share
            out = side * (cosine * beside - sine * above)
            self._put(HIPS + leg, k, (hip[0] - out * s, hip[1] + out * c, hip[2] + (sine * beside + cosine * above)))

    def _bend_knee(self, leg: int, count: int) -> None:
        """A knee that bends in the plane of hip, ankle and the axis of the ankle's roll joint.

        Of an ankle that pitches first that axis points forward with the foot; of one that rolls first it is turned with
        the shank.
        """
        a, b, least = self._thigh, self._shank, self._least_reach
        for k in range(count):
            ahead = (self._ahead[0, k], self._ahead[1, k], self._ahead[2, k])
            hip, ankle = self._point(HIPS + leg, k), self._point(ANKLES + leg, k)
            self._put(KNEES + leg, k, bent(hip, ankle, ahead, a, b, least))

    def _turn_ahead(self, leg: int, count: int) -> None:
        """The axis of the ankle's roll joint, turned with the shank about the level axis of pitch."""
        for k in range(count):
            c, s = self._c[leg, k], self._s[leg, k]
            knee, ankle = self._point(KNEES + leg, k), self._point(ANKLES + leg, k)
            x, y, z = ankle[0] - knee[0], ankle[1] - knee[1], ankle[2] - knee[2]
            rising = x * c + y * s
            share = 1.0 / math.sqrt(z * z * (c * c + s * s) + rising * rising)
            self._ahead[0, k], self._ahead[1, k], self._ahead[2, k] = -share * z * c, -share * z * s, share * rising

    def _correct(self, count: int) -> None:
        """Move the middle of the pelvis by what the CoM is off."""
        m, share = self._trunk_mass, 1.0 / self._carried
        at_hip, at_knee, at_ankle = self._at_hip, self._at_knee, self._at_ankle
        thigh, shank, own = self._thigh_pull, self._shank_pull, self._own
        for k in range(count):
            c, s, middle = self._c[MIDDLE, k], self._s[MIDDLE, k], self._point(TRUNK, k)
            one, other = self._point(HIPS, k), self._point(HIPS + 1, k)
            hx, hy, hz = one[0] + other[0], one[1] + other[1], one[2] + other[2]
            one, other = self._point(KNEES, k), self._point(KNEES + 1, k)
            kx, ky, kz = one[0] + other[0], one[1] + other[1], one[2] + other[2]
            one, other = self._point(ANKLES, k), self._point(ANKLES + 1, k)
            x, y, z = one[0] + other[0], one[1] + other[1], one[2] + other[2]
            # What lies ahead of the rods, across them.
            bx = thigh * (kx - hx) + shank * (x - kx)
            by = thigh * (ky - hy) + shank * (y - ky)
            bz = thigh * (kz - hz) + shank * (z - kz)
            ex = at_ankle * x + own[0] * c - own[1] * s + m * middle[0] + at_hip * hx + at_knee * kx - bz * c
            ey = at_ankle * y + own[0] * s + own[1] * c + m * middle[1] + at_hip * hy + at_knee * ky - bz * s
            ez = at_ankle * z + own[2] + m * middle[2] + at_hip * hz + at_knee * kz + bx * c + by * s
            self._put(TRUNK, k, (middle[0] - share * ex, middle[1] - share * ey, middle[2] - share * ez))

    def _settle(self, k: int) -> None:
        """Put the trunk's CoM beside the middle of the pelvis, and the links' beside their rods."""
        c, s = self._c[MIDDLE, k], self._s[MIDDLE, k]
        middle = self._point(TRUNK, k)
        trunk = self._trunk
        x, y = trunk[0] * c - trunk[1] * s, trunk[0] * s + trunk[1] * c
        self._put(TRUNK, k, (middle[0] + x, middle[1] + y, middle[2] + trunk[2]))
        if self._links_beside:
            for leg in range(2):
                self._place_beside(leg, k)

    def _place_beside(self, leg: int, k: int) -> None:
        """Ways from the rods of a leg to the CoMs of its links."""
        hip, knee, ankle = self._point(HIPS + leg, k), self._point(KNEES + leg, k), self._point(ANKLES + leg, k)
        side = -1.0 if leg else 1.0
        c, s = self._c[leg, k], self._s[leg, k]
        self._put(BESIDE + leg, k, beside_of(hip, knee, self._thigh_ahead, side * self._thigh_outward, c, s))
        self._put(BESIDE + 2 + leg, k, beside_of(knee, ankle, self._shank_ahead, side * self._shank_outward, c, s))

    def _point(self, point: int, k: int) -> Vector:
        return self._points[point, 0, k], self._points[point, 1, k], self._points[point, 2, k]

    def _put(self, point: int, k: int, at: Vector) -> None:
        self._points[point, 0, k], self._points[point, 1, k], self._points[point, 2, k] = at[0], at[1], at[2]

    def turn_momentum(self, count: int, sample_time: float, axes: int) -> None:
        """Set `bends` and `rate` at all of `count` samples but the first and the last, Σ M_ij x_i x x_j''.

        The rate is set about the first axes alone.
        """
        last, scale = count - 2, 1.0 / (sample_time * sample_time)
        for point in range(self._points.shape[0]):
            for axis in range(3):
                self._bend(point, axis, last)
        for axis in range(axes):
            for k in range(last):
                self._rate[axis, k] = 0.0
        for pair in range(self._masses.shape[0]):
            i, j, mass = self._pairs[pair, 0], self._pairs[pair, 1], self._masses[pair] * scale
            for axis in range(axes):
                y, z = (axis + 1) % 3, (axis + 2) % 3
                for k in range(last):
                    turning = self._points[i, y, k + 1] * self._bends[j, z, k]
                    turning -= self._points[i, z, k + 1] * self._bends[j, y, k]
                    self._rate[axis, k] += mass * turning

    def _bend(self, point: int, axis: int, last: int) -> None:
        """Acceleration of a point times the square of the sample time, by second differences.

        These alone are a mean over two samples, which takes a tenth off what a leg swings in a double support. Their
        error to fourth order is subtracted. At either end it is that of the sample beside it.
        """
        for k in range(last):
            after = self._points[point, axis, k + 2] - self._points[point, axis, k + 1]
            self._spare[k] = after - (self._points[point, axis, k + 1] - self._points[point, axis, k])
        if last <= 2:
            for k in range(last):
                self._bends[point, axis, k] = self._spare[k]
            return
        for k in range(1, last - 1):
            rest = (self._spare[k + 1] - self._spare[k]) - (self._spare[k] - self._spare[k - 1])
            self._bends[point, axis, k] = self._spare[k] - rest * (1.0 / 12.0)
        first, end = self._spare[1] - self._bends[point, axis, 1], last - 1
        self._bends[point, axis, 0] = self._spare[0] - first
        self._bends[point, axis, end] = self._spare[end] - (self._spare[end - 1] - self._bends[point, axis, end - 1])


def turn(angle: Array, count: int, cosine: Array, sine: Array) -> None:
    """Cosines and sines of angles; those of an angle that stays are not made again."""
    for k in range(count):
        if k > 0 and angle[k] == angle[k - 1]:
            cosine[k], sine[k] = cosine[k - 1], sine[k - 1]
        else:
            cosine[k], sine[k] = math.cos(angle[k]), math.sin(angle[k])


def bent(hip: Vector, ankle: Vector, ahead: Vector, a: float, b: float, least: float) -> Vector:
    """The knee of a leg from hip to ankle that bends ahead; it never quite stretches, see `_BEND`."""
    whole = a + b
    x, y, z = ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]
    long = math.sqrt(x * x + y * y + z * z)
    share, slack = 1.0 / long, 1.0 - long * (1.0 / whole)
    reach = whole * (1.0 - 0.5 * (slack + math.sqrt(slack * slack + _BEND * _BEND)))
    reach = max(reach, least)
    along = 0.5 * ((a * a - b * b) / reach + reach)
    x, y, z = share * x, share * y, share * z
    falling = x * ahead[0] + y * ahead[1] + z * ahead[2]
    u, v, w = ahead[0] - falling * x, ahead[1] - falling * y, ahead[2] - falling * z
    beside = math.sqrt((a * a - along * along) / (u * u + v * v + w * w))
    return hip[0] + along * x + beside * u, hip[1] + along * y + beside * v, hip[2] + along * z + beside * w


def beside_of(upper: Vector, lower: Vector, ahead: float, outward: float, c: float, s: float) -> Vector:
    """The way from a rod to a CoM so far ahead, as a share of its length, and outward, of a leg of heading (c, s)."""
    x, y, z = lower[0] - upper[0], lower[1] - upper[1], lower[2] - upper[2]
    return -ahead * z * c - outward * s, -ahead * z * s + outward * c, ahead * (x * c + y * s)
