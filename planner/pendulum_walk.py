"""Closed loop of planner and pendulum, with feet that do exactly what the plan says."""

from dataclasses import dataclass

import numpy as np

from planner.pendulum import Pendulum, PointPush, pushing_force
from planner.plan import WalkPlan
from planner.planner import WalkingPlanner
from planner.polygon import signed_distance
from planner.sampling import PlanSampler
from planner.types import Array, CentroidalState, FeetState


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
    pushes: tuple[PointPush, ...] = (),
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
        if pendulum.fallen(plans[-1].support_polygon, end.omega):
            fall_time = now
    time, positions, zmp, reference, margins = (np.array(column) for column in zip(*rows, strict=True))
    return PendulumTrace(time, positions, zmp, reference, margins, fall_time, tuple(plans))


def _run_tick(
    pendulum: Pendulum,
    sampler: PlanSampler,
    pushes: tuple[PointPush, ...],
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
