"""HTML pages that are whole without a network: their elements, figures and look."""

import html
import re
from importlib.resources import files
from io import StringIO
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.typing import RcKeyType

from surefoot.scenarios.show.figures.style import in_style

MISSING = "–"
"""Stands where there is no number."""
_PIXELS = 98
"""Of a page for an inch of a figure: one of 11.6 in is as wide as the text."""


def number(value: float | None, scale: float = 1.0, digits: int = 3) -> str:
    """A number with some significant digits."""
    if value is None:
        return MISSING
    shown = scale * value
    text = f"{shown:.0f}" if abs(shown) >= 10 ** (digits - 1) else f"{shown:.{digits}g}"
    return text.replace("-", "\N{MINUS SIGN}")


def escape(text: str) -> str:
    """Text for HTML."""
    return html.escape(text, quote=True)


def tag(name: str, content: str, **attributes: str) -> str:
    """An element; ``kind`` is its class, content is HTML."""
    named = {"class" if key == "kind" else key.replace("_", "-"): value for key, value in attributes.items() if value}
    inside = "".join(f' {key}="{escape(value)}"' for key, value in named.items())
    return f"<{name}{inside}>{content}</{name}>"


def document(title: str, body: str) -> str:
    """A whole page.

    Args:
        title: of the window.
        body: HTML.
    """
    style = (files(__package__) / "page.css").read_text(encoding="utf-8")
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}\n<style>\n{style}</style></head>\n'
        f"<body><main>\n{body}\n</main></body></html>\n"
    )


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
