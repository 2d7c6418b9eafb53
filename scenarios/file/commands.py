"""A scenario's gait in the planner's terms, whichever way it is commanded: by equal steps, a velocity or footsteps."""

import math
from collections.abc import Sequence

import numpy as np

from planner.commands import (
    Twist,
    VelocityCommand,
    VelocityTimeline,
    fitted,
    footstep_bouts,
    leading_foot,
    velocity_bouts,
    walk_of,
)
from planner.gait import GaitParameters
from planner.parameters import PlannerParameters
from planner.step_region import StepRegion, landing
from planner.types import Foot, Footstep
from scenarios.file.schema import FootstepSettings, Gait, VelocitySettings

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
