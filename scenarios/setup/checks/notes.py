"""Notes on a scenario that passes the checks: keys without effect, odd times, and what its robot lacks."""

from collections.abc import Iterator

from surefoot.parts.plugins import PluginError
from surefoot.planner.steps.step import climb_of
from surefoot.planner.swing.rolling import landing_pitch, strides
from surefoot.scenarios.file.group import Unfelt
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.file.schema import PendulumSettings, Scenario, TerrainSettings
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.record.provenance import Agenda, AskedPush
from surefoot.scenarios.setup.checks.given import Given
from surefoot.scenarios.setup.events import events
from surefoot.scenarios.setup.groups.gait import EQUAL_STEPS, commanded
from surefoot.scenarios.setup.walk import Walk

_PLANT_READS = {"pendulum": ("feedback",), "cart_table": ()}
"""Keys of `pendulum` that each of its plants reads."""


def notes(walk: Walk) -> tuple[str, ...]:
    """List them, one sentence each."""
    return _notes(walk)[0]


def agenda(walk: Walk) -> Agenda:
    """The agenda of a run, as its log holds it."""
    said, standing = _notes(walk)
    pushes = (*walk.pushes, *(push for _, push in walk.gait_pushes))
    return Agenda(
        events=events(walk),
        bodies=tuple(dict.fromkeys(push.body for push in pushes)),
        notes=said,
        standing=standing,
        pushes=tuple(map(AskedPush.of, walk.pushes)),
    )


def _notes(walk: Walk) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """All notes, and those of them that hold only while nobody tells the robot by hand how to walk."""
    given = Given(walk.keys)
    stands = not (walk.keys.gait.steps or commanded(walk.keys.gait) or walk.takes_commands)
    still = tuple(_without_steps(walk, given)) if stands else ()
    keys = (*_unlikely(walk), *_without_effect(walk, given), *_without_occasion(walk, given), *still, *_cut_short(walk))
    return (*keys, *_left_out(walk)), still


_LONG = 60.0
"""Time from which a stand or a push may have been meant in milliseconds [s]."""


def _unlikely(walk: Walk) -> Iterator[str]:
    """Note times that are what they say and were perhaps meant in another unit."""
    times = {f"pushes.{index}.duration": push.duration for index, push in enumerate(walk.keys.pushes)}
    for name, value in {"gait.initial_stand": walk.keys.gait.initial_stand, **times}.items():
        hint = meant(value, "s", _LONG)
        if hint:
            yield f"{name} is {value:g} s{hint}"


def _left_out(walk: Walk) -> Iterator[str]:
    """Note what the model of the robot has and the robot has not."""
    if walk.walker.has_body:
        yield from (f"robot {walk.robot.name}, {line}" for line in walk.robot.left_out)


def _without_effect(walk: Walk, given: Given) -> Iterator[str]:
    yield from _no_equal_steps(walk, given)
    yield from _unshaped(walk, given)
    walker = walk.walker
    yield from () if walker.has_body else _not_felt(walk, given)
    for group, name in walker.unfelt:
        yield from (f"{key} has no effect on a {walker.thing}" for key in given.of(group, (name,)))
    yield from _unfelt(walk)


def _unfelt(walk: Walk) -> Iterator[str]:
    """Note groups that are there and that what walks makes nothing of."""
    kind = walk.keys.walker
    beside = "beside controller" if kind == "seat" else f"on a {walk.walker.thing}"
    for name, field in Scenario.model_fields.items():
        marks = (mark for mark in field.metadata if isinstance(mark, Unfelt))
        if any(kind in mark.by for mark in marks) and getattr(walk.keys, name) not in (None, ()):
            yield f"{name} has no effect {beside}"


def _no_equal_steps(walk: Walk, given: Given) -> Iterator[str]:
    """Note keys of equal steps in a walk whose steps are given in another way."""
    gait, commands = walk.keys.gait, walk.keys.commands
    instead = next((f"gait.{name}" for name in ("velocity", "footsteps", "waypoints") if getattr(gait, name)), None)
    names: tuple[str, ...] = EQUAL_STEPS
    if instead is None and not gait.steps and any(not command.live for command in commands):
        instead, names = "commands and gait.steps 0", EQUAL_STEPS[1:]
    # Of a walk to a place it is the longest stride.
    bound = gait.waypoints or any(command.place is not None for command in commands)
    taken = [name for name in names if instead and not (bound and name == "step_length")]
    yield from (f"{key} has no effect beside {instead}" for key in given.of("gait", taken))


