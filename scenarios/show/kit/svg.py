"""Figures as elements of a page."""

import re
from io import StringIO
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.typing import RcKeyType

from surefoot.scenarios.show.kit.figures import in_style
from surefoot.scenarios.show.kit.html import escape, tag

_PIXELS = 98
"""Pixels of a page for an inch of a figure: one of 11.6 in is as wide as the text."""


def figure_html(figure: Figure, caption: str, name: str = "", kind: str = "") -> str:
    """A figure with its caption, below an anchor; a narrow one stays narrow, so that letters are as large in all."""
    shown = (
        f'<svg role="img" aria-label="{escape(caption)}" style="max-width: {_PIXELS * figure.get_figwidth():.0f}px" '
    )
    picture = svg(figure).replace("<svg ", shown, 1)
    return tag("figure", f"{picture}\n{tag('figcaption', escape(caption))}", id=name, kind=kind)


def svg(figure: Figure) -> str:
    """A figure as an SVG element for a page: no prolog, no metadata, words as words."""
    drawn = StringIO()
    words: dict[RcKeyType, Any] = {
        "svg.fonttype": "none",
        "font.sans-serif": ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans"],
    }
    with in_style(), matplotlib.rc_context(words):
        figure.savefig(drawn, format="svg", metadata={"Date": None})
    text = drawn.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    return re.sub(r'<svg ([^>]*?)width="[^"]*" height="[^"]*"|<svg height="[^"]*"', r"<svg \1", text, count=1)
