"""The controller's side of a bridge: a plant in another process."""

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from surefoot.apps.bridge.frames import Frame, Kind, Link, connected
from surefoot.apps.bridge.limits import Limits
from surefoot.apps.bridge.messages import (
    Start,
    State,
    command_bytes,
    end_bytes,
    json_bytes,
    json_of,
    push_bytes,
    start_bytes,
    state_of,
    why_of,
)
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.readings import Readings
from surefoot.scenarios.errors import LinkError
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record.link import LinkRecorder
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.plant import measured_tick
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Array, Measurement

PATIENCE = 10.0
"""Time that a plant may take for an answer [s]."""

SILENCE = 0.5
"""Time for which a plant that goes by the wall clock may say nothing; then its joints are damped [s]."""


@dataclass(frozen=True, slots=True)
class Welcome:
    """The welcome of a plant, with its data.

    Attributes:
        robot: its name.
        joints: their names, in order.
        rate: of control ticks [Hz].
        name: of its scenario.
        scenario: its scenario, in YAML.
        real_time: whether it goes by the wall clock, and waits for nobody.
        disturbed: whether messages are late or get lost.
    """

    robot: str
    joints: tuple[str, ...]
    rate: int
    name: str
    scenario: str
    real_time: bool = False
    disturbed: bool = False

    @classmethod
    def of(cls, keys: Mapping[str, Any]) -> "Welcome":
        """The welcome of a message.

        Raises:
            LinkError: it is none.
        """
        try:
            names = tuple(str(name) for name in keys["joints"])
            flags = bool(keys.get("real_time")), bool(keys.get("disturbed"))
            return cls(str(keys["robot"]), names, int(keys["rate"]), str(keys["name"]), str(keys["scenario"]), *flags)
        except (KeyError, TypeError, ValueError):
            raise LinkError("a welcome that does not say which robot is served") from None


class Remote:
    """A plant in another process, connected to.

    Args:
        address: at which the plant is served.
        hello: what the controller says of itself: robot, joints, rate; of those it does not say any will do.

    Attributes:
        welcome: what the plant says of itself.

    Raises:
        LinkError: nobody is there, or it refuses.
    """

    def __init__(self, address: str, hello: Mapping[str, Any]) -> None:
        self._link = connected(address, PATIENCE)
        try:
            self._link.send(Kind.HELLO, json_bytes(hello), PATIENCE)
            frame = self._link.receive(PATIENCE)
            if frame is None:
                raise LinkError(f"has not answered for {PATIENCE:g} s")
            if frame.kind is Kind.REFUSED:
                raise LinkError(f"refuses: {why_of(frame.payload)}")
            if frame.kind is not Kind.WELCOME:
                raise LinkError(f"a message {frame.kind.name} where a welcome is due")
            self.welcome = Welcome.of(json_of(frame.payload, "welcome"))
        except LinkError as fault:
            self._link.close()
            raise LinkError(f"{self._link.peer}: {fault}") from None

    def plant(self, walk: Walk, writer: LogWriter) -> "RemotePlant":
        """The plant of a walk, and of its log.

        Raises:
            LinkError: it is another robot's.
        """
        check(self.welcome, walk.robot.name, walk.robot.joint_names, walk.rates.control)
        recorded = self.welcome.real_time or self.welcome.disturbed
        recorder = LinkRecorder(writer, walk.rates.control) if recorded else None
        return RemotePlant(self._link, walk, self.welcome.real_time, recorder)

    def close(self, why: str) -> None:
        """Close the line with a message that the walk is over, and why."""
        with contextlib.suppress(LinkError):
            self._link.send(Kind.END, end_bytes(why), 1.0)
        self._link.close()


