"""A controller in the shadow of a log: it hears what was measured, and what it would do is compared and not done."""

from pathlib import Path

from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.readings import Readings
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import Log, LogWriter, read
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.shadow import ShadowRecorder
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.logged import LoggedRun
from surefoot.scenarios.run.run import Result, closed_loop, run_scenario
from surefoot.scenarios.run.skeleton import End, OnProgress, run_loop
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Array, Measurement


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
        self._run = LoggedRun(log, walk, ("/torque",))
        self._row, self.control_tick = -1, -1
        joints = len(walk.robot.joint_names)
        self._recorder = ShadowRecorder(writer, Sizes(joints, 7 + joints, 6 + joints, walk.parameters.horizon))

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """See `surefoot.Plant`."""
        self._row = -1

    def measure(self) -> Measurement:
        """See `surefoot.Plant`."""
        run, self._row = self._run, self._row + 1
        self.control_tick = run.ticks[self._row]
        stamp = self.control_tick * 1_000_000_000 // run.rate
        self._recorder.tick(stamp, run.fields["/torque"]["command"][self._row])
        return run.measurement(self._row)

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """See `surefoot.Plant`."""
        return self._run.readings(self._row, measurement.time)

    def act(self, command: JointCommand, period: float) -> None:
        """See `surefoot.Plant`; nothing is done."""

    def push(self, push: Push) -> None:
        """Nobody is pushed: what the log holds has happened."""


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
    lasts = (round(1e-9 * int(log["/measurement"].time_ns[-1]) * scenario.rates.control) + 1) / scenario.rates.control
    scenario = scenario.model_copy(update={"duration": lasts})

    def simulate(walk: Walk, writer: LogWriter, on_progress: OnProgress) -> End:
        loop = closed_loop(walk, writer, Parts(plant=lambda walk: ShadowPlant(log, walk, writer)))
        return run_loop(loop, on_progress)

    return run_scenario(scenario, out, on_progress, simulate)
