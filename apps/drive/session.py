"""A drive: runs that keep step with the wall clock, and inputs that take effect between their control ticks."""

import math
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from queue import Queue
from typing import Any, Protocol

from surefoot.errors import ParameterError
from surefoot.planner.types import Twist
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.simulation import Simulation, Tick
from surefoot.scenarios.run.skeleton import End


@dataclass(frozen=True, slots=True)
class GaitInput:
    """The gait that the user asks for; None leaves as it is [s, s, m]."""

    single_support: float | None = None
    double_support: float | None = None
    swing_height: float | None = None


@dataclass(frozen=True, slots=True)
class PushInput:
    """A push on a body, world frame [N·s]; evenly over `PUSH_TIME`."""

    impulse: tuple[float, float, float]
    body: str


@dataclass(frozen=True, slots=True)
class PaceInput:
    """Simulated over wall-clock time; None leaves as it is [-]."""

    speed: float | None = None
    paused: bool | None = None


@dataclass(frozen=True, slots=True)
class Reset:
    """End this run and begin another one."""


Input = Twist | GaitInput | PushInput | PaceInput | Reset

MOST_WAITING = 1000
"""Inputs that may wait until they are taken; a session takes all that wait every few milliseconds."""


class Inputs(Queue[Input]):
    """Inputs that wait to take effect, from any thread.

    Of velocities and of resets only the last one waits, which therefore always finds room. Others are refused by a
    ValueError while `MOST_WAITING` wait.
    """

    def _put(self, item: Input) -> None:
        waiting = self.queue
        if isinstance(item, Twist | Reset):
            for same in [one for one in waiting if type(one) is type(item)]:
                waiting.remove(same)
        elif len(waiting) >= MOST_WAITING:
            raise ValueError(f"{MOST_WAITING} inputs wait to be taken; send fewer at once")
        waiting.append(item)


PUSH_TIME = 0.1
"""Duration of a push, simulated [s]."""

COMMAND_PERIOD = 0.1
"""Least time between two commands, simulated [s]; a stop does not wait."""

PICTURE_PERIOD, SLOWEST_PICTURES = 1 / 30, 1 / 5
"""Time between pictures where there is time for them and the browser keeps up, and otherwise [s]."""

BURST = 0.008
"""Time for which control ticks are simulated before inputs are looked at again [s]."""

NO_TIME = 0.03
"""Lag behind the wall clock from which on pictures are left out [s]."""

TOO_FAR = 1.0
"""Lag that is not caught up any more [s]; the machine is too slow."""

IDLE = 0.004
"""Wait when nothing is due [s]."""

_PACE_SPAN = 2.0
_SLOW_SHOWN = 4.0


@dataclass(frozen=True, slots=True)
class DriveStatus:
    """The status beside a picture.

    Attributes:
        run: number of the run, from 1 on.
        time: simulated time of the run [s].
        speed: asked for, simulated over wall-clock time [-].
        pace: reached in the last seconds, simulated over wall-clock time [-].
        paused: whether time stands still.
        over: whether the run has ended.
        wanted: velocity that was asked for last.
        note: what is to be said: a fall, a machine that is too slow, a command that was refused; empty for nothing.
    """

    run: int
    time: float
    speed: float
    pace: float
    paused: bool
    over: bool
    wanted: Twist
    note: str


class DriveView(Protocol):
    """The view of the robot for people."""

    @property
    def looked_at(self) -> bool:
        """True if anybody has looked until now."""

    @property
    def drawn(self) -> bool:
        """True if all that was shown has been drawn where somebody looks."""

    def begin(self, robot: Simulation) -> None:
        """A run begins."""

    def pushed(self, push: PushInput, time: float) -> None:
        """A push begins to act at a simulated time [s]."""

    def show(self, tick: Tick, status: DriveStatus) -> None:
        """Show a picture."""


