"""Statements of docs/robots.md about the robots that come along are true of them."""

import re
from pathlib import Path

import pytest
import yaml

from surefoot.apps.robots.taken import rows as rows_of
from surefoot.models import RobotOptions, describe
from surefoot.scenarios import catalogue
from surefoot.similarity import Similarity

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8")


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


WALKED = yaml.safe_load((ROOT / "docs" / "catalogue.yaml").read_text(encoding="utf-8"))


@pytest.mark.unit
def test_the_table_of_the_catalogue_has_every_robot_and_every_scenario():
    assert set(WALKED) == {path.stem for path in SHIPPED}
    for found in WALKED.values():
        assert sorted(name for names in found.values() for name in names) == sorted(catalogue.OWN)


@pytest.mark.long
@pytest.mark.parametrize("name", ["g1", "talos"])
def test_what_a_robot_is_refused_is_what_the_table_says(name, tmp_path):
    found = rows_of(name, tuple(catalogue.OWN), False, 1, tmp_path, lambda *_: None)
    refused = {row.scenario for row in found if row.outcome == "refused"}
    assert refused == set(WALKED[name]["refused"]), "run python docs/catalogue.py, then python docs/reference.py"


@pytest.mark.long
@pytest.mark.parametrize("name", [path.stem for path in SHIPPED])
def test_what_becomes_of_every_scenario_is_what_the_table_says(name, tmp_path):
    found = rows_of(name, tuple(catalogue.OWN), True, 2, tmp_path, lambda *_: None)
    assert {row.scenario for row in found if row.outcome == "walks"} == set(WALKED[name]["met"])
