"""Plants without a body: the true variable-height pendulum, the paper's cart-table, and a walk on the first."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.forces import Push
from surefoot.planner.geometry import nearest_point, signed_distance
from surefoot.planner.model.dcm import dcm
from surefoot.planner.model.jerk import jerk_model
from surefoot.planner.plan import PlanSampler, WalkPlan
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.types import Array, CentroidalState, FeetState


def pushing_force(pushes: tuple[Push, ...], time: float) -> Array:
    """Horizontal sum of the pushes at an instant, shape (2,) [N]."""
    force = np.zeros(2)
    for push in pushes:
        if push.time - 1e-9 <= time < push.time + push.duration - 1e-9:
            force = force + push.force[:2]
    return force


class Pendulum:
    """Point mass over a ZMP: x'' = λ (x - p) + F / m horizontally, eq. (1) with a push; its height is given.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last step, shape (2,) [m].

    Args:
        mass: [kg].
        position: start position, shape (2,) [m].
        velocity: start velocity, shape (2,) [m/s].
    """

    def __init__(self, mass: float, position: Array, velocity: Array) -> None:
        self._mass = mass
        self.position = np.array(position)
        self.velocity = np.array(velocity)
        self.zmp = np.array(position)

    def advance(self, duration: float, zmp_command: Array, support: Array, stiffness: float, force: Array) -> None:
        """Exact motion under constant ZMP, stiffness and force.

        Args:
            duration: [s].
            zmp_command: wanted ZMP, shape (2,) [m].
            support: real support polygon, anticlockwise, shape (v, 2) [m]; the ZMP is its point
                nearest to the wanted one.
            stiffness: λ [1/s^2].
            force: horizontal force, shape (2,) [N].
        """
        self.zmp = nearest_point(support, zmp_command)
        center = self.zmp - force / (self._mass * stiffness)
        w = math.sqrt(stiffness)
        c, s = math.cosh(w * duration), math.sinh(w * duration)
        offset, velocity = self.position - center, self.velocity
        self.position = center + c * offset + s / w * velocity
        self.velocity = w * s * offset + c * velocity

    def fallen(self, support: Array, omega: float, distance: float = 1.0) -> bool:
        """Whether the DCM is farther from the support than any foot could reach.

        Args:
            support: support polygon, shape (v, 2) [m].
            omega: ω [1/s].
            distance: what counts as a fall [m].
        """
        here = dcm(self.position, self.velocity, omega)
        if not np.isfinite(here).all():
            return True
        gap = float(np.hypot(*(nearest_point(support, here) - here)))
        return signed_distance(support, here) < 0.0 and gap > distance


class CartTable:
    """Point mass under a commanded jerk; its ZMP x - x''/λ is an output and never bounded.

    So it cannot fall: what a pendulum would pay for with a fall is seen here only as a ZMP outside of the support.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        acceleration: shape (2,) [m/s^2].
        zmp: ZMP after the last step, shape (2,) [m].

    Args:
        mass: [kg].
        position: where it rests at the start, shape (2,) [m].
    """

    def __init__(self, mass: float, position: Array) -> None:
        self._mass = mass
        self.position = np.array(position)
        self.velocity, self.acceleration = np.zeros(2), np.zeros(2)
        self.zmp = np.array(position)

    def advance(self, duration: float, jerk: Array, stiffness: float, force: Array) -> None:
        """Exact motion under constant jerk and force.

        A push changes the velocity by F/m dt and not the acceleration, which is the jerk's integral; so the ZMP does
        not show it, as a measured contact force would not.

        Args:
            duration: [s].
            jerk: shape (2,) [m/s^3].
            stiffness: λ at the end of the step [1/s^2].
            force: horizontal force, shape (2,) [N].
        """
        a, b = jerk_model(duration)
        state = a @ np.stack((self.position, self.velocity, self.acceleration)) + np.outer(b, jerk)
        pushed = force / self._mass
        self.position = state[0] + 0.5 * duration**2 * pushed
        self.velocity = state[1] + duration * pushed
        self.acceleration = state[2]
        self.zmp = self.position - self.acceleration / stiffness


@dataclass(frozen=True, slots=True)
class PendulumTrace:
    """What happened, one row per planner tick.

    Attributes:
        time: shape (k,) [s].
        com: true CoM, shape (k, 3) [m].
        zmp: true ZMP at the end of the tick, shape (k, 2) [m].
        zmp_reference: the ZMP reference there, shape (k, 2) [m].
        margin: least distance of the true ZMP to the edge of the inner (90 %) polygon within the tick, shape (k,) [m].
        fall_time: instant of the fall, or None [s].
        plans: the plans, length k.
    """

    time: Array
    com: Array
    zmp: Array
    zmp_reference: Array
    margin: Array
    fall_time: float | None
    plans: tuple[WalkPlan, ...]


class IdealFeet:
    """Feet that follow the planned swing and feel the ground exactly when planned.

    Args:
        feet: start feet.
    """

    def __init__(self, feet: FeetState) -> None:
        self.state = feet

    def follow(self, sampler: PlanSampler, time: float) -> None:
        """Move to where the plan has the feet at an instant, which may be the planned touchdown."""
        position, yaw = self.state.position.copy(), self.state.yaw.copy()
        swing = sampler.plan.swing
        if swing is not None:
            sole = swing.evaluate(min(time, swing.touchdown_time))[0]
            position[swing.foot], yaw[swing.foot] = sole[:3], sole[3]
        self.state = FeetState(position, yaw, sampler.sample(time).contacts)


def walk_pendulum(
    planner: WalkingPlanner,
    feet: FeetState,
    duration: float,
    *,
    com: Array,
    pushes: tuple[Push, ...] = (),
    mass: float = 100.0,
    feedback: float = 3.0,
    substeps: int = 10,
    frozen_after: float = float("inf"),
) -> PendulumTrace:
    """Walk the pendulum.

    The low level commands p = p_ref + k (ξ - ξ_ref), with the references of the plan, and the real support polygon is
    the whole sole (or the hull of both).

    Args:
        planner: a fresh planner.
        feet: start feet.
        duration: [s].
        com: start CoM at rest, shape (3,) [m].
        pushes: forces on the mass.
        mass: [kg].
        feedback: k of the DCM feedback, 0 for none [-].
        substeps: control steps per planner tick.
        frozen_after: instant after which the planner is not asked any more; it always makes the first plan [s].
    """
    t = planner.parameters.sample_time
    pendulum, ideal = Pendulum(mass, com[:2], np.zeros(2)), IdealFeet(feet)
    state = CentroidalState(0.0, np.array(com), np.zeros(3))
    rows: list[tuple[float, Array, Array, Array, float]] = []
    plans: list[WalkPlan] = []
    fall_time = None
    while fall_time is None and len(rows) < round(duration / t):
        if not plans or state.time < frozen_after:
            plans.append(planner.update(state, ideal.state))
            sampler = PlanSampler(plans[-1])
        margin = _run_tick(pendulum, sampler, pushes, state.time, t / substeps, substeps, feedback)
        now = (len(rows) + 1) * t
        end = sampler.sample(now)
        position = np.append(pendulum.position, end.com[2])
        state = CentroidalState(now, position, np.append(pendulum.velocity, end.com_velocity[2]))
        ideal.follow(sampler, now)
        rows.append((now, position, pendulum.zmp, end.zmp_reference, margin))
        if pendulum.fallen(plans[-1].support_polygon, end.omega, planner.parameters.size.length):
            fall_time = now
    time, positions, zmp, reference, margins = (np.array(column) for column in zip(*rows, strict=True))
    return PendulumTrace(time, positions, zmp, reference, margins, fall_time, tuple(plans))


def _run_tick(
    pendulum: Pendulum,
    sampler: PlanSampler,
    pushes: tuple[Push, ...],
    start: float,
    step: float,
    count: int,
    feedback: float,
) -> float:
    plan = sampler.plan
    margin = np.inf
    for i in range(count):
        reference = sampler.sample(start + (i + 0.5) * step)
        error = pendulum.position + pendulum.velocity / reference.omega - sampler.sample(start + i * step).dcm
        pendulum.advance(
            step,
            reference.pendulum_zmp + feedback * error,
            plan.support_polygon,
            reference.stiffness,
            pushing_force(pushes, start + i * step),
        )
        margin = min(margin, signed_distance(plan.inner_polygon, pendulum.zmp))
    return margin
