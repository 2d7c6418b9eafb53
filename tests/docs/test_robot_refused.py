"""Quotes in docs/how-to/robot-refused.md are what refusals say."""

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "how-to" / "robot-refused.md").read_text(encoding="utf-8")
ROWS = re.findall(r"(?m)^\| (`.*?) \| ", TEXT.split("| the message says |")[1])
PLACES = ("models", "scenarios/setup", "apps/robots")


def quoted(rows):
    return [words for row in rows for words in re.findall(r"`([^`]+)`", row)]


def said(words):
    """Return true if words stand in a source, one after another, also where its line ends in between."""
    pattern = re.compile(r"(?:\s|\"\s*f?\")+".join(map(re.escape, words.split())))
    return any(
        pattern.search(path.read_text(encoding="utf-8")) for place in PLACES for path in (ROOT / place).rglob("*.py")
    )


def test_every_message_that_is_quoted_is_said_by_the_code():
    assert len(ROWS) >= 15
    assert [words for words in quoted(ROWS) if not said(words)] == []


def test_words_that_nobody_says_are_found():
    assert not said("has feet of clay")
    assert said("has no face that points down")
