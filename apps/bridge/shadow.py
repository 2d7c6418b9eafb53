"""A controller in the shadow of a log: it hears what was measured, and what it would do is compared and not done."""

from pathlib import Path
from typing import Any

import numpy as np

from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.readings import Reading, Readings
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import Kept, Log, LogWriter, read
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.shadow import ShadowRecorder
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.run import Result, closed_loop, run_scenario
from surefoot.scenarios.run.skeleton import End, OnProgress, run_loop
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Array, Measurement

_MEASURED = ("joint_position", "joint_velocity", "joint_torque", "gyro", "accelerometer", "external_force")
_JOINT, _IMU = ("joint_position", "joint_velocity", "joint_torque"), (
    "angular_velocity", "mean_angular_velocity", "specific_force",
)  # fmt: skip


class ShadowPlant:
    """A `surefoot.Plant` that says what a log holds, and does nothing.

    Args:
        log: of a walk in full physics.
        walk: that is walked in its shadow.
        writer: of the log of the shadow.

    Attributes:
        control_tick: number of the control tick at which was measured last.

    Raises:
        LogError: the log is of another robot, or holds no walk in full physics, or not all readings where they are
            needed.
    """

    def __init__(self, log: Log, walk: Walk, writer: LogWriter) -> None:
        joints, rate = len(walk.robot.joint_names), walk.rates.control
        needed = ["/truth", "/measurement", "/torque", *(["/readings"] if walk.sensing.source != "truth" else [])]
        missing = [topic for topic in needed if topic not in log.numeric]
        if missing:
            right = "give the log of a run in full physics, with the same sensors"
            raise LogError(f"{log.path}: has no channel {missing[0]}; {right}")
        stamps = log["/measurement"].time_ns
        apart = [topic for topic in needed if not np.array_equal(log[topic].time_ns, stamps)]
        if apart:
            right = "give the log of a run without log.rate"
            raise LogError(f"{log.path}: {apart[0]} has not a message for each one of /measurement; {right}")
        self._fields = {topic: _columns(log, topic) for topic in needed}
        if self._fields["/measurement"]["joint_position"].shape[1] != joints:
            raise LogError(f"{log.path}: a log of another robot than {walk.robot.name}; give one of it")
        self._ticks = [round(time * rate) for time in 1e-9 * log["/measurement"].time_ns]
        self._rate, self._row, self.control_tick = rate, -1, -1
        self._recorder = ShadowRecorder(writer, Sizes(joints, 7 + joints, 6 + joints, walk.parameters.horizon))

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """See `surefoot.Plant`."""
        self._row = -1

    def measure(self) -> Measurement:
        """See `surefoot.Plant`."""
        self._row = row = self._row + 1
        self.control_tick = self._ticks[row]
        seen, true = self._fields["/measurement"], self._fields["/truth"]
        self._recorder.tick(self.control_tick * 1_000_000_000 // self._rate, self._fields["/torque"]["command"][row])
        return Measurement(
            time=self.control_tick / self._rate,
            wrench=_both(seen, row),
            q=true["q"][row],
            v=true["v"][row],
            nonfoot_contact=bool(true["nonfoot_contact"][row]),
            self_contact=bool(true["self_contact"][row]),
            **{name: seen[name][row] for name in _MEASURED},
        )

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """See `surefoot.Plant`."""
        said, row = self._fields["/readings"], self._row

        def reading(name: str, group: str) -> Reading:
            return Reading(said[name][row], float(said[f"{group}_age"][row]), bool(said[f"{group}_fresh"][row]))

        known = {name: reading(name, "joint") for name in _JOINT} | {name: reading(name, "imu") for name in _IMU}
        speeds = None if np.isnan(said["joint_velocity"][row]).any() else known["joint_velocity"]
        wrench, age = _both(said, row), float(said["wrench_age"][row])
        felt = None if np.isnan(age) else Reading(wrench, age, bool(said["wrench_fresh"][row]))
        return Readings(measurement.time, **{**known, "joint_velocity": speeds}, wrench=felt)  # type: ignore[arg-type]

    def act(self, command: JointCommand, period: float) -> None:
        """See `surefoot.Plant`; nothing is done."""

    def push(self, push: Push) -> None:
        """Nobody is pushed: what the log holds has happened."""


def _both(fields: dict[str, Any], row: int) -> Array:
    """Wrenches of both soles, shape (2, 6)."""
    return np.stack((fields["wrench_left"][row], fields["wrench_right"][row]))


def _columns(log: Log, topic: str) -> dict[str, Any]:
    """The fields of a channel."""
    channel = log[topic]
    return {field.name: channel.field(field.name) for field in log.fields(topic)}


def walk_in_shadow(path: Path, scenario: Scenario, out: Path, on_progress: OnProgress | None = None) -> Result:
    """Walk in the shadow of a log, as long as it lasts.

    Args:
        path: of the log.
        scenario: what is walked.
        out: directory that gets the run's own folder.
        on_progress: called with the progress of the run.

    Raises:
        LogError: the log cannot be read, or is not one of such a walk.
    """
    log = read(path)
    if "/measurement" not in log.numeric:
        raise LogError(f"{path}: holds no walk in full physics; give the log of one")
    if (kept := Kept.from_metadata(log.metadata, str(path))) is not None:
        raise LogError(f"{path}: has its run from {kept.begin:.3f} s on alone; give the log of a run without log.keep")
    lasts = (round(1e-9 * int(log["/measurement"].time_ns[-1]) * scenario.rates.control) + 1) / scenario.rates.control
    scenario = scenario.model_copy(update={"duration": lasts})

    def simulate(walk: Walk, writer: LogWriter, on_progress: OnProgress) -> End:
        loop = closed_loop(walk, writer, Parts(plant=lambda walk: ShadowPlant(log, walk, writer)))
        return run_loop(loop, on_progress)

    return run_scenario(scenario, out, on_progress, simulate)
