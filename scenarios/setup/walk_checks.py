"""Checks of the walk that a scenario asks for: footsteps in reach and apart, times and heights that can be planned."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from surefoot.errors import ParameterError, at_least, at_most
from surefoot.planner.ground.terrain import flat
from surefoot.planner.references.com_height import highest_apex
from surefoot.planner.steps.commands import Twist, fastest
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import Stride
from surefoot.planner.swing.step_region import Landing, StepRegion, check_reach, soles_apart
from surefoot.planner.swing.trajectory import FEWEST_SWING_SAMPLES
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Gait
from surefoot.scenarios.setup.draft import LONGEST_REACH, Draft
from surefoot.scenarios.setup.gait import leg_span, step_region, twist_of
from surefoot.scenarios.setup.keys import scenario_problem
from surefoot.scenarios.setup.robot import RobotFacts

MOST_SAMPLES = 1_000_000
"""Planner samples of a gait."""

_PERIOD = 4
"""Footsteps after which a gait on flat ground only repeats itself: the first, one of each foot, the last."""


def swing_too_short(draft: Draft) -> bool:
    """Whether a single support leaves no time for a swing of the foot."""
    return draft.keys.gait.single_support < (FEWEST_SWING_SAMPLES - 0.5) * draft.keys.planner.sample_time


def walk_problems(draft: Draft) -> Iterator[Problem]:
    """List what cannot be planned whatever the robot."""
    gait, sample_time = draft.keys.gait, draft.keys.planner.sample_time
    yield from _moves(draft)
    if draft.gait_duration > MOST_SAMPLES * sample_time:
        what = f"a gait of {draft.gait_duration:.6g} s"
        yield Problem(
            ("gait", "steps"), what, f"it may last {MOST_SAMPLES * sample_time:g} s; use fewer or faster steps"
        )
    if draft.keys.duration is not None and draft.keys.duration * draft.keys.rates.control < 1.0:
        what = f"duration {draft.keys.duration} s is shorter than one control tick"
        yield Problem(("duration",), what, f"use at least {1 / draft.keys.rates.control:g} s")
    if not swing_too_short(draft):
        yield from _apexes(gait)


def _moves(draft: Draft) -> Iterator[Problem]:
    """List moves of the jerk that the profile has not got, or that begin after the horizon."""
    profile, settings = draft.profile, draft.keys.planner
    if not profile.moves:
        if settings.control_horizon is not None:
            what = f"planner.control_horizon with profile {profile.name!r}, which optimises no moves of the jerk"
            yield Problem(("planner", "control_horizon"), what, "leave it null")
        return
    horizon = settings.horizon or profile.parameters.horizon
    if settings.control_horizon is not None:
        if settings.control_horizon > horizon:
            what = f"planner.control_horizon {settings.control_horizon} exceeds the horizon of {horizon} samples"
            yield Problem(("planner", "control_horizon"), what, f"use at most {horizon}")
    elif horizon <= profile.parameters.moves[-1]:
        what = f"planner.horizon {horizon} is shorter than the planner's blocks of moves"
        yield Problem(("planner", "horizon"), what, f"use at least {profile.parameters.moves[-1] + 1}")


def footstep_problems(draft: Draft, facts: RobotFacts) -> Iterator[Problem]:
    """List footsteps out of reach of the planner, and feet that would touch each other."""
    gait = draft.keys.gait
    if gait.step_width < facts.foot_width:
        what = f"gait.step_width {gait.step_width} m lets feet {facts.foot_width:g} m wide touch"
        yield Problem(("gait", "step_width"), what, f"use more than {facts.foot_width:g} m")
        return
    found = (_footstep_problem(draft, facts, *step) for step in _landings(draft))
    yield from [problem for problem in found if problem is not None][:1]


def _landings(draft: Draft) -> Iterator[tuple[int, Landing]]:
    """Number of each footstep, and where it lands."""
    gait = replace(draft.gait, steps=min(draft.keys.gait.steps, _PERIOD))
    footsteps = plan_footsteps(gait, draft.stance, flat())
    for row in range(2, footsteps.steps + 2):
        yield row - 1, Landing.between(footsteps.footstep(row - 1), footsteps.footstep(row))


def _footstep_problem(draft: Draft, facts: RobotFacts, number: int, place: Landing) -> Problem | None:
    gait = draft.keys.gait
    sideways = "lateral_step" if gait.lateral_step else "turn" if gait.turn else "step_width"
    try:
        check_reach(number, place, replace(draft.usual, reach_length=draft.reach))
    except ParameterError as fault:
        name = "step_length" if fault.key[-1] == "ahead" else sideways
        return Problem(("gait", name), fault.what, f"{fault.right}; change gait.{name}")
    apart = soles_apart((facts.foot_length, facts.foot_width), place.turn)
    if place.beside < apart:
        what = f"footstep {number} would land {place.beside:.3f} m beside its stance foot and touch it"
        return Problem(("gait", sideways), what, f"keep the feet {at_least(apart)} m apart")
    return None


def _apexes(gait: Gait) -> Iterator[Problem]:
    """List rises of the CoM in a support phase from which it would fall too fast."""
    for support in ("single", "double"):
        duration, apex = getattr(gait, f"{support}_support"), getattr(gait, f"apex_{support}")
        highest = highest_apex(duration)
        if apex > highest:
            what = f"gait.apex_{support} {apex} m within {duration} s asks the CoM to fall faster than the feet allow"
            right = f"use at most {at_most(highest, 4)} m, or a longer gait.{support}_support"
            yield Problem(("gait", f"apex_{support}"), what, right)


_VELOCITY = ("gait", "velocity")
_FOOTSTEPS = ("gait", "footsteps")


def command_problems(draft: Draft) -> list[Problem]:
    """List what makes velocity or footsteps no walk at all, whatever the robot."""
    gait = draft.keys.gait
    if gait.velocity and gait.footsteps:
        return [Problem(_FOOTSTEPS, "footsteps beside gait.velocity", "give one of them", at_key=True)]
    problems = [*_times(draft), *_feet(gait)]
    if problems or not draft.commanded:
        return problems
    try:
        _ = draft.gait
    except ParameterError as fault:
        return [scenario_problem(fault)]
    return []


def commanded_step_problems(draft: Draft, facts: RobotFacts) -> Iterator[Problem]:
    """Name velocities whose steps are out of reach with the fastest possible, or the first footstep that is."""
    gait = draft.keys.gait
    sole, span = (facts.foot_length, facts.foot_width), leg_span(gait.com_height, facts)
    parameters = replace(draft.usual, reach_length=LONGEST_REACH * draft.size.length)
    region = step_region(parameters, sole, facts.shank_spacing, span, facts.hip_width)
    for index, command in enumerate(gait.velocity):
        right = _too_fast(gait, twist_of(command), region)
        if right is not None:
            stride = twist_of(command).stride(_period(gait), gait.step_width)
            what = f"gait.velocity.{index} asks for steps of {_step_text(stride)} in {_period(gait):g} s, out of reach"
            yield Problem((*_VELOCITY, index), what, right)
    if gait.footsteps:
        walk = draft.gait
        for index, stride in enumerate(walk.strides):
            why = region.why_not(stride.landing(walk.step_foot(index + 1)))
            if why is not None:
                yield Problem((*_FOOTSTEPS, index), f"footstep {index + 1} {why[0]}", why[1])
                return


def _times(draft: Draft) -> Iterator[Problem]:
    commands = draft.keys.gait.velocity
    for index, (before, command) in enumerate(pairwise(commands), start=1):
        if command.time <= before.time:
            what = f"gait.velocity.{index}.time {command.time} s does not come after the command before it"
            yield Problem((*_VELOCITY, index, "time"), what, f"use more than {before.time} s")
    if commands and not twist_of(commands[-1]).is_zero:
        what = "the last velocity command does not stop"
        yield Problem((*_VELOCITY, len(commands) - 1), what, "end gait.velocity with the time at which to stand alone")


def _feet(gait: Gait) -> Iterator[Problem]:
    for index, (before, after) in enumerate(zip(gait.footsteps, gait.footsteps[1:], strict=False), start=1):
        if before.foot == after.foot:
            what = f"gait.footsteps.{index} moves the {after.foot} foot a second time"
            yield Problem((*_FOOTSTEPS, index, "foot"), what, "left and right must take turns")


def _too_fast(gait: Gait, twist: Twist, region: StepRegion) -> str | None:
    limit = fastest(twist, _period(gait), gait.step_width, region)
    if limit == twist:
        return None
    speeds = ", ".join(f"{name} {_toward_zero(getattr(limit, name)):g}" for name in ("v_x", "v_y", "yaw_rate"))
    return f"the fastest in this direction is {speeds}; or take faster steps"


def _period(gait: Gait) -> float:
    """Time from one lift-off to the next [s]."""
    return gait.single_support + gait.double_support


def _step_text(stride: Stride) -> str:
    named = ((stride.length, "m ahead"), (stride.lateral, "m to the left"), (stride.turn, "rad of turn"))
    return " and ".join(f"{value:.3g} {unit}" for value, unit in named if value)


def _toward_zero(value: float) -> float:
    """Three decimals, never faster."""
    return math.trunc(1000.0 * value) / 1000.0
