"""One page of all figures of a log, or a single one of them."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from scenarios.errors import LogError, nearest
from scenarios.report.figures import balance, feet, height, solver, top_view, torques
from scenarios.report.figures.shading import Background, background
from scenarios.report.figures.style import Area, canvas, in_style
from scenarios.report.logview import LogView

Draw = Callable[[Area, LogView, Background], None]

_A3, _A4 = 11.7, 8.3
_HEADER = 0.75


@dataclass(frozen=True, slots=True)
class Family:
    """A family of figures.

    Attributes:
        draw: how.
        size: width and height when it stands alone [in].
        over_time: whether its axes are of time, with what happened behind them.
    """

    draw: Draw
    size: tuple[float, float]
    over_time: bool = True


FIGURES: dict[str, Family] = {
    "balance": Family(balance.draw, (_A3, 6.0)),
    "top-view": Family(top_view.draw, (_A3, 5.5), over_time=False),
    "height": Family(height.draw, (_A4, 4.5)),
    "feet": Family(feet.draw, (_A4, 4.5)),
    "torques": Family(torques.draw, (_A4, 6.0)),
    "solver": Family(solver.draw, (_A3, 4.5)),
}
"""The families of figures by name."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the page: its height [in] and the figures in it."""

    height: float
    names: tuple[str, ...]


_COMPACT = (
    Row(5.1, ("balance",)),
    Row(3.6, ("top-view", "height")),
    Row(3.9, ("feet", "torques")),
    Row(3.3, ("solver",)),
)
_WIDE = (
    Row(4.5, ("balance",)),
    Row(2.0, ("top-view",)),
    Row(3.1, ("height", "feet")),
    Row(3.1, ("torques",)),
    Row(3.1, ("solver",)),
)


def page(view: LogView, header: str) -> Figure:
    """Draw all figures on one page, A3 wide."""
    rows = _WIDE if top_view.is_wide(view) else _COMPACT
    heights = [_HEADER, *(row.height for row in rows)]
    with in_style():
        figure, areas = canvas(_A3, heights)
        behind = background(view)
        _head(areas[0], header, behind, 11.0)
        for area, row in zip(areas[1:], rows, strict=True):
            for part, name in zip(area.subfigures(1, len(row.names), squeeze=False)[0], row.names, strict=True):
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
        figure, (top, area) = canvas(width, (_HEADER, tall))
        behind = background(view) if FIGURES[name].over_time else Background((), (), None)
        _head(top, header, behind, 9.0)
        FIGURES[name].draw(area, view, behind)
    return figure


def _head(area: Area, header: str, behind: Background, size: float) -> None:
    """What the log is, and what the shades behind all curves over time mean."""
    area.text(0.01, 0.98, header, ha="left", va="top", fontsize=size, linespacing=1.4)
    area.legend(handles=behind.handles(), loc="lower left", bbox_to_anchor=(0.004, 0.0), ncols=4)
