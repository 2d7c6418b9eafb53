"""What is written on a video: which run it is, its clock, and what the colours mean."""

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from surefoot.scenarios.palette import WHITE
from surefoot.scenarios.show.replay.content import Replay

Image = NDArray[np.uint8]

_LINES, _LEAST = 45.0, 8.0
"""Lines of text in the height, or in two thirds of the width if that is less; the size of the smallest letters [px]."""

_ONE_ROW = 75.0
"""Letters' sizes in the width of a picture in which the whole legend has room beside each other."""

_PLATE: dict[str, Any] = {"facecolor": WHITE, "alpha": 0.7, "linewidth": 0, "boxstyle": "square,pad=0.3"}


class Caption:
    """Writes onto the pictures of one video."""

    def __init__(self, replay: Replay, size: tuple[int, int], speed: float) -> None:
        """Draw what stays.

        Args:
            replay: what is shown.
            size: width and height of the pictures [px].
            speed: of the video over that of the run.
        """
        self._size, self._text = size, max(min(size[1], 2 * size[0] / 3) / _LINES, _LEAST)
        still = self._sheet()
        still.text(*self._corner(0.0), replay.title, ha="left", va="top", fontsize=1.2 * self._text, bbox=_PLATE)
        marks = [Line2D([], [], marker="o", linestyle="", color=c, label=name) for name, c in replay.legend().items()]
        if marks:
            self._legend(still, marks)
        self._still, self._speed = _drawn(still), "" if speed == 1.0 else f"  {speed:g}x"
        self._moving = self._sheet()
        look: dict[str, Any] = {
            "ha": "right",
            "va": "top",
            "fontsize": 1.2 * self._text,
            "family": "monospace",
            "bbox": _PLATE,
        }
        self._clock = self._moving.text(*self._corner(1.0), "", **look)

    def drawn_on(self, picture: Image, time: float) -> Image:
        """A picture with what is written on it, at a time of the run [s]; shape (height, width, 3)."""
        self._clock.set_text(f"{time:7.3f} s{self._speed}")
        for sheet in (self._still, _drawn(self._moving)):
            rows = np.flatnonzero(sheet[..., 3].any(axis=1))
            written = slice(rows[0], rows[-1] + 1) if len(rows) else slice(0)
            share = sheet[written, :, 3:].astype(np.float32) / 255.0
            picture[written] = (1.0 - share) * picture[written] + share * sheet[written, :, :3]
        return picture

    def _sheet(self) -> Figure:
        """An empty figure of which a point is a pixel."""
        width, height = self._size
        figure = Figure(figsize=(width / 72.0, height / 72.0), dpi=72, facecolor="none")
        FigureCanvasAgg(figure)
        return figure

    def _corner(self, side: float) -> tuple[float, float]:
        width, height = self._size
        inset = self._text
        return (inset + side * (width - 2 * inset)) / width, 1.0 - inset / height

    def _legend(self, figure: Figure, marks: list[Line2D]) -> None:
        plate: dict[str, Any] = {"facecolor": WHITE, "edgecolor": "none", "framealpha": 0.7, "fancybox": False}
        spaces: dict[str, Any] = {"borderaxespad": 1.0, "borderpad": 0.3, "handletextpad": 0.0, "columnspacing": 0.8}
        columns = len(marks) if self._size[0] > _ONE_ROW * self._text else 4
        look = {"markerscale": self._text / 12.0, "prop": FontProperties(size=0.85 * self._text), **plate, **spaces}
        figure.legend(handles=marks, loc="lower left", ncols=columns, **look)


def _drawn(figure: Figure) -> Image:
    """Red, green, blue and opacity of a figure, shape (height, width, 4)."""
    canvas: Any = figure.canvas  # of matplotlib's untyped part
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()).copy()
