"""The skeleton of every closed loop: it goes tick by tick until its time is over, a fall or a fault."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from traceback import format_exception
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

from surefoot.errors import PartError
from surefoot.forces import Push
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import PhaseInfo, PhaseKind
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.record.provenance import AFTER_FALL
from surefoot.scenarios.record.walk import RunRecorder
from surefoot.scenarios.run.planning import ROUNDING, Planning, RunFault
from surefoot.scenarios.run.tick import Look, Spent
from surefoot.scenarios.setup.groups.gait import PushPoint
from surefoot.scenarios.setup.keys import scenario_problem
from surefoot.scenarios.setup.walk import Walk
from surefoot.wbc.controller import WholeBodyController

if TYPE_CHECKING:
    from surefoot.scenarios.run.instruments import Instruments

_PHASE_NAMES = {PhaseKind.STAND: "standing", PhaseKind.DOUBLE: "double support", PhaseKind.SINGLE: "single support"}


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of a run.

    Attributes:
        time: simulated [s].
        duration: that it will take at most, simulated [s].
        phase: in words, such as "single support, step 2".
        real_time_factor: simulated over wall-clock time so far [-].
    """

    time: float
    duration: float
    phase: str
    real_time_factor: float


@dataclass(frozen=True, slots=True)
class End:
    """The end of a run.

    Attributes:
        kind: completed; fall; fault (NaN, divergence, solver failure); interrupted by the user.
        time: simulated [s].
        reason: in words; empty when completed.
        trace: where in the code a part of others failed; empty otherwise.
    """

    kind: Literal["completed", "fall", "fault", "interrupted"]
    time: float
    reason: str = ""
    trace: str = ""


LONGEST_TRACE = 20_000
"""Characters of a traceback that a log keeps, the last ones."""


def fault_end(fault: RunFault | PartError, time: float) -> End:
    """The end of a run by a fault at a simulated time [s]."""
    if not isinstance(fault, PartError):
        return End("fault", time, str(fault))
    trace = "" if fault.__cause__ is None else "".join(format_exception(fault.__cause__))
    return End("fault", time, fault.what, trace[-LONGEST_TRACE:])


OnProgress = Callable[[Progress], None]


@contextmanager
def refusing() -> Iterator[None]:
    """Turn the refusal of a part to be built as the scenario asks into an error that the user can mend.

    Raises:
        SetupError: instead of a ValueError.
        PartError: a part of others fails, which no scenario mends.
    """
    try:
        yield
    except PartError:
        raise
    except ValueError as refusal:
        raise SetupError(scenario_problem(refusal)) from refusal


S = TypeVar("S")


class Walker(Protocol[S]):
    """A walker in a closed loop: a robot under its whole-body controller or another one, or a point mass.

    What it follows is a sample of the plan, or nothing. The skeleton calls its verbs in the order in which they stand
    here, once per control tick.
    """

    @property
    def planning(self) -> Planning | None:
        """Its planner, on its own clock; None without one."""
        ...

    @property
    def gait(self) -> tuple[float, PhaseInfo]:
        """Phase of its gait, and the instant at which it was there [s]."""
        ...

    @property
    def orders(self) -> Command:
        """Commands that it follows.

        Raises:
            ParameterError: it takes no commands.
        """
        ...

    def command(self, command: Command, now: float) -> None:
        """Command it at an instant [s].

        Raises:
            ParameterError: it takes no commands, or cannot do this.
        """
        ...

    @property
    def controller(self) -> WholeBodyController | None:
        """Its whole-body controller; None without one."""
        ...

    def sense(self, tick: int, now: float) -> int:
        """Measure; gives the number of the control tick that was measured, which may be later where some are lost.

        Raises:
            RunFault: what is measured is not finite.
        """
        ...

    def control(self, tick: int, now: float) -> tuple[S, Spent]:
        """Plan, and decide what to do until the next tick; returns the reference of now, and the time it took."""
        ...

    def record(self, now_ns: int, sample: S) -> None:
        """Write the tick into the log's channels."""
        ...

    def fallen(self, sample: S) -> bool:
        """Return true if it has fallen."""
        ...

    def draw(self, tick: int, now_ns: int, plan: Any, sample: S, fallen: bool) -> None:
        """Write what MCAP viewers show of the tick."""
        ...

    def advance(self, now: float) -> None:
        """Simulate until the next tick.

        Raises:
            RunFault: the simulation diverged.
        """
        ...

    def look(self) -> Look:
        """Look at the tick, for a viewer."""
        ...

    def push(self, push: Push) -> None:
        """Take a push that begins at the next tick.

        Raises:
            ValueError: it cannot act on this walker.
        """
        ...


