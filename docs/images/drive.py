"""Draw docs/images/drive.webp: a robot that is driven and pushed in a browser page, by a headless Chromium.

    python docs/images/drive.py

It drives in slow motion, so that the browser has the time to draw, and takes about three minutes.
"""

import io
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from websockets.sync.client import connect

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from browser import Browser  # noqa: E402  the tests' own
from webp import save_webp  # noqa: E402  of all pictures

PICTURE = Path(__file__).with_name("drive.webp")
SIZE, WIDTH = (1150, 800), 720
EVERY = 0.2
"""Simulated time from one picture to the next [s]."""

TIME = "return parseFloat(document.getElementById('drive-clock').textContent.split('·')[1])"
CANVAS = "return document.querySelector('canvas[data-engine]')?.getBoundingClientRect().toJSON()"
PAUSED = "return document.getElementById('drive-clock').textContent.includes('paused')"
PLAIN = "document.head.insertAdjacentHTML('beforeend', '<style>.mantine-Notifications-root {display: none}</style>')"

KEYS = ((0.3, "w", True), (3.0, "q", True), (4.6, "q", False), (6.4, "w", False))
"""Simulated time, key, and whether it is pressed or let go of."""

PUSH, END = 5.4, 7.6
"""Times when the body is dragged, and when it ends, simulated [s]."""


def post(address: str, **given: object) -> None:
    """Send an input as the page does."""
    with connect(f"{address.replace('http', 'ws')}session") as session:
        session.send(json.dumps(given))


def filmed(page: Browser, address: str) -> list[Image.Image]:
    """Drive from picture to picture, with a pause at each."""
    pictures, keys, pushed, following = [], list(KEYS), False, 0.0
    canvas = page.run(CANVAS)
    torso = 0.5 * canvas["width"], 0.33 * canvas["height"]
    while (time := float(page.run(TIME))) < END:
        while keys and keys[0][0] <= time:
            _, key, pressed = keys.pop(0)
            (page.press if pressed else page.release)(key)
        if not pushed and time >= PUSH:
            page.drag(torso, (torso[0] + 8, torso[1]), (torso[0] + 22, torso[1]))
            pushed = True
        following = max(time, following) + EVERY
        post(address, kind="pace", paused=False)
        page.wait_for(f"{TIME} >= {following}")
        post(address, kind="pace", paused=True)
        page.wait_for(PAUSED)
        pictures.append(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
    return pictures


def main(_: Sequence[str] = ()) -> None:
    """Drive and write the picture."""
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "surefoot", "drive", "--out", folder]
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        try:
            assert process.stdout is not None
            address = process.stdout.readline().split()[0]
            post(address, kind="pace", paused=True)
            with Browser(address, Path(folder) / "profile", SIZE) as page:
                page.wait_for(CANVAS)
                page.wait_for(f"{TIME} >= 0")
                page.run(PLAIN)
                post(address, kind="pace", speed=0.1)
                pictures = filmed(page, address)
        finally:
            process.terminate()
            process.wait()
    width, height = pictures[0].size
    small = [picture.resize((WIDTH, WIDTH * height // width), Image.Resampling.LANCZOS) for picture in pictures]
    save_webp(PICTURE, small, round(1000 * EVERY))
    print(f"{len(small)} pictures, {PICTURE.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
