"""Numbers and HTML as text."""

import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from surefoot.scenarios.paper.results import Spread

MISSING = "–"
"""Stands where there is no number."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table.

    Attributes:
        text: as shown.
        kind: CSS classes.
        value: the number behind the text, in SI units; None for words.
        below: a second, quiet line.
    """

    text: str
    kind: str = ""
    value: float | None = None
    below: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the page.

    Attributes:
        name: its anchor.
        head: column heads, with units.
        groups: heading, which may be empty, and rows of cells.
        note: below it, a sentence or two.
    """

    name: str
    head: tuple[str, ...]
    groups: tuple[tuple[str, tuple[tuple[Cell, ...], ...]], ...]
    note: str = ""

    @property
    def rows(self) -> tuple[tuple[Cell, ...], ...]:
        """All rows of cells."""
        return tuple(row for _, rows in self.groups for row in rows)


def number(value: float | None, scale: float = 1.0, digits: int = 3) -> str:
    """A number with some significant digits."""
    if value is None:
        return MISSING
    shown = scale * value
    text = f"{shown:.0f}" if abs(shown) >= 10 ** (digits - 1) else f"{shown:.{digits}g}"
    return text.replace("-", "\N{MINUS SIGN}")


def spread_text(spread: Spread | None, scale: float = 1.0, digits: int = 3) -> str:
    """A median, with its range where that is another text."""
    if spread is None:
        return MISSING
    between = _range(spread, scale, digits)
    return number(spread.median, scale, digits) + (f" ({between})" if between else "")


def spread_cell(spread: Spread | None, scale: float = 1.0, kind: str = "number") -> Cell:
    """The same as a cell, the range below the median."""
    if spread is None:
        return Cell(MISSING, kind)
    return Cell(number(spread.median, scale), kind, spread.median, _range(spread, scale, 3))


def words(text: str, kind: str = "") -> Cell:
    """A cell of words."""
    return Cell(text, kind)


def escape(text: str) -> str:
    """Text for HTML."""
    return html.escape(text, quote=True)


def tag(name: str, content: str, **attributes: str) -> str:
    """An element; ``kind`` is its class, content is HTML."""
    named = {"class" if key == "kind" else key.replace("_", "-"): value for key, value in attributes.items() if value}
    inside = "".join(f' {key}="{escape(value)}"' for key, value in named.items())
    return f"<{name}{inside}>{content}</{name}>"


def table_html(table: Table) -> str:
    """A table as HTML."""
    head = tag("tr", "".join(tag("th", escape(text), scope="col") for text in table.head))
    body = "\n".join(_group_html(heading, rows, len(table.head)) for heading, rows in table.groups)
    whole = tag("table", f"<thead>{head}</thead>\n<tbody>\n{body}\n</tbody>", id=table.name)
    return tag("div", whole, kind="wide") + (tag("p", table.note, kind="note") if table.note else "")


def paragraphs(texts: Iterable[str]) -> str:
    """Paragraphs of HTML."""
    return "\n".join(tag("p", text) for text in texts)


def listing(entries: Sequence[str]) -> str:
    """A list of HTML entries."""
    return tag("ul", "".join(tag("li", entry) for entry in entries))


def _group_html(heading: str, rows: Iterable[tuple[Cell, ...]], width: int) -> str:
    lines = [tag("tr", "".join(_cell_html(cell) for cell in row)) for row in rows]
    if heading:
        lines.insert(0, tag("tr", tag("th", escape(heading), scope="rowgroup", colspan=str(width)), kind="group"))
    return "\n".join(lines)


def _cell_html(cell: Cell) -> str:
    value = "" if cell.value is None else repr(cell.value)
    below = tag("small", escape(cell.below)) if cell.below else ""
    return tag("td", escape(cell.text) + below, kind=cell.kind, data_value=value)


def _range(spread: Spread, scale: float, digits: int) -> str:
    """Least and greatest value; empty when both read the same."""
    least, greatest = number(spread.least, scale, digits), number(spread.greatest, scale, digits)
    return "" if least == greatest else f"{least} … {greatest}"
