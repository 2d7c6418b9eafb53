"""What the body's own motion adds to the ZMP: the pendulum with legs that have mass.

The paper's pendulum carries all mass in the CoM. A real leg weighs a sixth of the body, and swinging it turns angular
momentum L over at up to hundreds of N·m, which moves the ZMP by decimetres. The moment balance about the ZMP,
(c - p) x m (c'' + g e_z) + L' = 0, gives with h = c_z - p_z and λ = (g + z'') / h

    p_x = c_x - c_x'' / λ - L_y' / (m (g + z'')),      p_y = c_y - c_y'' / λ + L_x' / (m (g + z'')).

L' follows from the planned soles and a CoM motion near the one that will be planned (see `planner.model.leg_chain`).
What still depends on the CoM is kept to first order: with point masses μ m at both soles at rest,
L' = -2 μ m h c'' e_y, so that

    p = c - (1 + 2 μ) c'' / λ + o

defines an offset o that the CoM's own deviations hardly change. So the motion is again a pendulum,
c'' = λ' (c - (p - o)) with λ' = λ / (1 + 2 μ), driven by the ZMP less the known offset o. (Multi-mass ZMP models:
Takanishi et al., 1988; Sato, Sakaino and Tsuji, ICRA 2010.)
"""

import numpy as np

from surefoot.native.library import Library, library
from surefoot.planner.model.leg_chain import LegChain, bind_chain
from surefoot.planner.model.nominal import NominalMotion, bind_motion, nominal_motion
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.nominal_feet import CompiledFeet, Feet, Moving, nominal_feet
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import GRAVITY, Array


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


def zmp_offset(
    chain: LegChain, feet: Feet, toe: float, motion: NominalMotion, height: HeightPreview, softened: Array
) -> Array:
    """Offset o of the module's equation over a window, in the plan frame.

    Args:
        chain: the body.
        feet: at the sample before the window, at its n samples, and maybe more.
        toe: toe edge from the sole's centre [m].
        motion: horizontal CoM motion, near the one to be planned.
        height: CoM height.
        softened: λ', shape (n,) [1/s^2].

    Returns:
        Shape (n, 2) [m].
    """
    n, t, com = len(softened), motion.sample_time, np.empty((len(softened) + 1, 3))
    com[1:, :2], com[1:, 2] = motion.com[0], height.height[0]
    com[0, :2] = _before(motion.com[:, 0], t) - motion.jerk[0] * t**3 / 6.0
    com[0, 2] = _before(height.height[:, 0], t)
    soles, heading, pitch = (motion_of[:, : n + 1] for motion_of in feet)
    rate = chain.momentum_rate(com, soles, heading, t, pitch, toe)
    pressing = GRAVITY + height.height[2]
    offset = (1.0 / softened - 1.0 / height.stiffness)[:, None] * motion.com[2]
    offset[:-1] += rate[:, [1, 0]] * (np.array([-1.0, 1.0]) / pressing[:-1, None])
    offset[-1] = offset[-2]
    return np.asarray(offset)


class LegOffset:
    """The offset that a plan counts with: that of a CoM on the nominal motion, which itself depends on it.

    Args:
        leg: inertia of the legs.
        toe: toe edge from the sole's centre [m].
        sample_time: T [s].
        most: samples that it may be wanted of.
    """

    def __init__(self, leg: LegInertia, toe: float, sample_time: float, most: int) -> None:
        self._softening, self._toe, self._sample_time = softening(leg), toe, sample_time
        kernels, self._chain = library(), leg.chain
        compiled = None if leg.chain is None or kernels is None else (kernels, leg.chain)
        self._compiled = compiled and _CompiledOffset(*compiled, toe, sample_time, most)

    def foresee(self, schedule: Schedule, frame: tuple[Array, Array]) -> None:
        """Make now what takes no more than the steps and the plan frame of the next tick."""
        if self._compiled is not None:
            self._compiled.feet.turn_to(schedule.phases, schedule, frame)

    def made(
        self,
        moving: Moving,
        point: Array,
        height: HeightPreview,
        position: Array,
        guess: Array | None,
    ) -> Array:
        """What the legs add to the ZMP, shape (n, 2) [m]; two passes, or one from a guess, leave a millimetre.

        Args:
            moving: what `nominal_feet` makes the feet of.
            point: ZMP that drives the pendulum but for it, shape (n, 2) [m].
            height: CoM height over the n samples.
            position: CoM now, shape (2,) [m].
            guess: about what it will be, shape (n, 2) [m].
        """
        stiffness = self._softening * height.stiffness
        passes, offset = (2, np.zeros_like(point)) if guess is None else (1, guess)
        if self._chain is None:
            return offset
        if self._compiled is not None:
            return self._compiled.made(moving, point, height, stiffness, position, offset, passes)
        feet = nominal_feet(*moving)
        for _ in range(passes):
            motion = nominal_motion(position, point - offset, stiffness, self._sample_time)
            offset = zmp_offset(self._chain, feet, self._toe, motion, height, stiffness)
        return offset


class _CompiledOffset:
    """Arrays of the kernel that does what `LegOffset.made` does, and `feet`, the kernel that moves them."""

    def __init__(self, kernels: Library, chain: LegChain, toe: float, sample_time: float, most: int) -> None:
        (bound, points), stride = bind_chain(kernels, chain), most + 9
        (self._point, self._offset), self._stiffness = np.empty((2, most, 2)), np.empty(most)
        self._height, self.feet = np.empty((3, most)), CompiledFeet(kernels, sample_time, most + 1)
        motion, own = bind_motion(kernels, sample_time, most)
        self._position, self._softened = own["position"], own["stiffness"]
        self._run = kernels.bind(
            "leg_offset_make",
            chain=bound,
            motion=motion,
            most=most,
            stride=stride,
            toe=toe,
            gravity=GRAVITY,
            point=self._point,
            stiffness=self._stiffness,
            height=self._height,
            **self.feet.arrays,
            zmp=own["zmp"],
            com=np.empty((most + 1, 3)),
            scratch=np.empty((23, stride)),
            points=np.empty((points, 3, stride)),
            bends=np.empty((points, 3, stride)),
            offset=self._offset,
        )

    def made(
        self,
        moving: Moving,
        point: Array,
        height: HeightPreview,
        softened: Array,
        position: Array,
        offset: Array,
        passes: int,
    ) -> Array:
        n = len(point)
        self.feet.move(n + 1, *moving)
        self._position[:], self._point[:n], self._offset[:n] = position, point, offset
        self._softened[:n], self._stiffness[:n], self._height[:, :n] = softened, height.stiffness, height.height
        self._run(n, passes)
        return self._offset[:n].copy()


def _before(state: Array, time: float) -> Array:
    """Position some time before a state of position, velocity and acceleration."""
    return np.asarray(state[0] - state[1] * time + 0.5 * state[2] * time**2)
