"""Runs beside those before them, as the markdown of a pull request shows them: two pictures, and three channels."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from surefoot.scenarios.check.beside import Beside
from surefoot.scenarios.check.check import Checked
from surefoot.scenarios.check.lines import Commit
from surefoot.scenarios.output import shown

_WIDTH = 360
"""Greatest width of a picture on a page [px]; a narrow page shows both smaller, beside each other."""


@dataclass(frozen=True, slots=True)
class Gallery:
    """Place of the pictures of a history, as a reader of the markdown sees it.

    Attributes:
        address: of the history's folder, without a slash at its end; empty where no history is kept.
    """

    address: str = ""

    @classmethod
    def of(cls, history: Path | None, markdown: Path | None, address: str | None) -> "Gallery":
        """The place by its address, or else by the way from the markdown file to the history's folder."""
        if history is None or markdown is None:
            return cls()
        way = os.path.relpath(history, markdown.parent)
        return cls(address.rstrip("/") if address else quote(shown(Path(way).as_posix())))

    def markdown(self, one: Checked) -> list[str]:
        """Lines on a run that is not as it should be, with the last one beside it that was."""
        return [] if one.passed or one.beside is None or not self.address else [*self._beside(one, one.beside)]

    def note(self, checked: Sequence[Checked]) -> list[str]:
        """A line where a run has moved and there is no history that could show how."""
        red = any(not one.passed and (one.moves or one.partings) for one in checked)
        what = "No pictures: `surefoot check --history FOLDER` keeps how runs moved, to show one beside another."
        return [what, ""] if red and not self.address else []

    def _beside(self, one: Checked, held: Beside) -> Iterator[str]:
        before = f"last good: {Commit(held.commit).short}" if held.commit else "last good"
        if held.pictures:
            yield "<table>"
            heads = (f'<th width="50%">{word}</th>' for word in (before, "now"))
            yield f"<tr>{''.join(heads)}</tr>"
            name = one.case.scenario.name
            cells = (
                self._picture(*each) for each in zip(held.pictures, (f"{name} before", f"{name} now"), strict=True)
            )
            yield f"<tr>{''.join(cells)}</tr>"
            yield "</table>\n"
            yield f"Both at {held.time:.3f} s, by one camera.\n"
        elif held.note:
            yield f"{held.note[:1].upper()}{held.note[1:]}.\n"
        if held.channels:
            yield "Channels that part first, from the last good run to this one:\n"
            yield from (f"{number}. {_channel(text)}" for number, text in enumerate(held.channels, 1))
            yield ""

    def _picture(self, path: str, alt: str) -> str:
        return f'<td><img src="{self.address}/{quote(path)}" alt="{alt}" width="{_WIDTH}"></td>'


def _channel(text: str) -> str:
    """A channel's text with its place as code."""
    place, at, rest = text.partition(" at ")
    return f"`{place}`{at}{rest}"
