"""The plant's side of a bridge: a simulated robot that does what it is told, or is damped."""

from dataclasses import replace

import numpy as np

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand, Servo
from surefoot.scenarios.apps.bridge.messages import Answered, Start, State
from surefoot.scenarios.errors import LinkError
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.drives import IDEAL, Drives
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.readings import SensorSuite
from surefoot.sim.world import World

DAMPING = 0.05
"""Damping of joints that are let go, over their largest torque, of the reference robot [s/rad]."""


class Host:
    """The simulated robot of a walk, a control tick at a time.

    Args:
        walk: its robot, ground, motors, sensors, rates and seed count; what is walked does not.

    Attributes:
        tick: control ticks since the start.
        rate: of them [Hz].
        damped: why the joints are damped, whatever they are told; empty as long as they are not.

    Raises:
        ParameterError: it has what only one process can have.
    """

    def __init__(self, walk: Walk) -> None:
        _refuse_undivided(walk)
        self.walk, self.rate = walk, walk.rates.control
        robot, rate, size = walk.true_robot, walk.rates.physics, walk.size
        errors = walk.hardware.drives
        drives = None if errors == IDEAL else Drives(walk.robot, errors, rate, walk.seed)
        self._world = World(robot, walk.ground.true_terrain, rate, (), size, drives)
        self.joints = len(robot.joint_names)
        zero = np.zeros(self.joints)
        self._damping = JointCommand(zero, Servo(zero, zero, zero, DAMPING * size.time * walk.robot.torque_limit))
        self.tick, self.damped = 0, ""
        self._command: JointCommand | None = None
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
        self._command = JointCommand(start.torque)
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
        """What is so now; asked once a tick."""
        measurement: Measurement = self._world.measure()
        readings = None if self._sensors is None else self._sensors.read(measurement, self.tick)
        return State(self.tick, measurement, readings, self._answered)

    def take(self, tick: int, command: JointCommand) -> None:
        """Take a command that answers the state of a tick; one that is older than the last one counts no more."""
        if tick > self._answered.tick:
            self._command, self._answered = command, replace(self._answered, tick=tick)

    def damp(self, why: str) -> None:
        """Damp the joints from now on; the first reason counts."""
        self.damped = self.damped or why
        self._answered = replace(self._answered, damped=True)

    def advance(self) -> None:
        """Do what is commanded until the next tick.

        Raises:
            LinkError: the simulation diverged.
        """
        command = self._damping if self.damped or self._command is None else self._command
        try:
            self._world.act(command, 1.0 / self.rate)
        except SimulationDiverged as fault:
            raise LinkError(str(fault)) from None
        self.tick += 1

    @property
    def joint_velocity(self) -> Array:
        """Speeds of the joints now, shape (nj,) [rad/s]."""
        return np.asarray(self._world.data.qvel[6:])


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
