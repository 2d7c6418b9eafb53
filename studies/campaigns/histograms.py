"""Stacked histograms of a campaign's page: what was drawn and measured, of runs that passed and that failed."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from surefoot.scenarios.file.search import MOST
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.palette import BLACK, FAIL, GREY, PASS, hexadecimal
from surefoot.scenarios.show.kit.figures import DASHED, in_style, note
from surefoot.scenarios.show.kit.html import escape, tag
from surefoot.scenarios.show.kit.svg import svg

ROUNDING, TINY = 1e-9, 1e-100
"""Values that differ by less, as a share of the greatest or at all, are drawn as the same."""

COLORS = {"met": hexadecimal(PASS), "missed": hexadecimal(FAIL)}
_SIZE = (2.8, 1.7)
"""Width and height of a picture [in]."""
_LETTERS = 42
"""Letters of the texts below an axis that have room beside each other."""


class Histogram(NamedTuple):
    """Values of a quantity of passing and of failing runs, and the bounds that it had to keep."""

    name: str
    passed: Sequence[Any]
    failed: Sequence[Any]
    bounds: Sequence[float] = ()


def histograms_html(spreads: Sequence[Histogram], caption: str, name: str) -> str:
    """A histogram of each quantity, with a legend and a caption, below an anchor."""
    legend = "".join(tag("span", word, style=f"--color: {color}") for word, color in COLORS.items())
    pictures = "\n".join(tag("div", svg(picture(spread)), role="img", aria_label=spread.name) for spread in spreads)
    parts = (tag("div", legend, kind="legend"), tag("div", pictures, kind="panels"), tag("figcaption", escape(caption)))
    return tag("figure", "\n".join(parts), id=name, kind="histograms")


def picture(spread: Histogram) -> Figure:
    """The histogram of a quantity; of words where not all its values are numbers."""
    with in_style():
        figure = Figure(figsize=_SIZE, layout="constrained")
        axes = figure.add_subplot()
        axes.yaxis.set_major_locator(MaxNLocator("auto", integer=True, min_n_ticks=1))
        if all(map(is_number, (*spread.passed, *spread.failed))):
            _of_numbers(axes, spread)
        else:
            _of_words(axes, spread)
        axes.set_xlabel(spread.name.replace("$", r"\$"))
    return figure


def _of_numbers(axes: Axes, spread: Histogram) -> None:
    groups = [[float(one) for one in group if abs(one) <= MOST] for group in (spread.passed, spread.failed)]
    shown = [*groups[0], *groups[1]]
    bounds = [float(bound) for bound in spread.bounds if abs(bound) <= MOST]
    edges: list[float] = []
    if shown:
        edges = np.linspace(*_range(shown), min(max(5, round(len(shown) ** 0.5)), 24) + 1).tolist()
        axes.hist(groups, edges, stacked=True, color=list(COLORS.values()), rwidth=0.98)
    for bound in bounds:
        axes.axvline(bound, color=BLACK, linestyle=DASHED, linewidth=0.8)
    low, high = _range([*edges, *bounds])
    axes.set_xlim(low - 0.03 * (high - low), high + 0.03 * (high - low))
    axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    beyond = len(spread.passed) + len(spread.failed) - len(shown)
    if beyond:
        axes.set_title(f"{beyond} values beyond all bounds", color=GREY, style="italic", fontsize=7.5)
    elif not shown:
        note(axes, "no value")


def _of_words(axes: Axes, spread: Histogram) -> None:
    passed, failed = ([str(value) for value in group] for group in (spread.passed, spread.failed))
    names = sorted({*passed, *failed})
    places = range(len(names))
    below = [passed.count(name) for name in names]
    axes.bar(places, below, 0.6, color=COLORS["met"])
    axes.bar(places, [failed.count(name) for name in names], 0.6, below, color=COLORS["missed"])
    every = -(-len(names) * (2 + max(map(len, names))) // _LETTERS)
    axes.set_xticks(places[::every], [name.replace("$", r"\$") for name in names[::every]])
    axes.margins(x=0.1)


def _range(values: Sequence[float]) -> tuple[float, float]:
    """From the least to the greatest of some values; wider where they are the same, and any where there is none."""
    low, high = min(values, default=0.0), max(values, default=0.0)
    if high - low > max(ROUNDING * max(abs(low), abs(high)), TINY):
        return low, high
    middle = 0.5 * (low + high)
    aside = 0.05 * abs(middle) if abs(middle) > TINY else 0.5
    return middle - aside, middle + aside
