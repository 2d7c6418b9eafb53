"""What a walk is told while it goes on, and the places that it goes to: in the planner's terms, and what is wrong."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations
from surefoot.planner.geometry import frame_rotation, wrap_angle
from surefoot.planner.steps.commands import Command, Pose, TimedCommand, Twist
from surefoot.planner.steps.source import AWAY, CommandSource, steps_ordered
from surefoot.scenarios.errors import Key, Problem
from surefoot.scenarios.file.schema import CommandSettings
from surefoot.scenarios.setup.gait import step_region

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft

_STOPPING = 3.0
"""Steps that a robot takes at most after it was told to stop [-]."""

_LARGEST_SOLE = (0.3, 0.15)
"""Length and width of soles where a scenario says nothing of them; smaller ones do not make strides shorter [m]."""


def timed_command(settings: CommandSettings) -> TimedCommand:
    """A command in the planner's terms; of a velocity that is given in part, the rest is zero."""
    velocity = (settings.v_x, settings.v_y, settings.yaw_rate)
    twist = None if velocity == (None, None, None) else Twist(*(value or 0.0 for value in velocity))
    place = settings.place
    places = None if place is None else (Pose(place.x, place.y, place.yaw),)
    gait = (settings.single_support, settings.double_support, settings.swing_height)
    return TimedCommand(settings.time, Command(twist, places, *gait))


def waypoints(draft: "Draft") -> tuple[Pose, ...]:
    """The places of `gait.waypoints` in the world frame."""
    yaw = draft.keys.start.yaw
    rotation = frame_rotation(yaw)
    places = ((draft.origin + rotation @ (to.x, to.y), to.yaw + yaw) for to in draft.keys.gait.waypoints)
    return tuple(Pose(float(place[0]), float(place[1]), heading) for place, heading in places)


def told(draft: "Draft") -> tuple[TimedCommand, ...]:
    """All that a walk hears while it goes on, the waypoints at its start."""
    places = waypoints(draft)
    start = (TimedCommand(0.0, Command(places=places)),) if places else ()
    return (*start, *(timed_command(settings) for settings in draft.keys.commands))


def told_until(draft: "Draft") -> float:
    """Time at which the robot stands after all that it is told, where nothing comes between, or a little later [s]."""
    gait, start, end = draft.gait, draft.keys.start, 0.0
    if draft.keys.gait.waypoints:
        sole = draft.size.times(_LARGEST_SOLE, "m")
        source = CommandSource(gait, step_region(draft.parameters, sole, sole[1]), size=draft.size)
        source.places = waypoints(draft)
        steps = steps_ordered(source, gait, Pose(start.x, start.y, start.yaw))
        end = gait.initial_stand + gait.double_support + (steps + 1) * gait.period
    return max([end, *(command.time + _STOPPING * gait.period for command in draft.keys.commands)])


def told_problems(draft: "Draft") -> Iterator[Problem]:
    """List commands and waypoints that say nothing, say two things, or cannot be obeyed."""
    keys = draft.keys
    placed = any(command.place is not None and not command.live for command in keys.commands)
    if (keys.gait.waypoints or placed) and keys.gait.step_length == 0.0:
        what = f"{'gait.waypoints' if keys.gait.waypoints else 'a place to go to'} with steps of no length"
        yield Problem(("gait", "step_length"), what, "give the longest step")
    if keys.gait.waypoints and (keys.gait.velocity or keys.gait.footsteps):
        what = f"waypoints beside gait.{'velocity' if keys.gait.velocity else 'footsteps'}"
        yield Problem(("gait", "waypoints"), what, "give one of them", at_key=True)
        return
    for index, command in enumerate(keys.commands):
        yield from _command_problems(draft, ("commands", index), command)
    yield from _no_way(draft)
    where: list[Key] = [("gait", "waypoints")] if keys.gait.waypoints else []
    where += [("commands", index) for index in range(len(keys.commands))]
    if where and keys.terrain.kind != "flat":
        what = "commands" if where[0][0] == "commands" else "gait.waypoints"
        what = f"{what} on terrain.kind {keys.terrain.kind}, where footsteps are laid for the ground"
        yield Problem(where[0], what, "use kind flat")
    if where and draft.profile.planner is not None:
        what = f"planner.profile {draft.profile.name}, whose planner takes no commands"
        yield Problem(("planner", "profile"), what, "use a profile with surefoot's own walking planner")
    leading = sorted((command for command in keys.commands if _leads(command)), key=lambda command: command.time)
    if leading and keys.duration is None and not _stops(leading[-1]):
        yield Problem(("commands",), "commands that do not end with a stop", "end them with v_x: 0, or give duration")


