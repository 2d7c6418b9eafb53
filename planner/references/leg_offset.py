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

from surefoot.planner.model.dcm import NominalMotion
from surefoot.planner.model.leg_chain import LegChain
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.steps.phases import Phase, PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import unit_swing
from surefoot.planner.swing.heel_off import bump
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import GRAVITY, Array, Foot, PhaseKind


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


Feet = tuple[Array, Array, Array]
"""Nominal motion of both feet over n samples, in the plan frame, the left one first.

Soles' centres as if they were level, shape (2, n, 3) [m], their headings, shape (2, n) [rad], and their pitch about
their toe edges, shape (2, n) [rad].
"""


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
        trajectory, time = flown
        now = np.flatnonzero(samples.which == samples.which[1])
        now = now[now > 0]
        times = np.asarray(time + samples.sample_time * (now - 1.0), dtype=np.float64)
        way = trajectory.positions(times)
        swing[now, :2] = (way[:, :2] - origin) @ rotation
        swing[now, 2] = np.maximum(way[:, 2], trajectory.target[2])
        # Before now it was where it accelerates as it does now: its own past may be on another trajectory.
        swing[0] = 2.0 * swing[1] - swing[2] if len(now) > 1 else swing[1]
        if time < trajectory.touchdown_time:
            bend = trajectory.evaluate(time)[2, :3] * samples.sample_time**2
            swing[0, :3] += np.append(bend[:2] @ rotation, bend[2])
    left = np.array([step.place.foot is Foot.LEFT for step in schedule.steps])[row]
    soles = np.where(np.stack((left, ~left))[..., None], stance, swing)
    pitch = rolled * np.stack((~left, left))
    return soles[..., :3], soles[..., 3] - np.arctan2(rotation[1, 0], rotation[0, 0]), pitch


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
            progress[here], height[here] = way[:, 0], way[:, 2]
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
    return unit_swing(phase.samples - late, step.climb, step.course, schedule.ground.parameters), late


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
    n = len(softened)
    com = np.empty((n + 1, 3))
    com[1:, :2], com[1:, 2] = motion.com[0], height.height[0]
    t = motion.sample_time
    com[0, :2] = _before(motion.com[:, 0], t) - motion.jerk[0] * t**3 / 6.0
    com[0, 2] = _before(height.height[:, 0], t)
    soles, heading, pitch = (motion_of[:, : n + 1] for motion_of in feet)
    rate = chain.momentum_rate(com, soles, heading, t, pitch, toe)
    pressing = GRAVITY + height.height[2]
    offset = (1.0 / softened - 1.0 / height.stiffness)[:, None] * motion.com[2]
    offset[:-1] += rate[:, [1, 0]] * (np.array([-1.0, 1.0]) / pressing[:-1, None])
    offset[-1] = offset[-2]
    return np.asarray(offset)


def _before(state: Array, time: float) -> Array:
    """Position some time before a state of position, velocity and acceleration."""
    return np.asarray(state[0] - state[1] * time + 0.5 * state[2] * time**2)
