"""Histograms of a campaign's page show every run once, at its place, and texts that can be read."""

from itertools import pairwise
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_hex

from surefoot.studies.campaigns.histograms import COLORS, Histogram, histograms_html, picture

pytestmark = pytest.mark.unit

NUMBERS = st.floats(-1e100, 1e100) | st.floats(-10.0, 10.0) | st.integers(-20, 20)
GROUP = st.lists(NUMBERS, max_size=30)


def axes_of(*spread):
    return picture(Histogram("q [m]", *spread)).axes[0]


def height(axes, word):
    return sum(bar.get_height() for bar in axes.patches if to_hex(bar.get_facecolor()) == COLORS[word].lower())


@given(passed=GROUP, failed=GROUP, bounds=st.lists(NUMBERS, max_size=3))
def test_bars_count_every_run_once_and_lie_within_the_axes(passed, failed, bounds):
    axes = axes_of(passed, failed, bounds)
    assert height(axes, "met") == len(passed) and height(axes, "missed") == len(failed)
    (low, high), (floor, top) = axes.get_xlim(), axes.get_ylim()
    for bar in axes.patches:
        assert low <= bar.get_x() and bar.get_x() + bar.get_width() <= high
        assert floor <= bar.get_y() and bar.get_y() + bar.get_height() <= top
    assert len(axes.lines) == len(bounds)
    assert all(low <= line.get_xdata()[0] <= high for line in axes.lines)


@pytest.mark.parametrize(
    "values",
    [
        pytest.param([0.04, 0.065], id="small"),
        pytest.param([15.0, 60.0], id="tens"),
        pytest.param([-1.0, 1.0], id="signs"),
        pytest.param([1e6, 1e6 + 1e-3], id="beside each other"),
        pytest.param([f"terrain-number-{number}" for number in range(12)], id="words"),
    ],
)
def test_no_text_runs_into_the_next(values):
    figure = picture(Histogram("q [m]", values, []))
    figure.draw_without_rendering()
    extents = [label.get_window_extent() for label in figure.axes[0].get_xticklabels()]
    shown = [one for one in extents if figure.axes[0].bbox.x0 <= 0.5 * (one.x0 + one.x1) <= figure.axes[0].bbox.x1]
    assert len(shown) > 1
    assert all(left.x1 <= right.x0 for left, right in pairwise(shown))


def test_what_has_no_value_says_so_and_shows_its_bound():
    axes = axes_of([], [], [0.5])
    assert [text.get_text() for text in axes.texts] == ["no value"]
    assert [line.get_xdata()[0] for line in axes.lines] == [0.5]


def test_values_that_no_axis_shows_are_counted():
    axes = axes_of([1.0, 1e300], [float("nan"), float("inf")])
    assert axes.get_title() == "3 values beyond all bounds"
    assert (height(axes, "met"), height(axes, "missed")) == (1, 0)


def test_words_have_a_bar_each():
    axes = axes_of(["flat", "<stairs>", "$x$"], ["flat"])
    bars = [(round(bar.get_x(), 6), bar.get_height()) for bar in axes.patches if bar.get_height()]
    assert len(bars) == 4 and len({place for place, _ in bars}) == 3
    assert [label.get_text() for label in axes.get_xticklabels()] == [r"\$x\$", "<stairs>", "flat"]


def test_the_page_has_a_picture_of_each_and_what_the_colours_mean():
    page = ElementTree.fromstring(histograms_html([Histogram("a", [1], []), Histogram("b", [], [2])], "said", "here"))
    names = [one.get("aria-label") for one in page.iter("div") if one.get("role") == "img"]
    assert names == ["a", "b"] and page.get("id") == "here"
    assert [span.text for span in page.iter("span")] == ["met", "missed"]
