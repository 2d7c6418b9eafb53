"""The keys of a gait in the planner's terms, whichever way it is commanded, and the gait's place in time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.commands import Command, footstep_bouts, leading_foot, velocity_bouts, walk_of
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.source import CommandSource, steps_ordered
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Array, Foot, Footstep, PhaseInfo, PhaseKind, Twist
from surefoot.scenarios.file.gait import CommandSettings, FootstepSettings, Gait, VelocitySettings
from surefoot.scenarios.file.schema import PushSettings, Start

EQUAL_STEPS = ("steps", "step_length", "lateral_step", "turn", "ramp")
"""Keys of a gait of equal steps, which say nothing beside a velocity or footsteps."""

_STOPPING = 3.0
"""Steps that a robot takes at most after it was commanded to stop [-]."""

_LARGEST_SOLE = (0.3, 0.15)
"""Length and width of soles where a scenario says nothing of them; smaller ones do not make strides shorter [m]."""

FINAL_STAND = 2.5
"""Standing after the last double support that ends a run whose duration is not given, of the reference robot [s]."""


def commanded(keys: Gait) -> bool:
    """Return true if the gait is given by a velocity or by footsteps."""
    return bool(keys.velocity or keys.footsteps)


def uncommanded(keys: Gait) -> Gait:
    """The same gait without velocity and footsteps."""
    return keys.model_copy(update={"velocity": (), "footsteps": ()})


def gait_of(keys: Gait) -> GaitParameters:
    """The gait in the planner's terms; the widths of its strides are not yet fitted to where feet may land.

    Raises:
        ParameterError: velocity or footsteps cannot be walked.
    """
    plain = GaitParameters(
        steps=0 if commanded(keys) or keys.waypoints else keys.steps,
        step_length=keys.step_length,
        step_width=keys.step_width,
        lateral_step=keys.lateral_step,
        turn=keys.turn,
        single_support=keys.single_support,
        double_support=keys.double_support,
        swing_height=keys.swing_height,
        com_height=keys.com_height,
        initial_stand=keys.initial_stand,
        apex_ss=keys.apex_single,
        apex_ds=keys.apex_double,
        heel_off=keys.heel_off,
        heel_strike=keys.heel_strike,
        pelvis_yaw=keys.pelvis_yaw,
        pelvis_list=keys.pelvis_list,
        ramp=keys.ramp,
    )
    if keys.velocity:
        bouts = velocity_bouts(velocities_of(keys.velocity), plain)
        return walk_of(plain, bouts, leading_foot(bouts))
    if keys.footsteps:
        footsteps = footsteps_of(keys.footsteps)
        return walk_of(plain, footstep_bouts(footsteps, plain), footsteps[0].foot)
    return plain


def longest_landing(gait: GaitParameters) -> float:
    """Longest distance of a landing from its stance foot, ahead or behind, either foot leading [m]."""
    places = [stride.landing(foot) for stride in gait.strides for foot in Foot]
    return max((abs(float(place.position[0])) for place in places), default=0.0)


def twist_of(command: VelocitySettings) -> Twist:
    """The velocity that a command asks for."""
    return Twist(command.v_x, command.v_y, command.yaw_rate)


def velocities_of(commands: Sequence[VelocitySettings]) -> list[Command]:
    """Velocity commands in the planner's terms."""
    return [Command(twist_of(command), time=command.time) for command in commands]


def footsteps_of(footsteps: Sequence[FootstepSettings]) -> list[Footstep]:
    """Footsteps in the planner's terms, in the frame between the start feet."""
    return [Footstep(Foot[step.foot.upper()], np.array([step.x, step.y, 0.0]), step.yaw) for step in footsteps]


def command_of(settings: CommandSettings) -> Command:
    """A command in the planner's terms."""
    place, names = settings.place, ("v_x", "v_y", "yaw_rate", "march", *_DURABLE, "time")
    places = None if place is None else (Twist(place.x, place.y, place.yaw),)
    return Command.of(**{name: getattr(settings, name) for name in names}, places=places)


def command_keys(command: Command) -> dict[str, Any]:
    """A command in the words of a scenario's `commands`, without its time.

    Raises:
        ParameterError: it has several places, for which there is no word.
    """
    twist, places = command.twist, command.places or ()
    if len(places) > 1:
        what = f"a command of {len(places)} places"
        raise ParameterError(("command", "places"), what, "tell one, and the next when it is there")
    found: dict[str, Any] = {name: getattr(command, name) for name in _DURABLE}
    if twist is not None:
        found |= {"v_x": twist.x, "v_y": twist.y, "yaw_rate": twist.yaw, "march": command.march or None}
    for place in places:
        found["place"] = {"x": place.x, "y": place.y, "yaw": place.yaw}
    return {name: value for name, value in found.items() if value is not None}