class ClosedLoop:
    """One run: a walker and its records on one integer clock.

    Args:
        walker: what walks.
        recorder: gets the reference and the timing of every tick.
        rate: of the control ticks [Hz].
        duration: simulated time [s].
        pushes: that begin at points of the gait; see `surefoot.scenarios.setup.walk.Walk`.
        instruments: that read the true state into the log; None for none.

    Attributes:
        walker: what walks.
        planning: its planner; None without one.
        rate: of the control ticks [Hz].
        tick: number of the next tick.
        sample: the reference of the last tick; there is none before the first, nor of a walker without a plan.
        end: how the run ended, or will have ended if nothing happens.
        fell: whether the walker has fallen.
        done: whether the run is over: its time, a while after a fall, or a fault.
        fault: that ended it, None where none has.
    """

    def __init__(
        self,
        walker: Walker[Any],
        recorder: RunRecorder,
        rate: int,
        duration: float,
        pushes: Sequence[tuple[PushPoint, Push]] = (),
        instruments: "Instruments | None" = None,
    ) -> None:
        self.walker, self.planning = walker, walker.planning
        self._recorder, self.rate = recorder, rate
        self._ticks = self._last = round(duration * rate)
        self.tick = 0
        self.sample: Any = None
        self._pushes = list(pushes)
        self._begun: list[tuple[PushPoint, Push]] = []
        self.end = End("completed", self._ticks / rate)
        self._instruments = instruments
        self._ahead = -1
        self.fell = False
        self.done = self._last == 0
        self.fault: RunFault | PartError | None = None

    @classmethod
    def of(
        cls, walk: Walk, walker: Walker[Any], recorder: RunRecorder, instruments: "Instruments | None" = None
    ) -> "ClosedLoop":
        """The loop of a walk around what walks it, at its start."""
        return cls(walker, recorder, walk.rates.control, walk.duration, walk.gait_pushes, instruments)

    @property
    def time(self) -> float:
        """Simulated time of the next tick [s]."""
        return self.tick / self.rate

    @property
    def duration(self) -> float:
        """Simulated time that the run takes at most [s]."""
        return self._ticks / self.rate

    @property
    def phase(self) -> PhaseInfo:
        """Phase of the gait; asked only after a step."""
        return self.walker.gait[1]

    def sense(self) -> None:
        """Measure the next tick ahead of `step`, which goes on from there; a fault is that of the step."""
        if self._ahead < 0 and not self.done:
            with suppress(RunFault, PartError):
                self._ahead = self.walker.sense(self.tick, self.tick / self.rate)

    def step(self) -> bool:
        """Go through one control tick; False when a fault ended the run."""
        tick, rate = self.tick, self.rate
        try:
            fallen = self._step(tick)
            tick = self.tick
        except (RunFault, PartError) as fault:
            self.end, self.done, self.fault = fault_end(fault, tick / rate), True, fault
            return False
        if fallen and not self.fell:
            self.fell = True
            self.end = End("fall", tick / rate, f"the robot fell at {tick / rate:.3f} s")
            self._last = min(self._last, tick + round(AFTER_FALL * rate))
        self.tick = tick + 1
        self.done = self.tick >= self._last
        if self.done and not self.fell:
            broken = self._broken_promise()
            self.end = End("fault" if broken else "completed", self.tick / rate, broken)
        return True

    def _broken_promise(self) -> str:
        """The push at a point of the gait that did not act, or not to its end; empty when all did that are to."""
        for point, _ in self._pushes:
            if point.promised:
                return f"a push never acted: the walk never came to {point}"
        for point, push in self._begun:
            if point.promised and push.time + push.duration > self.time + ROUNDING / self.rate:
                return f"a push at {push.time:.3f} s, {point}, would have lasted {push.duration:g} s and was cut off"
        return ""

    def _step(self, tick: int) -> bool:
        clock, busy_clock = time.perf_counter, time.thread_time_ns
        begin, busy = clock(), busy_clock()
        walker, rate, recorder = self.walker, self.rate, self._recorder
        if self._ahead < 0:
            self._ahead = walker.sense(tick, tick / rate)
        self.tick = tick = self._ahead
        self._ahead = -1
        now, now_ns = tick / rate, tick * 1_000_000_000 // rate
        sensed = clock()
        sample, spent = walker.control(tick, now)
        busy = busy_clock() - busy
        decided = clock()
        self.sample = sample
        if self._pushes:
            since, phase = walker.gait
            self._push(now, since, phase)
        walker.record(now_ns, sample)
        if self._instruments is not None:
            self._instruments.tick(tick, now_ns)
        planning = self.planning
        plan = None if planning is None else planning.plan
        if planning is not None and planning.recorder is not None:
            planning.recorder.reference(now_ns, planning.plan, sample)
        fallen = walker.fallen(sample)
        walker.draw(tick, now_ns, plan, sample, fallen)
        logged = clock()
        walker.advance(now)
        end = clock()
        state, plan_time, build, solve = spent
        state += sensed - begin
        log = logged - decided
        recorder.timing(now_ns, (state, build, solve, plan_time, end - logged, log, end - begin, 1e-9 * busy))
        return fallen

    def _push(self, now: float, since: float, phase: PhaseInfo) -> None:
        """Give the pushes whose point of the gait is reached before the next tick."""
        waiting, self._pushes = self._pushes, []
        for point, push in waiting:
            begin = max(now, since + point.left(phase))
            # At the end of the tick too: there the next phase may begin, which does not know the point any more.
            if begin < now + (1.0 + ROUNDING) / self.rate:
                begun = replace(push, time=begin)
                self._begun.append((point, begun))
                self.walker.push(begun)
                self._recorder.begun(begun, live=not point.promised)
            else:
                self._pushes.append((point, push))


def run_loop(loop: ClosedLoop, on_progress: OnProgress) -> End:
    """Run a closed loop to the end, to shortly after a fall, or to a fault.

    Args:
        loop: the closed loop, at its start.
        on_progress: called with the progress of the run, every simulated tenth of a second.
    """
    started, every = time.perf_counter(), loop.rate // 10 or 1
    while not loop.done and loop.step():
        if loop.tick % every == 0:
            on_progress(_progress(loop, time.perf_counter() - started))
    return loop.end


def _progress(loop: ClosedLoop, wall: float) -> Progress:
    phase = loop.phase
    name = _PHASE_NAMES[phase.kind]
    if phase.kind is PhaseKind.SINGLE:
        name = f"{name}, step {phase.step}"
    return Progress(loop.time, loop.duration, name, loop.time / wall if wall > 0.0 else 0.0)
