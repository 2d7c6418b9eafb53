"""Checks that relate several keys of a scenario, or keys and the robot, and what to know of one that passes them."""

import math
from collections.abc import Iterator
from typing import Any

from surefoot.errors import ParameterError, at_least, at_most
from surefoot.planner.swing.trajectory import FEWEST_SWING_SAMPLES
from surefoot.plugins import PluginError
from surefoot.scenarios.errors import Key, Problem, dotted, nearest
from surefoot.scenarios.file.group import controller_faults
from surefoot.scenarios.file.schema import Gait, PendulumSettings, Rates, Sensing, TerrainSettings
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.commands import told_problems
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.events import cut_off, idle_commands, never_act, slight
from surefoot.scenarios.setup.gait import EQUAL_STEPS, longest_step, uncommanded
from surefoot.scenarios.setup.robot import RobotFacts, Robots, is_known
from surefoot.scenarios.setup.sized import clock, default_of
from surefoot.scenarios.setup.walk_checks import (
    command_problems,
    commanded_step_problems,
    footstep_problems,
    swing_too_short,
    walk_problems,
)

_SENSED = ("source", "zmp_noise", "com_noise", "force_estimate")
"""What acts; the noises of the sensors that the whole-body controller's state would come from do not yet."""

AVAILABLE: dict[Key, tuple[Any, ...]] = {
    ("fidelity",): ("full", "pendulum"),
    **{("sensing", name): (field.default,) for name, field in Sensing.model_fields.items() if name not in _SENSED},
}
"""Values of the format's keys that this version has; of other keys it has all."""

_PENDULUM_FAULTS = ("planner_freeze", "state_nan")


def check(draft: Draft, robots: Robots) -> list[Problem]:
    """List what does not fit together."""
    commands = command_problems(draft)
    if commands:
        keys = draft.keys.model_copy(update={"gait": uncommanded(draft.keys.gait)})
        draft = Draft(keys, draft.size, draft.wider, draft.sole)
    clock = [*_rates(draft), *_pushes(draft)]
    return [
        *commands,
        *clock,
        *_durations(draft),
        *told_problems(draft),
        *(() if clock else (*never_act(draft), *cut_off(draft))),
        *slight(draft),
        *(() if commands else idle_commands(draft)),
        *_beliefs(draft),
        *_controller(draft),
        *walk_problems(draft),
        *_robot(draft, robots),
        *_unavailable(draft),
    ]


def _rates(draft: Draft) -> Iterator[Problem]:
    rates = draft.keys.rates
    for fast, slow in (("physics", "control"), ("control", "planner")):
        above, below = getattr(rates, fast), getattr(rates, slow)
        if above % below:
            right = f"use a divisor of {above} Hz"
            yield Problem(("rates", slow), f"rates.{slow} {below} Hz does not divide rates.{fast} {above} Hz", right)
    sample_time = draft.keys.planner.sample_time
    if not math.isclose(rates.planner * sample_time, 1.0, rel_tol=1e-9):
        what = f"planner.sample_time {sample_time} s is not the period of rates.planner {rates.planner} Hz"
        yield Problem(("planner", "sample_time"), what, f"use {1 / rates.planner:.6g} s, or rates.planner to match")


def _durations(draft: Draft) -> Iterator[Problem]:
    if swing_too_short(draft):
        what = f"gait.single_support {draft.keys.gait.single_support} s is too short for a swing of the foot"
        right = f"use at least {at_least(FEWEST_SWING_SAMPLES * draft.keys.planner.sample_time)} s"
        yield Problem(("gait", "single_support"), what, right)
    double, sample = draft.keys.gait.double_support, draft.keys.planner.sample_time
    if double < (1.0 - 1e-9) * sample:
        what = f"gait.double_support {double} s is shorter than a sample of the planner"
        yield Problem(("gait", "double_support"), what, f"use at least {at_least(sample, 5)} s")


