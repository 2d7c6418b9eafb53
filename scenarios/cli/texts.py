"""What commands tell of the package's own parts, as text beside this file: to make it takes half a second.

`python docs/told.py` writes it, and a test holds it against the sources.
"""

import json
from pathlib import Path

FOLDER = Path(__file__).with_name("told")


def text(name: str) -> str:
    """A text: ``schema``, or as `told`."""
    return (FOLDER / f"{name}.json").read_text(encoding="utf-8")


def told(name: str) -> dict[str, str]:
    """What is said of each: of keys of a scenario by their dotted names (``meanings``), or of metrics (``metrics``)."""
    said: dict[str, str] = json.loads(text(name))
    return said
