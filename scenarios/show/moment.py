"""The way to a moment of a log: the replay beside it, opened at that time, or the command that makes one."""

from dataclasses import dataclass
from pathlib import Path
from shlex import quote

PAGE = "replay.html"
"""Name of a replay beside its log."""

BEFORE, AFTER = 1.0, 0.5
"""Time that a replay shows about a moment [s]."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A time of a log.

    Attributes:
        log: its path.
        time: simulated [s].
    """

    log: Path
    time: float

    @property
    def page(self) -> Path:
        """Path of the replay, whether it is there or not."""
        return self.log.parent / PAGE

    @property
    def command(self) -> str:
        """Makes a replay of the time about it."""
        log, page = quote(str(self.log)), quote(str(self.page))
        start, end = max(self.time - BEFORE, 0.0), self.time + AFTER
        return f"surefoot replay {log} --html {page} --from {start:.3f} --to {end:.3f} --force"

    @property
    def link(self) -> str | None:
        """The replay opened at that time; None where there is none that is as new as the log."""
        try:
            made = self.page.stat().st_mtime >= self.log.stat().st_mtime
        except OSError:
            return None
        return f"{self.page}#t={self.time:.3f}" if made else None

    @property
    def text(self) -> str:
        """The link, or else the command."""
        return self.link or self.command

    def to_json(self) -> dict[str, str | None]:
        """Write as one JSON object."""
        return {"command": self.command, "link": self.link}
