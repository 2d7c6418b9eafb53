"""Tutorials are followed as they stand: files are written and commands given, each in a folder of its own."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from surefoot.apps.robots.draft import draft
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.load import load

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "tutorials"
PAGES = sorted(path.stem for path in FOLDER.glob("*.md"))
BLOCK = re.compile(r"(?s)```(sh|python|yaml)\n(.*?)\n```")


def follow(text, place, program):
    """Follow a page in a folder; gives what was printed."""
    environment = {
        **os.environ,
        "PATH": f"{program}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(place / "cache"),
    }
    told = ""
    for kind, block in BLOCK.findall(text):
        if kind == "sh":
            command = ["sh", "-e", "-c", block]
            done = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"
            told += done.stdout
        else:
            name, _, rest = block.partition("\n")
            (place / name.removeprefix("# ")).write_text(rest + "\n", encoding="utf-8")
    return told


@pytest.fixture
def program(tmp_path):
    """A folder for the path in which `surefoot` and `python` are those under test."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, words in (("surefoot", "-P -m surefoot"), ("python", "")):
        (folder / name).write_text(f'#!/bin/sh\nexec {sys.executable} {words} "$@"\n')
        (folder / name).chmod(0o755)
    return folder


SAID = {
    "first-run": r"verdict pass(?s:.*)the CoM moved [\d.]+ m forward",
    "own-scenario": r"verdict pass(?s:.*)exit code 2",
    "own-law": r"own walked(?s:.*)default walked(?s:.*)\nwalked",
    "own-task": r"walked with the neck turned by 0\.[45]",
    "own-estimator": r"0 mm: walked estimation error 0\.0 mm\n2 mm: walked estimation error 2\.0 mm",
    "own-loop": r"walked 1\.\d\d m in 8\.00 s(?s:.*)fell (?s:.*)s: a foot that bears the robot slides\n(?s:.*)slips",
    "own-policy": r"verdict pass(?s:.*)pushes\.0\.impulse \[N·s/kg\](?s:.*)stand\.html(?s:.*)stand\.npz",
    "own-robot": r"(?s:verdict pass.*){4}report\.html",
    "push-map": r"pushes\.0\.impulse \[N·s/kg\]\n(?s:.*)report\.html(?s:.*)table\.csv",
    "ci": r"two-steps(?s:.*)found, exit code 1",
    "logs": r"largest torques: \{",
}


@pytest.mark.unit
def test_every_tutorial_is_followed_and_names_the_next():
    assert set(SAID) == set(PAGES)
    for page in PAGES:
        text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
        for kind, block in BLOCK.findall(text):
            assert kind == "sh" or re.match(r"# [\w/.-]+\n", block), f"{page}: a file without its name"
    assert "exit 1" not in "".join(BLOCK.findall((FOLDER / "first-run.md").read_text(encoding="utf-8"))[0])


SOON = ("first-run",)
"""Pages that are followed at every change; the others with the long tests, as examples like theirs are."""


@pytest.mark.physics
@pytest.mark.parametrize(
    "page", [page if page in SOON else pytest.param(page, marks=pytest.mark.long) for page in PAGES]
)
def test_a_tutorial_does_what_it_says(page, tmp_path, program):
    place = tmp_path / "mine"
    place.mkdir()
    told = follow((FOLDER / f"{page}.md").read_text(encoding="utf-8"), place, program)
    assert re.search(SAID[page], told), told


@pytest.mark.unit
def test_a_command_that_fails_is_found(tmp_path, program):
    with pytest.raises(AssertionError, match="surefoot run nothing"):
        follow("```sh\nsurefoot run nothing\n```\n", tmp_path, program)


@pytest.mark.physics
def test_a_robot_that_is_refused_is_told_what_the_page_says(tmp_path):
    (quoted,) = re.findall(r"```text\n(.*?)\n```", (FOLDER / "own-robot.md").read_text(encoding="utf-8"))
    model = "package://example-robot-data/robots/romeo_description/urdf/romeo.urdf"
    (tmp_path / "romeo.yaml").write_text(draft(model, tmp_path).text, encoding="utf-8")
    scenario = load("walk-level", [f"robot={tmp_path / 'romeo.yaml'}"])
    with pytest.raises(SetupError) as refusal:
        Simulation(scenario)
    assert str(refusal.value) == quoted


@pytest.mark.physics
@pytest.mark.long
def test_the_notebook_of_the_first_tutorial_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    book = json.loads((FOLDER / "first-run.ipynb").read_text(encoding="utf-8"))
    names: dict = {}
    cells = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
    for cell in cells:
        exec(compile(cell, "cell", "exec"), names)
    assert names["result"].verdict.passed
    assert names["com"].shape[1] == 3
    assert not [cell for cell in book["cells"] if cell.get("outputs")]
