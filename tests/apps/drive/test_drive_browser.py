"""A drive in a real browser: a key makes the robot walk, a click and a drag push it, and its log is walked again."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import Browser

import surefoot
from surefoot.apps.drive.page import CHANNEL

pytestmark = [
    pytest.mark.physics,
    pytest.mark.usefixtures("with_a_browser"),
]

TIME = "return parseFloat(document.getElementById('drive-clock').textContent.split('·')[1])"
TEXT = "return document.getElementById('drive-%s').textContent"
CHARTS = "return [...document.querySelectorAll('#drive canvas')].map(canvas => canvas.toDataURL())"
CANVAS = "return document.querySelector('canvas[data-engine]')?.getBoundingClientRect().toJSON()"
HIDE_NOTICE = (
    "document.head.insertAdjacentHTML('beforeend', '<style>.mantine-Notifications-root {display: none}</style>')"
)
TORSO = (0.495, 0.3)
"""Place of the torso in the picture, from the left and from the top."""


@pytest.fixture(scope="module")
def driven(
    tmp_path_factory: pytest.TempPathFactory, heeding_throughout: None
) -> Iterator[tuple[Browser, subprocess.Popen[str], Path]]:
    pytest.importorskip("viser")
    client = pytest.importorskip("websockets.sync.client")
    folder = tmp_path_factory.mktemp("drive")
    command = [sys.executable, "-m", "surefoot", "drive", "--out", str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split()[0]
        process.stdout.readline()  # the log, before the page is there
        with client.connect(f"{address.replace('http', 'ws')}{CHANNEL}") as socket:
            for given in ({"kind": "pace", "paused": True}, {"kind": "click", "impulse": 5.0}):
                socket.send(json.dumps(given))
        with Browser(address, folder / "profile", (640, 420)) as page:
            page.wait_for(CANVAS)
            page.wait_for(TEXT % "clock" + ".includes('paused')")
            page.run(HIDE_NOTICE)
            yield page, process, folder
    finally:
        process.kill()
        process.wait()


def pass_time(page: Browser, seconds: float) -> None:
    page.wait_for(f"{TIME} > {page.run(TIME) + seconds}")


@pytest.mark.long
def test_a_browser_without_a_gpu_draws_less(driven: tuple[Browser, subprocess.Popen[str], Path]) -> None:
    page, *_ = driven
    assert page.run("return surefoot.software")
    canvas = "document.querySelector('canvas[data-engine]')"
    assert page.run(f"return {canvas}.width / {canvas}.clientWidth") == pytest.approx(0.6, abs=0.01)
    assert page.run(f"return {canvas}.getContext('webgl2').getContextAttributes().antialias") is False
    apart = "const begun = performance.now(); for (let i = 0; i < 10; i++) await new Promise(requestAnimationFrame);"
    assert page.run(f"return (async () => {{{apart} return performance.now() - begun}})()") > 10 * 45.0  # [ms]


def test_on_a_narrow_screen_the_robot_gets_half_of_it(driven: tuple[Browser, subprocess.Popen[str], Path]) -> None:
    page, *_ = driven
    canvas, (width, height) = page.run(CANVAS), page.run("return [innerWidth, innerHeight]")
    assert canvas["width"] == width <= 700
    assert 0.5 * height <= canvas["height"] < height


def test_a_drive(
    driven: tuple[Browser, subprocess.Popen[str], Path], same_content: Callable[[Path, Path], list[str]]
) -> None:
    page, process, folder = driven
    before = page.run(CHARTS)
    page.press("w")
    page.press("p")
    page.release("p")
    pass_time(page, 2.5)
    page.press("p")
    page.release("p")
    page.wait_for(TEXT % "clock" + ".includes('paused')")
    paused = page.run(TIME)
    assert all(old != new for old, new in zip(before, page.run(CHARTS), strict=True))
    page.wait_for(TEXT % "velocity" + ".includes('0.300.30')")  # asked for and done

    canvas = page.run(CANVAS)
    torso = TORSO[0] * canvas["width"], TORSO[1] * canvas["height"]
    page.drag(torso)
    page.wait_for(TEXT % "push" + ".startsWith('pushed')")
    click = page.run(TEXT % "push")
    assert "5.0 N·s = 0.05 N·s/kg" in click
    page.drag(torso, (torso[0] + 6, torso[1]), (torso[0] + 12, torso[1]))
    page.wait_for(f"{TEXT % 'push'} !== {click!r}")
    assert page.run(TIME) == paused

    page.press("p")
    page.release("p")
    pass_time(page, 0.5)
    page.release("w")
    pass_time(page, 0.5)
    page.wait_for("return !" + (TEXT % "velocity").removeprefix("return ") + ".includes('0.30')")
    process.send_signal(signal.SIGINT)
    assert process.wait(20) == 130
    page.wait_for(TEXT % "note" + ".includes('has ended')")

    (path,) = folder.rglob("log.mcap")
    log = surefoot.read(path)
    pushed = log["/measurement"].field("external_force")
    assert np.linalg.norm(pushed, axis=1).max() > 49.0
    com = log["/truth"].field("com")
    assert com[-1, 0] - com[0, 0] > 0.3
    assert log.metadata["end"]["kind"] == "interrupted"
    again = surefoot.run(surefoot.load(path), out=path.parent / "again")
    assert same_content(path, again.log) == []
