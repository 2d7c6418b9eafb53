"""Serves a simulated robot to a controller in another process, until that has ended or was lost."""

import contextlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from queue import Empty
from typing import Any

from surefoot.apps.bridge.door import Door
from surefoot.apps.bridge.frames import Frame, Kind, Link
from surefoot.apps.bridge.host import Host
from surefoot.apps.bridge.messages import command_of, end_bytes, push_of, start_of, state_bytes, why_of
from surefoot.scenarios.errors import LinkClosedError, LinkError

PATIENCE, GETTING_READY = 10.0, 300.0
"""Times that a controller may take for an answer, and to get ready [s]."""

LET_DOWN = 1.0
"""Time for which a robot that is damped is simulated on [s]."""

MOST_LATE = 0.01
"""Delay that a plant in real time may catch up; more of it would be simulated at once, unheard [s]."""

_LOOK = 0.1


@dataclass(frozen=True, slots=True)
class Served:
    """The end of serving.

    Attributes:
        time: simulated [s].
        said: why, in words.
        in_order: whether the controller has said that it ends, and was not damped before.
        late: by how much the plant's clock was put back, in all, since the machine was too slow for real time [s].
    """

    time: float
    said: str
    in_order: bool
    late: float = 0.0


class Server:
    """A plant that is served.

    Args:
        plant: the robot.
        host: address to be bound to.
        port: to be bound to; 0 for any free one.
        say: called with sentences on what happens.
        real_time: whether it goes by the wall clock, and waits for nobody.

    Attributes:
        plant: the robot.
        address: that is listened at.

    Raises:
        LinkError: the address cannot be had.
    """

    def __init__(self, plant: Host, host: str, port: int, say: Callable[[str], None], real_time: bool = False) -> None:
        walk = plant.walk
        self.plant, self._walk, self._say = plant, walk, say
        self._real_time, self._late = real_time, 0.0
        robot = walk.robot
        welcome = {
            "robot": robot.name,
            "joints": list(robot.joint_names),
            "rate": walk.rates.control,
            "name": walk.name,
            "scenario": walk.text,
            "real_time": real_time,
            "disturbed": not plant.care.disturbance.none,
        }
        self._door = Door(host, port, self._examine, welcome, say)
        self.address = self._door.address

    def _examine(self, hello: Mapping[str, Any]) -> str:
        """Reason why a controller cannot walk this robot."""
        robot = self._walk.robot
        wanted = {"robot": robot.name, "joints": list(robot.joint_names), "rate": self._walk.rates.control}
        for name, what in (("robot", "robot"), ("joints", "joints in this order"), ("rate", "control rate")):
            asked = hello.get(name)
            if asked is not None and asked != wanted[name]:
                return f"a controller of {str(asked)[:60]}, where the {what} served is {str(wanted[name])[:60]}"
        return ""

    def run(self, stopped: Callable[[], bool]) -> Served:
        """Wait for a controller and serve it; ``stopped`` says when nobody wants that any more."""
        link = None
        try:
            link = self._guest(stopped)
            if link is None:
                return Served(0.0, "stopped before a controller came", in_order=True)
            self._say(f"{link.peer} walks the robot")
            return replace(self._serve(link, stopped), late=self._late)
        finally:
            self._door.close()
            if link is not None:
                link.close()

    def _guest(self, stopped: Callable[[], bool]) -> Link | None:
        while not stopped():
            try:
                return self._door.guests.get(timeout=_LOOK)
            except Empty:
                continue
        return None

    def _serve(self, link: Link, stopped: Callable[[], bool]) -> Served:
        plant = self.plant
        try:
            frame = self._next(link, GETTING_READY, stopped)
            if frame.kind is Kind.END:
                return Served(0.0, why_of(frame.payload), in_order=True)
            if frame.kind is not Kind.RESET:
                raise LinkError(f"a message {frame.kind.name} before a start")
            plant.begin(start_of(frame.payload, plant.joints))
            end = (self._paced if self._real_time else self._in_step)(link, stopped)
            return Served(plant.time, why_of(end.payload), in_order=True)
        except LinkError as fault:
            # A controller that a signal ends may leave states unread, and be gone before its end is looked for.
            parting = link.last_word() if isinstance(fault, LinkClosedError) else None
            if parting is not None:
                return Served(plant.time, why_of(parting.payload), in_order=True)
            return self._let_down(link, str(fault))

    def _in_step(self, link: Link, stopped: Callable[[], bool]) -> Frame:
        """Wait for the answer to each state; gives the end."""
        plant = self.plant
        while not plant.damped:
            state = plant.state()
            if plant.tells:
                link.send(Kind.STATE, state_bytes(state), PATIENCE)
                if (end := self._answer(link, stopped)) is not None:
                    return end
            plant.advance()
        raise LinkError(plant.damped)

    def _paced(self, link: Link, stopped: Callable[[], bool]) -> Frame:
        """Wait for nobody once the first state is answered; gives the end."""
        plant = self.plant
        link.send(Kind.STATE, state_bytes(plant.state()), PATIENCE)
        if (end := self._answer(link, stopped)) is not None:
            return end
        begin = time.monotonic() - plant.time
        while not (plant.damped or stopped()):
            plant.advance()
            due = begin + plant.time
            while (frame := link.receive(due - time.monotonic())) is not None:
                if frame.kind is Kind.END:
                    return frame
                self._take(frame, time.monotonic() - begin)
            late = time.monotonic() - due
            if late > MOST_LATE:
                begin, self._late = begin + late, self._late + late
            state = plant.state()
            if plant.tells:
                link.offer(Kind.STATE, state_bytes(state))
        raise LinkError(plant.damped or "stopped by a signal")

    def _answer(self, link: Link, stopped: Callable[[], bool]) -> Frame | None:
        """Take what answers a state; the end, if that is the answer."""
        while (frame := self._next(link, PATIENCE, stopped)).kind is Kind.PUSH:
            self._take(frame)
        if frame.kind is Kind.END:
            return frame
        self._take(frame)
        return None

    def _take(self, frame: Frame, now: float | None = None) -> None:
        """Take a push or a command, which comes at an instant of the plant's clock; None for at this tick [s]."""
        plant = self.plant
        if frame.kind is Kind.PUSH:
            plant.push(push_of(frame.payload))
        elif frame.kind is Kind.COMMAND:
            plant.take(*command_of(frame.payload, plant.joints), now)
        else:
            raise LinkError(f"a message {frame.kind.name} where a command is due")

    def _next(self, link: Link, patience: float, stopped: Callable[[], bool]) -> Frame:
        deadline = time.monotonic() + patience
        while time.monotonic() < deadline:
            if stopped():
                raise LinkError("stopped by a signal")
            frame = link.receive(_LOOK)
            if frame is not None:
                return frame
        raise LinkError(f"{link.peer} has sent nothing for {patience:g} s")

    def _let_down(self, link: Link, why: str) -> Served:
        """Damp the joints, tell the controller if it is there, and simulate the robot until it has come down."""
        plant = self.plant
        plant.damp(why)
        when = plant.time
        with contextlib.suppress(LinkError):
            link.send(Kind.END, end_bytes(f"the plant was damped at {when:.3f} s: {why}"), _LOOK)
        for _ in range(round(LET_DOWN * plant.rate) if plant.tick else 0):
            plant.advance()
        return Served(plant.time, f"damped at {when:.3f} s: {why}", in_order=False)