def _not_felt(walk: Walk, given: Given) -> Iterator[str]:
    """Note what a pendulum, which is one body, and its plant make nothing of."""
    pendulum, load = walk.keys.pendulum, walk.keys.errors.payload
    unread = [name for name in PendulumSettings.model_fields if name not in ("plant", *_PLANT_READS[pendulum.plant])]
    yield from (f"{key} has no effect on pendulum.plant {pendulum.plant}" for key in given.of("pendulum", unread))
    bodies = {f"pushes.{index}.body": push.body for index, push in enumerate(walk.keys.pushes)}
    bodies["errors.payload.body"] = None if load is None else load.body
    yield from (f"{key} has no effect on a pendulum" for key in given.of("sensing", ("source", "options")))
    yield from (f"{name} has no effect on a pendulum" for name, body in bodies.items() if body is not None)


_STEPPING = (
    "step_length",
    "lateral_step",
    "turn",
    "swing_height",
    "apex_single",
    "apex_double",
    "heel_off",
    "heel_strike",
    "pelvis_yaw",
    "pelvis_list",
    "ramp",
)
"""Keys of a gait that say how steps are taken."""

_TIMES = ("single_support", "double_support", "initial_stand")
"""Keys of an instant, by which a run lasts that has no duration of its own."""


def _without_steps(walk: Walk, given: Given) -> Iterator[str]:
    """Note what a robot that takes no step has no use for."""
    names = (*_STEPPING, *(() if walk.keys.duration is None else _TIMES))
    unused = list(given.of("gait", names))
    if given.straight_knees:
        unused.append("planner.knee straight")
    yield from (f"{key} has no effect on a robot that takes no step" for key in unused)


def _without_occasion(walk: Walk, given: Given) -> Iterator[str]:
    """Note keys that shape what this scenario has not got: a climb, a load."""
    keys, load = walk.keys, walk.keys.errors.payload
    if keys.planner.rise is not None and keys.terrain.kind == "flat":
        yield "planner.rise has no effect on level ground"
    if keys.robot_options.payload_body is not None and keys.robot_options.payload_mass == 0.0:
        yield "robot_options.payload_body has no effect without robot_options.payload_mass"
    if walk.formulation.profile.height is not None and given.straight_knees:
        profile = keys.planner.profile
        yield f"planner.knee straight has no effect with planner.profile {profile}, which has its own height"
    yield from _without_weight(walk)
    yield from _flat_feet(walk, given)
    if load is not None and load.mass == 0.0:
        yield "errors.payload has no effect without a mass"
    if walk.walker.has_body and keys.sensing.preset is not None and keys.sensing.source == DEFAULTS["sensing"]:
        yield f"sensing.preset has no effect beside sensing.source {keys.sensing.source}, which reads no sensor"


def _without_weight(walk: Walk) -> Iterator[str]:
    """Note numbers of the task of the knees where that has no weight."""
    knees = getattr(walk.keys.wbc, "knees", None)
    numbers = {} if knees is None else knees.model_dump(exclude_none=True)
    if walk.walker.has_body and not walk.controller.knees.weight:
        yield from (f"wbc.knees.{name} has no effect without wbc.knees.weight" for name in numbers if name != "weight")


def _flat_feet(walk: Walk, given: Given) -> Iterator[str]:
    """Note rolls of the feet for which no footstep is long enough, or which edges of the ground keep flat."""
    gait = walk.gait
    asked = [name for name in ("heel_off", "heel_strike") if getattr(gait, name) and any(given.of("gait", (name,)))]
    if not asked or walk.takes_commands:
        return
    steps, footholds, half_length = walk.ground.footsteps, walk.ground.terrain.footholds, 0.5 * walk.facts.foot_length
    ways = tuple(zip(steps, steps[1:], steps[2:], strict=False))
    rolls = {
        "heel_off": any(strides(start, stance, half_length) for start, stance, _ in ways),
        "heel_strike": any(
            landing_pitch(stance, place, half_length, gait.step_length, gait.heel_strike) > 0.0
            and not footholds.edged(climb_of(start, place))
            for start, stance, place in ways
        ),
    }
    where = {"heel_off": "far enough", "heel_strike": "far enough, and level,"}
    for name in asked:
        if ways and not rolls[name]:
            yield f"gait.{name} has no effect, since no footstep is {where[name]} ahead of the other foot"


def _unshaped(walk: Walk, given: Given) -> Iterator[str]:
    terrain = walk.keys.terrain
    try:
        shaping = ("kind", "friction", *walk.ground.kind.keys)
        yield from walk.ground.kind.notes(walk.ground)
    except PluginError:  # a package that is broken where the log is judged, which needs nothing of it
        return
    elsewhere = [name for name in TerrainSettings.model_fields if name not in shaping]
    yield from (f"{key} has no effect on terrain.kind {terrain.kind}" for key in given.of("terrain", elsewhere))


def _cut_short(walk: Walk) -> Iterator[str]:
    duration = walk.keys.duration
    whole = walk.gait_duration
    if duration is not None and duration < whole:
        yield f"duration {duration:g} s ends before the gait does, which takes {whole:g} s"
