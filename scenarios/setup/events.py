"""The events of a walk: its pushes, faults and commands in time, and those that never act."""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations
from surefoot.planner.geometry.plane import wrap_angle
from surefoot.planner.steps.commands import velocity_bouts
from surefoot.planner.steps.source import AWAY
from surefoot.planner.types import Twist
from surefoot.scenarios.errors import Key, Problem
from surefoot.scenarios.file.gait import CommandSettings, VelocitySettings
from surefoot.scenarios.file.schema import PushSettings
from surefoot.scenarios.file.sensing import MOTOR_SIZES, SENSOR_SIZES
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.record.provenance import Event
from surefoot.scenarios.setup.groups.gait import (
    command_of,
    gait_of,
    push_force,
    push_time,
    twist_of,
    uncommanded,
    velocities_of,
)
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.setup.windows import LEAST, FaultWindow
from surefoot.sim.pushes import physics_window
from surefoot.sim.sensor_errors import SOON

Array = NDArray[np.float64]

MOST_IDLE = 20
"""Commands that never act that are reported of a scenario."""


@dataclass(frozen=True, slots=True)
class Due:
    """A push or a fault that is to act.

    Attributes:
        key: of what says when it begins.
        event: what the log tells of it.
        idle: why it does nothing even in a long run; None where it acts.
    """

    key: Key
    event: Event
    idle: Problem | None

    @classmethod
    def of(cls, key: Key, what: str, time: float, idle: Problem | None) -> "Due":
        """One that acts first at a time [s]; ``what`` are the words that go before that."""
        return cls(key, Event(what, time, "" if idle is None else idle.what), idle)


def due(walk: Walk) -> Iterator[Due]:
    """The promised pushes and the faults, each once.

    Raises:
        ParameterError: the gait cannot be walked, so that its phases have no times.
    """
    rates, cancelled = walk.keys.rates, _cancelled(walk)
    for index, push in _promised(walk):
        key, name = ("pushes", index), f"pushes.{index}"
        # Whether a walk that takes commands comes to a step, the run will show.
        time = 0.0 if walk.takes_commands and push.time is None else push_time(walk.asked_gait, push)
        start, stop = physics_window(time, push.duration, rates.physics)
        idle = next(_weak(key, push), None)
        if stop <= start:
            what = f"{name}.duration {push.duration:g} s rounds to nothing on a clock of {rates.physics} Hz"
            idle = Problem((*key, "duration"), what, "give it at least 1e-6 s")
        elif idle is None and index in cancelled:
            what = f"{name} never acts: other pushes on the same body cancel it all the while"
            idle = Problem(key, what, "let them differ in force or in time, or leave them out")
        yield Due.of((*key, "time" if push.time is not None else "step"), f"{name} begins at", time, idle)
    for index, fault in enumerate(walk.keys.faults):
        key, name, idle = ("faults", index), f"faults.{index}", None
        first = FaultWindow.of(fault, rates.control).first_act(rates)
        if math.isinf(first):
            every = rates.planner if fault.kind == "planner_freeze" else rates.control
            what = f"{name}.duration {fault.duration:g} s ends before the {fault.kind} acts at any tick of {every} Hz"
            idle = Problem((*key, "duration"), what, f"give it at least {1 / every:g} s")
        yield Due.of((*key, "time"), f"{name} acts first at", first if idle is None else 0.0, idle)


def never_act(walk: Walk) -> Iterator[Problem]:
    """List the promised pushes and the faults that do nothing in the whole run.

    Raises:
        ParameterError: the gait cannot be walked, so that its phases have no times.
    """
    end = walk.duration
    for one in due(walk):
        if one.event.time >= end:
            yield Problem(one.key, one.event.missed(end), "let it begin before")
        elif one.idle is not None:
            yield one.idle


def events(walk: Walk) -> tuple[Event, ...]:
    """The events that the log is to promise: pushes and faults."""
    try:
        return tuple(one.event for one in due(walk))
    except ParameterError as fault:
        return (Event("", 0.0, f"when its pushes and faults act cannot be known: {fault}"),)


