"""The page in a real browser without a network: it opens, pauses, plays, follows, and layers can be switched off."""

import time
from collections.abc import Iterator
from io import BytesIO

import numpy as np
import pytest
from browser import Browser
from invented_log import write
from PIL import Image

from surefoot.scenarios.show.replay.page import write_page

pytestmark = [
    pytest.mark.physics,
    pytest.mark.usefixtures("with_a_browser"),
]

SPEED = 2.5
"""Speed of a robot that leaves the picture unless it is followed [m/s]."""

DARK = 125
"""Only the robot is so dark in every channel."""

TIME = "return parseFloat(document.querySelector('input')?.value)"
ELAPSED = "parseFloat(document.querySelector('#root [role=slider]').getAttribute('aria-valuenow'))"
PLAY = "document.querySelector('.mantine-ActionIcon-root').click()"
EYE = """
const names = [...document.querySelectorAll('[data-playback-scene-tree] div')].filter(e => e.textContent === '/Robot');
const eye = names.at(-1).previousElementSibling.querySelector('svg');
eye.dispatchEvent(new MouseEvent('mousedown', {bubbles: true}));
eye.dispatchEvent(new MouseEvent('mouseup', {bubbles: true}));"""

SEEK = """
const input = document.querySelector('#root input');
Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(input, '%s');
input.dispatchEvent(new Event('input', {bubbles: true}));"""
CANVAS = "return document.querySelector('canvas[data-engine]').getBoundingClientRect().toJSON()"
CURSORS = "return [...document.querySelectorAll('#surefoot .cursor')].map(line => parseFloat(line.getAttribute('x1')))"
KEYS = "return [...document.querySelectorAll('#surefoot .keys')].map(key => key.textContent)"
HIDE_NOTICE = (
    "document.head.insertAdjacentHTML('beforeend', '<style>.mantine-Notifications-root {display: none}</style>')"
)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    pytest.importorskip("viser")
    folder = tmp_path_factory.mktemp("browser")
    write_page(write(folder / "log.mcap", speed=SPEED), folder / "walk.html")
    with Browser(folder / "walk.html", folder / "profile", (760, 400)) as opened:
        opened.wait_for("return document.querySelector('input') && document.querySelector('canvas') && true")
        opened.wait_for("return document.querySelector('[data-playback-scene-tree]') && true")
        opened.run(PLAY)
        opened.run(HIDE_NOTICE)
        yield opened


def picture(page: Browser) -> np.ndarray:
    """The picture of the scene on the page."""
    image = np.asarray(Image.open(BytesIO(page.screenshot())).convert("RGB")).astype(int)
    frame = page.run(CANVAS)
    return image[: round(frame["bottom"]), : round(frame["right"])]


def robot_at(page: Browser, seconds: float) -> float:
    """Place of the robot in the picture at a time, from 0 at the left to 1 at the right; NaN out of it."""
    page.run(SEEK % seconds)
    time.sleep(0.5)
    image = picture(page)
    columns = np.flatnonzero((image < DARK).all(axis=2).sum(axis=0) > 2)
    return float(np.median(columns)) / image.shape[1] if len(columns) else float("nan")


def changed(before: np.ndarray, after: np.ndarray) -> int:
    """Number of pixels that differ visibly."""
    return int(np.count_nonzero(np.abs(after - before).max(axis=2) > 40))


def test_nothing_is_fetched(page: Browser) -> None:
    assert (
        page.run("return performance.getEntriesByType('resource').filter(e => !/^(data|blob):/.test(e.name)).length")
        == 0
    )


def test_the_camera_follows_until_it_is_freed(page: Browser) -> None:
    places = [robot_at(page, seconds) for seconds in (0.5, 0.02, 0.9)]
    assert all(0.3 < place < 0.7 for place in places), places
    page.run("dispatchEvent(new KeyboardEvent('keydown', {key: 'f'}))")
    assert not 0.3 < robot_at(page, 0.02) < 0.7
    page.run("document.getElementById('surefoot-follow').click()")
    assert 0.3 < robot_at(page, 0.1) < 0.7


def test_nothing_lies_over_the_picture(page: Browser) -> None:
    right = page.run(CANVAS)["right"]
    assert right > 0.5 * page.run("return innerWidth")
    for part in ("#surefoot", "[data-playback-scene-tree]"):
        assert page.run(f"return document.querySelector('{part}').getBoundingClientRect().left") >= right - 1
    assert page.run("return document.querySelector('[data-playback-scene-tree]').getBoundingClientRect().height") > 30


def test_on_a_narrow_screen_the_robot_gets_half_of_it(page: Browser) -> None:
    page.resize(500, 800)  # the narrowest that this browser opens
    page.wait_for(f"{CANVAS}.width === innerWidth")
    bottom, height = page.run(CANVAS)["bottom"], page.run("return innerHeight")
    assert bottom >= 0.5 * height
    for part in ("#surefoot", "[data-playback-scene-tree]"):
        assert page.run(f"return document.querySelector('{part}').getBoundingClientRect().top") >= bottom - 1
    page.resize(760, 400)
    page.wait_for(f"{CANVAS}.width < 0.8 * innerWidth")


def test_the_charts_show_the_time_of_the_timeline(page: Browser) -> None:
    seen = []
    for seconds in (0.2, 0.7):
        page.run(SEEK % seconds)
        time.sleep(0.5)
        seen.append((page.run(CURSORS), page.run(KEYS)))
    span = 29 / 30  # the last frame of one second
    for (cursors, _), seconds in zip(seen, (0.2, 0.7), strict=True):
        assert cursors == pytest.approx(4 * [seconds / span], abs=1e-3)
    assert seen[0][1][0] != seen[1][1][0]
    assert "left foot 900" in seen[0][1][3]


def test_it_stands_still_when_paused_and_moves_when_played(page: Browser) -> None:
    page.run(SEEK % 0.3)
    time.sleep(0.5)
    paused_at, still = page.run(TIME), picture(page)
    time.sleep(0.5)
    assert page.run(TIME) == paused_at == 0.3
    assert changed(still, picture(page)) < 20
    page.run(PLAY)
    page.wait_for(f"return Math.abs(parseFloat(document.querySelector('input').value) - {paused_at}) > 0.2")
    page.run(PLAY)
    # A machine that is busy draws the robot late.
    assert any(changed(still, picture(page)) > 200 for _ in range(40) if not time.sleep(0.25))


def test_the_robot_can_be_switched_off(page: Browser) -> None:
    before = picture(page)
    page.run(EYE)
    time.sleep(0.8)
    assert changed(before, picture(page)) > 1000


def test_a_link_to_a_moment_shows_it_and_stands_still(page: Browser) -> None:
    page.run(SEEK % 0.1)
    page.run(PLAY)
    page.run("location.hash = '#t=0.53'")
    page.wait_for(f"return Math.abs({ELAPSED} - 0.53) < 1e-3")
    time.sleep(0.5)
    assert page.run(f"return {ELAPSED}") == pytest.approx(0.53, abs=1e-3), "it stands still"
    page.run("location.hash = '#t=99'")
    page.wait_for(f"return {ELAPSED} > 0.9")
    page.run("location.hash = '#t=soon'")
    time.sleep(0.3)
    assert page.run(f"return {ELAPSED}") > 0.9
    page.open(page.run("return location.href.split('#')[0] + '?again#t=0.71'"))
    page.wait_for("return document.querySelector('#root [role=slider]') && true")
    page.wait_for(f"return Math.abs({ELAPSED} - 0.71) < 1e-3")
