"""Elements of pages: whatever stands in them, a table has its rows and cells, and a text is a text."""

from html.parser import HTMLParser

import pytest

from surefoot.scenarios.show.kit.html import PageTable, TableCell, details, section, tally

pytestmark = pytest.mark.unit


class Elements(HTMLParser):
    """Elements in order, each with its attributes and the text that stands in it alone."""

    def __init__(self, text):
        super().__init__()
        self.open, self.found = [], []
        self.feed(text)
        assert not self.open, "an element that does not end"

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes), []))
        self.open.append(self.found[-1])

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open:
            self.open[-1][2].append(data)

    def of(self, tag):
        return [("".join(text), attributes) for name, attributes, text in self.found if name == tag]


TEXT = "<b> & \"c\" 'd'"


def test_a_table_has_a_cell_for_each_column_and_a_heading_across_all():
    table = PageTable("t", ("a [m]", TEXT), ["group", (TableCell(TEXT, "number bad", 0.1 + 0.2, "below"), "<i>x</i>")])
    found = Elements(table.html)
    assert [text for text, _ in found.of("th")] == ["a [m]", TEXT, "group"]
    assert found.of("th")[2][1]["colspan"] == "2"
    (cell, attributes), (other, _) = found.of("td")
    assert (cell, other) == (TEXT, "")
    assert attributes["class"] == "number bad"
    assert float(attributes["data-value"]) == 0.1 + 0.2
    assert found.of("small") == [("below", {})]
    assert found.of("i") == [("x", {})]
    assert found.of("table")[0][1] == {"id": "t"}


def test_a_note_stands_below_its_table_and_nothing_where_there_is_none():
    assert not Elements(PageTable("t", ("a",), []).html).of("p")
    (note,) = Elements(PageTable("t", ("a",), [], "why").html).of("p")
    assert note == ("why", {"class": "note"})


def test_a_section_leaves_out_what_is_empty():
    found = Elements(section(TEXT, "", "<p>x</p>", "", name="anchor"))
    assert found.of("h2") == [(TEXT, {"id": "anchor"})]
    assert [tag for tag, *_ in found.found] == ["section", "h2", "p"]


def test_boxes_and_details_take_any_text():
    found = Elements(tally([("3", TEXT), (TEXT, "runs")]))
    assert [text for text, _ in found.of("b")] == ["3", TEXT]
    assert [text for text, _ in found.of("span")] == [TEXT, "runs"]
    assert Elements(details(TEXT, "<p>x</p>")).of("summary") == [(TEXT, {})]
