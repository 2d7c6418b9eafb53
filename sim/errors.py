"""The errors of the simulator."""

from surefoot.errors import ParameterError


class SimulationDiverged(RuntimeError):  # noqa: N818  the event, not a mistake of the caller
    """The state or the commanded torque is no longer finite; the world holds the last finite state.

    Attributes:
        time: start of the advance in which it happened [s].
        cause: what is not finite.
    """

    def __init__(self, time: float, cause: str) -> None:
        super().__init__(f"simulation diverged after t = {time:.4f} s: {cause}; the world holds the last finite state")
        self.time = time
        self.cause = cause

    def __reduce__(self) -> tuple[type["SimulationDiverged"], tuple[float, str]]:
        """Survive the way between processes."""
        return type(self), (self.time, self.cause)


class WorldError(ParameterError):
    """A world was asked for that cannot be built, or a call does not fit it; the key starts with the argument."""
