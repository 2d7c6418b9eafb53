"""The measurements of a log, tick by tick, and a plant that goes on from a state of it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.readings import Reading, Readings
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Kept, Log, read
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.drives import Drives
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.world import World

_MEASURED = ("joint_position", "joint_velocity", "joint_torque", "gyro", "accelerometer", "external_force")
_JOINT, _IMU = ("joint_position", "joint_velocity", "joint_torque"), (
    "angular_velocity", "mean_angular_velocity", "specific_force",
)  # fmt: skip


class LoggedRun:
    """The measurements and readings of a log, row by row.

    Args:
        log: of a walk in full physics.
        walk: whose controller is to hear them.
        more: topics that are needed beside them.

    Attributes:
        ticks: numbers of the control ticks of the rows.

    Raises:
        LogError: the log is of another robot, lacks its beginning, or has not all that is needed at each tick.
    """

    def __init__(self, log: Log, walk: Walk, more: tuple[str, ...] = ()) -> None:
        joints, self.rate = len(walk.robot.joint_names), walk.rates.control
        needed = ["/truth", "/measurement", *more, *(["/readings"] if walk.sensing.source != "truth" else [])]
        missing = [topic for topic in needed if topic not in log.numeric]
        if missing:
            right = "give the log of a run in full physics, with the same sensors"
            raise LogError(f"{log.path}: has no channel {missing[0]}; {right}")
        if (kept := Kept.from_metadata(log.metadata, str(log.path))) is not None:
            right = "give the log of a run without log.keep"
            raise LogError(f"{log.path}: has its run from {kept.begin:.3f} s on alone; {right}")
        stamps = log["/measurement"].time_ns
        apart = [topic for topic in needed if not np.array_equal(log[topic].time_ns, stamps)]
        if apart:
            right = "give the log of a run without log.rate"
            raise LogError(f"{log.path}: {apart[0]} has not a message for each one of /measurement; {right}")
        self.fields = {topic: _columns(log, topic) for topic in needed}
        if self.fields["/measurement"]["joint_position"].shape[1] != joints:
            raise LogError(f"{log.path}: a log of another robot than {walk.robot.name}; give one of it")
        self.ticks = [round(time * self.rate) for time in 1e-9 * stamps]

    def measurement(self, row: int) -> Measurement:
        """The measurement of a row."""
        seen, true = self.fields["/measurement"], self.fields["/truth"]
        return Measurement(
            time=self.ticks[row] / self.rate,
            wrench=_both(seen, row),
            q=true["q"][row],
            v=true["v"][row],
            nonfoot_contact=bool(true["nonfoot_contact"][row]),
            self_contact=bool(true["self_contact"][row]),
            **{name: seen[name][row] for name in _MEASURED},
        )

    def readings(self, row: int, time: float) -> Readings:
        """The readings of a row, measured at a time [s]."""
        said = self.fields["/readings"]

        def reading(name: str, group: str) -> Reading:
            return Reading(said[name][row], float(said[f"{group}_age"][row]), bool(said[f"{group}_fresh"][row]))

        known = {name: reading(name, "joint") for name in _JOINT} | {name: reading(name, "imu") for name in _IMU}
        speeds = None if np.isnan(said["joint_velocity"][row]).any() else known["joint_velocity"]
        wrench, age = _both(said, row), float(said["wrench_age"][row])
        felt = None if np.isnan(age) else Reading(wrench, age, bool(said["wrench_fresh"][row]))
        return Readings(time, **{**known, "joint_velocity": speeds}, wrench=felt)  # type: ignore[arg-type]


class LogPlant:
    """A `surefoot.Plant` that says what a log holds up to an instant, and is the simulated world from its state on.

    Until then nothing is done, and the controller hears what was measured, so that its memory is that of the log. The
    world takes over the true state. Simulated sensors and motors hear what the log holds as well.

    Args:
        walk: that is walked.
        world: that goes on, without pushes of its own.
        drives: its motors; None for ones that give each torque at once.
        run: what the log holds.
        until: the last instant of which the log tells [s].

    Attributes:
        control_tick: number of the control tick at which was measured last.

    Raises:
        ParameterError: the log has no such instant.
    """

    def __init__(self, walk: Walk, world: World, drives: Drives | None, run: LoggedRun, until: float) -> None:
        self._last = int(np.searchsorted(run.ticks, round(until * run.rate), side="right")) - 1
        end = run.ticks[-1] / run.rate
        if self._last < 0 or until > end + 0.5 / run.rate:
            what = f"plant.options.until {until:g} s, where the log has {run.ticks[0] / run.rate:g} to {end:g} s"
            raise ParameterError(("plant", "options"), what, "give a time that the log has")
        self._walk, self._run = walk, run
        self._world, self._drives = world, drives
        self._pushes: list[Push] = []
        self._row = self._heard = self.control_tick = -1
        self._sensors: Any = None

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """See `surefoot.Plant`; its start is that of the log."""
        self._row = self._heard = self.control_tick = -1
        self._pushes, self._sensors = [], None

    @property
    def _live(self) -> bool:
        """The simulated world goes on."""
        return self._row > self._last

    def measure(self) -> Measurement:
        """See `surefoot.Plant`."""
        self._row += 1
        if self._live:
            self.control_tick += 1
            return self._world.measure()
        self.control_tick = self._run.ticks[self._row]
        found = self._run.measurement(self._row)
        if self._row == self._last:
            self._take_over(found)
        return found

    def _take_over(self, found: Measurement) -> None:
        """Put the world into a state at its instant, with the pushes that act then or later."""
        world, rate = self._world, self._world.physics_rate
        world.reset(found.q, found.v, found.joint_torque, self.control_tick * rate // self._run.rate)
        self._command_drives()
        now = world.time
        for push in self._pushes:
            end, begin = push.time + push.duration, max(push.time, now)
            if end > begin:
                world.push(Push(begin, end - begin, push.force, push.body))
        self._pushes = []

    def _command_drives(self) -> None:
        """Tell motors that err the torques that were commanded before, some of which they have not given yet."""
        drives, commanded, run = self._drives, self._run.fields.get("/torque"), self._run
        if drives is None or commanded is None or self._walk.control.output == "position":
            return
        for row, command in enumerate(commanded["command"][: self._last]):
            drives.tell(run.ticks[row] * self._world.physics_rate // run.rate, command)

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """See `surefoot.Plant`; simulated sensors hear what the log holds too, and so go on from there."""
        if self._sensors is None:
            from surefoot.sim.readings import SensorSuite

            walk = self._walk
            self._sensors = SensorSuite(self._world, walk.hardware.sensors, walk.rates.control, walk.seed)
        while self._heard < tick:  # also of ticks whose states the log has not
            self._heard += 1
            made: Readings = self._sensors.read(measurement, self._heard)
        return made if self._live else self._run.readings(self._row, measurement.time)

    def act(self, command: JointCommand, period: float) -> None:
        """See `surefoot.Plant`."""
        if self._row >= self._last:
            self._world.act(command, period)

    def push(self, push: Push) -> None:
        """Take a push; what of it lies before the instant is in the log."""
        if self._row >= self._last:
            self._world.push(push)
        else:
            self._pushes.append(push)


def log_plant(walk: Walk, world: World, drives: Drives | None, options: Mapping[str, Any]) -> LogPlant:
    """The plant of a log.

    Args:
        walk: that is walked.
        world: that goes on, without pushes of its own.
        drives: its motors; None for ones that give each torque at once.
        options: ``log``, its path, and ``until``, the instant at which the simulated world takes over [s].

    Raises:
        ParameterError: an option is missing, unknown or no such value, or joints are driven by somebody else.
        LogError: the log cannot be read, or is not one of such a walk.
    """
    path, until = options.get("log"), options.get("until")
    if not (isinstance(path, str) and isinstance(until, int | float)) or len(options) != 2:
        what = f"plant.options of a log with {', '.join(options) or 'nothing'}"
        raise ParameterError(("plant", "options"), what, "give log, its path, and until, a time in seconds")
    if walk.control.driven_joints:
        what = "control.driven_joints of a plant that goes on from a log"
        raise ParameterError(("control", "driven_joints"), what, "leave them out, or let plant.name be mujoco")
    more = () if drives is None else ("/torque",)
    return LogPlant(walk, world, drives, LoggedRun(read(path), walk, more), float(until))


def _both(fields: Mapping[str, Any], row: int) -> Array:
    """Wrenches of both soles, shape (2, 6)."""
    return np.stack((fields["wrench_left"][row], fields["wrench_right"][row]))


def _columns(log: Log, topic: str) -> dict[str, Any]:
    """The fields of a channel."""
    channel = log[topic]
    return {field.name: channel.field(field.name) for field in log.fields(topic)}
