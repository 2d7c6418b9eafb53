"""The look of figures, the thinning of curves, and the saving of both."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.typing import RcKeyType
from numpy.typing import NDArray

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.palette import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, Color
from surefoot.scenarios.show.logview import MissingError

Area = Figure | SubFigure

CYCLE = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, BLACK, SKY, GREY)
"""Colours of curves that are of the same quantity."""

_RC: dict[RcKeyType, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.ymargin": 0.1,
    "axes.xmargin": 0.0,
    "grid.color": "#C8C8C8",
    "grid.linewidth": 0.4,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "legend.borderpad": 0.0,
    "legend.columnspacing": 1.4,
    "legend.labelspacing": 0.3,
    "lines.linewidth": 1.1,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "svg.hashsalt": "surefoot",
    "path.simplify": True,
}


@contextmanager
def in_style() -> Iterator[None]:
    """Draw and save in the style of these figures; what matplotlib was set to before comes back afterwards."""
    with matplotlib.rc_context(_RC):
        yield


def canvas(width: float, heights: Sequence[float]) -> tuple[Figure, list[SubFigure]]:
    """An empty figure of a width, and its rows of some heights [in], laid out without overlap."""
    figure = Figure(figsize=(width, sum(heights)), layout=ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.05))
    rows = figure.subfigures(len(heights), 1, height_ratios=list(heights), squeeze=False)
    return figure, list(rows[:, 0])


PAGE_WIDTH = 11.6
"""Width of a figure that is as wide as a page's text [in]."""


def panels(
    count: int, most: int, height: float, projection: str | None = None, width: float = PAGE_WIDTH
) -> tuple[Figure, list[Axes]]:
    """An empty figure of panels of one size, laid out without overlap.

    Args:
        count: of panels.
        most: beside each other.
        height: of each [in].
        projection: of each, such as ``polar``.
        width: of a row with as many as may be beside each other [in].
    """
    columns = min(count, most)
    rows = -(-count // columns)
    size = (max(width * columns / most, 4.2), rows * height + 0.3)
    figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.06))
    every = list(figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": projection}).ravel())
    for one in every[count:]:
        one.set_visible(False)
    return figure, every[:count]


def heading(area: Area, title: str) -> None:
    """Name a family of figures."""
    area.suptitle(title, x=0.01, ha="left", fontsize=10, fontweight="bold")


BUCKETS = 800
"""Stretches of a curve of which the least and the greatest value are kept: about one per pixel."""


def curve(
    axes: Axes,
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    label: str | None,
    color: Color,
    buckets: int = BUCKETS,
    **style: Any,
) -> None:
    """Draw a curve over time, thinned to some buckets without losing an extreme; shapes (n,).

    Of a curve that is drawn in parts each gets its share of the buckets of all the axes. Parts behind the first have
    its label behind an underscore, which keeps them out of the legend.
    """
    first, last = axes.get_xlim()
    share = (time[-1] - time[0]) / (last - first) if len(time) and last > first else 1.0
    rows = kept(values, max(math.ceil(buckets * min(share, 1.0)), 1))
    if label in {line.get_label() for line in axes.lines}:
        label = f"_{label}"
    axes.plot(time[rows], values[rows], color=color, label=label, **style)


DASHED = (0, (4, 2))
"""Line style of what should be."""


def reference_curve(
    axes: Axes,
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    label: str | None,
    color: Color,
    buckets: int = BUCKETS,
) -> None:
    """Draw what a curve should be: thin, dashed, on top."""
    curve(axes, time, values, label, color, buckets, linestyle=DASHED, linewidth=0.7, zorder=3)


def legend(axes: Axes, columns: int = 4, handles: Sequence[Artist] = ()) -> None:
    """Put the legend above the axes, outside the data."""
    drawn, labels = axes.get_legend_handles_labels()
    found = {str(handle.get_label()): handle for handle in reversed(handles)}
    found |= dict(zip(reversed(labels), reversed(drawn), strict=True))  # of what was drawn in parts the first
    if found:
        every, names = [*reversed(found.values())], [*reversed(found)]
        axes.legend(every, names, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns)


@contextmanager
def or_say(axes: Axes) -> Iterator[None]:
    """Draw in axes, or write into them what the log has not got."""
    try:
        yield
    except MissingError as missing:
        note(axes, f"not in this log: {missing}")


def note(axes: Axes, text: str) -> None:
    """Write a note into axes that stay empty."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY, style="italic")
    axes.set_yticks([])


_DPI = 150
_UNDATED: dict[str, dict[str, Any]] = {
    "png": {},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
}
"""Formats, and what keeps the day of drawing out of them, so that the same log gives the same file."""


def format_of(out: Path) -> str:
    """Format by a file's ending.

    Raises:
        LogError: no figure can be written in it.
    """
    ending = out.suffix.lower().removeprefix(".")
    if ending not in _UNDATED:
        raise LogError(f"{out}: figures are written as .png, .svg or .pdf; end the file's name with one of them")
    return ending


def save(figure: Figure, out: Path, replace: bool = False) -> None:
    """Write a figure.

    Raises:
        LogError: the ending is none of a figure, or the file exists or cannot be written.
    """
    kind, drawn = format_of(out), BytesIO()
    with in_style():
        figure.savefig(drawn, format=kind, dpi=_DPI, metadata=_UNDATED[kind])
    with write_whole(out, replace) as temporary:
        temporary.write_bytes(drawn.getvalue())


def kept(values: NDArray[np.float64], buckets: int = BUCKETS) -> NDArray[np.intp]:
    """Rows of a curve to draw: of each bucket the first, the least, the greatest and a gap, and the last of all.

    Args:
        values: shape (n,); NaN where the curve has a gap.
        buckets: into which the rows are divided.

    Returns:
        ascending rows, at most 4 per bucket and one more; all of them when there are no more than that.
    """
    n = len(values)
    if n <= 4 * buckets:
        return np.arange(n)
    size = -(-n // buckets)
    padded = np.full(buckets * size, np.nan)
    padded[:n] = values
    table = padded.reshape(buckets, size)
    gaps = np.isnan(table)
    picks = (
        np.zeros(buckets, np.intp),
        np.argmin(np.where(gaps, np.inf, table), axis=1),
        np.argmax(np.where(gaps, -np.inf, table), axis=1),
        np.argmax(gaps, axis=1),
    )
    rows = np.unique(np.concatenate([[n - 1], *(np.arange(buckets) * size + pick for pick in picks)]))
    return rows[rows < n]


def kept_of_path(points: NDArray[np.float64]) -> NDArray[np.intp]:
    """Rows of a path in the plane to draw, shape (n, 2) of points: the extremes of both coordinates."""
    return np.union1d(kept(points[:, 0]), kept(points[:, 1]))


def steps(*bounds: NDArray[np.float64]) -> NDArray[np.intp]:
    """Rows at which any of several piecewise constant curves changes, with the first and the last row."""
    table = np.stack(bounds, axis=1)
    changed = np.flatnonzero(np.any(table[1:] != table[:-1], axis=1)) + 1
    rows = np.unique(np.concatenate([[0], changed, [len(table) - 1]]))
    return rows.astype(np.intp)
