"""The plant's side of a bridge: a simulated robot that obeys its commands, or is damped."""

import math
from dataclasses import dataclass, field, replace

from surefoot.apps.bridge.limits import Limits, blended
from surefoot.apps.bridge.line import Disturbance, Line
from surefoot.apps.bridge.messages import Answered, Start, State
from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.scenarios.errors import LinkError
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.drives import IDEAL, Drives
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.measurement import Measurement
from surefoot.sim.readings import SensorSuite
from surefoot.sim.world import World

_SOON = 1e-9
"""Difference of the times of one tick, for rounding [s]."""


@dataclass(frozen=True, slots=True)
class Care:
    """The care of a plant with commands beside obeying them.

    Attributes:
        disturbance: of the line.
        watchdog: age of the state that the newest command answers, from which on the joints are damped [s].
        soft_start: time in which joints go over from being held to their commands [s].
        torque_rate: by which torques may change; see `Limits`.
    """

    disturbance: Disturbance = field(default_factory=Disturbance)
    watchdog: float = math.inf
    soft_start: float = 0.0
    torque_rate: float = math.inf


class Host:
    """The simulated robot of a walk, a control tick at a time.

    Args:
        walk: its robot, ground, motors, sensors, rates and seed count; what is walked does not.
        care: that is taken of commands.

    Attributes:
        tick: control ticks since the start.
        rate: of them [Hz].
        damped: why the joints are damped, whatever they are commanded; empty as long as they are not.
        care: that is taken of commands.

    Raises:
        ParameterError: it has what only one process can have.
    """

    def __init__(self, walk: Walk, care: Care) -> None:
        _refuse_undivided(walk)
        self.walk, self.rate = walk, walk.rates.control
        robot, rate, size = walk.true_robot, walk.rates.physics, walk.size
        errors = walk.hardware.drives
        drives = None if errors == IDEAL else Drives(walk.robot, errors, rate, walk.seed)
        self._world = World(robot, walk.ground.true_terrain, rate, (), size, drives)
        self.joints = len(robot.joint_names)
        self.care, self._line = care, Line(care.disturbance)
        self._limits = Limits(walk.robot, size, 1.0 / self.rate, care.torque_rate)
        self.tick, self.damped = 0, ""
        self._command = self._held = self._limits.damping
        self._answered = Answered()
        self._sensors: SensorSuite | None = None

    @property
    def time(self) -> float:
        """Simulated time since the start [s]."""
        return self.tick / self.rate

    def begin(self, start: Start) -> None:
        """Stand at a start."""
        self._world.reset(start.q, start.v, torque=start.torque)
        self.tick, self._answered = 0, Answered()
        self._limits.begin(start.torque)
        self._command = self._held = self._limits.holding(start.q[7:], start.torque)
        self._sensors = SensorSuite(self._world, self.walk.hardware.sensors, self.rate, self.walk.seed)
        if not start.senses:
            self._sensors = None

    def push(self, push: Push) -> None:
        """Take a push, which begins now if it was to begin before.

        Raises:
            LinkError: the robot cannot be pushed so.
        """
        try:
            self._world.push(replace(push, time=max(push.time, self._world.time)))
        except ParameterError as refusal:
            raise LinkError(str(refusal)) from None

    def state(self) -> State:
        """State of now; asked once a tick."""
        measurement: Measurement = self._world.measure()
        readings = None if self._sensors is None else self._sensors.read(measurement, self.tick)
        return State(self.tick, measurement, readings, self._answered)

    @property
    def tells(self) -> bool:
        """Return true if the state of now gets to the controller; to be asked once a tick."""
        return self._line.carries_state(self.time)

    def take(self, tick: int, command: JointCommand, now: float | None = None) -> None:
        """Take a command that answers the state of a tick.

        Args:
            tick: that it answers; what is older than the newest one counts no more.
            command: for the joints.
            now: when it comes, by the plant's clock; None for at this tick [s].

        Raises:
            LinkError: there has been no such tick.
        """
        if not 0 <= tick <= self.tick + 1:  # a controller that has heard nothing for too long answers the next one
            raise LinkError(f"a command that answers the state of tick {tick}, where {self.tick} is the last")
        self._line.send(self.time if now is None else now, tick, command)

    def damp(self, why: str) -> None:
        """Damp the joints from now on; the first reason counts."""
        self.damped = self.damped or why
        self._answered = replace(self._answered, damped=True)

    def advance(self) -> None:
        """Do what is commanded until the next tick, or damp the joints where nothing has been for too long.

        Raises:
            LinkError: the simulation diverged.
        """
        self._hear()
        try:
            self._world.act(self._obeyed(), 1.0 / self.rate)
        except SimulationDiverged as fault:
            raise LinkError(str(fault)) from None
        self.tick += 1

    def _hear(self) -> None:
        """Take the command that has arrived, if it is a new one."""
        arrived, answered = self._line.arrived(self.time), self._answered
        if arrived is not None and arrived[0] > answered.tick:
            tick, self._command = arrived
            self._answered = replace(answered, tick=tick)
        elif answered.tick >= 0:
            self._answered = replace(answered, missed=answered.missed + 1)
        age = (self.tick - self._answered.tick) / self.rate
        if self._answered.tick >= 0 and age > self.care.watchdog + _SOON:
            self.damp(f"no command answers a state of the last {age:.3f} s")

    def _obeyed(self) -> JointCommand:
        """Command that the joints obey now."""
        if self.damped:
            return self._limits.damping
        if self._answered.tick < 0:
            return self._held
        command, bent = self._limits.within(self._command, self._world.angles)
        if bent:
            self._answered = replace(self._answered, limited=self._answered.limited + 1)
        if self.time < self.care.soft_start:
            return blended(self._held, command, self.time / self.care.soft_start)
        return command


def _refuse_undivided(walk: Walk) -> None:
    """Refuse what plant and controller share in one process."""
    if not walk.walker.has_body:
        raise ParameterError(("fidelity",), "a pendulum has no joints to be commanded", "serve with fidelity full")
    if walk.keys.plant is not None and walk.keys.plant.name not in (None, DEFAULTS["plant"]):
        what = f"plant.name {walk.keys.plant.name}, where the simulated world is served"
        raise ParameterError(("plant", "name"), what, "leave it out")
    if walk.control.driven_joints:
        what = "control.driven_joints, which somebody drives in the process of the controller"
        raise ParameterError(("control", "driven_joints"), what, "leave it out, or walk in one process")
