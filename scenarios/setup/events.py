"""What is to happen to a walk while it goes on: its pushes, faults and commands in time, and which never act."""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from surefoot.errors import ParameterError
from surefoot.planner.walk.commands import velocity_bouts
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Fault, Rates, VelocitySettings
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.gait import gait_of, push_time, timeline_of, twist_of, uncommanded
from surefoot.sim.pushes import physics_window

MOST_IDLE = 20
"""Commands that never act of which a scenario is told."""


@dataclass(frozen=True, slots=True)
class FaultWindow:
    """A fault on the control clock.

    Attributes:
        kind: of the fault.
        start: first control tick at which it holds.
        end: first control tick at which it does not any more; infinite when it lasts.
    """

    kind: str
    start: int
    end: float

    @classmethod
    def of(cls, fault: Fault, control_rate: int) -> "FaultWindow":
        """The window of a fault on a clock of ``control_rate`` [Hz]."""
        end = math.inf if fault.duration is None else round((fault.time + fault.duration) * control_rate)
        return cls(fault.kind, round(fault.time * control_rate), end)

    def holds(self, tick: int) -> bool:
        """Whether it holds at a control tick."""
        return self.start <= tick < self.end

    def first_act(self, rates: Rates) -> float:
        """Time of the first tick at which it does something, infinite when there is none [s].

        A frozen planner is noticed when the next plan is due, but for the first plan, which is made whatever happens.
        """
        every = rates.control // rates.planner if self.kind == "planner_freeze" else 1
        first = max(math.ceil(self.start / every), 1 if every > 1 else 0) * every
        return first / rates.control if first < self.end else math.inf


def never_act(draft: Draft, end: float) -> Iterator[Problem]:
    """List the pushes and faults that do nothing in a run that ends at this time [s].

    Raises:
        ParameterError: the gait cannot be walked, so that its phases have no times.
    """
    rates = draft.keys.rates
    for index, push in enumerate(draft.keys.pushes):
        key, name = ("pushes", index), f"pushes.{index}"
        # Whether a walk that is told where to go comes to a step, the run will show.
        time = 0.0 if draft.told and push.time is None else push_time(draft.gait, push)
        start, stop = physics_window(time, push.duration, rates.physics)
        if time >= end:
            yield _too_late((*key, "time" if push.time is not None else "step"), f"{name} begins at", time, end)
        elif stop <= start:
            what = f"{name}.duration {push.duration:g} s rounds to nothing on a clock of {rates.physics} Hz"
            yield Problem((*key, "duration"), what, "give it at least 1e-6 s")
        elif not (push.impulse or any(push.force or ())):
            given = "force" if push.impulse is None else "impulse"
            yield Problem((*key, given), f"{name}.{given} is zero, which pushes nothing", "give more, or no push")
    for index, fault in enumerate(draft.keys.faults):
        key, name = ("faults", index), f"faults.{index}"
        first = FaultWindow.of(fault, rates.control).first_act(rates)
        if math.isinf(first):
            every = rates.planner if fault.kind == "planner_freeze" else rates.control
            what = f"{name}.duration {fault.duration:g} s ends before the {fault.kind} acts at any tick of {every} Hz"
            yield Problem((*key, "duration"), what, f"give it at least {1 / every:g} s")
        elif first >= end:
            yield _too_late((*key, "time"), f"{name} acts first at", first, end)


def _too_late(key: tuple[str | int, ...], what: str, time: float, end: float) -> Problem:
    return Problem(key, f"{what} {time:.6g} s and never acts: the run ends at {end:.6g} s", "let it begin before")


def idle_commands(draft: Draft) -> Iterator[Problem]:
    """List the velocity commands without which the walk would be the same, though they ask for a change."""
    commands = draft.keys.gait.velocity
    plain = gait_of(uncommanded(draft.keys.gait))

    def bouts(chosen: Sequence[VelocitySettings]) -> object:
        return velocity_bouts(timeline_of(chosen), plain)

    try:
        walked, walk, found = bouts(commands), draft.gait, 0
        times = [command.time for command in commands]
        # One in force as a foot lifts off acts; of the others few do, and each costs a look at the whole walk.
        used = {bisect_right(times, walk.lift_off(step) + 1e-6) - 1 for step in range(1, walk.steps + 1)}
        for index, command in enumerate(commands[:-1]):
            if index in used or found == MOST_IDLE:
                continue
            before = twist_of(commands[index - 1]) if index else twist_of(VelocitySettings(time=0.0))
            if twist_of(command) != before and bouts([*commands[:index], *commands[index + 1 :]]) == walked:
                until = commands[index + 1].time
                what = f"gait.velocity.{index} is over at {until:g} s, before any foot lifts off by it, and never acts"
                yield Problem(("gait", "velocity", index), what, "let it hold for a step, or leave it out")
                found += 1
    except ParameterError:  # told by the checks of the walk
        return
