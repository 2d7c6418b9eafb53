"""Every command line on the pages can be given: its command, its options and its keys are there."""

import re
import shlex
from functools import cache
from itertools import chain, pairwise
from pathlib import Path

import pytest
import typer
import yaml

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.show.options import keys
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.shipped import shipped

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PAGES = (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")))
LINES = [
    (page.name, re.split(r"  |\s+#|\s*\\?\|", line)[0])
    for page in PAGES
    for line in re.findall(r"(?m)(?:^(?:\$ )?|`)(surefoot(?: [^`\n]*)?)(?:$|`)", page.read_text(encoding="utf-8"))
]
COMMANDS = typer.main.get_command(app)


@cache
def axes(campaign):
    """Axes of a campaign that comes along, which --set can fix too."""
    return set(read_campaign(campaign).axes) if campaign in shipped() else set()


def options(command):
    return {name for parameter in command.params for name in parameter.opts} | {"-h", "--help"}


def faults(line):
    """Parts of a command line that are not there."""
    _, *words = shlex.split(line)
    command = COMMANDS if not words or words[0].startswith("-") else COMMANDS.commands.get(words[0])
    if isinstance(command, typer.core.TyperGroup) and command is not COMMANDS and words[1:]:
        _, *words = words
        command = command.commands.get(words[0])
    if command is None:
        return [words[0]]
    given = [word for text in words for word in re.findall(r"^-[\w-]+", text.strip("()[]"))]
    known = {re.sub(r"\.\d+", "", key) for key, _ in keys(Scenario)}
    known |= axes("".join(words[1:2])) if words[:1] == ["sweep"] else set()
    settings = [text.partition("=")[0] for before, text in pairwise(words) if before == "--set"]
    return [word for word in given if word not in options(command)] + [key for key in settings if key not in known]


@pytest.mark.parametrize(("page", "line"), sorted(set(LINES)))
def test_a_command_line_can_be_given(page, line):
    assert faults(line) == []


def test_the_workflow_of_a_ci_server_gives_commands_that_are_there():
    (text,) = re.findall(
        r"(?s)```yaml\n(# \.github/.*?)```", (ROOT / "docs" / "checking.md").read_text(encoding="utf-8")
    )
    workflow = yaml.safe_load(text)
    steps = workflow["jobs"]["check"]["steps"]
    lines = [step["run"] for step in steps if "run" in step]
    assert [line.split()[0] for line in lines] == ["pip", "surefoot", "cat"]
    assert faults(lines[1]) == []
    assert all({"run", "uses"} & set(step) for step in steps)
    (kept,) = [step["with"]["path"] for step in steps if step.get("if") == "failure()"]
    options = shlex.split(lines[1])
    assert kept.split() == [options[options.index(name) + 1] for name in ("--out", "--junit")]


def test_what_is_not_there_is_found():
    assert len(LINES) > 50
    assert faults("surefoot swep x") == ["swep"]
    assert faults("surefoot robot chek x.yaml") == ["chek"]
    assert faults("surefoot robot check x.yaml --wak") == ["--wak"]
    assert faults("surefoot compare A B --exit-cod") == ["--exit-cod"]
    assert faults("surefoot run walk-level --set gait.stride=3 --seed 3") == ["gait.stride"]
    assert faults("surefoot sweep push-map --set phase=x --set phases=x") == ["phases"]
    assert faults("surefoot run push-map --set phase=x") == ["phase"]


def test_keys_that_the_pages_set_are_there():
    known = {*dict(keys(Scenario)), *chain.from_iterable(map(axes, shipped()))}
    for page in PAGES:
        for key in re.findall(r"--set [\"']?([a-z_.]+)=", page.read_text(encoding="utf-8")):
            assert key in known, f"{page.name}: {key}"
