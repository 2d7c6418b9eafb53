"""The layout file: every panel is placed, what it shows exists in a log, and Foxglove publishes the names in it."""

import importlib
import json
import re
from pathlib import Path

import pytest
import yaml

from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes

pytestmark = pytest.mark.unit

LAYOUT = Path(__file__).parents[3] / "docs" / "foxglove-layout.json"
PUBLISHED = yaml.safe_load(Path(__file__).with_name("foxglove_published.yaml").read_text())
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


def groups(layout):
    """Each group of a panel's configuration with the kind by which its fields are published."""
    for name, config in layout["configById"].items():
        kind = name.partition("!")[0]
        yield kind, config
        yield from ((f"{kind}.paths", path) for path in config.get("paths", []))
        for inner in ("cameraState", "scene"):
            yield from [(f"{kind}.{inner}", config[inner])] if inner in config else []
        yield from (
            (f"{kind}.{inner}", one) for inner in ("topics", "layers") for one in config.get(inner, {}).values()
        )
        yield from [(f"{kind}.scene.transforms", config["scene"]["transforms"])] if "scene" in config else []


def unknown(layout):
    older = PUBLISHED["older"]
    return [
        f"{kind}.{field}"
        for kind, group in groups(layout)
        for field in group
        if field not in PUBLISHED["panels"][kind] and field not in older.get(kind, ())
    ]


def test_every_setting_of_a_panel_is_one_that_foxglove_publishes(layout):
    assert {kind for kind, _ in groups(layout)} == set(PUBLISHED["panels"])
    assert unknown(layout) == []


def test_what_a_fork_calls_otherwise_has_its_present_name_too(layout):
    transforms = layout["configById"]["3D!walk"]["scene"]["transforms"]
    assert transforms["axisSize"] == transforms["axisScale"]


def test_a_setting_that_nobody_knows_is_found():
    layout = {"configById": {"3D!walk": {"scene": {"transforms": {"axisLength": 1}}}, "Plot!x": {"line": 1}}}
    assert unknown(layout) == ["3D.scene.transforms.axisLength", "Plot.line"]


@pytest.mark.parametrize("name", PUBLISHED["messages"])
def test_messages_of_a_log_have_the_fields_that_foxglove_publishes(name):
    message = getattr(importlib.import_module(f"foxglove_schemas_protobuf.{name}_pb2"), name)
    assert sorted(field.name for field in message.DESCRIPTOR.fields) == sorted(PUBLISHED["messages"][name])
