"""The page of all figures of a log, one of them, or two runs over each other, as a file."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from textwrap import shorten
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import refuse_existing, shown
from surefoot.scenarios.palette import BLACK, BLUE, VERMILION
from surefoot.scenarios.record.provenance import ABSENT, END_RECORD
from surefoot.scenarios.show.figures.effort import draw_joints, draw_solver, draw_torques
from surefoot.scenarios.show.figures.ground import draw_grip, draw_soles, draw_top_view, is_wide, strip_height
from surefoot.scenarios.show.figures.motion import draw_balance, draw_feet, draw_height, strips
from surefoot.scenarios.show.kit.figures import DASHED, Area, canvas, curve, format_of, in_style, legend, save
from surefoot.scenarios.show.kit.shading import NOTHING, Background, Panel, background, draw_panels
from surefoot.scenarios.show.logview import LogView, MissingError

DrawFigure = Callable[[Area, LogView, Background], None]

_A3, _A4 = 11.7, 8.3
_HEADER = 0.75


@dataclass(frozen=True, slots=True)
class Family:
    """A family of figures.

    Attributes:
        draw: how.
        size: width and height when it stands alone [in].
        over_time: whether its axes are of time, with what happened behind them.
        longer: height of each strip more that a long run needs [in].
    """

    draw: DrawFigure
    size: tuple[float, float]
    over_time: bool = True
    longer: float = 0.0

    def more(self, view: LogView) -> float:
        """Height beyond that of a short run [in]."""
        return self.longer * (len(strips(view)) - 1)


FIGURES: dict[str, Family] = {
    "balance": Family(draw_balance, (_A3, 7.0), longer=2.7),
    "top-view": Family(draw_top_view, (_A3, 5.5), over_time=False),
    "height": Family(draw_height, (_A4, 4.5)),
    "feet": Family(draw_feet, (_A4, 4.5)),
    "soles": Family(draw_soles, (_A4, 4.0), over_time=False),
    "grip": Family(draw_grip, (_A4, 4.5)),
    "torques": Family(draw_torques, (_A4, 6.0)),
    "joints": Family(draw_joints, (_A3, 6.0)),
    "solver": Family(draw_solver, (_A3, 4.5)),
}
"""The families of figures by name."""


_COMPACT = (
    (6.0, ("balance",)),
    (3.6, ("top-view", "height")),
    (3.9, ("feet", "torques")),
    (3.3, ("soles", "grip")),
    (3.9, ("joints",)),
    (3.3, ("solver",)),
)
"""Rows of the page: height [in] and the figures in it."""

_WIDE = (
    (5.7, ("balance",)),
    (0.9, ("top-view",)),
    (3.1, ("height", "feet")),
    (3.3, ("soles", "grip")),
    (3.3, ("torques",)),
    (3.9, ("joints",)),
    (3.1, ("solver",)),
)
"""Rows of the page of a walk whose top view is a strip: height [in] and the figures in it."""


def page(view: LogView, header: str) -> Figure:
    """Draw all figures on one page, A3 wide."""
    rows = _WIDE if is_wide(view) else _COMPACT
    heights = [_HEADER, *(height + max(FIGURES[name].more(view) for name in names) for height, names in rows)]
    if rows is _WIDE:
        heights[2] += strip_height(view, _A3)
    with in_style():
        figure, areas = canvas(_A3, heights)
        behind = background(view)
        _head(areas[0], header, behind, 11.0)
        for area, (_, names) in zip(areas[1:], rows, strict=True):
            for part, name in zip(area.subfigures(1, len(names), squeeze=False)[0], names, strict=True):
                FIGURES[name].draw(part, view, behind)
    return figure


def single(view: LogView, header: str, name: str) -> Figure:
    """Draw one figure by name.

    Raises:
        LogError: there is no such figure.
    """
    if name not in FIGURES:
        raise LogError(f"--what {name}: no such figure; {nearest(name, FIGURES)}")
    with in_style():
        width, tall = FIGURES[name].size
        figure, (top, area) = canvas(width, (_HEADER, tall + FIGURES[name].more(view)))
        behind = background(view) if FIGURES[name].over_time else NOTHING
        _head(top, header, behind, 9.0)
        FIGURES[name].draw(area, view, behind)
    return figure


def _head(area: Area, header: str, behind: Background, size: float) -> None:
    """Write the title of the log, and the meaning of the shades behind all curves over time."""
    area.text(0.01, 0.98, header, ha="left", va="top", fontsize=size, linespacing=1.4)
    area.legend(handles=behind.handles(), loc="lower left", bbox_to_anchor=(0.004, 0.0), ncols=4)


PAGE_NAME = "figures.png"
_REASON = 90
"""Letters of a reason that fit into the header."""


@dataclass(frozen=True, slots=True)
class Plotted:
    """The file that was drawn, and what of the log could not be read, in words."""

    path: Path
    notes: tuple[str, ...]


def plot(
    log_path: Path,
    out: Path | None = None,
    what: str | None = None,
    start: float | None = None,
    end: float | None = None,
    replace: bool = False,
) -> Plotted:
    """Draw the figures of a log.

    Args:
        log_path: a log, also a truncated one.
        out: file to write, PNG, SVG or PDF by its ending; ``figures.png`` beside the log by default, or the figure's
            own name when one was chosen.
        what: one figure by name, all on one page by default.
        start: of the window [s].
        end: of the window [s].
        replace: an existing file.

    Raises:
        LogError: the log cannot be read, the window is empty, there is no such figure, or the file exists or cannot be
            written.
    """
    out = out or log_path.parent / (f"{what}.png" if what else PAGE_NAME)
    format_of(out)
    refuse_existing(out, replace)
    log = read(log_path)
    view = LogView(log, start, end)
    header = _header(view, _verdict(log) if start is None and end is None else _part(log))
    figure = page(view, header) if what is None else single(view, header, what)
    save(figure, out, replace)
    return Plotted(out, _notes(log))


def _header(view: LogView, outcome: str) -> str:
    """Two lines: which run and its verdict, or how it ended; the stretch of time and what made it."""
    log = view.log
    try:
        scenario, seed, fidelity = (view.constant(name) for name in ("scenario", "seed", "fidelity"))
        name = f"{scenario}, seed {seed}, fidelity {fidelity}"
    except MissingError:
        name = shown(log.path.name)
    versions = log.metadata.get("versions", {})
    parts = (("surefoot", "surefoot"), ("git_revision", "revision"), ("mujoco", "mujoco"))
    made = [f"{label} {versions[part][:12]}" for part, label in parts if versions.get(part, ABSENT) not in ("", ABSENT)]
    window = f"{view.start:.3f} s to {view.end:.3f} s"
    return f"{name}: {outcome}\n{', '.join([window, *made])}".replace("$", r"\$")


def _verdict(log: Log) -> str:
    try:
        verdict = judge(log)
    except LogError:
        return "no verdict"
    first = f" ({shorten(verdict.reasons[0], _REASON)})" if verdict.reasons else ""
    return f"{'pass' if verdict.passed else 'fail'}{first}"


def _part(log: Log) -> str:
    """The end of a run of whose log only a part is looked at, so that nothing of it is judged."""
    end = log.metadata.get(END_RECORD, {})
    if not {"time", "kind"} <= end.keys():
        return "a part of the run"
    return f"a part of the run, which ended at {end['time'].rstrip('0').rstrip('.')} s: {end['kind']}"


def _notes(log: Log) -> tuple[str, ...]:
    truncated = (f"the file is truncated: it can be read up to {log.time_range()[1]:.3f} s",) if log.truncated else ()
    return (*truncated, *dict.fromkeys(log.damage))


_BOTH = (
    ("ZMP x [m]", "/contact", "zmp", 0),
    ("ZMP y [m]", "/contact", "zmp", 1),
    ("CoM x [m]", "/truth", "com", 0),
    ("CoM y [m]", "/truth", "com", 1),
    ("CoM z [m]", "/truth", "com", 2),
)
"""Curves that are drawn of two runs: label, topic, field and its component."""


def overlay(a: LogView, b: LogView, header: str, divergence: float | None) -> Figure:
    """Draw both runs on one page below a header, with a line where they part [s], None when they do not."""

    def both(axes: Axes, _: LogView, topic: str, name: str, axis: int) -> None:
        """Draw a channel of both runs; one that has not got it is left out, and named when neither has."""
        styles: dict[str, dict[str, Any]] = {
            "A": {"color": BLUE, "linewidth": 1.8},
            "B": {"color": VERMILION, "linewidth": 1.0, "linestyle": DASHED},
        }
        missing = []
        for view, (label, style) in zip((a, b), styles.items(), strict=True):
            try:
                curve(axes, view.time(topic), view.field(topic, name, 3)[:, axis], label, **style)
            except MissingError as absent:
                missing.append(absent)
        if len(missing) == len(styles):
            raise missing[0]

    panels = [
        Panel(label, partial(both, topic=topic, name=name, axis=axis), in_parts=False)
        for label, topic, name, axis in _BOTH
    ]
    with in_style():
        figure, (top, area) = canvas(_A3, (0.5, 9.5))
        top.text(0.01, 0.9, header, ha="left", va="top", fontsize=9, linespacing=1.4)
        axes = draw_panels(area, a, NOTHING, "Measured ZMP and true CoM of both runs", panels)
        axes[-1].set_xlim(min(a.start, b.start), max(a.end, b.end, a.start + 1e-3))
        for one in axes:
            if divergence is not None:
                one.axvline(divergence, color=BLACK, linewidth=0.8, linestyle=":", label="first divergence")
        legend(axes[0])
    return figure
