"""What a health check says."""

from dataclasses import asdict, dataclass
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        check: its name.
        status: ok or warning.
        time: where the evidence is strongest or first [s]; None where it has no time.
        value: the evidence, in the check's unit.
        cause: what was found and its likely cause; empty when all is well.
    """

    check: str
    status: Literal["ok", "warning"]
    time: float | None
    value: float | None
    cause: str = ""

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        return asdict(self)


def judged(check: str, warn: bool, time: float | None, value: float | None, cause: str) -> Finding:
    """A finding whose cause is told only when it is a warning."""
    return Finding(check, "warning" if warn else "ok", time, value, cause if warn else "")
