"""Sentences of the documentation are short enough to be read once."""

from pathlib import Path

import pytest
from sentences import LIMIT, sentences, too_long, words

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PAGES = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))
LONG = " ".join(["word"] * (LIMIT + 1))


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md", *PAGES])
def test_no_sentence_is_too_long(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    assert sum(1 for _ in sentences(text)) >= 5
    assert too_long(text) == [], f"more than {LIMIT} words"


@pytest.mark.parametrize(
    "text",
    [
        f"Short. {LONG}. Short.",
        f"- An item\n  {LONG}\n- Another",
        f"1. {LONG}",
        f"> {LONG}",
        f"## {LONG}",
        f"It has, e.g. {LONG}.",
        f"See `a. b` and [{LONG}](page.md). Short.",
        f"**Bold.** {LONG}; more.",
        "\n".join(["word"] * (LIMIT + 1)),
        f"| a |\n|---|\n| b |\n{LONG}",
        f"```\ncode\n```\n{LONG}",
    ],
)
def test_a_sentence_that_is_too_long_is_found(text):
    assert len(too_long(text)) == 1


@pytest.mark.parametrize(
    "text",
    [
        f"| {LONG} |\n|---|\n| {LONG} |",
        f"```\n{LONG}\n```",
        f"~~~yaml\n{LONG}\n~~~",
        f"$$\n{LONG}\n$$",
        f"<!-- {LONG} -->",
        f"A key `{LONG}` is one word.",
        f"An equation ${LONG}$ is one word.",
        "It has half.\n\n- " + " ".join(["word"] * (LIMIT // 2)) + "\n- " + " ".join(["word"] * (LIMIT // 2)),
        " ".join(["word"] * (LIMIT // 2)) + " in 5 N. It " + " ".join(["word"] * (LIMIT // 2)),
    ],
)
def test_what_is_no_sentence_and_what_is_short_is_left_alone(text):
    assert too_long(text) == []


def test_where_a_sentence_ends():
    text = "One, cf. M. Kasaei, eq. (5). `code.py` is two (see 3.5). Lengths 0.5, 0.55, ... were four! Is it? Yes"
    assert list(sentences(text)) == [
        "One, cf. M. Kasaei, eq. (5).",
        "code is two (see 3.5).",
        "Lengths 0.5, 0.55, ... were four!",
        "Is it?",
        "Yes",
    ]
    assert words("ZMP minus its reference: 3.73 mm - and `x`") == 8
