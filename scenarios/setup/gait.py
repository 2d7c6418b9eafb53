"""A scenario's gait in the planner's terms, whichever way it is commanded, and its place in time."""

import math
from collections.abc import Sequence

import numpy as np

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.types import Foot, Footstep
from surefoot.planner.walk.commands import (
    Twist,
    VelocityCommand,
    VelocityTimeline,
    fitted,
    footstep_bouts,
    leading_foot,
    velocity_bouts,
    walk_of,
)
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.reach import StepRegion, landing
from surefoot.scenarios.file.schema import FootstepSettings, Gait, PushSettings, Scenario, VelocitySettings


def longest_step(leg_length: float, hip_height: float, hip_width: float, step_width: float) -> float:
    """Longest step with flat soles, the CoM halfway between the feet at touchdown.

    Each straight leg then spans half the step forward, half the difference of foot and hip spacing sideways and the hip
    height upward.

    Args:
        leg_length: hip centre to sole with the knee straight [m].
        hip_height: hip centre above the soles at touchdown [m].
        hip_width: distance between the hip centres [m].
        step_width: lateral distance between the soles' centres [m].

    Returns:
        forward distance between the soles' centres [m]; NaN when the hips are out of reach of feet side by side.
    """
    sideways = (step_width - hip_width) / 2
    square = leg_length**2 - hip_height**2 - sideways**2
    return 2 * math.sqrt(square) if square >= 0 else math.nan


EQUAL_STEPS = ("steps", "step_length", "lateral_step", "turn")
"""Keys of a gait of equal steps, which say nothing beside a velocity or footsteps."""

SHANKS_APART = 0.11
"""Distance beside at which upright shanks, a decimetre thick, keep a centimetre apart; soles may be narrower [m]."""


def commanded(gait: Gait) -> bool:
    """Whether the gait is given by a velocity or by footsteps."""
    return bool(gait.velocity or gait.footsteps)


def uncommanded(gait: Gait) -> Gait:
    """The same gait without velocity and footsteps."""
    return gait.model_copy(update={"velocity": (), "footsteps": ()})


def gait_of(gait: Gait, region: StepRegion | None = None) -> GaitParameters:
    """The gait in the planner's terms.

    Args:
        gait: the keys.
        region: where steps may land, to which the widths of a velocity's strides are fitted; None leaves them.

    Raises:
        ValueError: velocity or footsteps cannot be walked.
    """
    plain = GaitParameters(
        steps=0 if commanded(gait) else gait.steps,
        step_length=gait.step_length,
        step_width=gait.step_width,
        lateral_step=gait.lateral_step,
        turn=gait.turn,
        single_support=gait.single_support,
        double_support=gait.double_support,
        swing_height=gait.swing_height,
        com_height=gait.com_height,
        initial_stand=gait.initial_stand,
        apex_ss=gait.apex_single,
        apex_ds=gait.apex_double,
        heel_off=gait.heel_off,
    )
    if gait.velocity:
        bouts = velocity_bouts(timeline_of(gait.velocity), plain)
        walk = walk_of(plain, bouts, leading_foot(bouts))
        return walk if region is None else fitted(walk, region)
    if gait.footsteps:
        footsteps = footsteps_of(gait.footsteps)
        return walk_of(plain, footstep_bouts(footsteps, plain), footsteps[0].foot)
    return plain


def longest_landing(gait: Gait) -> float:
    """How far ahead of or behind its stance foot a commanded step lands at most, either foot leading [m]."""
    places = [landing(stride, foot) for stride in gait_of(gait).strides for foot in Foot]
    return max((abs(place.ahead) for place in places), default=0.0)


def twist_of(command: VelocitySettings) -> Twist:
    """The velocity that a command asks for."""
    return Twist(command.v_x, command.v_y, command.yaw_rate)


def timeline_of(commands: Sequence[VelocitySettings]) -> VelocityTimeline:
    """Velocity commands in the planner's terms.

    Raises:
        ValueError: they are out of order or end in motion.
    """
    return VelocityTimeline([VelocityCommand(command.time, twist_of(command)) for command in commands])


def footsteps_of(footsteps: Sequence[FootstepSettings]) -> list[Footstep]:
    """Footsteps in the planner's terms, in the frame between the start feet."""
    return [Footstep(Foot[step.foot.upper()], np.array([step.x, step.y, 0.0]), step.yaw) for step in footsteps]


def step_region(
    parameters: PlannerParameters, sole: tuple[float, float], leg_span: float = math.inf, hip_width: float = 0.0
) -> StepRegion:
    """Where commanded steps may land: within the planner's reach, and the legs' if they are given."""
    near, far = parameters.reach_width
    width = (max(near, SHANKS_APART), far)
    return StepRegion(parameters.reach_length, width, sole, leg_span=leg_span, hip_width=hip_width)


FINAL_STAND = 2.5
"""Standing after the last double support that ends a run whose duration is not given [s]."""


def step_count(gait: Gait) -> int:
    """Number of footsteps."""
    return gait_of(gait).steps


def phase_start(gait: Gait, step: int, phase: str) -> float:
    """Begin [s] of a support phase of a footstep; step 1 is the first, its double support comes first."""
    walk = gait_of(gait)
    return walk.lift_off(step) - (0.0 if phase == "single" else walk.support_before(step))


def phase_duration(gait: Gait, step: int, phase: str) -> float:
    """Duration [s] of a support phase of a footstep."""
    return gait.single_support if phase == "single" else gait_of(gait).support_before(step)


def push_time(gait: Gait, push: PushSettings) -> float:
    """Begin [s] of a push, given directly or by step, phase and fraction."""
    if push.time is not None:
        return push.time
    if push.step is None or push.phase is None:
        raise ValueError("a push needs a time, or a step and a phase")
    return phase_start(gait, push.step, push.phase) + (push.fraction or 0.0) * phase_duration(
        gait, push.step, push.phase
    )


def gait_duration(gait: Gait) -> float:
    """Time from the start to the end of the last double support [s]."""
    return gait_of(gait).duration


def run_duration(scenario: Scenario) -> float:
    """Simulated time [s]: as given, or the gait and a while of standing."""
    return gait_duration(scenario.gait) + FINAL_STAND if scenario.duration is None else scenario.duration
