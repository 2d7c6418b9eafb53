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

import math
from functools import lru_cache
from typing import Any

import numpy as np

from surefoot.native.library import Library, library
from surefoot.planner.model.dcm import NominalMotion, bind_motion, nominal_motion
from surefoot.planner.model.leg_chain import LegChain, bind_chain
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.steps.phases import Phase, PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import Step, unit_swing
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.heel_off import RollSpan, bump
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import GRAVITY, Array, Foot, PhaseKind


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


_SUNK = 3e-4
"""Height by which a footstep may be off the end of its swing: twice what soles sink, of the reference robot [m]."""

Feet = tuple[Array, Array, Array]
"""Nominal motion of both feet over n samples, in the plan frame, the left one first.

Soles' centres as if they were level, shape (2, n, 3) [m], their headings, shape (2, n) [rad], and their pitch about
their toe edges, shape (2, n) [rad].
"""


Moving = tuple[PhaseSamples, Schedule, tuple[Array, Array], tuple[SwingTrajectory, float] | None]
"""What feet are to move by: see `nominal_feet`."""


def nominal_feet(
    samples: PhaseSamples,
    schedule: Schedule,
    frame: tuple[Array, Array],
    flown: tuple[SwingTrajectory, float] | None = None,
) -> Feet:
    """Nominal feet in the plan frame, but for a swing that does not go as its step was laid.

    Args:
        samples: the phases over a window.
        schedule: the steps in sight, landing where they are aimed at.
        frame: the plan frame's rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        flown: that swing, and the time now [s].
    """
    (rotation, origin), position = frame, schedule.positions
    points = np.column_stack(((position[:, :2] - origin) @ rotation, position[:, 2], schedule.yaws))
    row = np.array([schedule.index(phase.leaves - 1) for phase in samples.phases])[samples.which]
    progress, height, rolled = _swings(samples, schedule)
    before, after = points[row - 1], points[np.minimum(row + 1, len(points) - 1)]
    stance, swing = points[row], before + progress[:, None] * (after - before)
    swing[:, 2] = before[:, 2] + height
    if flown is not None:
        _fly(swing[:, :3], swing[:, 3], samples, frame, *flown)
    left = np.array([step.place.foot is Foot.LEFT for step in schedule.steps])[row]
    soles = np.where(np.stack((left, ~left))[..., None], stance, swing)
    pitch = rolled * np.stack((~left, left))
    return soles[..., :3], soles[..., 3] - np.arctan2(rotation[1, 0], rotation[0, 0]), pitch


def _over(row: int, swing: SwingTrajectory, schedule: Schedule) -> float:
    """How far over its swing's end a foot lands [m]: standing there a sample later it would seem to accelerate."""
    height = schedule.positions[:, 2]
    over = float(height[min(row + 1, len(height) - 1)] - height[row - 1] - swing.target[2])
    return over if abs(over) > _SUNK * schedule.ground.parameters.size.length else 0.0


def _fly(
    soles: Array,
    heading: Array,
    samples: PhaseSamples,
    frame: tuple[Array, Array],
    trajectory: SwingTrajectory,
    time: float,
) -> None:
    """Put a foot where a trajectory has it; soles of shape (n, 3) [m] and heading of shape (n,) [rad] are changed."""
    (rotation, origin), which = frame, samples.which[: len(soles)]
    now = np.flatnonzero(which == which[1])
    now = now[now > 0]
    times = np.asarray(time + samples.sample_time * (now - 1.0), dtype=np.float64)
    way = trajectory.positions(times)
    soles[now, :2] = (way[:, :2] - origin) @ rotation
    soles[now, 2] = np.maximum(way[:, 2], trajectory.target[2])
    # Before now it was where it accelerates as it does now: its own past may be on another trajectory.
    for values in (soles, heading):
        values[0] = 2.0 * values[1] - values[2] if len(now) > 1 else values[1]
    if time < trajectory.touchdown_time:
        bend = trajectory.evaluate(time)[2, :3] * samples.sample_time**2
        soles[0] += np.append(bend[:2] @ rotation, bend[2])


def _swings(samples: PhaseSamples, schedule: Schedule) -> tuple[Array, Array, Array]:
    """Progress of the swing foot [-], height of its sole above lift-off [m] and its pitch [rad], shape (n,) each."""
    progress, height, pitch = np.zeros((3, len(samples.which)))
    for number in np.unique(samples.which).tolist():
        phase, here = samples.phases[number], samples.which == number
        if phase.kind is PhaseKind.SINGLE:
            swing, late = _swing(phase, schedule, float(samples.elapsed[here][0]))
            # A foot that searches for the ground is expected to find it at once.
            times = np.minimum((samples.elapsed[here] - late) * samples.sample_time, swing.touchdown_time - TOUCHING)
            way = swing.positions(times)
            over = _over(schedule.index(phase.leaves - 1), swing, schedule)
            progress[here], height[here] = way[:, 0], way[:, 2] + over * way[:, 0]
        if phase.roll is not None:
            start, end, angle = phase.roll
            share = (samples.clock[here] - start) / (end - start)
            pitch[here] = [angle * bump(s)[0] for s in share.tolist()]
    return progress, height, pitch


