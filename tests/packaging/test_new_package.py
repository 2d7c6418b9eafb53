"""`surefoot new` writes a package that works at once, out of the files of docs/extending.md."""

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

from surefoot.apps.package.new import new
from surefoot.scenarios.errors import ScenarioError

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")

LEFT_OUT = (
    "planners",
    "ground",
    "plants",
    "rules",
    "commands",
    "terrains",
    "controllers",
    "observations",
    "instruments",
)
"""Modules of the page that a first package does not need."""


@pytest.fixture
def made(tmp_path):
    return new("ski-jump", tmp_path)


@pytest.mark.unit
def test_its_files_are_those_of_the_page(tmp_path):
    place, seen = new("my-package", tmp_path), set()
    for path, text in re.findall(r"(?s)```(?:python|yaml)\n# (my_package/\S+)\n(.*?)```", PAGE):
        if Path(path).stem not in LEFT_OUT:
            assert (place / path).read_text(encoding="utf-8") == text, path
            seen.add(path)
    assert len(seen) == 6
    points = tomllib.loads((place / "pyproject.toml").read_text())["project"]["entry-points"]
    told = {}
    for table in re.findall(r"(?s)```toml\n(.*?)```", PAGE):
        for group, named in tomllib.loads(table)["project"]["entry-points"].items():
            kept = {name: to for name, to in named.items() if to.partition(":")[0].rpartition(".")[2] not in LEFT_OUT}
            told.setdefault(group, {}).update(kept)
    assert points == {group: named for group, named in told.items() if named}


@pytest.mark.unit
def test_its_name_is_everywhere(made):
    texts = {path.relative_to(made): path.read_text("utf-8") for path in made.rglob("*") if path.is_file()}
    assert {Path("ski_jump/laws.py"), Path("tests/test_ski_jump.py"), Path(".github/workflows/test.yml")} <= set(texts)
    assert not [path for path, text in texts.items() if re.search(r"my.package|tmpl", f"{path} {text}")]
    assert tomllib.loads(texts[Path("pyproject.toml")])["project"]["name"] == "ski-jump"
    (steps,) = [job["steps"] for job in yaml.safe_load(texts[Path(".github/workflows/test.yml")])["jobs"].values()]
    assert [step["run"] for step in steps if "run" in step] == ["pip install -e '.[test]'", "make test"]


@pytest.mark.unit
@pytest.mark.parametrize("name", ["My", "a--b", "-a", "a/b", "..", "class", "json", "surefoot", "tests", "a" * 61, ""])
def test_what_is_no_name_is_refused_and_nothing_written(name, tmp_path):
    with pytest.raises(ScenarioError, match="; take "):
        new(name, tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.unit
def test_nothing_is_written_over(made):
    (made / "README.md").write_text("mine")
    with pytest.raises(ScenarioError, match="is there already; take another name, or another folder with --out"):
        new("ski-jump", made.parent)
    assert (made / "README.md").read_text() == "mine"
    (made.parent / "file").write_text("")
    with pytest.raises(ScenarioError, match=r"file/x: .*; take another"):
        new("x", made.parent / "file")


@pytest.mark.unit
def test_the_command_says_what_comes_next(at_hand, tmp_path):
    answer = at_hand("new", "ski-jump", "--out", str(tmp_path))
    assert (answer.code, answer.err) == (0, "")
    assert answer.out.splitlines() == [
        f"{tmp_path}/ski-jump",
        f"next: cd {tmp_path}/ski-jump && pip install -e '.[test]' && pytest",
    ]
    assert at_hand("new", "ski-jump", "--out", str(tmp_path)).code == 2


@pytest.mark.physics
def test_its_own_tests_pass_and_its_scenario_walks(made, site):
    """As if it were installed: its folder and entry points are on the path."""
    unpacked = site("ski-jump")
    for group, points in tomllib.loads((made / "pyproject.toml").read_text())["project"]["entry-points"].items():
        unpacked.register(group, **points)
    path = os.pathsep.join([str(made), str(unpacked.folder), os.environ.get("PYTHONPATH", str(ROOT))])
    environment = {**os.environ, "PYTHONPATH": path}

    def ran(*words):
        command = [sys.executable, "-m", *words]
        return subprocess.run(command, cwd=made, env=environment, capture_output=True, text=True, check=False)

    done = ran("pytest", "-q", "-p", "no:cacheprovider")
    assert done.returncode == 0, done.stdout
    assert "5 passed" in done.stdout
    done = ran("surefoot", "run", "two-slow-steps", "--json")
    assert json.loads(done.stdout)["verdict"] == "pass", done.stderr
    done = ran("ruff", "check", "--no-cache", "--isolated", "--ignore", "I", ".")
    assert done.returncode == 0, done.stdout
