"""What a histogram of a campaign's page shows: every run once, at its place, and texts that can be read."""

import re
from itertools import pairwise
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.studies.campaigns.histograms import COLORS, LETTER, Histogram, histograms_html

pytestmark = pytest.mark.unit

NUMBERS = st.floats(-1e100, 1e100) | st.floats(-10.0, 10.0) | st.integers(-20, 20)
GROUP = st.lists(NUMBERS, max_size=30)


def drawn(*spread):
    return ElementTree.fromstring(histograms_html([Histogram("q [m]", *spread)], "said", "here"))


def height(page, word):
    return sum(float(bar.get("height")) for bar in page.iter("rect") if bar.get("fill") == COLORS[word])


@given(passed=GROUP, failed=GROUP, bounds=st.lists(NUMBERS, max_size=3))
def test_bars_are_as_high_as_there_are_runs_and_lie_within_the_axes(passed, failed, bounds):
    page = drawn(passed, failed, bounds)
    total, met = len(passed) + len(failed), height(page, "met")
    whole = met + height(page, "missed")
    assert met == pytest.approx(whole * len(passed) / max(total, 1), abs=0.05 * (total + 1))
    assert (whole == 0.0) == (total == 0)
    for bar in page.iter("rect"):
        left, top, wide, high = (float(bar.get(name)) for name in ("x", "y", "width", "height"))
        assert left >= 33.0 and left + wide <= 269.0 and wide >= 1.9 and top >= 10.0 and top + high <= 128.2


@given(passed=GROUP, failed=st.just([]), bounds=st.lists(NUMBERS, max_size=3))
def test_no_text_runs_into_the_next(passed, failed, bounds):
    page = drawn(passed, failed, bounds)
    ticks = [(float(one.get("x")), one.text) for one in page.iter("text") if one.get("class") is None]
    assert ticks
    for (left, text), (right, after) in pairwise(ticks):
        assert right - left >= 0.5 * LETTER * (len(text) + len(after))


def test_what_has_no_value_says_so_and_shows_its_bound():
    page = drawn([], [], [0.5])
    assert [one.text for one in page.iter("text") if one.get("class") == "note"] == ["no value"]
    assert sum(one.get("class") == "bound" for one in page.iter("path")) == 1


def test_values_that_no_axis_shows_are_counted():
    page = drawn([1.0, 1e300], [float("nan"), float("inf")])
    assert [one.text for one in page.iter("text") if one.get("class") == "note"] == ["3 values beyond all bounds"]
    assert height(page, "missed") == 0.0 < height(page, "met")


def test_words_have_a_bar_each():
    page = drawn(["flat", "<stairs>"], ["flat"])
    bars = [(bar.get("x"), bar.get("fill")) for bar in page.iter("rect")]
    assert len(bars) == 3 and len({at for at, _ in bars}) == 2
    assert [one.text for one in page.iter("text") if one.get("class") is None] == ["<stairs>", "flat"]


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        pytest.param([0.04, 0.065], ["0.04", "0.045", "0.05", "0.055", "0.06", "0.065"], id="small"),
        pytest.param([15.0, 60.0], ["20", "30", "40", "50", "60"], id="tens"),
        pytest.param([-1.0, 1.0], ["−1", "−0.5", "0", "0.5", "1"], id="signs"),
    ],
)
def test_ticks_are_round_numbers(values, texts):
    found = [one.text for one in drawn(values, []).iter("text") if one.get("class") is None]
    assert found == texts[:: -(-len(texts) // len(found))]
    assert re.search(r"e\+0", " ".join(found)) is None
