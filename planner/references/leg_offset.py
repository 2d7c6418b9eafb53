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

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.model.dcm import NominalMotion
from surefoot.planner.model.leg_chain import LegChain
from surefoot.planner.parameters import LegInertia, PlannerParameters
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.swing.heel_off import RollPlan
from surefoot.planner.swing.trajectory import SwingCourse, SwingTrajectory, start_swing, swing_times
from surefoot.planner.types import GRAVITY, Array, Foot, PhaseKind
from surefoot.planner.walk.clock import Schedule
from surefoot.planner.walk.footsteps import FootstepPlan


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


@dataclass(frozen=True, slots=True)
class Feet:
    """Nominal motion of both feet over n samples, in the plan frame.

    Attributes:
        soles: centres of the left and the right sole as if they were level, shape (2, n, 3) [m].
        pitch: of the soles about their toe edges, shape (2, n) [rad].
        heading: mean of both, shape (n,) [rad].
        toe: toe edge from the sole's centre [m].
    """

    soles: Array
    pitch: Array
    heading: Array
    toe: float


@dataclass(frozen=True, slots=True)
class SwingShape:
    """Where both feet are in a whole walk, for unit steps. K samples.

    Attributes:
        row: row of a foot that stands, shape (K,); the other foot goes from the row before to the row after.
        progress: share of that way done, shape (K,).
        height: of its sole above the row before, shape (K,) [m].
        pitch: of its sole about the toe edge, shape (K,) [rad].
        toe: toe edge from the sole's centre [m].
    """

    row: NDArray[np.intp]
    progress: Array
    height: Array
    pitch: Array
    toe: float


def swing_shape(
    schedule: Schedule,
    footsteps: FootstepPlan,
    courses: Sequence[SwingCourse],
    rolls: RollPlan,
    parameters: PlannerParameters,
) -> SwingShape:
    """Tabulate the swings of a schedule to nominal footsteps, each on its course."""
    count = len(schedule.phase_index)
    rows = np.empty(count, dtype=np.intp)
    values = np.zeros((2, count))
    tables: dict[tuple[int, float, SwingCourse], Array] = {}
    for phase in schedule.phases:
        span = slice(phase.start, phase.end if phase.samples else count)
        rows[span] = phase.step + (phase.kind is not PhaseKind.SINGLE)
        if phase.kind is PhaseKind.SINGLE:
            climb = float(footsteps.position[phase.step + 1, 2] - footsteps.position[phase.step - 1, 2])
            key = (phase.samples, round(climb, 6), courses[phase.step - 1])
            if key not in tables:
                tables[key] = _unit_swing(*key, parameters)
            values[:, span] = tables[key]
    progress, height = values
    return SwingShape(rows, progress, height, rolls.pitch(schedule), rolls.toe)


def nominal_feet(
    shape: SwingShape, footsteps: FootstepPlan, frame: tuple[Array, Array], samples: NDArray[np.intp]
) -> Feet:
    """Nominal feet in the plan frame.

    Args:
        shape: swing motion of the walk.
        footsteps: footholds in the world frame.
        frame: the plan frame's rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        samples: which, shape (n,).
    """
    rotation, origin = frame
    points = np.column_stack(((footsteps.position[:, :2] - origin) @ rotation, footsteps.position[:, 2], footsteps.yaw))
    row, progress = shape.row[samples], shape.progress[samples, None]
    before, after = points[row - 1], points[np.minimum(row + 1, len(points) - 1)]
    stance, swing = points[row], before + progress * (after - before)
    swing[:, 2] = before[:, 2] + shape.height[samples]
    left = np.array([foot is Foot.LEFT for foot in footsteps.feet])[row]
    soles = np.where(np.stack((left, ~left))[..., None], stance, swing)
    pitch = shape.pitch[samples] * np.stack((~left, left))
    turned = 0.5 * (stance[:, 3] + swing[:, 3]) - np.arctan2(rotation[1, 0], rotation[0, 0])
    return Feet(soles[..., :3], pitch, turned, shape.toe)


def zmp_offset(chain: LegChain, feet: Feet, motion: NominalMotion, height: HeightPreview, softened: Array) -> Array:
    """Offset o of the module's equation over a window, in the plan frame.

    Args:
        chain: the body.
        feet: at the window's n samples and the one before.
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
    rate = chain.momentum_rate(com, feet.soles, feet.heading, t, feet.pitch, feet.toe)
    pressing = GRAVITY + height.height[2]
    offset = (1.0 / softened - 1.0 / height.stiffness)[:, None] * motion.com[2]
    offset[:-1] += rate[:, [1, 0]] * (np.array([-1.0, 1.0]) / pressing[:-1, None])
    offset[-1] = offset[-2]
    return np.asarray(offset)


def _before(state: Array, time: float) -> Array:
    """Position some time before a state of position, velocity and acceleration."""
    return np.asarray(state[0] - state[1] * time + 0.5 * state[2] * time**2)


def _unit_swing(samples: int, climb: float, course: SwingCourse, parameters: PlannerParameters) -> Array:
    """Progress of the sole and its height above lift-off at the samples of a swing, shape (2, samples)."""
    times = swing_times(0.0, samples, course, parameters)
    swing: SwingTrajectory = start_swing(
        Foot.LEFT, np.zeros(6), np.array([1.0, 0.0, climb, 0.0, 0.0, 0.0]), times, course.height, parameters
    )
    return np.array([swing.evaluate(k * parameters.sample_time)[0, [0, 2]] for k in range(samples)]).T
