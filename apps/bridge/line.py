"""A line between controller and plant that is late, unevenly late or loses some; and a controller that stands still."""

import heapq
import math
from dataclasses import dataclass

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand
from surefoot.streams import Stream, generator

_SOON = 1e-9
"""Delay after a tick within which a message is there at the tick [s]."""

PAUSE_PERIOD = 1.0
"""In each of these the controller stands still once, at a time that is drawn [s]."""


@dataclass(frozen=True, slots=True)
class Disturbance:
    """The disturbance of messages, by numbers drawn from a seed.

    Attributes:
        delay: by which every command comes later [s].
        jitter: most of what is added to that, evenly drawn for each command [s].
        drop: share of states, and of commands, that get lost [-].
        pause: how long the controller hears nothing once in every second [s].
        seed: of the draws.

    Raises:
        ParameterError: a number is out of range.
    """

    delay: float = 0.0
    jitter: float = 0.0
    drop: float = 0.0
    pause: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse what is no disturbance."""
        for name, most in (("delay", 10.0), ("jitter", 10.0), ("drop", 1.0), ("pause", PAUSE_PERIOD)):
            value = getattr(self, name)
            if not 0.0 <= value <= most:
                raise ParameterError((name,), f"a {name} of {value}", f"use 0 to {most:g}")

    @property
    def none(self) -> bool:
        """True if nothing is disturbed."""
        return not (self.delay or self.jitter or self.drop or self.pause)


class Line:
    """Carries states and commands of one walk; time is that of the plant.

    Args:
        how: messages are disturbed.
    """

    def __init__(self, how: Disturbance) -> None:
        self._how = how
        parts = (generator(how.seed, Stream.LINE, part) for part in range(4))
        self._lost_state, self._lost_command, self._late, self._stalled = parts
        self._under_way: list[tuple[float, int, JointCommand]] = []
        self._second, self._pause = -1, math.inf

    def carries_state(self, now: float) -> bool:
        """Return true if the state of an instant [s] gets to the controller; asked once for each, in order."""
        how = self._how
        lost = bool(how.drop) and self._lost_state.random() < how.drop
        second = math.floor(now / PAUSE_PERIOD)
        if how.pause and second != self._second:
            self._second = second
            self._pause = second * PAUSE_PERIOD + (PAUSE_PERIOD - how.pause) * self._stalled.random()
        return not lost and not self._pause <= now < self._pause + how.pause

    def send(self, now: float, tick: int, command: JointCommand) -> None:
        """Take a command at an instant [s]."""
        how = self._how
        if how.drop and self._lost_command.random() < how.drop:
            return
        late = how.delay + (how.jitter * float(self._late.random()) if how.jitter else 0.0)
        heapq.heappush(self._under_way, (now + late, tick, command))

    def arrived(self, now: float) -> tuple[int, JointCommand] | None:
        """The newest of the commands that have arrived since it was asked last, by the tick that it answers."""
        newest = None
        while self._under_way and self._under_way[0][0] <= now + _SOON:
            _, tick, command = heapq.heappop(self._under_way)
            if newest is None or tick > newest[0]:
                newest = tick, command
        return newest
