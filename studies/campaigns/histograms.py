"""Stacked histograms of a campaign's page, as SVG: a page has twenty, which matplotlib takes a second to draw."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.palette import FAIL, PASS, hexadecimal
from surefoot.scenarios.show.kit.html import escape, tag
from surefoot.studies.campaigns.spec import MOST

ROUNDING, TINY = 1e-9, 1e-100
"""Values that differ by less, as a share of the greatest or at all, are drawn as the same."""

WIDTH, HEIGHT = 276, 168
LEFT, RIGHT, TOP, BOTTOM = 34, 268, 10, 128
"""A picture, and the edges of what is drawn in it [px]."""
LETTER = 6
"""Width of a letter [px]."""
COLORS = {"met": hexadecimal(PASS), "missed": hexadecimal(FAIL)}
THINNEST = 2.0
"""Width of a bar that would be seen as none [px]."""


class Histogram(NamedTuple):
    """Values of a quantity of passing and of failing runs, and the bounds that it had to keep."""

    name: str
    passed: Sequence[Any]
    failed: Sequence[Any]
    bounds: Sequence[float] = ()


_Tick = tuple[float, str]
"""A value and its text."""


class _Bar(NamedTuple):
    """A bar over a range: how many passed, and how many failed."""

    low: float
    high: float
    passed: int
    failed: int


def histograms_html(spreads: Sequence[Histogram], caption: str, name: str) -> str:
    """A histogram of each quantity, with a legend and a caption, below an anchor."""
    legend = "".join(tag("span", word, style=f"--color: {color}") for word, color in COLORS.items())
    pictures = "\n".join(map(_picture, spreads))
    parts = (tag("div", legend, kind="legend"), tag("div", pictures, kind="panels"), tag("figcaption", escape(caption)))
    return tag("figure", "\n".join(parts), id=name, kind="histograms")


def _picture(spread: Histogram) -> str:
    values = [*spread.passed, *spread.failed]
    shown = _of_numbers(spread, values) if all(map(is_number, values)) else _of_words(spread, values)
    heading = _text(0.5 * (LEFT + RIGHT), HEIGHT - 8, spread.name, kind="name")
    return tag("svg", shown + heading, role="img", aria_label=spread.name, viewBox=f"0 0 {WIDTH} {HEIGHT}")


def _of_numbers(spread: Histogram, values: Sequence[Any]) -> str:
    groups = [[float(one) for one in group if abs(one) <= MOST] for group in (spread.passed, spread.failed)]
    shown = [*groups[0], *groups[1]]
    edges = _edges(shown) if shown else []
    counts = [np.histogram(group, edges)[0].tolist() if shown else [] for group in groups]
    bars = [_Bar(*one) for one in zip(edges[:-1], edges[1:], *counts, strict=True)]
    bounds = [float(bound) for bound in spread.bounds if abs(bound) <= MOST]
    low, high = _range([*edges, *bounds])
    aside = 0.03 * (high - low)
    axis = _Axis(low - aside, high + aside)
    marks = (_line(axis.at(bound), TOP, axis.at(bound), BOTTOM, "bound") for bound in bounds)
    beyond, said = len(values) - len(shown), ""
    if beyond or not values:
        said = f"{beyond} values beyond all bounds" if values else "no value"
    note = _text(0.5 * (LEFT + RIGHT), 0.5 * (TOP + BOTTOM), said, kind="note") if said else ""
    return _drawn(axis, bars, axis.ticks()) + "".join(marks) + note


def _of_words(spread: Histogram, values: Sequence[Any]) -> str:
    passed, failed = (Counter(map(str, group)) for group in (spread.passed, spread.failed))
    names = sorted({str(value) for value in values})
    bars = [_Bar(at - 0.3, at + 0.3, passed[name], failed[name]) for at, name in enumerate(names)]
    return _drawn(_Axis(-0.6, len(names) - 0.4), bars, _with_room(list(enumerate(names))))


class _Axis(NamedTuple):
    """The range of what is drawn from left to right."""

    low: float
    high: float

    def at(self, value: float) -> float:
        """Where a value is [px]."""
        return LEFT + (RIGHT - LEFT) * ((value - self.low) / (self.high - self.low))

    def ticks(self) -> Sequence[_Tick]:
        """Round values in the range, with their texts."""
        step, places = _round_values(self.low, self.high)
        digits = 1 + math.floor(math.log10(max(map(abs, places)) or step)) - math.floor(math.log10(step))
        texts = [f"{place:.{max(digits, 6)}g}".replace("-", "\N{MINUS SIGN}") for place in places]
        return _with_room(list(zip(places, texts, strict=True)))


def _drawn(axis: _Axis, bars: Sequence[_Bar], ticks: Sequence[_Tick]) -> str:
    """The axes with their ticks, and the bars in them."""
    most = max((bar.passed + bar.failed for bar in bars), default=1)
    up = (BOTTOM - TOP) / (1.05 * most)
    parts = []
    for value, said in ticks:
        at = axis.at(value)
        parts += [_line(at, TOP, at, BOTTOM), _text(at, BOTTOM + 14, said)]
    for count in _round_values(0.0, max(1.05 * most, 5.0))[1]:
        level = BOTTOM - up * count
        if level >= TOP:
            parts += [_line(LEFT, level, RIGHT, level), _text(LEFT - 5, level + 4, f"{count:.0f}", kind="count")]
    for bar in bars:
        left, right = axis.at(bar.low), axis.at(bar.high)
        wide = max(right - left - 0.5, THINNEST)
        for count, below, color in ((bar.passed, 0, COLORS["met"]), (bar.failed, bar.passed, COLORS["missed"])):
            if count:
                place = f'x="{0.5 * (left + right - wide):.1f}" y="{BOTTOM - up * (below + count):.1f}"'
                parts.append(f'<rect {place} width="{wide:.1f}" height="{up * count:.1f}" fill="{color}"/>')
    return "".join((*parts, f'<path d="M{LEFT} {TOP}V{BOTTOM}H{RIGHT}"/>'))


def _with_room(ticks: Sequence[_Tick]) -> Sequence[_Tick]:
    """Every tick, or every so manieth, so that no text runs into the next."""
    widest = LETTER * (2 + max(len(text) for _, text in ticks))
    return ticks[:: -(-len(ticks) * widest // (RIGHT - LEFT))]


def _line(x: float, y: float, right: float, bottom: float, kind: str = "") -> str:
    return tag("path", "", d=f"M{x:.1f} {y:.1f}L{right:.1f} {bottom:.1f}", kind=kind or "grid")


def _text(x: float, y: float, text: str, kind: str = "") -> str:
    return tag("text", escape(text), x=f"{x:.1f}", y=f"{y:.1f}", kind=kind)


def _round_values(low: float, high: float) -> tuple[float, list[float]]:
    """A step of 1, 2 or 5 times a power of ten, and its multiples in a range, of which there are two to six."""
    rough = (high - low) / 5
    decade = 10.0 ** math.floor(math.log10(rough))
    step = next(times * decade for times in (1, 2, 5, 10) if times == 10 or times * decade >= rough)
    return step, [number * step for number in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _edges(values: Sequence[float]) -> list[float]:
    """Edges of the bins of a histogram; values that differ by rounding alone stand in the middle of a wider range."""
    count = min(max(5, round(len(values) ** 0.5)), 24)
    return [float(edge) for edge in np.linspace(*_range(values), count + 1)]


def _range(values: Sequence[float]) -> tuple[float, float]:
    """From the least to the greatest of some values; wider where they are the same, and any where there is none."""
    low, high = min(values, default=0.0), max(values, default=0.0)
    if high - low > max(ROUNDING * max(abs(low), abs(high)), TINY):
        return low, high
    middle = 0.5 * (low + high)
    aside = 0.05 * abs(middle) if abs(middle) > TINY else 0.5
    return middle - aside, middle + aside
