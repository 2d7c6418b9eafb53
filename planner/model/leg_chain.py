"""A walking body as a trunk on two legs of thigh, shank and foot: its posture and angular momentum from CoM and soles.

The trunk does not tilt, each knee bends to where its ankle lets it, the feet stay level. Then the hips follow from the
CoM, the knees from hips and soles, and with them the mass of every link: a rod whose momentum is bilinear in its ends.
"""

import math
from functools import lru_cache

import numpy as np

from surefoot.native.library import Bound, Library
from surefoot.planner.model.vectors import bend, cross, crossed, dot, headings, pitched, turned
from surefoot.planner.types import Array
from surefoot.values import dataclass

_REST = 4e-3
"""Share of the first guess's error that the hips may keep; a constant rest does no harm [-]."""

_BEND = 0.01
"""Share of its length by which a leg stays the more bent the nearer it comes to straight, or its sole out of reach: the
knee of a straight leg would move infinitely fast. Two per cent cost ordinary walks a millimetre of ZMP; with 0.8 two
pushes of the paper's gait fell that are survived with one [-]."""

_GUESS = -0.1
"""Where the middle of the hips is sought at first, from the CoM: below it, as in any walk [m]."""

_OUTWARD = np.array([1.0, -1.0])[:, None, None]
"""Which way is outward for the left and the right leg, along the left [-]."""

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Link:
    """A straight link of a leg.

    Attributes:
        length: from its upper to its lower joint [m].
        mass: over the body's mass [-].
        centre: where its CoM is, as a share of the length from the upper joint [-].
        inertia: pitch inertia about its CoM over the body's mass [m^2].
        ahead: how far its CoM lies ahead of the line between the joints, as a share of the length [-].
        outward: of its CoM from the line of its joints, away from the other leg [m].
    """

    length: float
    mass: float
    centre: float
    inertia: float
    ahead: float = 0.0
    outward: float = 0.0

    def mass_matrix(self) -> Array:
        """M with Σ M_ij x_i · x_j' the momentum of the rod with ends x_1, x_2, shape (2, 2) [-].

        But for what the CoM beside the rod has to do with the one on it: see `LegChain._beside`.
        """
        s, spin = self.centre, self.inertia / self.length**2 + self.mass * self.ahead**2
        mixed = self.mass * s * (1.0 - s) - spin
        return np.array([[self.mass * (1.0 - s) ** 2 + spin, mixed], [mixed, self.mass * s**2 + spin]])