def check(welcome: Welcome, robot: str, joints: Sequence[str], rate: int) -> None:
    """Refuse a plant that is not of this robot.

    Raises:
        LinkError: it is another one, or another rate.
    """
    if (welcome.robot, welcome.joints) != (robot, tuple(joints)):
        raise LinkError(
            f"{welcome.robot} is served and {robot} would walk; give a scenario of {welcome.robot}, or none"
        )
    if welcome.rate != rate:
        raise LinkError(
            f"{welcome.rate} control ticks a second are served and {rate} would be walked; set rates.control"
        )


class RemotePlant:
    """See `surefoot.Plant`.

    Args:
        link: to the process that has it.
        walk: what is walked.
        real_time: whether it waits for nobody, so that of its states the newest counts.
        recorder: of what becomes of messages; None for none.

    Attributes:
        control_tick: number of the control tick at which was measured last.
    """

    def __init__(self, link: Link, walk: Walk, real_time: bool = False, recorder: LinkRecorder | None = None) -> None:
        self._link = link
        self._rate = walk.rates.control
        self._real_time = real_time
        self._recorder = recorder
        self._patience = SILENCE if real_time else PATIENCE
        self._damping = Limits(walk.robot, walk.size, 1.0 / self._rate).damping
        self._joints, self._senses = len(walk.robot.joint_names), walk.sensing.source != "truth"
        self._state: State
        self.control_tick = -1

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """See `surefoot.Plant`."""
        n = self._joints
        start = Start(q, np.zeros(6 + n) if v is None else v, np.zeros(n) if torque is None else torque, self._senses)
        self._send(Kind.RESET, start_bytes(start))

    def measure(self) -> Measurement:
        """See `surefoot.Plant`."""
        frame = self._receive()
        if self._real_time and frame.kind is Kind.STATE:
            frame = self._newest(frame)
        try:
            if frame.kind is Kind.END:
                raise RunFault(why_of(frame.payload))
            if frame.kind is not Kind.STATE:
                raise LinkError(f"a message {frame.kind.name} where a state is due")
            self._state = state_of(frame.payload, self._joints, self._rate, self._senses)
        except LinkError as fault:
            raise RunFault(f"the plant sends {fault}") from None
        measured_tick(self._state.tick, self.control_tick + 1, self._rate)
        if self._recorder is not None:
            said = self._state.answered
            self._recorder.state(
                self._state.tick, self.control_tick, said.tick, (said.missed, said.limited, said.damped)
            )
        self.control_tick = self._state.tick
        return self._state.measurement

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """See `surefoot.Plant`."""
        assert self._state.readings is not None
        return self._state.readings

    def act(self, command: JointCommand, period: float) -> None:
        """See `surefoot.Plant`."""
        self._send(Kind.COMMAND, command_bytes(self.control_tick, command))

    def push(self, push: Push) -> None:
        """See `surefoot.Plant`."""
        self._send(Kind.PUSH, push_bytes(push))

    def _send(self, kind: Kind, payload: bytes) -> None:
        try:
            self._link.send(kind, payload, PATIENCE)
        except LinkError as fault:
            self._refused(fault)

    def _refused(self, fault: LinkError) -> None:
        """The plant is gone; what it has said before is why."""
        end = self._link.last_word()
        raise RunFault(f"the plant is lost: {fault}" if end is None else why_of(end.payload))

    def _receive(self) -> Frame:
        try:
            frame = self._link.receive(self._patience)
        except LinkError as fault:
            raise RunFault(f"the plant is lost: {fault}") from None
        if frame is None:
            with contextlib.suppress(LinkError):
                self._link.offer(Kind.COMMAND, command_bytes(self.control_tick + 1, self._damping))
            raise RunFault(f"damped: {self._link.peer} has sent nothing for {self._patience:g} s")
        return frame

    def _newest(self, frame: Frame) -> Frame:
        """The last of the states that are there, or the end if it is."""
        with contextlib.suppress(LinkError):  # what is wrong is reported when it is waited for
            while frame.kind is Kind.STATE and (later := self._link.receive(0.0)) is not None:
                frame = later
        return frame
