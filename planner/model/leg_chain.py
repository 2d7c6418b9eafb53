"""A walking body as a trunk on two legs of thigh, shank and foot: its lengths and masses.

`planner.model.leg_body` places it over the samples of a walk. A link is a rod whose momentum is bilinear in its ends.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil

import numpy as np

from surefoot.planner.model.leg_body import Body
from surefoot.planner.model.leg_points import ANKLES, BESIDE, FEET, HIPS, KNEES, LEFT, RIGHT, TRUNK, Vector
from surefoot.planner.types import Array

_REST = 4e-3
"""Share of the first guess's error that the hips may keep; a constant rest does no harm [-]."""


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

        But for what the CoM beside the rod has to do with the one on it: see `mass_pairs`.
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
            pitch: of the soles, heel up about their toe edges, negative about their heel edges, shape (2, n)
                [rad]; level by default. `soles`
                are where they would be without it.
            toe: toe edge from the sole's centre, which the heel edge is as far behind [m].

        Returns:
            At all samples but the first and the last, shape (n - 2, 3) [m^2/s^2].
        """
        body = self.body(com, soles, heading, pitch, toe)
        body.turn_momentum(len(com), sample_time, 3)
        return np.asarray(body.rate[:, : len(com) - 2].T)

    def joints(
        self, com: Array, soles: Array, heading: Array, pitch: Array | None = None, toe: float = 0.0
    ) -> tuple[Array, Array, Array]:
        """Hips, knees and ankles in the world, shape (2, n, 3) each [m]; the arguments are those of `body`."""
        points = self.body(com, soles, heading, pitch, toe).points.swapaxes(1, 2) + com
        return points[HIPS:KNEES], points[KNEES:ANKLES], points[ANKLES:FEET]

    def body(self, com: Array, soles: Array, heading: Array, pitch: Array | None = None, toe: float = 0.0) -> Body:
        """The body placed at samples.

        Args:
            com: CoM, shape (n, 3) [m].
            soles: centres of the left and the right sole, shape (2, n, 3) [m].
            heading: of the left and the right knee and foot, shape (2, n) [rad].
            pitch: of the soles, heel up about their toe edges, negative about their heel edges, shape (2, n)
                [rad]; level by default.
            toe: toe edge from the sole's centre, which the heel edge is as far behind [m].
        """
        body = Body(self, toe, len(com))
        body.turn_legs(heading, np.zeros_like(heading) if pitch is None else pitch, len(com))
        body.place(com, soles, len(com))
        return body

    @property
    def links_beside(self) -> bool:
        """Return true if the CoM of a link lies beside the line between its joints."""
        return any(link.ahead or link.outward for link in (self.thigh, self.shank))

    def mass_pairs(self) -> Iterator[tuple[int, int, float]]:
        """Points i and j and their mass M_ij [-], of which the momentum is Σ M_ij x_i x x_j', row by row.

        Those on rods follow from the mass matrices of these. With a the point of a rod beside its CoM, and b the way
        from there to it, Σ m (a x b'' + b x a'') counts too; b x b'' is in the rods' inertia.
        """
        count = BESIDE + 4 if self.links_beside else BESIDE
        M = np.zeros((BESIDE + 4, BESIDE + 4))
        for first, link in ((HIPS, self.thigh), (KNEES, self.shank)):
            for leg in (LEFT, RIGHT):
                ends, way = [first + leg, first + leg + 2], BESIDE + first + leg
                M[np.ix_(ends, ends)] += link.mass_matrix()
                M[ends, way] = M[way, ends] = link.mass * np.array([1.0 - link.centre, link.centre])
        M[range(FEET, TRUNK), range(FEET, TRUNK)] = self.foot_mass
        M[TRUNK, TRUNK] = 1.0 - 2.0 * (self.thigh.mass + self.shank.mass + self.foot_mass)
        for i, j in np.argwhere(M[:count, :count]).tolist():
            yield i, j, float(M[i, j])

    @property
    def carried(self) -> float:
        """Share of the mass that goes where the hips go, while the feet stay [-]."""
        return 1.0 - 2.0 * (self.foot_mass + self.shank.mass * self.shank.centre) - self.at_knee

    @property
    def at_knee(self) -> float:
        """Mass of one leg that counts as in its knee, over the body's; the knee goes half as far as the hip [-]."""
        return self.thigh.mass * self.thigh.centre + self.shank.mass * (1.0 - self.shank.centre)

    @property
    def shares(self) -> tuple[float, float, float]:
        """Masses that count as in a hip, in an ankle and in the trunk, over the body's [-]."""
        thigh, shank = self.thigh, self.shank
        trunk = 1.0 - 2.0 * (thigh.mass + shank.mass + self.foot_mass)
        return thigh.mass * (1.0 - thigh.centre), shank.mass * shank.centre + self.foot_mass, trunk

    @property
    def corrections(self) -> int:
        """Corrections of the hips by the CoM's error: the lighter the legs, the less is left by one."""
        return ceil(math.log(_REST) / math.log(max(1.0 - self.carried, _REST)))
