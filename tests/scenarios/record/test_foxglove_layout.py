"""The layout file: every panel is placed, and what it shows exists in a log."""

import json
import re
from pathlib import Path

import pytest

from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes

pytestmark = pytest.mark.unit

LAYOUT = Path(__file__).parents[3] / "docs" / "foxglove-layout.json"
SIZES = Sizes(nj=25, nq=32, nv=31, horizon=50)
MAKERS = (
    *(channels.measurement, channels.truth, channels.estimate, channels.contact, channels.reference),
    *(channels.wbc, channels.torque, channels.timing),
)


@pytest.fixture(scope="module")
def layout():
    return json.loads(LAYOUT.read_text())


def placed(node):
    return {node} if isinstance(node, str) else placed(node["first"]) | placed(node["second"])


def test_every_panel_is_placed_once(layout):
    assert placed(layout["layout"]) == set(layout["configById"])


def test_every_plotted_path_is_an_element_of_a_channel(layout):
    shapes = {(spec.topic, f.name): f.shape for spec in (make(SIZES) for make in MAKERS) for f in spec.fields}
    paths = [path["value"] for panel in layout["configById"].values() for path in panel.get("paths", [])]
    assert len(paths) > 10
    for path in paths:
        topic, field, index = re.fullmatch(r"(/\w+)\.(\w+)(?:\[(\d+)\])?", path).groups()
        shape = shapes[topic, field]
        assert shape == () if index is None else int(index) < shape[0]


def test_the_3d_panel_shows_the_topics_that_are_drawn(layout):
    topics = layout["configById"]["3D!walk"]["topics"]
    assert set(topics) == {"/scene/world", "/scene/points", "/scene/forces", "/scene/support"}