def _no_way(draft: "Draft") -> Iterator[Problem]:
    """List waypoints at which the robot is already, where it stands at first or at the waypoint before."""
    before, where = Pose(0.0, 0.0, 0.0), "the robot starts"
    for index, to in enumerate(draft.keys.gait.waypoints):
        place, turn = Pose(to.x, to.y, to.yaw), abs(wrap_angle(to.yaw - before.yaw))
        if max(math.dist(place[:2], before[:2]) / draft.size.length, turn) <= AWAY:
            what = f"gait.waypoints.{index} is where {where}, so that no step goes there"
            yield Problem(("gait", "waypoints", index), what, "give another place or heading, or leave it out")
        before, where = place, f"gait.waypoints.{index} is"


def _command_problems(draft: "Draft", key: Key, command: CommandSettings) -> Iterator[Problem]:
    given = {name for name in type(command).model_fields if getattr(command, name) is not None} - {"time", "live"}
    name = f"commands.{key[1]}"
    if not given:
        yield Problem(key, f"{name} says nothing", "give a velocity, a place, or what of the gait is to change")
    if "place" in given and given & {"v_x", "v_y", "yaw_rate"}:
        yield Problem(key, f"{name} has both a place and a velocity", "give one of them")
    yield from _unheard(draft, key)
    durations = {entry: getattr(command, entry) for entry in ("single_support", "double_support")}
    try:
        given_durations = {entry: value for entry, value in durations.items() if value is not None}
        check_durations(replace(draft.gait, **given_durations), draft.keys.planner.sample_time)
    except ParameterError as fault:
        if durations[str(fault.key[-1])] is not None:
            yield Problem((*key, fault.key[-1]), f"{name}.{fault.what}", fault.right)


def _unheard(draft: "Draft", key: Key) -> Iterator[Problem]:
    """List what of a promised command no plan hears of: it comes after the last one, or is superseded before the next.

    A command is taken by the first plan at or after its time; of two that one plan takes the later one holds.
    """
    told, index = draft.keys.commands, int(key[1])
    command, name = told[index], f"commands.{key[1]}"
    rate, end = draft.keys.rates.planner, draft.keys.duration
    heard = plan_of(command, rate)
    if command.live:
        return
    if end is not None and heard / rate >= end - 1e-9:
        what = f"{name} comes at {command.time:g} s and never acts: "
        what += f"the run ends at {end:g} s" if command.time >= end else f"no plan comes before the end at {end:g} s"
        yield Problem((*key, "time"), what, "let it come before")
        return
    for number, other in enumerate(told):
        later = (other.time, number) > (command.time, index) and plan_of(other, rate) == heard
        for entry in sorted(command.superseded_by(other)) if later and not other.live else ():
            what = f"{name}.{entry} never acts: commands.{number} supersedes it before the plan at {heard / rate:g} s"
            yield Problem((*key, entry), what, "leave one of them out, or let a plan come between")


def plan_of(command: CommandSettings, rate: int) -> int:
    """Number of the first plan that hears of a command, where plans come at a rate [Hz]."""
    return math.ceil(command.time * rate - 1e-6)


def _leads(command: CommandSettings) -> bool:
    """Whether it says where to walk."""
    return any(getattr(command, name) is not None for name in ("v_x", "v_y", "yaw_rate", "place"))


def _stops(command: CommandSettings) -> bool:
    """Whether it asks to stand."""
    twist = timed_command(command).command.twist
    return twist is not None and twist.is_zero
