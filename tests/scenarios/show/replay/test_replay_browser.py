"""The page in a real browser without a network: it opens, pauses, plays, and layers can be switched off."""

import time
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import browser
import numpy as np
import pytest
from browser import Browser
from PIL import Image

from surefoot.scenarios.log import read
from surefoot.scenarios.show.replay.command import write_page
from surefoot.scenarios.show.replay.extract import extract

pytestmark = [
    pytest.mark.physics,
    pytest.mark.skipif(browser.missing() is not None, reason=str(browser.missing())),
]

TIME = "return parseFloat(document.querySelector('input')?.value)"
PLAY = "document.querySelector('.mantine-ActionIcon-root').click()"
EYE = """
const names = [...document.querySelectorAll('[data-playback-scene-tree] div')].filter(e => e.textContent === '/Robot');
const eye = names.at(-1).previousElementSibling.querySelector('svg');
eye.dispatchEvent(new MouseEvent('mousedown', {bubbles: true}));
eye.dispatchEvent(new MouseEvent('mouseup', {bubbles: true}));"""


@pytest.fixture(scope="module")
def page(log_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    pytest.importorskip("viser")
    folder = tmp_path_factory.mktemp("browser")
    write_page(extract(read(log_path)), folder / "walk.html")
    with Browser(folder / "walk.html", folder / "profile") as opened:
        opened.wait_for("return document.querySelector('input') && document.querySelector('canvas') && true")
        opened.wait_for("return document.querySelector('[data-playback-scene-tree]') && true")
        yield opened


def picture(page: Browser) -> np.ndarray:
    """The middle of the page, where the robot is."""
    image = np.asarray(Image.open(BytesIO(page.screenshot())).convert("RGB")).astype(int)
    height, width = image.shape[:2]
    return image[height // 10 : -height // 5, width // 4 : -width // 3]


def changed(before: np.ndarray, after: np.ndarray) -> int:
    """Number of pixels that differ visibly."""
    return int(np.count_nonzero(np.abs(after - before).max(axis=2) > 40))


def test_nothing_is_fetched(page: Browser) -> None:
    assert (
        page.run("return performance.getEntriesByType('resource').filter(e => !/^(data|blob):/.test(e.name)).length")
        == 0
    )


def test_it_stands_still_when_paused_and_moves_when_played(page: Browser) -> None:
    page.run(PLAY)
    time.sleep(2.0)
    paused_at, still = page.run(TIME), picture(page)
    time.sleep(1.0)
    assert page.run(TIME) == paused_at
    assert changed(still, picture(page)) < 20
    page.run(PLAY)
    page.wait_for(f"return Math.abs(parseFloat(document.querySelector('input').value) - {paused_at}) > 0.2")
    page.run(PLAY)
    time.sleep(2.0)
    assert changed(still, picture(page)) > 200


def test_the_robot_can_be_switched_off(page: Browser) -> None:
    before = picture(page)
    page.run(EYE)
    time.sleep(2.0)
    assert changed(before, picture(page)) > 1000