@dataclass(frozen=True, slots=True)
class LegChain:
    """Lengths and masses of the body; both legs are alike.

    Attributes:
        hip_half_width: hip centre from the middle between the hips [m]; of hips with `hip_lever`, their axis of roll.
        trunk: CoM of everything but the legs, from that middle: forward, left, up [m].
        thigh, shank: the links.
        foot_mass: over the body's mass [-].
        foot_centre: CoM of the foot from the ankle: forward, left, up [m].
        ankle: from the sole's centre: forward, left, up [m].
        foot_outward: of the foot's CoM from its ankle, away from the other leg [m].
        rolls_first: whether the ankle's roll joint is above its pitch joint.
        hip_lever: of a leg that rolls before it pitches, its hip from the axis of roll: outward and up in the frame of
            the leg [m].
    """

    hip_half_width: float
    trunk: Vector
    thigh: Link
    shank: Link
    foot_mass: float
    foot_centre: Vector
    ankle: Vector
    foot_outward: float = 0.0
    rolls_first: bool = False
    hip_lever: tuple[float, float] = (0.0, 0.0)

    def momentum_rate(
        self,
        com: Array,
        soles: Array,
        heading: Array,
        sample_time: float,
        pitch: Array | None = None,
        toe: float = 0.0,
    ) -> Array:
        """Rate of angular momentum about the CoM over the body's mass, by differences of fourth order.

        Args:
            com: CoM, shape (n, 3) [m].
            soles: centres of the left and the right sole, shape (2, n, 3) [m].
            heading: of the left and the right knee and foot, shape (2, n); the trunk has their mean [rad].
            sample_time: between the samples [s].
            pitch: of the soles about their toe edges, heel up positive, shape (2, n) [rad]; level by default. `soles`
                are where they would be without it.
            toe: toe edge from the sole's centre [m].

        Returns:
            At all samples but the first and the last, shape (n - 2, 3) [m^2/s^2].
        """
        frame, legs = headings(0.5 * (heading[0] + heading[1])), headings(heading)
        left, (ankles, lever) = legs[:, 1], self._rolled(legs, pitch, toe)
        ankles += (soles - com).swapaxes(1, 2)
        foot = ankles + lever + _OUTWARD * self.foot_outward * left
        hips, knees, middle = self._posture(ankles, frame, legs[:, 0])
        trunk = middle + turned(frame, self.trunk)
        points = np.concatenate((hips, knees, ankles, foot, trunk[None]))
        bends = bend(points, sample_time)
        pull = (_masses(self) @ bends.reshape(len(points), -1)).reshape(bends.shape)
        rate = crossed(points[..., 1:-1], pull)
        if any(link.ahead or link.outward for link in (self.thigh, self.shank)):
            rate += self._beside(points[:6], left, sample_time)
        return rate.T

    def joints(
        self, com: Array, soles: Array, heading: Array, pitch: Array | None = None, toe: float = 0.0
    ) -> tuple[Array, Array, Array]:
        """Hips, knees and ankles in the world, shape (2, n, 3) each [m]; arguments as of `momentum_rate`."""
        frame, legs = headings(0.5 * (heading[0] + heading[1])), headings(heading)
        ankles = self._rolled(legs, pitch, toe)[0] + (soles - com).swapaxes(1, 2)
        hips, knees, _ = self._posture(ankles, frame, legs[:, 0])
        return hips.swapaxes(1, 2) + com, knees.swapaxes(1, 2) + com, ankles.swapaxes(1, 2) + com

    def _beside(self, ends: Array, left: Array, sample_time: float) -> Array:
        """What links whose CoM lies beside their rod add to the rate of angular momentum, shape (3, n - 2) [m^2/s^2].

        With a the point of the rod beside the CoM, and b the way from there to it, Σ m (a x b'' + b x a''); b x b'' is
        in the rods' inertia.

        Args:
            ends: hips, knees and ankles, shape (6, 3, n) [m].
            left: of the legs, shape (2, 3, n).
            sample_time: between the samples [s].
        """
        links, shape = (self.thigh, self.shank), (2, 2, 3, left.shape[-1])
        numbers = np.array([(link.centre, link.ahead, link.outward) for link in links])
        centre, ahead, outward = numbers.T[:, :, None, None, None]
        upper, along = ends[:4].reshape(shape), (ends[2:] - ends[:4]).reshape(shape)
        ways = np.stack((upper + centre * along, ahead * cross(along, left) + _OUTWARD * outward * left))
        bends = bend(ways, sample_time)
        thigh, shank = crossed(ways[..., 1:-1], bends[::-1]).swapaxes(0, 1)
        return np.asarray(self.thigh.mass * (thigh[0] + thigh[1]) + self.shank.mass * (shank[0] + shank[1]))

    def _rolled(self, frame: Array, pitch: Array | None, toe: float) -> tuple[Array, Array]:
        """Ankles from the level soles, and the feet's CoMs from the ankles, shape (2, 3, n) each."""
        if pitch is None or not pitch.any():
            return turned(frame, self.ankle), turned(frame, self.foot_centre)
        edge = np.array([toe, 0.0, 0.0])
        lever = pitched(frame, np.array(self.ankle) - edge, pitch)
        return turned(frame, edge) + lever, pitched(frame, np.array(self.foot_centre), pitch)

    def _posture(self, ankles: Array, frame: Array, ahead: Array) -> tuple[Array, Array, Array]:
        """Hips and knees, shape (2, 3, n) each, and the middle of the pelvis, shape (3, n), all from the CoM.

        Args:
            ankles: from the CoM, shape (2, 3, n) [m].
            frame: of the trunk, as of `headings`, shape (2, 3, n).
            ahead: where the knees point, shape (2, 3, n).
        """
        thigh, shank, carried = self.thigh, self.shank, self.carried
        (at_hip, at_ankle, trunk_mass), at_knee = self._shares, self._at_knee
        fixed = at_ankle * (ankles[0] + ankles[1]) + turned(
            frame, trunk_mass * np.array(self.trunk) + 2.0 * self.foot_mass * np.array(self.foot_centre)
        )
        middle = np.zeros_like(fixed)
        middle[2] = _GUESS
        for _ in range(self._corrections):
            hips = self._hips(middle, ankles, frame)
            knees = self._knees(hips, ankles, ahead)
            error = fixed + trunk_mass * middle + at_hip * (hips[0] + hips[1]) + at_knee * (knees[0] + knees[1])
            if thigh.ahead or shank.ahead:
                upper, lower = knees - hips, ankles - knees
                beside = thigh.mass * thigh.ahead * (upper[0] + upper[1])
                beside += shank.mass * shank.ahead * (lower[0] + lower[1])
                error += cross(beside, frame[1])
            middle = middle - error / carried
        hips = self._hips(middle, ankles, frame)
        return hips, self._knees(hips, ankles, ahead), middle

    def _hips(self, middle: Array, ankles: Array, frame: Array) -> Array:
        """The hips beside the middle of the pelvis, shape (2, 3, n).

        A leg with a lever rolls about its axis until its plane, so far beside the axis, goes through the ankle.
        """
        left, hips = frame[1], np.empty_like(ankles)
        half = self.hip_half_width * left
        np.add(middle, half, out=hips[0])
        np.subtract(middle, half, out=hips[1])
        beside, above = self.hip_lever
        if beside == above == 0.0:
            return hips
        outward = _OUTWARD * left
        way = ankles - hips
        y, z = dot(way, outward), way[:, 2]
        square = y * y + z * z
        down = np.sqrt(np.maximum(square - beside * beside, 0.0))
        c, s = (y * beside - z * down) / square, (z * beside + y * down) / square
        hips += (c * beside - s * above)[:, None] * outward
        hips[:, 2] += s * beside + c * above
        return hips

    @property
    def carried(self) -> float:
        """Share of the mass that goes where the hips go, while the feet stay [-]."""
        return 1.0 - 2.0 * (self.foot_mass + self.shank.mass * self.shank.centre) - self._at_knee

    @property
    def _at_knee(self) -> float:
        """Mass of one leg that counts as in its knee, over the body's; the knee goes half as far as the hip [-]."""
        return self.thigh.mass * self.thigh.centre + self.shank.mass * (1.0 - self.shank.centre)

    @property
    def _shares(self) -> tuple[float, float, float]:
        """Masses that count as in a hip, in an ankle and in the trunk, over the body's [-]."""
        thigh, shank = self.thigh, self.shank
        trunk = 1.0 - 2.0 * (thigh.mass + shank.mass + self.foot_mass)
        return thigh.mass * (1.0 - thigh.centre), shank.mass * shank.centre + self.foot_mass, trunk

    @property
    def _corrections(self) -> int:
        """Corrections of the hips by the CoM's error: the lighter the legs, the less is left by one."""
        return math.ceil(math.log(_REST) / math.log(max(1.0 - self.carried, _REST)))

    def _knees(self, hips: Array, ankles: Array, forward: Array) -> Array:
        """Knees that bend in the plane of hip, ankle and the axis of the ankle's roll joint.

        Of an ankle that pitches first that axis points forward with the foot; of one that rolls first it is turned with
        the shank, about the level axis of pitch.
        """
        knees = self._bent(hips, ankles, forward)
        if self.rolls_first:
            shank = ankles - knees
            rising = dot(shank, forward)
            forward = -shank[:, 2:] * forward
            forward[:, 2] += rising
            knees = self._bent(hips, ankles, forward / np.linalg.norm(forward, axis=1, keepdims=True))
        return knees

    def _bent(self, hips: Array, ankles: Array, forward: Array) -> Array:
        leg = ankles - hips
        long = np.sqrt(dot(leg, leg))
        a, b = self.thigh.length, self.shank.length
        slack = 1.0 - long / (a + b)
        reach = (a + b) * (1.0 - 0.5 * (slack + np.sqrt(slack * slack + _BEND * _BEND)))
        reach = np.maximum(reach, abs(a - b) + 1e-6)
        along = (a * a - b * b + reach * reach) / (2.0 * reach)
        down = leg / long[:, None]
        ahead = forward - dot(down, forward)[:, None] * down
        bent = np.sqrt((a * a - along * along) / dot(ahead, ahead))
        return np.asarray(hips + along[:, None] * down + bent[:, None] * ahead)


