"""Sentences of a Markdown page: what a reader reads in one breath, without tables, code and equations."""

import re
from collections.abc import Iterator

LIMIT = 30
"""Words of the longest sentence that a page may have."""

ABBREVIATIONS = ("e.g", "i.e", "cf", "vs", "approx", "eq", "eqs", "fig", "figs", "no", "resp", "etc", "al", "et")
_ABBREVIATED = re.compile(rf"(?:^|[\s(])(?:(?i:{'|'.join(map(re.escape, ABBREVIATIONS))})|(?<!\d )[A-Z])\.$")
"""The last word is an abbreviation, or an initial and no unit."""

_FENCE = re.compile(r"^\s*(```+|~~~+)")
_ITEM = re.compile(r"^\s*(?:[-*+]|\d+[.)])\s+")
_END = re.compile(r"(?<!\.)[.!?][\"')\]]*(?=\s|$)")
"""The end of a sentence; dots that stand for what goes on end none."""


def paragraphs(text: str) -> Iterator[str]:
    """Paragraphs, items of lists and headings, each in one line, code spans and links as one word or as their words."""
    lines: list[str] = []
    for line in [*_prose(text), ""]:
        stripped = line.strip()
        begins = bool(_ITEM.match(line)) or stripped.startswith(("#", ">"))
        if (not stripped or begins) and lines:
            yield _plain(" ".join(lines))
            lines = []
        if stripped:
            lines.append(_ITEM.sub("", stripped) if _ITEM.match(line) else stripped.lstrip("#> "))
        if stripped.startswith("#"):
            yield _plain(lines.pop())


def sentences(text: str) -> Iterator[str]:
    """Sentences of a page; a colon or a semicolon ends none."""
    for paragraph in paragraphs(text):
        begin = 0
        for end in _END.finditer(paragraph):
            if not _ABBREVIATED.search(paragraph[begin : end.start() + 1]):
                yield paragraph[begin : end.end()].strip()
                begin = end.end()
        if paragraph[begin:].strip():
            yield paragraph[begin:].strip()


def words(sentence: str) -> int:
    """Number of words of a sentence: what has a letter or a digit in it and stands between spaces."""
    return sum(any(letter.isalnum() for letter in word) for word in sentence.split())


def too_long(text: str) -> list[str]:
    """Sentences of a page with more than LIMIT words."""
    return [sentence for sentence in sentences(text) if words(sentence) > LIMIT]


def _prose(text: str) -> Iterator[str]:
    """Lines that are neither of a table, nor of code, nor of an equation; an empty line stands for each of those."""
    fence = ""
    for line in re.sub(r"(?s)<!--.*?-->|\$\$.*?\$\$", " ", text).splitlines():
        found = _FENCE.match(line)
        if fence:
            fence = "" if found and found[1].startswith(fence) else fence
            yield ""
        elif found:
            fence = found[1]
            yield ""
        else:
            yield "" if line.lstrip().startswith("|") else line


def _plain(text: str) -> str:
    """A text without marks: a code span, a picture's address and an equation are one word each."""
    text = re.sub(r"(`+)(?!`).+?(?<!`)\1(?!`)", "code", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\$[^$]+\$", "equation", text)
    return re.sub(r"<[^>]+>|\*\*|(?<!\w)[*_]|[*_](?!\w)", "", text)
