"""The pictures of the documentation are drawn as the code draws now."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

from surefoot.scenarios.palette import COM, DCM, ZMP

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def make():
    pytest.importorskip("PIL")
    spec = importlib.util.spec_from_file_location("make", ROOT / "docs" / "images" / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


DRAWN = ("tick", "planner", "qp", "recovery", "estimation")


@pytest.mark.parametrize("name", ["walk.png", "walk.gif", "figures.png", *(f"{name}.svg" for name in DRAWN)])
def test_a_picture_is_of_the_present_colours_and_lines(make, name):
    assert make.noted(name) == make.digest(name), f"run python docs/images/make.py {name}"


def test_curves_of_the_figure_have_the_colours_of_the_palette(make):
    """Few colours for all pixels made ZMP and CoM alike."""
    with make.Image.open(make.FOLDER / "figures.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).reshape(-1, 3) / 255
    for color in (ZMP, COM, DCM):
        assert np.sum(np.abs(pixels - color).max(axis=1) < 0.02) > 30


def test_the_digest_follows_the_sources(make, tmp_path, monkeypatch):
    before = make.digest("figures.png")
    for source in make.SOURCES["figures.png"]:
        (tmp_path / source).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / source).write_bytes((ROOT / source).read_bytes())
    monkeypatch.setattr(make, "ROOT", tmp_path)
    assert make.digest("figures.png") == before
    (tmp_path / make.PALETTE).write_text("ZMP = (0.0, 0.0, 0.0)\n")
    assert make.digest("figures.png") != before


def test_the_moving_picture_of_the_readme_is_smooth_and_small(make):
    with make.Image.open(make.FOLDER / "front.webp") as picture:
        assert picture.width == 720
        picture.seek(1)
        picture.load()
        assert picture.info["duration"] <= 40
        assert picture.n_frames * picture.info["duration"] > 4000
    assert (make.FOLDER / "front.webp").stat().st_size < 2_000_000


def test_pictures_are_small_together(make):
    sizes = [path.stat().st_size for path in make.FOLDER.iterdir() if path.suffix not in (".py", "")]
    assert sum(sizes) < 6_000_000


def test_every_picture_that_a_page_shows_can_be_made(make):
    pages = (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"))
    shown = {name for page in pages for name in re.findall(r"!\[[^\]]*\]\(\S*images/(\S+)\)", page.read_text("utf-8"))}
    drawn = {
        path.name for path in (ROOT / "docs" / "images").iterdir() if path.suffix in (".png", ".gif", ".svg", ".webp")
    }
    assert shown == drawn
    assert set(make.PICTURES) <= drawn <= {*make.PICTURES, *make.OF_CAMPAIGNS}
