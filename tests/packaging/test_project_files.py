"""Files about the project: workflows that only call make, fragments of the changelog, the citation."""

import csv
import importlib.util
import re
import tomllib
from pathlib import Path

import pytest
import yaml

from surefoot.scenarios import catalogue

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
TARGETS = set(re.findall(r"(?m)^([a-z][a-z-]*):", MAKEFILE))
WORKFLOWS = {path.stem: yaml.safe_load(path.read_text("utf-8")) for path in (ROOT / ".github/workflows").glob("*.yml")}


def test_every_target_of_the_makefile_is_phony():
    assert set(re.search(r"(?m)^\.PHONY: (.*)$", MAKEFILE)[1].split()) == TARGETS


@pytest.mark.parametrize("name", WORKFLOWS)
def test_a_workflow_only_calls_targets_that_are_there(name):
    called = []
    for job in WORKFLOWS[name]["jobs"].values():
        tiers = job.get("strategy", {}).get("matrix", {}).get("tier", [])
        for line in (step["run"] for step in job["steps"] if "run" in step):
            word = re.fullmatch(r"make (\S+|\$\{\{ matrix\.tier \}\})(?: [A-Z]+=.*)?", line)
            assert word is not None, line
            called += tiers if "matrix.tier" in word[1] else [word[1]]
    assert called
    assert set(called) <= TARGETS


def test_every_scenario_has_a_job():
    (job,) = WORKFLOWS["scenarios"]["jobs"].values()
    assert job["strategy"]["matrix"]["scenario"] == sorted(catalogue.names())


def test_a_release_is_tried_on_every_python_that_it_names():
    job = WORKFLOWS["release"]["jobs"]["dist"]
    least = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["requires-python"].removeprefix(">=")
    versions = job["strategy"]["matrix"]["python"]
    assert versions[0] == least
    named = re.findall(r"Python :: (3\.\d+)", (ROOT / "pyproject.toml").read_text())
    with (ROOT / "docs" / "results" / "pythons.csv").open(encoding="utf-8") as file:
        tried = [
            row["python"].rpartition(".")[0]
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
        ]
    assert versions == named == list(dict.fromkeys(tried))
    built = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["cibuildwheel"]["build"].split()
    assert built == [f"cp{version.replace('.', '')}-*" for version in versions]


def test_the_citation_is_of_this_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert (citation["version"], citation["license"]) == (project["version"], project["license"])


@pytest.fixture
def changelog():
    spec = importlib.util.spec_from_file_location("changelog", ROOT / "docs" / "changelog.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_fragments_that_are_there_are_in_order(changelog):
    changelog.fragments(ROOT / "changes")


def test_fragments_go_under_their_sections_and_nothing_else_moves(changelog, tmp_path):
    (tmp_path / "added-b.md").write_text("- B\n  goes on\n")
    (tmp_path / "added-a.md").write_text("- A\n")
    (tmp_path / "removed-x.md").write_text("- X")
    (tmp_path / "README.md").write_text("none\n")
    before = "# Changelog\n\n## [Unreleased]\n\nWords.\n\n### Added\n\n- old\n\n### Fixed\n\n- f\n\n## [0.1.0]\n\n- n\n"
    after = changelog.with_fragments(before, changelog.fragments(tmp_path))
    assert after == (
        "# Changelog\n\n## [Unreleased]\n\nWords.\n\n### Added\n\n- A\n- B\n  goes on\n\n- old\n\n### Fixed\n\n- f\n\n"
        "### Removed\n\n- X\n\n## [0.1.0]\n\n- n\n"
    )


@pytest.mark.parametrize(
    ("name", "text"), [("new.md", "- a"), ("added-a.md", "a"), ("added-a.md", ""), ("x-a.md", "- a")]
)
def test_a_fragment_that_would_be_lost_is_refused(changelog, tmp_path, name, text):
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=name):
        changelog.fragments(tmp_path)
