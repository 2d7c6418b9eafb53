"""Numbers of a page that somebody typed: those of its tables that stand in no generated block."""

import re
from collections.abc import Iterator
from typing import NamedTuple

_PLACE = re.compile(r"<!-- (table|sample|fall|value|site): [\w-]+ -->")
_UNITS = "%|°|mm|cm|m|us|ms|s|min|kB|MB|MiB|GB|kg|N|N·m|N m|N·s/kg|m/s|rad|deg|body weights|times"
_MEASURE = re.compile(rf"(?<![-\d.])\d+\.\d|\d ?(?:{_UNITS})(?![\w-])|\d of \d|\d to \d|\d,\d{{3}}")
"""A decimal number that is no version, one with a unit, so many of so many, a range, or thousands."""

_NUMBER = re.compile(r"(?<![\w.])\d+(?:,\d{3})*(?:\.\d+)?")


class Row(NamedTuple):
    """A row of a table, the heading that it stands under, and its numbers in order."""

    heading: str
    text: str
    numbers: tuple[float, ...]


def typed(text: str) -> Iterator[Row]:
    """Rows of a page's tables that have a number outside code, and outside what is generated."""
    heading, made, fenced = "", False, False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        if fenced:
            continue
        if line.startswith("#"):
            heading = line.lstrip("# ")
        if _PLACE.fullmatch(line):
            made = True
        if line.startswith("|") and not made and _MEASURE.search(bare := _bare(line)):
            yield Row(heading, line, tuple(float(one.replace(",", "")) for one in _NUMBER.findall(bare)))
        if line == "<!-- end -->":
            made = False


def _bare(line: str) -> str:
    """A row without code, addresses of links, and numbers that are generated within the line."""
    line = re.sub(rf"{_PLACE.pattern}.*?<!-- end -->", "", line)
    return re.sub(r"`[^`]*`|\]\([^)]*\)", "", line)