def _pushes(draft: Draft) -> Iterator[Problem]:
    for index, push in enumerate(draft.keys.pushes):
        key = ("pushes", index)
        by_gait = (push.step, push.phase, push.fraction)
        if push.time is not None and by_gait != (None, None, None):
            yield Problem(key, "a push with both a time and a point of the gait", "give one of them")
        elif push.time is None and (push.step is None or push.phase is None):
            yield Problem(key, "a push without a begin", "give time, or step, phase and fraction")
        elif push.step is not None and push.step > draft.gait.steps and not draft.told:
            what = f"a push in step {push.step} of a gait of {draft.gait.steps} steps"
            yield Problem((*key, "step"), what, f"give a step of at most {draft.gait.steps}")
        if push.impulse is not None and push.force is not None:
            yield Problem((*key, "impulse"), "a push with both a force and an impulse", "give one of them")
        elif push.impulse is None and push.direction is not None:
            yield Problem(
                (*key, "direction"), "a direction of a push without an impulse", "give impulse, or force alone"
            )


def _beliefs(draft: Draft) -> Iterator[Problem]:
    height, error = draft.keys.gait.com_height, draft.keys.errors.com_height
    if error > 0.5 * height:
        what = f"errors.com_height {error} m leaves {height - error:.3g} m of gait.com_height {height} m as the truth"
        yield Problem(("errors", "com_height"), what, f"use at most {at_most(0.5 * height)} m")


def _controller(draft: Draft) -> Iterator[Problem]:
    wbc = draft.keys.wbc
    if wbc is not None and wbc.friction is not None and draft.keys.errors.friction != 0.0:
        yield Problem(("wbc", "friction"), "a believed friction beside errors.friction", "give one of them")
    for fault in controller_faults(wbc):
        yield Problem(fault.key, fault.what, fault.right)


def _robot(draft: Draft, robots: Robots) -> Iterator[Problem]:
    if not is_known(draft.keys.robot, robots):
        yield Problem(("robot",), f"unknown robot '{draft.keys.robot}'", nearest(draft.keys.robot, robots.names()))
        return
    try:
        facts = robots.facts(draft.keys.robot, draft.keys.robot_options)
    except ParameterError as error:
        option = error.key[:1] and error.key[0] in type(draft.keys.robot_options).model_fields
        yield Problem(("robot_options", *error.key) if option else ("robot",), error.what, error.right)
        return
    except PluginError as error:
        yield Problem(("robot",), error.what, error.right)
        return
    bodies: list[tuple[Key, str | None]] = [(("pushes", i, "body"), p.body) for i, p in enumerate(draft.keys.pushes)]
    load = draft.keys.errors.payload
    bodies += [(("errors", "payload", "body"), load.body)] if load is not None else []
    for key, body in (*bodies, (("robot_options", "payload_body"), draft.keys.robot_options.payload_body)):
        if body is not None and body not in facts.bodies:
            yield Problem(key, f"unknown body '{body}' of {draft.keys.robot}", nearest(body, facts.bodies))
    steps = commanded_step_problems if draft.commanded else footstep_problems
    feet = list(_reach(draft, facts)) or list(steps(draft, facts))
    yield from feet or [*draft.kind.problems(draft, facts), *_unevenness(draft)]


MOST_TILES = 1000
"""Tiles of uneven ground, since every look at it goes through all of them [-]."""


def _unevenness(draft: Draft) -> Iterator[Problem]:
    key, kind = ("errors", "ground_noise"), draft.keys.terrain.kind
    if draft.tiles is None:
        return
    if kind != "flat":
        right = "use terrain.height_noise" if "height_noise" in draft.kind.keys and kind != "slope" else "use kind flat"
        yield Problem(key, f"errors.ground_noise on terrain.kind {kind}", right)
    elif draft.gait.steps > MOST_TILES or len(draft.tiles.cells(draft.site)) > MOST_TILES:
        what = f"errors.ground_noise under {draft.gait.steps} steps needs more than {MOST_TILES} tiles"
        yield Problem(key, what, "take fewer steps, or leave it out")


