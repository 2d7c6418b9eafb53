"""Writes what was commanded in the log in whose shadow a controller walks."""

from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.sim.measurement import Array


class ShadowRecorder:
    """The channel of the commands of another log.

    Args:
        writer: of the log.
        sizes: of the robot.
    """

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        self._channel = writer.channel(channels.shadow(sizes))

    def tick(self, time_ns: int, command: Array) -> None:
        """The torques that were commanded at a control tick [ns], shape (nj,) [N·m]."""
        self._channel.put(time_ns, command=command)