def cut_off(walk: Walk) -> Iterator[Problem]:
    """List the promised pushes and the faults that the end of the run cuts off.

    Raises:
        ParameterError: the gait cannot be walked, so that its phases have no times.
    """
    rates = walk.keys.rates
    end = round(walk.duration * rates.control) / rates.control
    last = round(end * rates.physics, 6)
    for index, push in _promised(walk):
        if push.time is None and walk.takes_commands:
            continue
        start, stop = physics_window(push_time(walk.asked_gait, push), push.duration, rates.physics)
        if start < last < stop:
            room = (last - start) / rates.physics
            hint = meant(push.duration, "s", room)
            yield _cut(("pushes", index, "duration"), stop / rates.physics, end, f"at most {room:.6g} s{hint}")
    for index, fault in enumerate(walk.keys.faults):
        window = FaultWindow.of(fault, rates.control)
        if window.start / rates.control < end < window.end / rates.control < math.inf:
            right = f"at most {end - fault.time:.6g} s, or no duration"
            yield _cut(("faults", index, "duration"), window.end / rates.control, end, right)


def _cut(key: Key, stop: float, end: float, right: str) -> Problem:
    what = f"{key[0]}.{key[1]} would last until {stop:.6g} s, and the end of the run at {end:.6g} s cuts it off"
    return Problem(key, what, f"give it {right}")


def _promised(walk: Walk) -> Iterator[tuple[int, PushSettings]]:
    """The pushes that are to act, with their numbers; those that were given by hand need not."""
    return ((index, push) for index, push in enumerate(walk.keys.pushes) if not push.live)


def _weak(key: Key, push: PushSettings) -> Iterator[Problem]:
    """Report a push that moves nothing; of a force given in newtons the mass does not matter, as that of any robot."""
    given = "force" if push.impulse is None else "impulse"
    name = f"{key[0]}.{key[1]}.{given}"
    impulse = push.duration * math.hypot(*(push.force or ())) if push.impulse is None else push.impulse
    if impulse == 0.0 and not any(push.force or ()):
        yield Problem((*key, given), f"{name} is zero, which pushes nothing", "give more, or no push")
    elif impulse < LEAST:
        unit = "N·s" if push.impulse is None else "N·s/kg"
        what = f"{name} makes an impulse of {impulse:.3g} {unit}, by which no robot moves as far as an atom is wide"
        yield Problem((*key, given), what, f"give at least {LEAST:g} {unit}, or no push")


def _cancelled(walk: Walk) -> set[int]:
    """Numbers of the promised pushes beside which no net force is left on their body as long as they last.

    Raises:
        ParameterError: the gait cannot be walked, so that its phases have no times.
    """
    by_body: dict[tuple[str, bool], list[tuple[int, float, float, Array]]] = {}
    for index, push in _promised(walk):
        if push.time is None and walk.takes_commands:
            continue
        begin = push_time(walk.asked_gait, push)
        body = push.body if push.body is not None and walk.walker.has_body else ""
        # How forces and impulses per kilogram add up, only the robot's mass tells.
        alike = by_body.setdefault((body, push.impulse is None), [])
        alike.append((index, round(begin, 9), round(begin + push.duration, 9), push_force(push, 1.0)))
    return {index for pushes in by_body.values() if len(pushes) > 1 for index in _without_net(pushes)}


def _without_net(pushes: Sequence[tuple[int, float, float, Array]]) -> Iterator[int]:
    """Numbers of pushes, each from an instant to another [s], as long as which all add up to nothing but rounding."""
    begins, ends = (np.array([push[place] for push in pushes]) for place in (1, 2))
    forces = np.array([push[3] for push in pushes])
    steps = np.column_stack([forces, np.linalg.norm(forces, axis=1)])
    cuts = np.unique([*begins, *ends])
    total = np.zeros((len(cuts), 4))
    for times, sign in ((begins, 1.0), (ends, -1.0)):
        np.add.at(total, np.searchsorted(cuts, times), sign * steps)
    total = np.cumsum(total, axis=0)
    acts = np.append(0, np.cumsum(np.linalg.norm(total[:, :3], axis=1) > LEAST * total[:, 3]))
    for index, begin, end, _ in pushes:
        first, last = np.searchsorted(cuts, (begin, end))
        if acts[last] == acts[first]:
            yield index