def _reach(draft: Draft, facts: RobotFacts) -> Iterator[Problem]:
    gait = draft.keys.gait
    sideways = (gait.step_width - facts.hip_width) / 2
    if abs(sideways) >= facts.leg_length:
        what = f"gait.step_width {gait.step_width} m is out of reach of the legs"
        hint = meant(gait.step_width, "m", facts.leg_length)
        yield Problem(("gait", "step_width"), what, f"use for example {facts.hip_width:.3f} m{hint}")
        return
    longest = longest_step(facts.leg_length, gait.com_height - facts.com_above_hip, facts.hip_width, gait.step_width)
    if math.isnan(longest):
        highest = facts.com_above_hip + math.sqrt(facts.leg_length**2 - sideways**2)
        what = f"gait.com_height {gait.com_height} m is out of reach with feet {gait.step_width} m apart"
        yield Problem(
            ("gait", "com_height"), what, f"use less than {at_most(highest)} m{meant(gait.com_height, 'm', highest)}"
        )
    elif gait.steps and not draft.commanded and abs(gait.step_length) > longest:
        what = f"gait.step_length {gait.step_length} m is out of reach at com_height {gait.com_height} m"
        right = f"use at most {at_most(longest)} m, or lower gait.com_height{meant(gait.step_length, 'm', longest)}"
        yield Problem(("gait", "step_length"), what, right)


def _unavailable(draft: Draft) -> list[Problem]:
    """List values that the contract allows and this version has not got."""
    found = []
    for key, values in AVAILABLE.items():
        value: Any = draft.keys
        for part in key:
            value = getattr(value, str(part))
        if value not in values:
            what = f"{dotted(key)} {value!r} is not available in this version"
            found.append(Problem(key, what, f"available: {', '.join(str(v) for v in values)}"))
    return [*found, *_without_body(draft)] if draft.keys.fidelity == "pendulum" else found


def _without_body(draft: Draft) -> Iterator[Problem]:
    """List what would test nothing on a pendulum."""
    for index, fault in enumerate(draft.keys.faults):
        if fault.kind not in _PENDULUM_FAULTS:
            what = f"fault {fault.kind!r} needs joints, which fidelity pendulum has not got"
            yield Problem(("faults", index, "kind"), what, f"use fidelity full, or {' or '.join(_PENDULUM_FAULTS)}")
    for index, push in enumerate(draft.keys.pushes):
        if push.force is not None and push.force[2] != 0.0:
            what = "a vertical push on a pendulum, whose height is prescribed"
            yield Problem(("pushes", index, "force"), what, "use fidelity full, or [x, y, 0]")


