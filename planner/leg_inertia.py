"""What the legs' own motion adds to the ZMP: the pendulum with two point masses at the soles.

The paper's pendulum carries all mass in the CoM. A real leg weighs a sixth of the body, and swinging it turns angular
momentum over at up to tens of N·m, which moves the ZMP by centimetres. With the mass μ m of each leg reduced to its
sole r_k, the angular momentum about the CoM is L = Σ μ m (r_k - c) x (r_k' - c'), and the moment balance about the ZMP,
(c - p) x m (c'' + g e_z) + L' = 0, gives per horizontal axis (with h = c_z - p_z, λ = (g + z'') / h, the other sole at
rest)

    p = c - (1 + 2 μ) c'' / λ + o,      o = (μ / λ) [ a (c_z - r_z) / h + (r + ℓ - p_ref) a_z / h ],

where r and a are position and acceleration of the swing sole, r_z its height, and ℓ, ahead of the sole, stands for the
knee, which moves forward when the sole moves up. Terms in z'' times μ are left out, and the CoM stands over p_ref in
the small last term. So the motion is again a pendulum c'' = λ' (c - (p - o)) with λ' = λ / (1 + 2 μ), driven by the ZMP
less the known offset o.
(Multi-mass ZMP models: Takanishi et al., 1988; Sato, Sakaino and Tsuji, ICRA 2010.)
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.footsteps import FootstepPlan
from planner.parameters import LegInertia, PlannerParameters
from planner.schedule import Schedule
from planner.swing import SwingCourse, SwingTrajectory, start_swing, swing_times
from planner.types import Array, Foot, PhaseKind


def softening(leg: LegInertia) -> float:
    """Factor λ'/λ = 1 / (1 + 2 μ) by which the legs' masses soften the pendulum."""
    return 1.0 / (1.0 + 2.0 * leg.mass_ratio)


@dataclass(frozen=True, slots=True)
class SwingShape:
    """Swing motion of a whole walk for unit steps; zero where no foot swings. K samples.

    Attributes:
        row: row of the stance foot of the sample's swing, shape (K,).
        progress: share of the step done, shape (K,).
        acceleration: its second derivative, shape (K,) [1/s^2].
        height: height of the swing sole above its lift-off, shape (K,) [m].
        vertical: its second derivative, shape (K,) [m/s^2].
    """

    row: NDArray[np.intp]
    progress: Array
    acceleration: Array
    height: Array
    vertical: Array


def swing_shape(
    schedule: Schedule, footsteps: FootstepPlan, courses: Sequence[SwingCourse], parameters: PlannerParameters
) -> SwingShape:
    """Tabulate the swings of a schedule to nominal footsteps, each on its course."""
    count = len(schedule.phase_index)
    rows = np.zeros(count, dtype=np.intp)
    values = np.zeros((4, count))
    tables: dict[tuple[int, float, SwingCourse], Array] = {}
    for phase in schedule.phases:
        if phase.kind is PhaseKind.SINGLE:
            climb = float(footsteps.position[phase.step + 1, 2] - footsteps.position[phase.step - 1, 2])
            key = (phase.samples, round(climb, 6), courses[phase.step - 1])
            if key not in tables:
                tables[key] = _unit_swing(*key, parameters)
            rows[phase.start : phase.end] = phase.step
            values[:, phase.start : phase.end] = tables[key]
    return SwingShape(rows, *values)


def zmp_offset(
    shape: SwingShape,
    footsteps: FootstepPlan,
    frame: tuple[Array, Array],
    window: slice,
    reference: Array,
    stiffness: Array,
    height: Array,
    leg: LegInertia,
) -> Array:
    """Offset o of the module's equation over a window, with nominal footsteps, in the plan frame.

    Args:
        shape: swing motion of the walk.
        footsteps: footholds in the world frame.
        frame: the plan frame's rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        window: samples.
        reference: ZMP reference, x, y in the plan frame and height, shape (n, 3) [m].
        stiffness: λ of the point-mass pendulum, shape (n,) [1/s^2].
        height: CoM height over the ZMP, shape (n,) [m].
        leg: the reduced leg.

    Returns:
        Shape (n, 2) [m].
    """
    rotation, origin = frame
    points = (footsteps.position[:, :2] - origin) @ rotation
    row = shape.row[window]
    lift = points.take(np.maximum(row - 1, 0), axis=0)
    step = points.take(np.minimum(row + 1, len(points) - 1), axis=0) - lift
    sole = lift + shape.progress[window, None] * step
    sole[:, 0] += leg.lever
    above = footsteps.position[:, 2].take(np.maximum(row - 1, 0)) + shape.height[window] - reference[:, 2]
    lever = (shape.acceleration[window] * (1.0 - above / height))[:, None]
    lift_rate = (shape.vertical[window] / height)[:, None]
    moving = lever * step + lift_rate * (sole - reference[:, :2])
    return np.asarray((leg.mass_ratio / stiffness)[:, None] * moving)


def _unit_swing(samples: int, climb: float, course: SwingCourse, parameters: PlannerParameters) -> Array:
    """Progress, its second derivative, height and vertical acceleration at the samples of a swing, (4, samples)."""
    times = swing_times(0.0, samples, course, parameters)
    swing: SwingTrajectory = start_swing(
        Foot.LEFT, np.zeros(6), np.array([1.0, 0.0, climb, 0.0, 0.0, 0.0]), times, course.height, parameters
    )
    states = [swing.evaluate(k * parameters.sample_time) for k in range(samples)]
    return np.array([(s[0, 0], s[2, 0], s[0, 2], s[2, 2]) for s in states]).T