def bind_chain(kernels: Library, chain: LegChain) -> tuple[Bound, int]:
    """The chain as kernels take it, and how many points of it they move.

    Theirs are those of `_masses`, and where a CoM lies beside its rod those ways of `LegChain._beside`, thighs first.
    """
    links, M = (chain.thigh, chain.shank), np.zeros((13, 13))
    points = 13 if any(link.ahead or link.outward for link in links) else 9
    M[:9, :9] = _masses(chain)
    for number, link in enumerate(links):
        for upper in range(2 * number, 2 * number + 2):
            ends, way = [upper, upper + 2], upper + 9
            M[ends, way] = M[way, ends] = link.mass * np.array([1.0 - link.centre, link.centre])
    pairs = np.ascontiguousarray(np.argwhere(M[:points, :points]))
    own = ("hip_half_width", "hip_lever", "trunk", "ankle", "foot_centre", "foot_outward", "rolls_first", "foot_mass")
    return kernels.fill(
        "LegChain",
        **{name: getattr(chain, name) for name in (*own, "carried")},
        **{name: tuple(getattr(link, name) for link in links) for name in ("length", "ahead", "outward")},
        **dict(zip(("at_hip", "at_ankle", "trunk_mass"), chain._shares, strict=True)),
        mass_ahead=tuple(link.mass * link.ahead for link in links),
        at_knee=chain._at_knee,
        guess=_GUESS,
        bend=_BEND,
        least_reach=abs(chain.thigh.length - chain.shank.length) + 1e-6,
        corrections=chain._corrections,
        points=points,
        pair_count=len(pairs),
        pairs=pairs,
        pair_mass=M[tuple(pairs.T)],
    ), points


@lru_cache(maxsize=4)
def _masses(chain: LegChain) -> Array:
    """Mass matrix of the points hips, knees, ankles, feet (left, right each) and trunk, shape (9, 9) [-]."""
    M = np.zeros((9, 9))
    thigh, shank = chain.thigh.mass_matrix(), chain.shank.mass_matrix()
    for leg in (0, 1):
        upper, lower = np.ix_((leg, 2 + leg), (leg, 2 + leg)), np.ix_((2 + leg, 4 + leg), (2 + leg, 4 + leg))
        M[upper] += thigh
        M[lower] += shank
        M[6 + leg, 6 + leg] = chain.foot_mass
    M[8, 8] = 1.0 - 2.0 * (chain.thigh.mass + chain.shank.mass + chain.foot_mass)
    M.flags.writeable = False
    return M