_NO_CONTACT = (
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("sensing", "force_estimate"),
    ("gait", "heel_off"),
    ("start", "angle_noise"),
    ("errors", "friction"),
    ("errors", "torso_com"),
    ("errors", "ground"),
    ("errors", "ground_noise"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""

_POINT_ONLY = tuple(("pendulum", name) for name in PendulumSettings.model_fields)
"""Keys of the pendulum alone."""

_PLANT_READS = {"pendulum": ("feedback",), "cart_table": ()}
"""Keys of `pendulum` that each of its plants reads."""


def notes(draft: Draft, driven: bool = False) -> tuple[str, ...]:
    """List them, one sentence each.

    Args:
        draft: the scenario.
        driven: whether its robot was told by hand how to walk.
    """
    still = () if driven or draft.keys.gait.steps or draft.commanded or draft.told else _without_steps(draft)
    return (*_unlikely(draft), *_without_effect(draft), *_without_occasion(draft), *still, *_cut_short(draft))


_LONG = 60.0
"""Time from which a stand or a push may have been meant in milliseconds [s]."""


def _unlikely(draft: Draft) -> Iterator[str]:
    """Tell times that are what they say and were perhaps meant in another unit."""
    times = {f"pushes.{index}.duration": push.duration for index, push in enumerate(draft.keys.pushes)}
    for name, value in {"gait.initial_stand": draft.keys.gait.initial_stand, **times}.items():
        hint = meant(value, "s", _LONG)
        if hint:
            yield f"{name} is {value:g} s{hint}"


def _without_effect(draft: Draft) -> Iterator[str]:
    keys = draft.keys
    yield from _no_equal_steps(draft)
    yield from _unshaped(draft)
    point = keys.fidelity == "pendulum"
    yield from _not_felt(draft) if point else ()
    for group, name in _NO_CONTACT if point else _POINT_ONLY:
        settings = getattr(keys, group)
        if getattr(settings, name) != default_of(type(settings), name, draft.size):
            yield f"{group}.{name} has no effect on a {'pendulum' if point else 'whole body'}"
    if point and keys.wbc is not None:
        yield "wbc has no effect on a pendulum"
    if point and keys.rates.physics not in (Rates().physics, clock(Rates(), draft.size.time).physics):
        yield "rates.physics has no effect on a pendulum"


def _no_equal_steps(draft: Draft) -> Iterator[str]:
    """Tell keys of equal steps in a walk whose steps are given in another way."""
    gait, commands = draft.keys.gait, draft.keys.commands
    instead = next((f"gait.{name}" for name in ("velocity", "footsteps", "waypoints") if getattr(gait, name)), None)
    names: tuple[str, ...] = EQUAL_STEPS
    if instead is None and not gait.steps and any(not command.live for command in commands):
        instead, names = "commands and gait.steps 0", EQUAL_STEPS[1:]
    # Of a walk to a place it is the longest stride.
    bound = gait.waypoints or any(command.place is not None for command in commands)
    for name in names if instead else ():
        if not (bound and name == "step_length") and getattr(gait, name) != default_of(Gait, name, draft.size):
            yield f"gait.{name} has no effect beside {instead}"


def _not_felt(draft: Draft) -> Iterator[str]:
    """Tell what a pendulum, which is one body, and its plant make nothing of."""
    pendulum, load = draft.keys.pendulum, draft.keys.errors.payload
    for name in PendulumSettings.model_fields:
        read = name == "plant" or name in _PLANT_READS[pendulum.plant]
        if not read and getattr(pendulum, name) != default_of(PendulumSettings, name, draft.size):
            yield f"pendulum.{name} has no effect on pendulum.plant {pendulum.plant}"
    bodies = {f"pushes.{index}.body": push.body for index, push in enumerate(draft.keys.pushes)}
    bodies["errors.payload.body"] = None if load is None else load.body
    yield from (f"{name} has no effect on a pendulum" for name, body in bodies.items() if body is not None)


_STEPPING = ("step_length", "lateral_step", "turn", "swing_height", "apex_single", "apex_double", "heel_off")
"""Keys of a gait that say how steps are taken."""

_TIMES = ("single_support", "double_support", "initial_stand")
"""Those that say when, by which a run lasts that has no duration of its own."""


def _without_steps(draft: Draft) -> Iterator[str]:
    """Tell what a robot that takes no step has no use for."""
    keys = draft.keys
    for name in (*_STEPPING, *(() if keys.duration is None else _TIMES)):
        if getattr(keys.gait, name) != default_of(Gait, name, draft.size):
            yield f"gait.{name} has no effect on a robot that takes no step"


def _without_occasion(draft: Draft) -> Iterator[str]:
    """Tell keys that shape what this scenario has not got: a climb, a load."""
    keys, load = draft.keys, draft.keys.errors.payload
    if keys.planner.rise is not None and keys.terrain.kind == "flat":
        yield "planner.rise has no effect on level ground"
    if keys.robot_options.payload_body is not None and keys.robot_options.payload_mass == 0.0:
        yield "robot_options.payload_body has no effect without robot_options.payload_mass"
    if load is not None and load.mass == 0.0:
        yield "errors.payload has no effect without a mass"


def _unshaped(draft: Draft) -> Iterator[str]:
    terrain = draft.keys.terrain
    try:
        shaping = ("kind", "friction", *draft.kind.keys)
        yield from draft.kind.notes(draft)
    except PluginError:  # a package that is broken where the log is judged, which needs nothing of it
        return
    for name in TerrainSettings.model_fields:
        elsewhere = name not in shaping
        if elsewhere and getattr(terrain, name) != default_of(TerrainSettings, name, draft.size):
            yield f"terrain.{name} has no effect on terrain.kind {terrain.kind}"


def _cut_short(draft: Draft) -> Iterator[str]:
    duration = draft.keys.duration
    whole = draft.gait_duration
    if duration is not None and duration < whole:
        yield f"duration {duration:g} s ends before the gait does, which takes {whole:g} s"
