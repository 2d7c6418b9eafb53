"""Texts beside a viewer's picture neither break the viewer's page nor are broken by any text."""

import json
import re

import pytest

from surefoot.scenarios.show.replay.page import filled, taken_in

pytestmark = pytest.mark.unit

TEMPLATE = '<b>@title</b><script id=d type="application/json">@data</script><i>`${x}` costs $5</i>'


def test_data_come_out_of_the_script_as_they_went_in():
    data = {"name": "</script><b>", "values": [1.5, None]}
    text = filled(TEMPLATE, data, title="<u>t</u>")
    assert text.count("</script>") == 1
    (told,) = re.findall(r'json">(.*)</script>', text)
    assert json.loads(told) == data
    assert text.startswith("<b><u>t</u></b>")
    assert text.endswith("<i>`${x}` costs $5</i>")


def test_a_name_that_is_not_given_or_a_number_that_is_none_is_an_error():
    with pytest.raises(KeyError, match="title"):
        filled(TEMPLATE, {})
    with pytest.raises(ValueError, match="JSON"):
        filled(TEMPLATE, {"x": float("nan")}, title="")


def test_a_viewers_page_keeps_all_that_it_had():
    page = "<html><head><meta></head><body><p>'</body>'</p></body></html>"
    text = taken_in(page, "<title>t</title>", "<aside>")
    assert text == "<html><head><title>t</title><meta></head><body><p>'</body>'</p><aside></body></html>"
