"""``surefoot plot``: from a log to a file of figures."""

from dataclasses import dataclass
from pathlib import Path
from textwrap import shorten

from scenarios.errors import LogError
from scenarios.log import Log, read
from scenarios.provenance import ABSENT
from scenarios.report.figures.page import page, single
from scenarios.report.figures.save import format_of, save
from scenarios.report.logview import LogView, MissingError
from scenarios.verdict import judge

PAGE_NAME = "figures.png"
_REASON = 90
"""Letters of a reason that fit into the header."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """What was drawn.

    Attributes:
        path: of the file.
        notes: what of the log could not be read, in words.
    """

    path: Path
    notes: tuple[str, ...]


def plot(
    log_path: Path,
    out: Path | None = None,
    what: str | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Drawn:
    """Draw the figures of a log.

    Args:
        log_path: a log, also a truncated one.
        out: file to write, PNG, SVG or PDF by its ending; ``figures.png`` beside the log by default, or the figure's
            own name when one was chosen.
        what: one figure by name, all on one page by default.
        start: of the window [s].
        end: of the window [s].

    Raises:
        LogError: the log cannot be read, the window is empty, there is no such figure or the file cannot be written.
    """
    out = out or log_path.parent / (f"{what}.png" if what else PAGE_NAME)
    format_of(out)
    log = read(log_path)
    view = LogView(log, start, end)
    figure = page(view, _header(view)) if what is None else single(view, _header(view), what)
    save(figure, out)
    return Drawn(out, _notes(log))


def _header(view: LogView) -> str:
    """Two lines: which run and its verdict; the stretch of time and what made it."""
    log = view.log
    try:
        scenario, seed, fidelity = (view.constant(name) for name in ("scenario", "seed", "fidelity"))
        name = f"{scenario}, seed {seed}, fidelity {fidelity}"
    except MissingError:
        name = log.path.name
    versions = log.metadata.get("versions", {})
    parts = (("surefoot", "surefoot"), ("git_revision", "revision"), ("mujoco", "mujoco"))
    made = [f"{label} {versions[part][:12]}" for part, label in parts if versions.get(part, ABSENT) not in ("", ABSENT)]
    window = f"{view.start:.3f} s to {view.end:.3f} s"
    return f"{name}: {_verdict(log)}\n{', '.join([window, *made])}".replace("$", r"\$")


def _verdict(log: Log) -> str:
    try:
        verdict = judge(log)
    except LogError:
        return "no verdict"
    first = f" ({shorten(verdict.reasons[0], _REASON)})" if verdict.reasons else ""
    return f"{'pass' if verdict.passed else 'fail'}{first}"


def _notes(log: Log) -> tuple[str, ...]:
    truncated = (f"the file is truncated: it can be read up to {log.time_range()[1]:.3f} s",) if log.truncated else ()
    return (*truncated, *dict.fromkeys(log.damage))
