"""The planner under a controller or a point mass: on its own clock, commanded and logged."""

import math
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.parts.guard import OWN_GUARD, Guard
from surefoot.planner.plan.plan import Planner, WalkPlan
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import CentroidalState, FeetState, Foot, Footstep, PhaseInfo, PhaseKind
from surefoot.scenarios.file.schema import Fault, Rates
from surefoot.scenarios.record.walk import WalkRecorder
from surefoot.scenarios.run.sensing import PlannerSensing
from surefoot.scenarios.setup.parts import plan as taken_plan
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.setup.windows import FaultWindow

ROUNDING = 1e-6
"""Times of commands are compared with those of ticks with this tolerance [ticks]."""


Measured = tuple[CentroidalState, NDArray[np.float64], FeetState]
"""State that a planner may measure: CoM, ZMP, shape (2,) [m], and feet."""

MOST_MISSED = 25
"""Plans that are made up for at once where readings have failed to come; a longer gap ends the walk [-]."""


class RunFault(Exception):  # noqa: N818  the event, not a mistake of the caller
    """A fault that ends a run before its time, in words."""


class CommandedPlanner(Planner, Protocol):
    """A planner that hears while the walk goes on what to do, as `surefoot.planner.planner.WalkingPlanner`."""

    @property
    def orders(self) -> Command:
        """Commands that the walk follows."""

    def command(self, command: Command) -> None:
        """Do something else from the next plan on.

        Raises:
            ParameterError: it cannot do this.
        """


class Planned:
    """A walker whose gait is that of a plan, and which is commanded by its planner.

    Attributes:
        planning: its planner, on its own clock.
    """

    __slots__ = ()  # as a base beside a compiled one needs
    planning: "Planning"

    @property
    def gait(self) -> tuple[float, PhaseInfo]:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        plan = self.planning.plan
        return plan.time, plan.phase

    @property
    def orders(self) -> Command:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        return self.planning.orders

    def command(self, command: Command, now: float) -> None:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        self.planning.command(command, now)


class FaultSchedule:
    """Time windows of injected faults on the control clock."""

    def __init__(self, faults: Sequence[Fault], control_rate: int) -> None:
        """Faults with times in seconds, on a clock of ``control_rate`` [Hz]."""
        self._windows = tuple(FaultWindow.of(fault, control_rate) for fault in faults)

    def active(self, kind: str, tick: int) -> bool:
        """Return true if a fault of that kind acts at that control tick."""
        return bool(self._windows) and any(window.kind == kind and window.holds(tick) for window in self._windows)


