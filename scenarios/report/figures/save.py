"""A figure to a file, in the format of the file's ending."""

from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from scenarios.errors import LogError
from scenarios.report.figures.style import in_style

_DPI = 150
_UNDATED: dict[str, dict[str, Any]] = {
    "png": {},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
}
"""Formats, and what keeps the day of drawing out of them, so that the same log gives the same file."""


def format_of(out: Path) -> str:
    """Format by a file's ending.

    Raises:
        LogError: no figure can be written in it.
    """
    ending = out.suffix.lower().removeprefix(".")
    if ending not in _UNDATED:
        raise LogError(f"{out}: figures are written as .png, .svg or .pdf; end the file's name with one of them")
    return ending


def save(figure: Figure, out: Path) -> None:
    """Write a figure.

    Raises:
        LogError: the ending is none of a figure, or the file cannot be written.
    """
    kind, drawn = format_of(out), BytesIO()
    with in_style():
        figure.savefig(drawn, format=kind, dpi=_DPI, metadata=_UNDATED[kind])
    try:
        out.write_bytes(drawn.getvalue())
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise LogError(f"{out}: cannot be written, {reason}; choose another file with --out") from None
