"""Checks of commanded walks: velocities that are too fast, footsteps that cross, times out of order."""

import math
from collections.abc import Iterator

from planner.commands import Twist, fastest
from planner.gait import Stride
from planner.parameters import PlannerParameters
from planner.step_region import StepRegion, landing
from scenarios.errors import Problem
from scenarios.file.commands import commanded, gait_of, step_region, twist_of
from scenarios.file.planner_setup import LONGEST_REACH
from scenarios.file.reach import longest_step
from scenarios.file.robots import RobotFacts
from scenarios.file.schema import Gait, Scenario

_VELOCITY = ("gait", "velocity")
_FOOTSTEPS = ("gait", "footsteps")


def command_problems(scenario: Scenario) -> list[Problem]:
    """List what makes velocity or footsteps no walk at all, whatever the robot."""
    gait = scenario.gait
    if gait.velocity and gait.footsteps:
        return [Problem(_FOOTSTEPS, "footsteps beside gait.velocity", "give one of them", at_key=True)]
    problems = [*_times(scenario), *_feet(gait)]
    if problems or not commanded(gait):
        return problems
    try:
        gait_of(gait)
    except ValueError as error:
        what, _, right = str(error).rstrip(".").partition(", but ")
        return [Problem(_VELOCITY if gait.velocity else _FOOTSTEPS, what, right or "give others")]
    return []


def commanded_step_problems(scenario: Scenario, facts: RobotFacts) -> Iterator[Problem]:
    """Name velocities whose steps are out of reach with the fastest possible, or the first footstep that is."""
    gait = scenario.gait
    sole, span = (facts.foot_length, facts.foot_width), _leg_span(gait, facts)
    region = step_region(PlannerParameters(reach_length=LONGEST_REACH), sole, span, facts.hip_width)
    for index, command in enumerate(gait.velocity):
        right = _too_fast(gait, twist_of(command), region)
        if right is not None:
            stride = twist_of(command).stride(_period(gait), gait.step_width)
            what = f"gait.velocity.{index} asks for steps of {_step_text(stride)} in {_period(gait):g} s, out of reach"
            yield Problem((*_VELOCITY, index), what, right)
    if gait.footsteps:
        walk = gait_of(gait)
        for index, stride in enumerate(walk.strides):
            why = region.why_not(landing(stride, walk.step_foot(index + 1)))
            if why is not None:
                yield Problem((*_FOOTSTEPS, index), *_clauses(f"footstep {index + 1} {why}"))
                return


def _times(scenario: Scenario) -> Iterator[Problem]:
    sample_time, commands = scenario.planner.sample_time, scenario.gait.velocity
    for index, command in enumerate(commands):
        count = command.time / sample_time
        what = f"gait.velocity.{index}.time {command.time} s"
        if index and command.time <= commands[index - 1].time:
            what = f"{what} does not come after the command before it"
            yield Problem((*_VELOCITY, index, "time"), what, f"use more than {commands[index - 1].time} s")
        elif not math.isclose(count, round(count), rel_tol=1e-9, abs_tol=1e-9):
            what = f"{what} is not a multiple of planner.sample_time {sample_time} s"
            yield Problem((*_VELOCITY, index, "time"), what, f"use for example {round(count) * sample_time:.6g} s")
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


def _clauses(why: str) -> tuple[str, str]:
    """A fault and what would be right, from "..., and ... is the least"."""
    what, _, right = why.rpartition(", ")
    return what, right.removeprefix("and ")


def _leg_span(gait: Gait, facts: RobotFacts) -> float:
    """Largest distance between two soles with the hips over their middle, less the hip width sideways [m]."""
    span = longest_step(facts.leg_length, gait.com_height - facts.com_above_hip, facts.hip_width, facts.hip_width)
    return 0.0 if math.isnan(span) else span
