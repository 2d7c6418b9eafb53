"""The demand of a scenario on a controller in the seat of planner and whole-body controller: velocities over time."""

from collections.abc import Iterator

from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.setup.groups.gait import command_of, velocities_of
from surefoot.scenarios.setup.walk import Walk

STANDING = Twist()
"""The velocity of standing."""

_UNHEARD = ("place", "single_support", "double_support", "swing_height")
"""Keys of a command that are for a planner; a controller in its seat hears velocities."""

_PLANNERS_FAULTS = ("planner_freeze", "qp_failure")


def seat_problems(walk: Walk) -> Iterator[Problem]:
    """List what a scenario asks of a controller in the seat that it cannot hear."""
    keys, seat = walk.keys, walk.keys.controller
    if seat is None:
        return
    if keys.fidelity == "pendulum":
        yield Problem(("controller",), "a controller of joints on a pendulum, which has none", "use fidelity full")
    yield from _unnamed(walk)
    for name in ("waypoints", "footsteps"):
        if getattr(keys.gait, name):
            what = f"gait.{name} for a controller that hears velocities alone"
            yield Problem(("gait", name), what, "give gait.velocity, or leave out controller")
    for index, command in enumerate(keys.commands):
        for name in _UNHEARD:
            if getattr(command, name) is not None:
                what = f"commands.{index}.{name} for a controller that hears velocities alone"
                yield Problem(("commands", index, name), what, "leave it out, or leave out controller")
    for index, fault in enumerate(keys.faults):
        if fault.kind in _PLANNERS_FAULTS:
            what = f"faults.{index}, {fault.kind}, of a planner or a QP that is not there"
            yield Problem(("faults", index, "kind"), what, "use torque_loss or state_nan")


def _unnamed(walk: Walk) -> Iterator[Problem]:
    """Report a seat that names nothing, or two things."""
    seat = walk.keys.controller
    assert seat is not None
    name = seat.name or DEFAULTS["controller"]
    if seat.policy is None and name == DEFAULTS["controller"]:
        yield Problem(("controller",), "a controller without a name", "give controller.policy, or controller.name")
    elif seat.policy is not None and name != DEFAULTS["controller"]:
        what = f"controller.policy beside controller.name {name}"
        yield Problem(("controller", "policy"), what, "give one of them")


def velocities(walk: Walk) -> tuple[Command, ...]:
    """Commands to a controller in the seat, in order of time; before the first it stands.

    Equal steps are the velocity of their path, from the first lift-off for as long as they take; so it goes as far.
    """
    gait, keys = walk.asked_gait, walk.keys
    heard = velocities_of(keys.gait.velocity)
    if not heard and keys.gait.steps > 1 and not walk.takes_commands:
        twist = Twist(gait.step_length, gait.lateral_step, gait.turn).scaled(1.0 / gait.period)
        begin = gait.lift_off(1)
        heard = [Command(twist, time=begin), Command(STANDING, time=begin + (gait.steps - 1) * gait.period)]
    heard += [command_of(command) for command in keys.commands]
    return tuple(sorted(heard, key=lambda command: command.time))
