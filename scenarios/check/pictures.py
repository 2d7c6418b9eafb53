"""Runs beside those before them, as the markdown of a pull request shows them: two pictures, and three channels."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

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

    def markdown(self, checked: Sequence[Checked]) -> list[str]:
        """Lines on each run that is not as it should be, with the last one beside it that was."""
        red = [one for one in checked if not one.passed and one.now is not None]
        lines = [line for one in red for line in self._beside(one)]
        if red and not self.address:
            lines.append(
                "No pictures: `surefoot check --history FOLDER` keeps how runs moved, to show one beside another.\n"
            )
        return lines

    def _beside(self, one: Checked) -> Iterator[str]:
        name, held = one.case.scenario.name, one.beside
        if not self.address or (held is None and not one.moves and not one.partings):
            return
        yield f"#### {name}"
        yield ""
        if held is None:
            yield "No pictures: the history has no run before that is another.\n"
            return
        before = f"last good: {Commit(held.commit).short}" if held.commit else "last good"
        if held.pictures:
            pictures = (
                self._picture(path, f"{name}, {what}")
                for path, what in zip(held.pictures, (before, "now"), strict=True)
            )
            yield f"| {before} | now |"
            yield "|---|---|"
            yield f"| {' | '.join(pictures)} |"
            yield ""
            yield f"Both at {held.time:.3f} s, by one camera.\n"
        elif held.note:
            yield f"{held.note[:1].upper()}{held.note[1:]}.\n"
        if held.channels:
            yield "Channels that part first, from the last good run to this one:\n"
            yield from (f"{number}. {_channel(text)}" for number, text in enumerate(held.channels, 1))
            yield ""

    def _picture(self, path: str, alt: str) -> str:
        return f'<img src="{self.address}/{quote(path)}" alt="{alt}" width="{_WIDTH}">'


def _channel(text: str) -> str:
    """A channel's text with its place as code."""
    place, at, rest = text.partition(" at ")
    return f"`{place}`{at}{rest}".replace("|", "\\|")
