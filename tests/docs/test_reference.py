"""The tables of the documentation follow from the code."""

import importlib.util
import re
from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from pydantic import BaseModel

from surefoot.planner.rules import RULES
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import PlannerSettings, Scenario, TerrainSettings, own_keys
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def reference():
    spec = importlib.util.spec_from_file_location("reference", ROOT / "docs" / "reference.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_tables_are_up_to_date(reference):
    for name, (page, table) in reference.TABLES.items():
        text = (ROOT / "docs" / page).read_text(encoding="utf-8")
        assert text == reference.updated(text, name, table()), f"{name}: run python docs/reference.py"
        assert table() in text, name


def test_the_campaign_of_the_rules_leaves_out_each(reference):
    """`make texts` writes its lines, also that of a rule that comes."""
    text = reference.RULES_CAMPAIGN.read_text(encoding="utf-8")
    grid = yaml.safe_load(text)["grid"]["mechanism"].values()
    assert [keys["planner.without"] for keys in grid if "planner.without" in keys] == [
        [rule.__name__] for rule in RULES
    ]
    assert reference.with_rules(text) == text, "run make texts"

    def waits(view):
        return view

    more = reference.with_rules(text, (*RULES, waits))
    assert "[retimes]}\n    rule waits: {planner.without: [waits]}\n    times and" in more


def test_a_table_that_is_typed_over_is_found(reference):
    page, table = reference.TABLES["heel-off"]
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    assert reference.updated(text.replace("| 0.6 | yes | 1.01 |", "| 0.6 | yes | 1.02 |"), "heel-off", table()) == text


def test_a_generated_table_has_a_maker(reference):
    for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")):
        for name in re.findall(r"(?m)^<!-- table: ([\w-]+) -->$", path.read_text(encoding="utf-8")):
            page, _ = reference.TABLES[name]
            assert (ROOT / "docs" / page).resolve() == path, name


def test_every_kept_result_says_what_made_it_and_is_shown(reference):
    """In its first two lines; by a table or a picture."""
    docs = ROOT / "docs"
    results, written = docs / "results", ("result_tables.py", "push_tables.py", "images/sources.py")
    makers = "".join((docs / name).read_text() for name in written)
    for path in results.glob("*.csv"):
        command, code, *_ = path.read_text(encoding="utf-8").splitlines()
        assert re.match(r"# (surefoot|python|make) ", command), path.name
        assert re.match(r"# (surefoot [\d.]+, source_digest|commits?) ", code), path.name
        assert f'"{path.stem}"' in makers or f"{path.name}" in makers, path.name


def test_campaigns_of_pages_can_be_read():
    for path in (ROOT / "docs" / "campaigns").glob("*.yaml"):
        assert read_campaign(str(path)).cells > 1, path.name


def test_numbers_that_follow_from_the_code_are_up_to_date(reference):
    texts = {page.name: page.read_text(encoding="utf-8") for page in reference.pages()}
    assert sum(text.count("<!-- value: chunk -->90 ms<!-- end -->") for text in texts.values()) == 3
    for name, text in texts.items():
        assert text == reference.with_values(text), f"{name}: run python docs/reference.py"


def test_a_killed_run_loses_no_more_than_the_pages_say(reference, tmp_path):
    """Chunks are as far apart as the number that the pages give, and a tick at most; the first is shorter."""
    spec, period = ChannelSpec("/x", "X", (FieldSpec("a"),)), float(reference.VALUES["chunk"].removesuffix(" ms"))
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        channel = writer.channel(spec)
        for tick in range(200):
            channel.append(tick * 2_000_000, 0.0)
    starts = [chunk.start_ns / 1e6 for chunk in read(tmp_path / "log.mcap").contents.chunks]
    assert len(starts) == 5
    first, *others = (b - a for a, b in pairwise(starts))
    assert 0.8 * period < first < period
    assert all(period <= apart <= period + 2.0 for apart in others)


def test_every_key_of_the_table_is_one_and_takes_its_default(reference):
    rows = re.findall(r"(?m)^\| `([\w.]+)` \| `(.*?)` \|", reference.keys_table())
    keys: dict = {}
    kinds = {"terrain": TerrainSettings, "planner": PlannerSettings}
    of_a_kind = {f"{group}.{name}" for group, model in kinds.items() for name, _ in own_keys(model)}
    for name, default in (row for row in rows if row[0] not in of_a_kind):
        *groups, last = name.split(".")
        group = keys
        for part in groups:
            group = group.setdefault(part, {})
        group[last] = yaml.safe_load(default)
    assert len(rows) > 90
    assert without_null_groups(Scenario.model_validate(keys)) == Scenario()


def without_null_groups(group):
    """A group of keys without the groups in it that are null as a whole by default."""
    changed = {}
    for name, field in type(group).model_fields.items():
        value = getattr(group, name)
        if isinstance(value, BaseModel):
            changed[name] = None if field.default is None else without_null_groups(value)
    return group.model_copy(update=changed)


@pytest.mark.parametrize("page", ["README.md", "docs/scenarios.md"])
def test_scenarios_of_the_documentation_load(page):
    examples = re.findall(r"(?s)```yaml\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"))
    assert examples
    for text in examples:
        read_scenario(text, "example.yaml", "example", (), Robots())


def test_the_faults_that_the_page_shows_are_those_that_are_found():
    page = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
    text = re.search(r"(?s)```yaml\n(.*?)```", page)[1].replace("steps: 6", "step: 6").replace("0.25", "0.9", 1)
    shown = re.search(r"(?s)```\n(pushed\.yaml:.*?)\n```", page)[1]
    with pytest.raises(ScenarioError) as refusal:
        read_scenario(text, "pushed.yaml", "pushed", (), Robots())
    assert str(refusal.value) == shown


def test_links_lead_somewhere():
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")):
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_index_has_every_page_with_a_line():
    folder = ROOT / "docs"
    text = (folder / "index.md").read_text(encoding="utf-8")
    listed = re.findall(r"(?m)^\| \[[^\]]+\]\(([\w./-]+\.md)\) \| \S.* \|$", text)
    assert sorted(listed) == sorted(
        {path.relative_to(folder).as_posix() for path in folder.rglob("*.md") if path.parent.name != "decisions"}
        - {"index.md"}
        | {"decisions/index.md"}
    )


def test_the_index_of_the_decisions_has_every_record():
    folder = ROOT / "docs" / "decisions"
    text = (folder / "index.md").read_text(encoding="utf-8")
    listed = re.findall(r"(?m)^\| \[[^\]]+\]\(([\w-]+\.md)\) \| \S.* \|$", text)
    assert listed == sorted(path.name for path in folder.glob("*.md") if path.name != "index.md")
    for name in listed:
        record = (folder / name).read_text(encoding="utf-8")
        assert re.findall(r"(?m)^## (.*)$", record) == ["Decision", "What else was considered", "Why"], name