_SIZES = (
    ("robot_options", ("payload_mass",)),
    ("gait", ("apex_single", "apex_double", "heel_off", "heel_strike", "pelvis_yaw", "pelvis_list")),
    ("sensing", ("zmp_noise", "com_noise", *SENSOR_SIZES)),
    ("start", ("position_noise", "angle_noise")),
    ("errors", ("com_height", "link_mass_noise", "friction", "ground_noise", "ground_pitch", "ground_roll")),
)
"""Keys of a size, beside those of the ground, that is 0 or meant to act; a place or a direction may be any number."""


def slight(walk: Walk) -> Iterator[Problem]:
    """List sizes that are not zero and so small that nothing follows from them but rounding."""
    keys, errors = walk.keys, walk.keys.errors
    sizes: list[tuple[Key, float]] = [
        ((group, name), getattr(getattr(keys, group), name) or 0.0) for group, names in _SIZES for name in names
    ]
    sizes += [(("terrain", name), getattr(keys.terrain, name)) for name in KINDS[keys.terrain.kind].uneven]
    sizes += [(("errors", "torso_com"), math.hypot(*(errors.torso_com or (0.0,))))]
    sizes += [(("errors", "payload", "mass"), errors.payload.mass)] if errors.payload is not None else []
    sizes += [(("errors", "ground", index, "height"), box.height) for index, box in enumerate(errors.ground or ())]
    sizes += [(("motors", name), getattr(keys.motors, name) or 0.0) for name in MOTOR_SIZES if keys.motors is not None]
    late = {("sensing", name) for name in SENSOR_SIZES if name.endswith(("latency", "jitter"))}
    for key, size in sizes:
        if key in late and 0.0 < size <= SOON:
            what = f"{'.'.join(map(str, key))} {size:g} s is too short to make any sample late"
            yield Problem(key, what, f"use 0, or more than {SOON:g} s")
        elif size and abs(size) < LEAST:
            what = f"{'.'.join(map(str, key))} {size:g} is too small to change anything"
            yield Problem(
                key, what, f"use {'' if key[-1] == 'height' or key[0] == 'motors' else '0, or '}at least {LEAST:g}"
            )


def idle_commands(walk: Walk) -> Iterator[Problem]:
    """List the velocity commands without which the walk would be the same, though they ask for a change."""
    commands = walk.keys.gait.velocity
    plain = gait_of(uncommanded(walk.keys.gait))

    def bouts(chosen: Sequence[VelocitySettings]) -> object:
        return velocity_bouts(velocities_of(chosen), plain)

    try:
        walked, gait, found = bouts(commands), walk.asked_gait, 0
        times = [command.time for command in commands]
        # One in force as a foot lifts off acts; of the others few do, and each costs a look at the whole walk.
        used = {bisect_right(times, gait.lift_off(step) + 1e-6) - 1 for step in range(1, gait.steps + 1)}
        for index, command in enumerate(commands[:-1]):
            if index in used or found == MOST_IDLE:
                continue
            before = twist_of(commands[index - 1]) if index else twist_of(VelocitySettings(time=0.0))
            if twist_of(command) != before and bouts([*commands[:index], *commands[index + 1 :]]) == walked:
                until = commands[index + 1].time
                what = f"gait.velocity.{index} is over at {until:g} s, before any foot lifts off by it, and never acts"
                yield Problem(("gait", "velocity", index), what, "let it hold for a step, or leave it out")
                found += 1
    except ParameterError:  # reported by the checks of the walk
        return


def command_problems(walk: Walk) -> Iterator[Problem]:
    """List commands and waypoints that say nothing, say two things, or cannot be obeyed."""
    keys = walk.keys
    placed = any(command.place is not None and not command.live for command in keys.commands)
    if (keys.gait.waypoints or placed) and keys.gait.step_length == 0.0:
        what = f"{'gait.waypoints' if keys.gait.waypoints else 'a place to go to'} with steps of no length"
        yield Problem(("gait", "step_length"), what, "give the longest step")
    if keys.gait.waypoints and (keys.gait.velocity or keys.gait.footsteps):
        what = f"waypoints beside gait.{'velocity' if keys.gait.velocity else 'footsteps'}"
        yield Problem(("gait", "waypoints"), what, "give one of them", at_key=True)
        return
    for index, command in enumerate(keys.commands):
        yield from _problems_of(walk, ("commands", index), command)
    yield from _no_way(walk)
    where: list[Key] = [("gait", "waypoints")] if keys.gait.waypoints else []
    where += [("commands", index) for index in range(len(keys.commands))]
    if where and keys.terrain.kind != "flat":
        what = "commands" if where[0][0] == "commands" else "gait.waypoints"
        what = f"{what} on terrain.kind {keys.terrain.kind}, where footsteps are laid for the ground"
        yield Problem(where[0], what, "use kind flat")
    others = walk.formulation.profile.planner
    if where and others is not None and not hasattr(others, "command"):
        what = f"planner.profile {walk.formulation.profile.name}, whose planner takes no commands"
        yield Problem(("planner", "profile"), what, "use a profile with surefoot's own walking planner")
    leading = sorted((command for command in keys.commands if _leads(command)), key=lambda command: command.time)
    if leading and keys.duration is None and not _stops(leading[-1]):
        yield Problem(("commands",), "commands that do not end with a stop", "end them with v_x: 0, or give duration")


