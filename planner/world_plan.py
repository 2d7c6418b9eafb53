"""From a motion in the plan frame to the plan in the world frame that is handed over."""

import numpy as np

from planner.heel_off import FootRoll
from planner.plan import WalkPlan
from planner.prediction import Trajectory
from planner.stepper import Stepper
from planner.support import Support
from planner.swing import SwingTrajectory
from planner.types import Array, PlannedFootstep, PlanStatus
from planner.window import Window


def world_plan(
    time: float,
    stepper: Stepper,
    support: Support,
    window: Window,
    motion: Trajectory,
    shifts: Array,
    footsteps: tuple[PlannedFootstep, ...],
    swing: SwingTrajectory | None,
    roll: FootRoll | None,
    status: PlanStatus,
) -> WalkPlan:
    """The plan of a tick.

    Args:
        time: instant of the measurement [s].
        stepper: clock and footholds.
        support: the present support and the plan frame on it.
        window: references.
        motion: predicted motion in the plan frame.
        shifts: shifts of the next two footsteps in the plan frame, shape (2, 2) [m].
        footsteps: the next footsteps.
        swing: trajectory of the swing foot.
        roll: of the foot that leaves the ground.
        status: how the plan was made.
    """
    reference, schedule = window.reference, stepper.schedule
    count, to_world = len(motion.zmp), support.rotation.T
    com = np.empty((3, count, 3))
    com[:, :, :2] = motion.com @ to_world
    com[0, :, :2] += support.origin
    com[:, :, 2] = window.height.height[:, :count]
    point = reference.point[:count] + reference.gain[:count] @ shifts
    samples = slice(window.start, window.start + count)
    return WalkPlan(
        time=time,
        sample_time=schedule.sample_time,
        com=com[0],
        com_velocity=com[1],
        com_acceleration=com[2],
        jerk=motion.jerk @ to_world,
        zmp=(motion.zmp + window.offset[:count]) @ to_world + support.origin,
        zmp_offset=window.offset[:count] @ to_world,
        zmp_reference=point @ to_world + support.origin,
        stiffness=window.stiffness[:count],
        omega=window.omega[:count],
        phase=stepper.info,
        contacts=schedule.contacts[samples],
        load_left=schedule.load_left[samples],
        support_polygon=support.outer,
        inner_polygon=support.inner,
        footholds=support.footholds,
        footsteps=footsteps,
        swing=swing,
        roll=roll,
        status=status,
    )
