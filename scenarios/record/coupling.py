"""Writes how well joints follow others in the simulated world, where an equality holds them that gives way a little."""

from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.sim.world import World


class CouplingRecorder:
    """The channel of joints that follow others.

    Args:
        writer: of the log.
        sizes: of the robot.
        world: that simulates it.
    """

    def __init__(self, writer: LogWriter, sizes: Sizes, world: World) -> None:
        self._channel, self._world = writer.channel(channels.coupling(sizes)), world

    def tick(self, time_ns: int) -> None:
        """Log where the joints are at a control tick [ns]."""
        self._channel.put(time_ns, apart=self._world.apart)
