"""Pages that the site generates have a place for every key, metric, channel, command and public name."""

import importlib.util
import re
import sys
from importlib import import_module
from pathlib import Path

import pytest
import typer
from dotted import named

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.show.options import keys

pytestmark = pytest.mark.unit

SITE = Path(__file__).parents[2] / "docs" / "site"


def module(name):
    spec = importlib.util.spec_from_file_location(name, SITE / f"{name}.py")
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded
    spec.loader.exec_module(loaded)
    return loaded


@pytest.fixture(scope="module")
def generated():
    return module("generated")


@pytest.fixture(scope="module")
def build(generated):
    return module("build")


@pytest.fixture(scope="module")
def texts(build):
    return build.texts()


def headings(text):
    return re.findall(r"(?m)^##+ `?([^`\n]+)`?", text)


def test_every_key_and_metric_has_a_heading_of_its_own(texts):
    told = [name.replace("[]", "") for name in headings(texts["reference/keys.md"])]
    assert len(told) == len(set(told))
    leaves = {name for name, _ in keys(Scenario)}
    groups = {name.rpartition(".")[0] for name in leaves} | {"gait.footsteps", "gait.velocity", "gait.waypoints"}
    assert leaves - set(told) <= groups | {"criteria.min", "criteria.max", "criteria.equals", "errors.ground"}
    assert len(set(told) & leaves) > 180
    assert headings(texts["reference/metrics.md"]) == sorted(OWN)


def test_a_key_is_told_with_default_unit_and_range(texts):
    (said,) = re.findall(r"(?s)### `gait.steps`\n\n(.*?)\n\n###", texts["reference/keys.md"])
    assert said.startswith("Footsteps to take [-].") and "Default `5`" in said and "at least 0" in said
    (said,) = re.findall(r"(?s)### `fidelity`\n\n(.*?)\n\n###", texts["reference/keys.md"])
    assert "one of `full`, `pendulum`" in said


def test_every_command_is_there_with_its_options(texts):
    page = texts["reference/commands.md"]
    for name, command in typer.main.get_command(app).commands.items():
        assert f"## `surefoot {name}" in page
        for parameter in getattr(command, "params", ()):
            assert parameter.opts[0] in page or parameter.name.upper() in page


def test_every_public_name_has_a_heading_and_is_told_once(generated, texts):
    told = [name for text in texts.values() for name in re.findall(r"\.\. auto\w+:: (\S+)", text)]
    assert len(told) == len(set(told))
    objects = [id(named(name)) for name in told if not name.endswith("PROFILES")]
    assert len(objects) == len(set(objects))
    for face in generated.FACES:
        page = texts[f"reference/{face.rpartition('.')[2]}.md"] + texts["reference/errors.md"]
        for name in import_module(face).__all__:
            assert name.startswith("__") or f"\n## {name}\n" in page, f"{face}.{name}"


def test_every_page_is_in_the_contents_once(build, texts):
    listed = []
    for page, text in texts.items():
        folder = page.rpartition("/")[0]
        for block in re.findall(r"(?s)```{toctree}\n(.*?)```", text):
            listed += [f"{folder}/{name}".strip("/") for name in block.split() if name.endswith(".md")]
    assert sorted(listed) == sorted(set(texts) - {"index.md"})


@pytest.mark.parametrize(
    ("page", "link", "led"),
    [
        ("log.md", "viewers.md", "viewers.md"),
        ("licences.md", "../LICENSE", "project/licence.md"),
        ("whole-body.md", "../examples/own_task.py", "examples.md#own_taskpy"),
        ("decisions/index.md", "../log.md", "../log.md"),
        ("project/contributing.md", "docs/decisions/index.md", "../decisions/index.md"),
        ("project/contributing.md", "CHANGELOG.md", "changelog.md"),
    ],
)
def test_links_that_lead_out_of_the_folder_lead_to_a_page(build, page, link, led):
    assert build.led(page, link) == led