def _swing(phase: Phase, schedule: Schedule, elapsed: float) -> tuple[SwingTrajectory, float]:
    """The swing of a single support, and how long after the phase it begins [samples].

    A foot is lifted by a plan. Of a phase that begins between two of them it has the rest, and swings the faster.

    Args:
        phase: the single support.
        schedule: the steps in sight.
        elapsed: how long it has lasted at one of the samples [samples].
    """
    step, late = schedule.step(phase.step), elapsed % 1.0
    if min(late, 1.0 - late) <= CLOCK_ROUNDING:
        return step.swing, 0.0
    return _rest_of(step, phase.samples - late, schedule.ground), late


@lru_cache(maxsize=16)
def _rest_of(step: Step, samples: float, ground: Ground) -> SwingTrajectory:
    """The swing of a step that has so many samples, the same from plan to plan."""
    return unit_swing(samples, step.climb, step.course, ground.parameters)


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


_LEVEL = RollSpan(0.0, 1.0, 0.0)
"""That of a foot that does not roll."""


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
    """Arrays of the kernels that do what `nominal_feet` and `LegOffset.made` do."""

    def __init__(self, kernels: Library, chain: LegChain, toe: float, sample_time: float, most: int) -> None:
        (bound, points), stride = bind_chain(kernels, chain), most + 9
        (self._point, self._offset), self._stiffness = np.empty((2, most, 2)), np.empty(most)
        self._height, self._which = np.empty((3, most)), np.empty(most + 1, dtype=np.int64)
        self._elapsed, self._clock = np.empty((2, most + 1))
        self._soles, self._heading, self._pitch = (np.empty((2, most + 1, *size)) for size in ((3,), (), ()))
        feet: dict[str, Any] = {"soles": self._soles, "heading": self._heading, "pitch": self._pitch}
        self._feet = kernels.fill(
            "NominalFeet",
            sample_time=sample_time,
            touching=TOUCHING,
            heading_of_frame=0.0,
            most=most + 1,
            which=self._which,
            elapsed=self._elapsed,
            clock=self._clock,
            phases=self._clock,
            steps=self._clock,
            **feet,
        )
        motion, own = bind_motion(kernels, sample_time, most)
        self._position, self._softened = own["position"], own["stiffness"]
        self._place_feet = kernels.bind("nominal_feet_make", self._feet)
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
            **feet,
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
        self._walk(n + 1, *moving)
        self._position[:], self._point[:n], self._offset[:n] = position, point, offset
        self._softened[:n], self._stiffness[:n], self._height[:, :n] = softened, height.stiffness, height.height
        self._run(n, passes)
        return self._offset[:n].copy()

    def _walk(
        self,
        count: int,
        samples: PhaseSamples,
        schedule: Schedule,
        frame: tuple[Array, Array],
        flown: tuple[SwingTrajectory, float] | None,
    ) -> None:
        """Move the feet over so many samples."""
        which = samples.which[:count]
        self._which[:count], self._elapsed[:count] = which, samples.elapsed[:count]
        self._clock[:count] = samples.clock[:count]
        (rotation, origin), position, steps = frame, schedule.positions, schedule.steps
        numbers, last = range(int(which[0]), int(which[-1]) + 1), len(steps) - 1
        elapsed = samples.elapsed[which.searchsorted(numbers)].tolist()
        phases, heads = np.empty((len(numbers), 36)), []
        for told, number, gone in zip(phases, numbers, elapsed, strict=True):
            phase, late = samples.phases[number], 0.0
            row, single = schedule.index(phase.leaves - 1), phase.kind is PhaseKind.SINGLE
            if single:
                swing, late = _swing(phase, schedule, gone)
                told[9:-1], told[-1] = _told(swing), _over(row, swing, schedule)
            rows = row - 1 if row else last, row, min(row + 1, last)
            heads.append((*rows, steps[row].place.foot is Foot.RIGHT, single, late, *(phase.roll or _LEVEL)))
        phases[:, :9] = heads
        places = np.empty((last + 1, 4))
        places[:, :2], places[:, 2], places[:, 3] = (position[:, :2] - origin) @ rotation, position[:, 2], schedule.yaws
        self._feet.struct.heading_of_frame = math.atan2(rotation[1, 0], rotation[0, 0])
        self._feet.point(phases=phases, steps=places)
        self._place_feet(count)
        if flown is not None:
            foot = flown[0].foot
            _fly(self._soles[foot, :count], self._heading[foot, :count], samples, frame, *flown)


@lru_cache(maxsize=16)
def _told(swing: SwingTrajectory) -> Array:
    """The swing of a step as the kernel takes it, shape (26,)."""
    end, past = swing.target, swing.search.motion(-TOUCHING)[0]
    times = swing.start_time, swing.glide_end, swing.apex_time, swing.touchdown_time, swing.rise_start, swing.fall_start
    ways = swing.level[:, 0], swing.rise[:, 0], swing.fall[:, 0]
    return np.concatenate(((*times, end[0], end[2] - past), *ways))


def _before(state: Array, time: float) -> Array:
    """Position some time before a state of position, velocity and acceleration."""
    return np.asarray(state[0] - state[1] * time + 0.5 * state[2] * time**2)