class Session:
    """Runs one after another, each in real time; the first goes on from its first tick once somebody looks.

    Control ticks are never left out; pictures are, where the ticks leave no time for them.

    Args:
        begin: makes the simulation of the next run, to which nothing is done but between two of its control ticks.
        page: shows it.
        inputs: of any thread; each takes effect before the next control tick.
        clock: wall-clock time [s].
    """

    def __init__(
        self,
        begin: Callable[[], Simulation],
        page: DriveView,
        inputs: Inputs,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._make = begin
        self._page = page
        self._inputs = inputs
        self._clock = clock
        self._speed, self._paused, self._waits = 1.0, False, True
        self._gait = GaitInput()
        self._runs = 0
        self._robot: Simulation
        self._shown_at = -math.inf
        self._begin()

    def run(self, stopped: Callable[[], bool], sleep: Callable[[float], None] = time.sleep) -> None:
        """Go on until stopped."""
        while not stopped():
            sleep(self.advance())

    def close(self) -> None:
        """End the run; its log is whole then."""
        self._robot.close()

    def advance(self) -> float:
        """Do what is due now; gives the time until there is more to do [s]."""
        self._take_inputs()
        now = self._clock()
        self._waits = self._waits and not self._page.looked_at
        moving = not (self._still or self._robot.done)
        if not moving:
            self._anchor(now)
            self._passed.clear()
        elif self._lag(now) > TOO_FAR:
            self._slow_at, self._slow_pace = now, self._pace(now)
            self._anchor(now)
        self._step_until(now + BURST)
        now = self._clock()
        lag = self._lag(now)
        period = PICTURE_PERIOD if moving and lag < NO_TIME and self._page.drawn else SLOWEST_PICTURES
        if now - self._shown_at >= period - 1e-6:
            self._shown_at = now
            with suppress(RunFault):  # there is nothing to see of a run that ended in its first tick
                self._page.show(self._robot.look(), self._status(now))
            return 0.0
        if not moving:
            return 5 * IDLE
        return 0.0 if lag > 0.0 else IDLE

    def _begin(self) -> None:
        self._robot = self._make()
        self._runs += 1
        self._wanted = self._sent = Twist()
        self._sent_gait, self._sent_at = GaitInput(), -math.inf
        self._over, self._note = False, ""
        self._slow_at = self._shown_at = -math.inf
        self._page.begin(self._robot)
        with suppress(RunFault):  # its end says why
            self._robot.advance()
        self._passed: deque[tuple[float, float]] = deque()
        self._anchor(self._clock())

    def _anchor(self, now: float) -> None:
        """Count simulated time anew from here and now."""
        self._anchored = (now, self._robot.time)

    def _due(self, now: float) -> float:
        """Simulated time that should be reached [s]."""
        wall, simulated = self._anchored
        return simulated + (now - wall) * self._speed

    def _lag(self, now: float) -> float:
        """Delay of the run, in wall-clock time [s]."""
        return (self._due(now) - self._robot.time) / self._speed

    def _pace(self, now: float) -> float:
        """Simulated over wall-clock time in the last seconds."""
        passed = self._passed
        passed.append((now, self._robot.time))
        while len(passed) > 2 and passed[1][0] < now - _PACE_SPAN:
            passed.popleft()
        span = now - passed[0][0]
        return (self._robot.time - passed[0][1]) / span if span > 0.1 else self._speed

    def _step_until(self, deadline: float) -> None:
        """Simulate what is due, or as much of it as there is time for."""
        robot, now = self._robot, self._clock()
        while not (robot.done or self._still) and robot.time < self._due(now) - 1e-9 and now < deadline:
            self._send()
            with suppress(RunFault):
                robot.advance()
            now = self._clock()
        if robot.done and not self._over:
            self._over, self._note = True, _ending(robot.end)

    @property
    def _still(self) -> bool:
        """Return true if time stands still."""
        return self._paused or self._waits

    def _take_inputs(self) -> None:
        for _ in range(self._inputs.qsize()):  # nobody else takes them; what comes meanwhile waits for the next look
            self._take(self._inputs.get_nowait())

    def _take(self, given: Input) -> None:
        if isinstance(given, Twist):
            self._wanted = given
        elif isinstance(given, GaitInput):
            self._gait = replace(self._gait, **{key: v for key, v in asdict(given).items() if v is not None})
        elif isinstance(given, PushInput):
            if self._over:
                return
            self._note = ""
            if self._try(self._push, given):
                self._page.pushed(given, self._robot.time)
        elif isinstance(given, PaceInput):
            self._speed = self._speed if given.speed is None else given.speed
            self._paused = self._paused if given.paused is None else given.paused
            self._anchor(self._clock())
            self._passed.clear()
        else:
            self._robot.close()
            self._begin()

    def _push(self, push: PushInput) -> None:
        self._robot.push([part / PUSH_TIME for part in push.impulse], PUSH_TIME, push.body)

    def _send(self) -> None:
        """Command what has changed, before a control tick."""
        wanted, stop = self._wanted, self._wanted.is_zero
        if (wanted, self._gait) == (self._sent, self._sent_gait):
            return
        if self._robot.time - self._sent_at < COMMAND_PERIOD - 1e-9 and not (stop and wanted != self._sent):
            return
        before = asdict(self._sent_gait)
        changed = {key: value for key, value in asdict(self._gait).items() if value != before[key]}
        # One after the other: a gait that is refused shall not take a stop with it.
        orders = (wanted.velocity if wanted != self._sent else {}, changed)
        self._sent, self._sent_gait, self._sent_at = wanted, self._gait, self._robot.time
        self._note = ""
        for keys in filter(None, orders):
            self._try(lambda keys: self._robot.command(**keys), keys)

    def _try(self, do: Callable[[Any], None], what: Any) -> bool:
        """Do what the robot may refuse, and say so if it does."""
        try:
            do(what)
        except ParameterError as refusal:
            self._note = f"{refusal.what}; {refusal.right}"
            return False
        return True

    def _status(self, now: float) -> DriveStatus:
        slow = now - self._slow_at < _SLOW_SHOWN
        return DriveStatus(
            run=self._runs,
            time=self._robot.time,
            speed=self._speed,
            pace=self._pace(now),
            paused=self._paused,
            over=self._over,
            wanted=self._wanted,
            note=self._note or (f"the machine is too slow: {self._slow_pace:.1f} x real time" if slow else ""),
        )


def _ending(end: End) -> str:
    what = {
        "completed": f"the scenario's {end.time:g} s are over",
        "fall": f"it has fallen at {end.time:.1f} s",
    }.get(end.kind, end.reason)
    return f"{what}: reset it (R)"
