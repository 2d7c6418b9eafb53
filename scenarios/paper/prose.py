"""What the page says beside its numbers, section by section; the words themselves are in ``sections.yaml``."""

from dataclasses import dataclass
from importlib.resources import files

import yaml


@dataclass(frozen=True, slots=True)
class Section:
    """A section of the page.

    Attributes:
        name: its anchor.
        title: its heading.
        text: paragraphs, as HTML.
        points: entries of a list below them, as HTML.
    """

    name: str
    title: str
    text: tuple[str, ...]
    points: tuple[str, ...] = ()


def sections() -> tuple[Section, ...]:
    """All sections in the order of the page."""
    entries = yaml.safe_load((files(__package__) / "sections.yaml").read_text(encoding="utf-8"))
    return tuple(
        Section(entry["name"], entry["title"], tuple(entry["text"]), tuple(entry.get("points", ())))
        for entry in entries
    )
