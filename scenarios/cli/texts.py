"""Texts of commands on the package's own parts, in files beside this one: to make them takes half a second.

`python docs/texts.py` writes them, and a test holds them against the sources.
"""

import json
from pathlib import Path

FOLDER = Path(__file__).with_name("generated")


def text(name: str) -> str:
    """A text: ``schema``, ``meanings`` or ``metrics``."""
    return (FOLDER / f"{name}.json").read_text(encoding="utf-8")


def entries(name: str) -> dict[str, str]:
    """Texts by name: on keys of a scenario by their dotted names (``meanings``), or on metrics (``metrics``)."""
    said: dict[str, str] = json.loads(text(name))
    return said
