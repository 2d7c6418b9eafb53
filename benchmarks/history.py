"""The ratios, version by version: a committed file to which the command appends."""

import csv
import subprocess
from collections.abc import Mapping
from pathlib import Path

from surefoot.version import __version__

FILE = Path(__file__).with_name("history.csv")
COLUMNS = ("version", "commit", "date", "ratio", "value")


def append(ratios: Mapping[str, float], file: Path = FILE) -> None:
    """Add a row for each ratio, of the commit that is checked out."""
    commit, date = _git("rev-parse", "--short=12", "HEAD"), _git("show", "-s", "--format=%cs", "HEAD")
    new = not file.exists()
    with file.open("a", newline="") as opened:
        writer = csv.writer(opened, lineterminator="\n")
        if new:
            writer.writerow(COLUMNS)
        writer.writerows((__version__, commit, date, name, f"{value:.3g}") for name, value in ratios.items())


def _git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=FILE.parent, capture_output=True, text=True, check=True).stdout.strip()
