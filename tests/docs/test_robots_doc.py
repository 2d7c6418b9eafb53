"""The tutorial of docs/robots.md is walked as it stands, in a folder that is no clone."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from surefoot.models import RobotOptions, describe
from surefoot.similarity import Similarity

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"(?s)```sh\n(.*?)\n```", TEXT)


@pytest.mark.unit
def test_the_tutorial_goes_from_a_model_to_a_push_map():
    lines = [line for block in COMMANDS for line in block.splitlines()]
    words = [line.split()[1] for line in lines if line.startswith("surefoot ")]
    assert words[:2] == ["robot", "robot"] and {"run", "replay", "inspect"} <= set(words)
    assert words[-1] == "sweep"


@pytest.mark.physics
def test_every_command_of_the_tutorial_does_what_it_says(tmp_path):
    """As a shell gives them, one after another; the program is the one under test, whatever is installed."""
    folder = tmp_path / "bin"
    folder.mkdir()
    program = folder / "surefoot"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -P -m surefoot "$@"\n')
    program.chmod(0o755)
    environment = {
        **os.environ,
        "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
    }
    place = tmp_path / "mine"
    place.mkdir()
    for block in COMMANDS:
        done = subprocess.run(
            ["sh", "-e", "-c", block], cwd=place, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"
    verdicts = [json.loads(path.read_text()) for path in sorted(place.glob("runs/walk-*/verdict.json"))]
    assert len(verdicts) == 3 and all(verdict["verdict"] == "pass" for verdict in verdicts)
    assert "</html>" in (place / "walk.html").read_text(encoding="utf-8")[-200:]
    assert (place / "runs" / "push-map" / "report.html").exists()


def rows(heading):
    """Cells of the table under a heading, by the first of each row."""
    part = TEXT.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = re.findall(r"(?m)^\| (.*) \|$", part)
    return {cells[0]: cells[1:] for cells in (line.split(" | ") for line in lines)}


SHIPPED = sorted((ROOT / "models" / "robots").glob("*.yaml"))
CORE = (ROOT / "pyproject.toml").read_text(encoding="utf-8").split("[project.optional-dependencies]")[0]
GALLERY, SIZES = rows("Gallery"), rows("How a scenario fits every robot")
LINK = re.compile(r"\]\(([^)]*)\)")


@pytest.mark.unit
def test_the_gallery_shows_every_robot_that_comes_along():
    files = {path.stem: yaml.safe_load(path.read_text(encoding="utf-8")) for path in SHIPPED}
    for name, file in files.items():
        *_, licence, source, package = GALLERY[f"`{name}`"]
        assert f"(images/robot-{name}.webp)<br>`{name}`" in TEXT
        assert licence == file["licence"]
        assert LINK.search(source)[1] == re.search(r"https?://\S+", file["source"])[0]
        needed = re.search(r"package://([^/]+)/", file["model"])[1].replace("_", "-")
        assert package == ("comes along" if f'"{needed}>=' in CORE else "`surefoot[robots]`")
    assert {cell for cell in GALLERY if cell.startswith("`")} == {f"`{name}`" for name in files}


@pytest.mark.unit
def test_the_pictures_of_robots_are_small_and_about_three_seconds():
    image = pytest.importorskip("PIL.Image")
    for path in SHIPPED:
        picture = ROOT / "docs" / "images" / f"robot-{path.stem}.webp"
        with image.open(picture) as shown:
            shown.seek(1)
            shown.load()
            assert 1800 <= shown.n_frames * shown.info["duration"] <= 4000
        assert picture.stat().st_size <= 350 * 1024


@pytest.mark.physics
@pytest.mark.parametrize("name", [path.stem for path in SHIPPED])
def test_numbers_of_a_robot_are_those_that_walk(name):
    robot = describe(name, RobotOptions())
    mass, leg, joints, *_ = GALLERY[f"`{name}`"]
    assert (
        mass == f"{robot.mass:.0f} kg" and leg == f"{robot.leg_length:.2f} m" and joints == str(len(robot.joint_names))
    )


@pytest.mark.physics
@pytest.mark.parametrize(("name", "column"), [("talos", 2), ("g1", 3)])
def test_what_becomes_of_a_quantity_is_that_of_the_robots(name, column):
    robot = describe(name, RobotOptions())
    size = Similarity.of(robot.leg_length, robot.mass)
    shown = {cells[0]: cells[column] for cells in SIZES.values() if cells[0].startswith("`")}
    assert shown == {f"`{unit}`": f"{size.factor(unit):.2f}" for unit in ("m", "s", "m/s", "N", "N·m", "N·s/kg")}
