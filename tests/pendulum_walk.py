"""A walk of a planner on the pendulum, without a robot, for the tests of both."""

from dataclasses import dataclass

import numpy as np

from surefoot.forces import Push
from surefoot.planner.geometry.plane import signed_distance
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet, Pendulum
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import Array, CentroidalState, FeetState

MASS = 100.0
"""Mass of the pendulum that walks alone, as of the reference robot [kg]."""

LEGS = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0))
"""Reach of its legs, as of the reference robot."""


def pushing_force(pushes: tuple[Push, ...], time: float) -> Array:
    """Horizontal sum of the pushes at an instant, shape (2,) [N]."""
    force = np.zeros(2)
    for push in pushes:
        if push.time - 1e-9 <= time < push.time + push.duration - 1e-9:
            force = force + push.force[:2]
    return force


class Attended:
    """A planner at each update of which a function is asked, which is given it, the state and the feet."""

    def __init__(self, planner, update):
        self.planner, self.parameters, self._update = planner, planner.parameters, update

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        return self._update(self.planner, state, feet)


@dataclass(frozen=True, slots=True)
class PendulumTrace:
    """The trace of the pendulum, one row per planner tick.

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


def walk_pendulum(
    planner: WalkingPlanner | Attended,
    feet: FeetState,
    duration: float,
    *,
    com: Array,
    pushes: tuple[Push, ...] = (),
    feedback: float = 3.0,
    substeps: int = 10,
) -> PendulumTrace:
    """Walk the pendulum.

    The low level commands p = p_ref + k (ξ - ξ_ref), with the references of the plan, and the real support polygon is
    the whole sole (or the hull of both).

    Args:
        planner: a fresh planner.
        feet: start feet.
        duration: [s].
        com: start CoM at rest, shape (3,) [m].
        pushes: forces on the mass, which is `MASS`.
        feedback: k of the DCM feedback, 0 for none [-].
        substeps: control steps per planner tick.
    """
    t = planner.parameters.sample_time
    pendulum, ideal = Pendulum(MASS, com[:2], np.zeros(2)), IdealFeet(feet)
    state = CentroidalState(0.0, np.array(com), np.zeros(3))
    rows: list[tuple[float, Array, Array, Array, float]] = []
    plans: list[WalkPlan] = []
    fall_time = None
    while fall_time is None and len(rows) < round(duration / t):
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
