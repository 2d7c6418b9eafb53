"""Writes what has become of states and commands on the way between a plant and a controller in other processes."""

from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record import channels


class LinkRecorder:
    """The channel of a line on which messages may be late or lost.

    Args:
        writer: of the log.
        rate: of control ticks [Hz].
    """

    def __init__(self, writer: LogWriter, rate: int) -> None:
        self._channel, self._rate = writer.channel(channels.link()), rate

    def state(self, tick: int, before: int, commanded: int, counts: tuple[int, int, bool]) -> None:
        """A state that has come.

        Args:
            tick: of the state.
            before: of the state that came before it; -1 for none.
            commanded: tick of the state that the command in force answers; -1 for none.
            counts: commands missed and limited so far, and whether the joints are damped.
        """
        missed, limited, damped = counts
        age = (tick - commanded) / self._rate if commanded >= 0 else float("nan")
        self._channel.put(
            tick * 1_000_000_000 // self._rate, command_age=age, states_missed=max(tick - before - 1, 0),
            commands_missed=missed, commands_limited=limited, damped=damped,
        )  # fmt: skip