def _no_way(walk: Walk) -> Iterator[Problem]:
    """List waypoints at which the robot is already, where it stands at first or at the waypoint before."""
    before, where = Twist(), "the robot starts"
    for index, to in enumerate(walk.keys.gait.waypoints):
        place, turn = Twist(to.x, to.y, to.yaw), abs(wrap_angle(to.yaw - before.yaw))
        if max(math.dist(place[:2], before[:2]) / walk.size.length, turn) <= AWAY:
            what = f"gait.waypoints.{index} is where {where}, so that no step goes there"
            yield Problem(("gait", "waypoints", index), what, "give another place or heading, or leave it out")
        before, where = place, f"gait.waypoints.{index} is"


def _problems_of(walk: Walk, key: Key, command: CommandSettings) -> Iterator[Problem]:
    given = {name for name in type(command).model_fields if getattr(command, name) is not None} - {"time", "live"}
    name = f"commands.{key[1]}"
    if not given:
        yield Problem(key, f"{name} says nothing", "give a velocity, a place, or what of the gait is to change")
    if "place" in given and given & {"v_x", "v_y", "yaw_rate", "march"}:
        yield Problem(key, f"{name} has both a place and a velocity", "give one of them")
    yield from _unheard(walk, key)
    durations = {entry: getattr(command, entry) for entry in ("single_support", "double_support")}
    try:
        given_durations = {entry: value for entry, value in durations.items() if value is not None}
        check_durations(replace(walk.asked_gait, **given_durations), walk.keys.planner.sample_time)
    except ParameterError as fault:
        if durations[str(fault.key[-1])] is not None:
            yield Problem((*key, fault.key[-1]), f"{name}.{fault.what}", fault.right)


def _unheard(walk: Walk, key: Key) -> Iterator[Problem]:
    """List what of a promised command no plan hears of: the first at its time or later takes it, of two the last."""
    commands, index = walk.keys.commands, int(key[1])
    command, name = commands[index], f"commands.{key[1]}"
    rate, end = walk.keys.rates.planner, walk.keys.duration
    heard = plan_of(command, rate)
    if command.live:
        return
    if end is not None and heard / rate >= end - 1e-9:
        what = f"{name} comes at {command.time:g} s and never acts: "
        what += f"the run ends at {end:g} s" if command.time >= end else f"no plan comes before the end at {end:g} s"
        yield Problem((*key, "time"), what, "let it come before")
        return
    for number, other in enumerate(commands):
        later = (other.time, number) > (command.time, index) and plan_of(other, rate) == heard
        for entry in sorted(command.superseded_by(other)) if later and not other.live else ():
            what = f"{name}.{entry} never acts: commands.{number} supersedes it before the plan at {heard / rate:g} s"
            yield Problem((*key, entry), what, "leave one of them out, or let a plan come between")


def plan_of(command: CommandSettings, rate: int) -> int:
    """Number of the first plan that hears of a command, where plans come at a rate [Hz]."""
    return math.ceil(command.time * rate - 1e-6)


def _leads(command: CommandSettings) -> bool:
    """Return true if it says where to walk."""
    return any(getattr(command, name) is not None for name in ("v_x", "v_y", "yaw_rate", "march", "place"))


def _stops(command: CommandSettings) -> bool:
    """Return true if it asks to stand."""
    twist = command_of(command).twist
    return twist is not None and twist.is_zero and not command.march
