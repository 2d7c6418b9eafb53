"""Checks that relate several keys of a scenario, or keys and the robot."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from surefoot.errors import ParameterError, at_least, at_most
from surefoot.models.facts import RobotFacts, longest_step
from surefoot.parts.plugins import PluginError
from surefoot.planner.geometry.plane import seen_from
from surefoot.planner.ground.terrain import flat
from surefoot.planner.references.com_height import highest_apex
from surefoot.planner.steps.commands import fastest
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.swing.step_region import StepRegion, check_reach, soles_apart
from surefoot.planner.swing.trajectory import FEWEST_SWING_SAMPLES
from surefoot.planner.types import Footstep, Twist
from surefoot.scenarios.errors import Key, Problem, nearest
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.events import command_problems, cut_off, idle_commands, never_act, slight
from surefoot.scenarios.setup.groups.formulation import LONGEST_REACH
from surefoot.scenarios.setup.groups.gait import commanded, step_region, twist_of, uncommanded
from surefoot.scenarios.setup.groups.hardware import hardware_problems
from surefoot.scenarios.setup.groups.instruments import instrument_problems
from surefoot.scenarios.setup.keys import scenario_problem
from surefoot.scenarios.setup.robot.robots import Robots, is_known
from surefoot.scenarios.setup.terrain.ground import uneven_problems
from surefoot.scenarios.setup.walk import Walk

MOST_SAMPLES = 1_000_000
"""Planner samples of a gait."""

_PERIOD = 4
"""Footsteps after which a gait on flat ground only repeats itself: the first, one of each foot, the last."""

_PENDULUM_FAULTS = ("planner_freeze", "state_nan")


def check(walk: Walk, robots: Robots) -> list[Problem]:
    """List what does not fit together."""
    commands = _command_problems(walk)
    if commands:
        walk = replace(walk, keys=walk.keys.model_copy(update={"gait": uncommanded(walk.keys.gait)}))
    clock = [*_rates(walk), *_pushes(walk)]
    return [
        *commands,
        *clock,
        *_durations(walk),
        *command_problems(walk),
        *(() if clock else (*never_act(walk), *cut_off(walk))),
        *slight(walk),
        *(() if commands else idle_commands(walk)),
        *_beliefs(walk),
        *_controller(walk),
        *_walk_problems(walk),
        *_seat(walk),
        *_robot(walk, robots),
        *hardware_problems(walk.sensing, walk.keys.motors, walk.rates.physics),
        *_instruments(walk),
        *(() if walk.walker.has_body else _without_body(walk)),
    ]


def _instruments(walk: Walk) -> Iterator[Problem]:
    """List what of the instruments cannot act on a robot; a pendulum has none, as a note says."""
    if walk.instruments and walk.walker.has_body:
        yield from instrument_problems(walk.instruments, walk.rates.control, walk.duration)


def _seat(walk: Walk) -> Iterator[Problem]:
    """List what a controller in the seat of the planner cannot hear, if there is one."""
    if walk.seat is not None:
        from surefoot.scenarios.setup.seat import seat_problems

        yield from seat_problems(walk)


def _rates(walk: Walk) -> Iterator[Problem]:
    rates = walk.keys.rates
    for fast, slow in (("physics", "control"), ("control", "planner")):
        above, below = getattr(rates, fast), getattr(rates, slow)
        if above % below:
            right = f"use a divisor of {above} Hz"
            yield Problem(("rates", slow), f"rates.{slow} {below} Hz does not divide rates.{fast} {above} Hz", right)
    sample_time = walk.keys.planner.sample_time
    if not math.isclose(rates.planner * sample_time, 1.0, rel_tol=1e-9):
        what = f"planner.sample_time {sample_time} s is not the period of rates.planner {rates.planner} Hz"
        yield Problem(("planner", "sample_time"), what, f"use {1 / rates.planner:.6g} s, or rates.planner to match")


def _durations(walk: Walk) -> Iterator[Problem]:
    if _swing_too_short(walk):
        what = f"gait.single_support {walk.keys.gait.single_support} s is too short for a swing of the foot"
        right = f"use at least {at_least(FEWEST_SWING_SAMPLES * walk.keys.planner.sample_time)} s"
        yield Problem(("gait", "single_support"), what, right)
    double, sample = walk.keys.gait.double_support, walk.keys.planner.sample_time
    if double < (1.0 - 1e-9) * sample:
        what = f"gait.double_support {double} s is shorter than a sample of the planner"
        yield Problem(("gait", "double_support"), what, f"use at least {at_least(sample, 5)} s")


def _swing_too_short(walk: Walk) -> bool:
    """Return true if a single support leaves no time for a swing of the foot."""
    return walk.keys.gait.single_support < (FEWEST_SWING_SAMPLES - 0.5) * walk.keys.planner.sample_time


def _pushes(walk: Walk) -> Iterator[Problem]:
    for index, push in enumerate(walk.keys.pushes):
        key = ("pushes", index)
        by_gait = (push.step, push.phase, push.fraction)
        if push.time is not None and by_gait != (None, None, None):
            yield Problem(key, "a push with both a time and a point of the gait", "give one of them")
        elif push.time is None and (push.step is None or push.phase is None):
            yield Problem(key, "a push without a begin", "give time, or step, phase and fraction")
        elif push.step is not None and push.step > walk.asked_gait.steps and not walk.takes_commands:
            what = f"a push in step {push.step} of a gait of {walk.asked_gait.steps} steps"
            yield Problem((*key, "step"), what, f"give a step of at most {walk.asked_gait.steps}")
        if push.impulse is not None and push.force is not None:
            yield Problem((*key, "impulse"), "a push with both a force and an impulse", "give one of them")
        elif push.impulse is None:
            for angle in ("direction", "elevation"):
                if getattr(push, angle) is not None:
                    what = f"{angle} of a push without an impulse"
                    yield Problem((*key, angle), what, "give impulse, or force alone")


def _beliefs(walk: Walk) -> Iterator[Problem]:
    height, error = walk.keys.gait.com_height, walk.keys.errors.com_height
    if error > 0.5 * height:
        what = f"errors.com_height {error} m leaves {height - error:.3g} m of gait.com_height {height} m as the truth"
        yield Problem(("errors", "com_height"), what, f"use at most {at_most(0.5 * height)} m")


def _controller(walk: Walk) -> Iterator[Problem]:
    wbc = walk.keys.wbc
    if wbc is not None and wbc.friction is not None and walk.keys.errors.friction != 0.0:
        yield Problem(("wbc", "friction"), "a believed friction beside errors.friction", "give one of them")


def _robot(walk: Walk, robots: Robots) -> Iterator[Problem]:
    if not is_known(walk.keys.robot, robots):
        yield Problem(("robot",), f"unknown robot '{walk.keys.robot}'", nearest(walk.keys.robot, robots.names()))
        return
    try:
        facts = robots.facts(walk.keys.robot, walk.keys.robot_options)
    except ParameterError as error:
        option = error.key[:1] and error.key[0] in type(walk.keys.robot_options).model_fields
        yield Problem(("robot_options", *error.key) if option else ("robot",), error.what, error.right)
        return
    except PluginError as error:
        yield Problem(("robot",), error.what, error.right)
        return
    bodies: list[tuple[Key, str | None]] = [(("pushes", i, "body"), p.body) for i, p in enumerate(walk.keys.pushes)]
    load = walk.keys.errors.payload
    bodies += [(("errors", "payload", "body"), load.body)] if load is not None else []
    for key, body in (*bodies, (("robot_options", "payload_body"), walk.keys.robot_options.payload_body)):
        if body is not None and body not in facts.bodies:
            yield Problem(key, f"unknown body '{body}' of {walk.keys.robot}", nearest(body, facts.bodies))
    steps = _commanded_step_problems if commanded(walk.keys.gait) else _footstep_problems
    feet = list(_reach(walk, facts)) or list(steps(walk, facts))
    yield from feet or [*walk.ground.kind.problems(walk.ground, facts), *uneven_problems(walk.ground)]


def _reach(walk: Walk, facts: RobotFacts) -> Iterator[Problem]:
    gait = walk.keys.gait
    sideways = (gait.step_width - facts.hip_width) / 2
    if abs(sideways) >= facts.leg_length:
        what = f"gait.step_width {gait.step_width} m is out of reach of the legs"
        hint = meant(gait.step_width, "m", facts.leg_length)
        yield Problem(("gait", "step_width"), what, f"use for example {facts.hip_width:.3f} m{hint}")
        return
    hips, raised = gait.com_height - facts.com_above_hip, 0.5 * facts.foot_length * math.sin(gait.heel_strike)
    longest = longest_step(facts.leg_length, hips, facts.hip_width, gait.step_width, raised)
    if math.isnan(longest):
        highest = facts.com_above_hip + math.sqrt(facts.leg_length**2 - sideways**2)
        what = f"gait.com_height {gait.com_height} m is out of reach with feet {gait.step_width} m apart"
        yield Problem(
            ("gait", "com_height"), what, f"use less than {at_most(highest)} m{meant(gait.com_height, 'm', highest)}"
        )
    elif gait.steps and not commanded(walk.keys.gait) and abs(gait.step_length) > longest:
        what = f"gait.step_length {gait.step_length} m is out of reach at com_height {gait.com_height} m"
        right = f"use at most {at_most(longest)} m, or lower gait.com_height{meant(gait.step_length, 'm', longest)}"
        yield Problem(("gait", "step_length"), what, right)


def _without_body(walk: Walk) -> Iterator[Problem]:
    """List what would test nothing on a pendulum."""
    for index, fault in enumerate(walk.keys.faults):
        if fault.kind not in _PENDULUM_FAULTS:
            what = f"fault {fault.kind!r} needs joints, which fidelity pendulum has not got"
            yield Problem(("faults", index, "kind"), what, f"use fidelity full, or {' or '.join(_PENDULUM_FAULTS)}")
    for index, push in enumerate(walk.keys.pushes):
        if push.force is not None and push.force[2] != 0.0:
            what = "a vertical push on a pendulum, whose height is prescribed"
            yield Problem(("pushes", index, "force"), what, "use fidelity full, or [x, y, 0]")
        if push.elevation:
            what = "an elevation of a push on a pendulum, whose height is prescribed"
            yield Problem(("pushes", index, "elevation"), what, "use fidelity full, or no elevation")


def _walk_problems(walk: Walk) -> Iterator[Problem]:
    """List what cannot be planned whatever the robot."""
    gait, sample_time = walk.keys.gait, walk.keys.planner.sample_time
    yield from walk.formulation.problems()
    if walk.gait_duration > MOST_SAMPLES * sample_time:
        what = f"a gait of {walk.gait_duration:.6g} s"
        yield Problem(
            ("gait", "steps"), what, f"it may last {MOST_SAMPLES * sample_time:g} s; use fewer or faster steps"
        )
    if walk.keys.duration is not None and walk.keys.duration * walk.keys.rates.control < 1.0:
        what = f"duration {walk.keys.duration} s is shorter than one control tick"
        yield Problem(("duration",), what, f"use at least {1 / walk.keys.rates.control:g} s")
    if not _swing_too_short(walk):
        yield from _apexes(gait)


def _footstep_problems(walk: Walk, facts: RobotFacts) -> Iterator[Problem]:
    """List footsteps out of reach of the planner, and feet that would touch each other."""
    gait = walk.keys.gait
    if gait.step_width < facts.foot_width:
        what = f"gait.step_width {gait.step_width} m lets feet {facts.foot_width:g} m wide touch"
        yield Problem(("gait", "step_width"), what, f"use more than {facts.foot_width:g} m")
        return
    found = (_footstep_problem(walk, facts, *step) for step in _landings(walk))
    yield from [problem for problem in found if problem is not None][:1]


def _landings(walk: Walk) -> Iterator[tuple[int, Footstep]]:
    """Number of each footstep, and where it lands, seen from its stance foot."""
    gait = replace(walk.asked_gait, steps=min(walk.keys.gait.steps, _PERIOD))
    footsteps = plan_footsteps(gait, walk.ground.stance, flat())
    for number, (stance, place) in enumerate(pairwise(footsteps[1:]), 1):
        yield number, seen_from(stance, place)


def _footstep_problem(walk: Walk, facts: RobotFacts, number: int, place: Footstep) -> Problem | None:
    gait = walk.keys.gait
    sideways = "lateral_step" if gait.lateral_step else "turn" if gait.turn else "step_width"
    try:
        check_reach(number, place, walk.formulation.usual)
    except ParameterError as fault:
        name = "step_length" if fault.key[-1] == "ahead" else sideways
        return Problem(("gait", name), fault.what, f"{fault.right}; change gait.{name}")
    apart = soles_apart((facts.foot_length, facts.foot_width), place.yaw)
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


def _command_problems(walk: Walk) -> list[Problem]:
    """List what makes velocity or footsteps no walk at all, whatever the robot."""
    gait = walk.keys.gait
    if gait.velocity and gait.footsteps:
        return [Problem(_FOOTSTEPS, "footsteps beside gait.velocity", "give one of them", at_key=True)]
    problems = [*_times(walk), *_feet(gait)]
    if problems or not commanded(walk.keys.gait):
        return problems
    try:
        _ = walk.asked_gait
    except ParameterError as fault:
        return [scenario_problem(fault)]
    return []


def _commanded_step_problems(walk: Walk, facts: RobotFacts) -> Iterator[Problem]:
    """Name velocities whose steps are out of reach with the fastest possible, or the first footstep that is."""
    gait = walk.keys.gait
    sole, span = (facts.foot_length, facts.foot_width), facts.leg_span(gait.com_height)
    parameters = replace(walk.formulation.usual, reach_length=LONGEST_REACH * walk.size.length)
    region = step_region(parameters, sole, facts.shank_spacing, span, facts.hip_width)
    for index, command in enumerate(gait.velocity):
        right = _too_fast(gait, twist_of(command), region)
        if right is not None:
            stride = twist_of(command).stride(_period(gait), gait.step_width)
            what = f"gait.velocity.{index} asks for steps of {_step_text(stride)} in {_period(gait):g} s, out of reach"
            yield Problem((*_VELOCITY, index), what, right)
    if gait.footsteps:
        asked = walk.asked_gait
        for index, stride in enumerate(asked.strides):
            why = region.why_not(stride.landing(asked.step_foot(index + 1)))
            if why is not None:
                yield Problem((*_FOOTSTEPS, index), f"footstep {index + 1} {why[0]}", why[1])
                return


def _times(walk: Walk) -> Iterator[Problem]:
    commands = walk.keys.gait.velocity
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
    never_faster = {name: math.trunc(1000.0 * value) / 1000.0 for name, value in limit.velocity.items()}
    speeds = ", ".join(f"{name} {value:g}" for name, value in never_faster.items())
    return f"the fastest in this direction is {speeds}; or take faster steps"


def _period(gait: Gait) -> float:
    """Time from one lift-off to the next [s]."""
    return gait.single_support + gait.double_support


def _step_text(stride: Twist) -> str:
    named = zip(stride, ("m ahead", "m to the left", "rad of turn"), strict=False)
    return " and ".join(f"{value:.3g} {unit}" for value, unit in named if value)
