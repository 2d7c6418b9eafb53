"""The pictures of the documentation are drawn as the code draws now."""

import importlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from surefoot.scenarios.palette import COM, DCM, ZMP

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]


FOLDER = ROOT / "docs" / "images"


@pytest.fixture(scope="module")
def make():
    """The module that draws all of them, and beside it the one that knows what by."""
    pytest.importorskip("PIL")
    sys.path.insert(0, str(FOLDER))
    try:
        yield importlib.import_module("make")
    finally:
        sys.path.remove(str(FOLDER))


@pytest.fixture(scope="module")
def sources(make):
    return importlib.import_module("sources")


SHOWN = sorted(path.name for path in FOLDER.iterdir() if path.suffix in (".png", ".svg", ".webp"))


@pytest.mark.parametrize("name", SHOWN)
def test_a_picture_is_of_the_present_colours_and_lines(sources, name):
    assert sources.noted(name) == sources.digest(name), f"run python docs/images/make.py {name}"


@pytest.mark.parametrize("script", sorted(FOLDER.glob("*.py")), ids=lambda path: path.name)
def test_a_picture_has_no_colour_but_those_of_the_palette(script):
    """They are told apart by any colour vision."""
    assert not re.findall(r"#[0-9a-fA-F]{6}", script.read_text(encoding="utf-8"))


def test_a_moving_picture_carries_the_digest_of_its_name(make, sources, tmp_path):
    webp = importlib.import_module("webp")
    images = [make.Image.new("RGB", (8, 8), colour) for colour in ("red", "blue")]
    webp.save_webp(tmp_path / "front.webp", images, 40)
    assert sources.noted("front.webp", tmp_path) == sources.digest("front.webp") != sources.digest("drive.webp")


def test_curves_of_the_figure_have_the_colours_of_the_palette(make):
    """Few colours for all pixels made ZMP and CoM alike."""
    with make.Image.open(make.FOLDER / "figures.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).reshape(-1, 3) / 255
    for color in (ZMP, COM, DCM):
        assert np.sum(np.abs(pixels - color).max(axis=1) < 0.02) > 30


def test_the_digest_follows_the_sources(sources, tmp_path):
    before = sources.digest("figures.png")
    for source in sources.SOURCES["figures.png"]:
        (tmp_path / source).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / source).write_bytes((ROOT / source).read_bytes())
    assert sources.digest("figures.png", tmp_path) == before
    palette = tmp_path / sources.PALETTE
    told = palette.read_text(encoding="utf-8").replace('"""', '"""Another sentence. ', 1) + "\n# And a comment.\n"
    palette.write_text(told, encoding="utf-8")
    assert sources.digest("figures.png", tmp_path) == before
    palette.write_text("ZMP = (0.0, 0.0, 0.0)\n", encoding="utf-8")
    assert sources.digest("figures.png", tmp_path) != before


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


def test_every_picture_that_a_page_shows_can_be_made_by_one_command(make, sources):
    pages = (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"))
    shown = {name for page in pages for name in re.findall(r"!\[[^\]]*\]\(\S*images/(\S+)\)", page.read_text("utf-8"))}
    assert shown == set(SHOWN)
    assert set(make.PICTURES) == set(sources.SOURCES) == shown