_DURABLE = ("single_support", "double_support", "swing_height")
"""Values of a gait that a command changes, by the names that `Command` and the key have in common."""


def waypoints_of(keys: Gait, start: Start) -> tuple[Twist, ...]:
    """The places of `gait.waypoints` in the world frame."""
    origin, rotation = np.array([start.x, start.y]), frame_rotation(start.yaw)
    places = ((origin + rotation @ (to.x, to.y), to.yaw + start.yaw) for to in keys.waypoints)
    return tuple(Twist(float(place[0]), float(place[1]), heading) for place, heading in places)


def commanded_until(gait: GaitParameters, command: CommandSettings) -> float:
    """Time at which the robot stands after a command that lets it stop, or a little later [s]."""
    return command.time + _STOPPING * gait.period


def there_at(gait: GaitParameters, start: Twist, places: tuple[Twist, ...], parameters: PlannerParameters) -> float:
    """Time at which the robot stands at the last of some places, where nothing comes between, or a little later [s]."""
    sole = parameters.size.times(_LARGEST_SOLE, "m")
    source = CommandSource(gait, step_region(parameters, sole, sole[1]), places=places, size=parameters.size)
    return gait.initial_stand + gait.double_support + (steps_ordered(source, gait, start) + 1) * gait.period


def step_region(
    parameters: PlannerParameters,
    sole: tuple[float, float],
    shank_spacing: float,
    leg_span: float = math.inf,
    hip_width: float = 0.0,
) -> StepRegion:
    """Region in which commanded steps may land: within the planner's reach, and the legs' if they are given."""
    near, far = parameters.reach_width
    width = (max(near, shank_spacing), far)
    gap = parameters.recovery.sole_gap
    return StepRegion(parameters.reach_length, width, sole, gap, leg_span=leg_span, hip_width=hip_width)


def push_time(gait: GaitParameters, push: PushSettings) -> float:
    """Begin [s] of a push, given directly or by step, phase and fraction of that phase.

    Raises:
        ParameterError: it has neither a time nor a step and a phase.
    """
    if push.time is not None:
        return push.time
    if push.step is None or push.phase is None:
        raise ParameterError(("pushes",), "a push without a begin", "give time, or step, phase and fraction")
    start, duration = phase_of(gait, push.step, push.phase)
    return start + (push.fraction or 0.0) * duration


@dataclass(frozen=True, slots=True)
class PushPoint:
    """The point of the gait at which a push begins, whenever that is reached.

    Attributes:
        step: number of the step.
        kind: single support, or the double support before it.
        fraction: of that phase that has gone by [-].
        promised: whether the run is no pass unless it comes to act, wholly.
    """

    step: int
    kind: PhaseKind
    fraction: float
    promised: bool = True

    @classmethod
    def of(cls, push: PushSettings) -> "PushPoint | None":
        """The point of a push; None of one that begins at a time."""
        if push.step is None or push.phase is None:
            return None
        kind = PhaseKind.SINGLE if push.phase == "single" else PhaseKind.DOUBLE
        return cls(push.step, kind, push.fraction or 0.0, not push.live)

    def left(self, phase: PhaseInfo) -> float:
        """Time until it is reached, on the clock of the gait; infinite in other phases [s]."""
        here = phase.kind is self.kind and phase.leads_to == self.step
        return self.fraction * phase.duration - phase.elapsed if here else math.inf

    def __str__(self) -> str:
        """In the words of a scenario."""
        return f"fraction {self.fraction:g} of the {self.kind.name.lower()} support of step {self.step}"


def push_force(push: PushSettings, mass: float) -> Array:
    """Force of a push, given directly or by its impulse per mass [kg], shape (3,) [N]."""
    if push.impulse is None:
        return np.array(push.force or np.zeros(3))
    size = mass * push.impulse / push.duration
    direction, elevation = push.direction or 0.0, push.elevation or 0.0
    level = math.cos(elevation)
    return size * np.array([level * math.cos(direction), level * math.sin(direction), math.sin(elevation)])


def phase_of(gait: GaitParameters, step: int, phase: str) -> tuple[float, float]:
    """Begin and duration [s] of a support phase of a footstep; step 1 is the first, its double support comes first."""
    lift_off = gait.lift_off(step)
    if phase == "single":
        return lift_off, gait.single_support
    before = gait.support_before(step)
    return lift_off - before, before
