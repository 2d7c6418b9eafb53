"""HTML pages that are whole without a network: their elements and look."""

import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.resources import files

MISSING = "–"
"""Stands where there is no number."""


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
    """A whole page: the title of its window, and its body, HTML."""
    style = (files(__package__) / "page.css").read_text(encoding="utf-8")
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}\n<style>\n{style}</style></head>\n'
        f"<body><main>\n{body}\n</main></body></html>\n"
    )


def section(title: str, *parts: str, name: str = "") -> str:
    """A section of a page: its heading, with an anchor if it has a name, and its parts, empty ones left out."""
    return tag("section", "\n".join((tag("h2", escape(title), id=name), *filter(None, parts))))


def tally(boxes: Iterable[tuple[str, str]]) -> str:
    """Numbers in boxes beside each other, each with what it counts."""
    shown = (tag("div", tag("b", escape(count)) + tag("span", escape(what))) for count, what in boxes)
    return tag("div", "".join(shown), kind="tally")


def details(summary: str, content: str, name: str = "") -> str:
    """Content that opens below its summary."""
    return tag("details", tag("summary", escape(summary)) + content, id=name)


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell of a table: its text, CSS classes, the number in SI behind the text, and a second, quiet line."""

    text: str
    kind: str = ""
    value: float | None = None
    below: str = ""

    @property
    def html(self) -> str:
        """The element."""
        value = "" if self.value is None else repr(self.value)
        below = tag("small", escape(self.below)) if self.below else ""
        return tag("td", escape(self.text) + below, kind=self.kind, data_value=value)


TableRow = Sequence[TableCell | str]
"""Cells; one that is a text is HTML."""


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table of a page.

    Attributes:
        name: its anchor.
        head: of its columns, with units.
        rows: of cells; a text is the heading of the rows below it.
        note: below it, HTML of a sentence or two.
        kind: CSS classes.
    """

    name: str
    head: Sequence[str]
    rows: Sequence[TableRow | str]
    note: str = ""
    kind: str = ""

    @property
    def html(self) -> str:
        """The element; it can be scrolled where it is wider than the page."""
        top = tag("tr", "".join(tag("th", escape(text), scope="col") for text in self.head))
        body = f"<thead>{top}</thead>\n<tbody>\n" + "\n".join(map(self._row, self.rows)) + "\n</tbody>"
        note = tag("p", self.note, kind="note") if self.note else ""
        return tag("div", tag("table", body, kind=self.kind, id=self.name), kind="wide") + note

    def _row(self, row: TableRow | str) -> str:
        if isinstance(row, str):
            heading = tag("th", escape(row), scope="rowgroup", colspan=str(len(self.head)))
            return tag("tr", heading, kind="group")
        return tag("tr", "".join(tag("td", cell) if isinstance(cell, str) else cell.html for cell in row))
