"""The ZMP that the body's own motion adds: the pendulum with legs that have mass.

The paper's pendulum carries all mass in the CoM. A real leg weighs a sixth of the body. Its swing changes the angular
momentum L at up to hundreds of N·m, which moves the ZMP by decimetres. The moment balance about the ZMP,
(c - p) x m (c'' + g e_z) + L' = 0, gives with h = c_z - p_z and λ = (g + z'') / h

    p_x = c_x - c_x'' / λ - L_y' / (m (g + z'')),      p_y = c_y - c_y'' / λ + L_x' / (m (g + z'')).

L' follows from the planned soles and a CoM motion near the one that will be planned (see `planner.model.leg_body`).
What still depends on the CoM is kept to first order: with point masses μ m at both soles at rest,
L' = -2 μ m h c'' e_y, so that

    p = c - (1 + 2 μ) c'' / λ + o

defines an offset o that the CoM's own deviations hardly change. So the motion is again a pendulum,
c'' = λ' (c - (p - o)) with λ' = λ / (1 + 2 μ), driven by the ZMP less the known offset o. (Multi-mass ZMP models:
Takanishi et al., 1988; Sato, Sakaino and Tsuji, ICRA 2010.)
"""

import numpy as np

from surefoot.planner.model.leg_body import Body
from surefoot.planner.model.nominal import NominalMotion
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.nominal_feet import Moving, NominalFeet
from surefoot.planner.types import GRAVITY, Array


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


class LegOffset:
    """The offset that a plan counts with: that of a CoM on the nominal motion, which itself depends on it.

    Args:
        leg: inertia of the legs, which have a chain.
        toe: toe edge from the sole's centre [m].
        sample_time: T [s].
        count: samples that it may be wanted of.
    """

    def __init__(self, leg: LegInertia, toe: float, sample_time: float, count: int) -> None:
        assert leg.chain is not None
        self._softening, self._sample_time = softening(leg), sample_time
        # With the sample before.
        self._body, self._feet = Body(leg.chain, toe, count + 1), NominalFeet(count + 1)
        self._com = np.zeros((count + 1, 3))
        self._motion = NominalMotion(sample_time, count)

    def made(
        self,
        moving: Moving,
        point: Array,
        height: HeightPreview,
        position: Array,
        guess: Array | None,
    ) -> Array:
        """ZMP that the legs add, shape (n, 2) [m]; two passes, or one from a guess, leave a millimetre.

        Args:
            moving: what `NominalFeet.move` moves the feet by.
            point: ZMP that drives the pendulum but for it, shape (n, 2) [m].
            height: CoM height over the n samples.
            position: CoM now, shape (2,) [m].
            guess: about what it will be, shape (n, 2) [m].
        """
        n = len(point)
        body = self._body
        feet = self._feet
        stiffness = self._softening * height.stiffness
        passes, offset = (2, np.zeros((n, 2))) if guess is None else (1, guess)
        if self._motion.count != n:
            self._motion = NominalMotion(self._sample_time, n)
        samples, schedule, frame, flown = moving
        feet.move(n + 1, samples, schedule, frame, flown)
        body.turn_legs(feet.heading, feet.pitch, n + 1)
        for _ in range(passes):
            self._motion.follow(position, point - offset, stiffness)
            self._place_com(height.height, n)
            body.place(self._com, feet.soles, n + 1)
            body.turn_momentum(n + 1, self._sample_time, 2)
            offset = np.empty((n, 2))
            self._tell(height.height, height.stiffness, stiffness, offset)
        return offset

    def _place_com(self, height: Array, n: int) -> None:
        """The CoM at n samples and at the one before them."""
        t, motion, com = self._sample_time, self._motion, self._com
        for axis in range(2):
            c = motion.c[0, axis]
            v = motion.v[0, axis]
            a = motion.a[0, axis]
            u = motion.u[0, axis]
            com[0, axis] = c - v * t + 0.5 * a * t * t - u * t * t * t / 6.0
        com[0, 2] = height[0, 0] - height[1, 0] * t + 0.5 * height[2, 0] * t * t
        for k in range(n):
            com[k + 1, 0], com[k + 1, 1], com[k + 1, 2] = motion.c[k, 0], motion.c[k, 1], height[0, k]

    def _tell(self, height: Array, stiffness: Array, softened: Array, offset: Array) -> None:
        """Write the offset of the module's equation; the last sample, whose momentum is not known, has that before."""
        last, rate, a = stiffness.shape[0] - 1, self._body.rate, self._motion.a
        for k in range(last + 1):
            pull = 1.0 / softened[k] - 1.0 / stiffness[k]
            offset[k, 0], offset[k, 1] = pull * a[k, 0], pull * a[k, 1]
        for k in range(last):
            pressing = GRAVITY + height[2, k]
            offset[k, 0] -= rate[1, k] / pressing
            offset[k, 1] += rate[0, k] / pressing
        offset[last, 0], offset[last, 1] = offset[last - 1, 0], offset[last - 1, 1]