class Planning:
    """Planner, its sensing, its latest plan, and the record of all.

    A command is taken by the first plan at or after its time.

    Args:
        planner: what plans.
        sensing: what it is given of the state.
        recorder: of its channels; None for no record.
        faults: injected.
        rates: of the clock; that of the planner need not divide that of the control ticks.
        commands: that it hears while the walk goes on.
        guard: around the calls of the planner.

    Attributes:
        planner: what plans.
        plan: the latest plan; there is none before the first `update`.
        due: from when on the next plan is [s].
        sampler: of the latest plan.
        recorder: of its channels; None for no record.
    """

    def __init__(
        self,
        planner: Planner,
        sensing: PlannerSensing,
        recorder: WalkRecorder | None,
        faults: FaultSchedule,
        rates: Rates,
        commands: Sequence[Command] = (),
        guard: Guard = OWN_GUARD,
    ) -> None:
        self.planner = planner
        self._sensing = sensing
        self.recorder = recorder
        self._faults = faults
        self._guard = guard
        self._plan_rate, self._rate = rates.planner, rates.control
        self._made, self.due = 0, -math.inf
        self.plan: WalkPlan
        self.sampler: PlanSampler
        self._started = False
        self._commands = deque(sorted(commands, key=lambda command: command.time))
        self._has_command = False
        self._aim: Footstep | None = None
        self._landing: Footstep | None = None
        self._swinging: Foot | None = None

    @classmethod
    def of(cls, walk: Walk, planner: Planner) -> "Planning":
        """Make the planning of a walk around its planner, at its start and without a record."""
        faults = FaultSchedule(walk.faults, walk.rates.control)
        return cls(planner, PlannerSensing(walk), None, faults, walk.rates, walk.commands, walk.formulation.guard)

    def tick(self, now: float) -> int:
        """The number of the control tick of an instant [s]."""
        return round(now * self._rate)

    def follow(self, now: float, measure: Callable[[], Measured]) -> float:
        """Make the plans that are due.

        A plan is that of its place on the planner's own clock, whenever the readings come: what is measured since is
        taken back to there. Plans that were due while no readings came are made up for.

        Args:
            now: instant of what is measured, which goes on from call to call [s].
            measure: gives what is measured; asked only where a plan is due.

        Returns:
            the wall-clock time that planning took [s].

        Raises:
            RunFault: nothing was measured for too long.
        """
        begin = time.perf_counter()
        if (self._made + MOST_MISSED) / self._plan_rate < now:
            raise RunFault(
                f"nothing was measured for {now - (self._made - 1) / self._plan_rate:.3f} s before {now:.3f} s"
            )
        while self.due <= now:
            due, (state, zmp, feet) = self._made / self._plan_rate, measure()
            late = now - due
            if abs(late) * self._rate > ROUNDING:
                state = replace(state, time=due, com=state.com - late * state.com_velocity)
            self._made += 1
            self.due = self._made / self._plan_rate - ROUNDING / self._rate
            tick = self.tick(now)
            self.update(tick, tick * 1_000_000_000 // self._rate, state, zmp, feet)
        return time.perf_counter() - begin

    def update(self, tick: int, now_ns: int, state: CentroidalState, zmp: NDArray[np.float64], feet: FeetState) -> None:
        """Measure and plan; a frozen planner only measures, but the first plan is made whatever the faults say.

        Args:
            tick: control tick.
            now_ns: its time [ns].
            state: CoM without noise, as the planner's robot model has it.
            zmp: ZMP without noise, shape (2,) [m].
            feet: the feet, which are measured without noise.
        """
        before = self.plan if self._started else None
        sensed = self._sensing.sense(state, zmp, before)
        if self.recorder is not None:
            self.recorder.planner_state(now_ns, sensed)
        if self._started and self._faults.active("planner_freeze", tick):
            return
        if self._commands:
            self._tell(tick)
        update: Callable[[CentroidalState, FeetState], WalkPlan] = self._guard.function(self.planner.update, taken_plan)
        self.plan = update(sensed.given, feet)
        self.sampler = PlanSampler(self.plan)
        self._started = True
        if self.recorder is not None:
            self._record(self.recorder, now_ns, feet)

    def _record(self, recorder: WalkRecorder, now_ns: int, feet: FeetState) -> None:
        recorder.plan(now_ns, self.plan)
        if self._has_command:
            recorder.command(now_ns, self.orders)
            self._has_command = False
        self._book(recorder, now_ns, feet)

    def command(self, command: Command, now: float) -> None:
        """Command the planner at an instant [s], from the next plan on.

        Raises:
            ParameterError: it is a planner that takes no commands, or cannot do this.
        """
        self._commanded  # noqa: B018  refuses before the planner hears what it was to hear earlier
        self._tell(self.tick(now))
        self._say(command)

    @property
    def orders(self) -> Command:
        """Commands that the walk follows.

        Raises:
            ParameterError: it is a planner that takes no commands.
        """
        with self._guard:
            return self._commanded.orders

    @property
    def _commanded(self) -> CommandedPlanner:
        if not hasattr(self.planner, "command"):
            what = f"a command to {type(self.planner).__name__}, which takes none"
            raise ParameterError(("commands",), what, "use a profile with surefoot's own walking planner")
        return cast("CommandedPlanner", self.planner)

    def _say(self, command: Command) -> None:
        with self._guard.making:
            self._commanded.command(command)
        self._has_command = True

    def _tell(self, tick: int) -> None:
        """Give the planner the commands of a control tick, and those since its last plan."""
        while self._commands and self._commands[0].time * self._rate <= tick + ROUNDING:
            self._say(self._commands.popleft())

    def _book(self, recorder: WalkRecorder, now_ns: int, feet: FeetState) -> None:
        """Record a footstep once its swing is over and its foot has touched down, which it may never do.

        What was planned of it is what the last plan before the touchdown said: the planner moves the footstep of a foot
        that has touched down early to where it stands.
        """
        before, self._swinging = self._swinging, _swinging(self.plan)
        swinging = self._swinging
        if before is not None and swinging is not before:
            self._landing = self._aim
        landing = self._landing
        if landing is not None and landing.foot is swinging:
            self._landing = None
        elif landing is not None and feet.contact[landing.foot]:
            recorder.touchdown(now_ns, landing, feet)
            self._landing = None
        if swinging is not None and not self.plan.status.early_touchdown:
            self._aim = self.plan.footsteps[0]


def _swinging(plan: WalkPlan) -> Foot | None:
    """The foot that swings in a plan's phase."""
    stance = plan.phase.stance
    return stance.other if plan.phase.kind is PhaseKind.SINGLE and stance is not None else None
