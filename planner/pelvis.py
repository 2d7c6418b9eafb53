"""The pelvis turns and lists with the steps, as a person's.

The hip of a leg that swings comes forward with it: the pelvis is turned the most as a foot lands. It drops on the
swinging side: it lists the most in the middle of single support. A longer step has more of both, and feet that land
beside each other have none.
"""

from surefoot.planner.state import WalkState
from surefoot.planner.swing.rolling import way
from surefoot.planner.swing.sway import SOONEST, Pelvis
from surefoot.planner.types import Footstep, PhaseKind


def swaying(state: WalkState, footsteps: tuple[Footstep, ...], time: float) -> Pelvis | None:
    """The pelvis of the plan to come, which goes on from that of the last one; None for a gait that moves it not.

    Args:
        state: now, with the last plan.
        footsteps: the next ones, with their times.
        time: now [s].
    """
    gait, last = state.model.gait, None if state.plan is None else state.plan.pelvis
    if not (gait.pelvis_yaw or gait.pelvis_list):
        return None
    last, soonest = last or Pelvis(), SOONEST * state.model.parameters.size.time
    (turn, lands), (tilt, middle) = _extremes(state, footsteps, time)
    return Pelvis(last.yaw.towards(turn, time, lands, soonest), last.roll.towards(tilt, time, middle, soonest))


def _extremes(
    state: WalkState, footsteps: tuple[Footstep, ...], time: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """The next extremes of yaw and list and their times [rad, s]."""
    gait, phase, sample = state.model.gait, state.phase, state.clock.sample_time
    ends = time + state.time_left
    if not footsteps or phase.kind is PhaseKind.STAND or state.info.leads_to == 0:
        return (0.0, ends), (0.0, ends)
    step, lands = state.schedule.step(state.landed + 1), footsteps[0].touchdown_time
    stance = state.schedule.step(state.landed).place
    length = _length(stance, footsteps[0], gait.step_length)
    turn = -footsteps[0].foot.side * gait.pelvis_yaw * length
    middle, dropping = lands - 0.5 * step.single_support * sample, footsteps[0]
    if middle <= time + 0.5 * sample:  # the list is on its way to the other side
        following = state.schedule.after(step.number)
        ends = lands + step.double_support * sample
        if len(footsteps) < 2 or not following or following[0].stop is not None:
            return (turn, lands), (0.0, ends)
        dropping, stance = footsteps[1], footsteps[0]
        middle = footsteps[1].touchdown_time - 0.5 * following[0].single_support * sample
        length = _length(stance, dropping, gait.step_length)
    return (turn, lands), (-dropping.foot.side * gait.pelvis_list * abs(length), middle)


def _length(stance: Footstep, landing: Footstep, usual: float) -> float:
    """Way by which a foot lands ahead of the other one, over that of the gait's steps; within -1 and 1 [-]."""
    return max(-1.0, min(1.0, way(stance, landing) / abs(usual))) if usual else 0.0
