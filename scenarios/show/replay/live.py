"""A replay that goes along with a log that may still grow."""

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.output import reason
from surefoot.scenarios.show.logview import rows_at
from surefoot.scenarios.show.replay.content import Replay, ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.gate import Gate, serving
from surefoot.scenarios.show.replay.scene import ViserScene

if TYPE_CHECKING:
    import viser

STEP = 0.001
"""Resolution of the timeline [s]."""

POLL = 1.0
"""Wall-clock time between looks at the log [s]."""

PATIENCE = 15.0
"""Time for which a log may lack its first control tick [s]."""

SPEEDS = {"0.1x": 0.1, "0.25x": 0.25, "0.5x": 0.5, "1x": 1.0, "2x": 2.0, "4x": 4.0}
"""Speeds of replayed over wall-clock time, by what they are called."""


def serve(path: Path, window: ReplayWindow, say: Callable[[str], None]) -> None:
    """Serve a log, which may still grow, on this machine until a signal ends it; ``say`` gets the address.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the log holds nothing to show, or is there no more; the port is taken.
    """
    gate = Gate()
    with serving(gate) as server:
        replay = _first(path, window)
        say(f"{gate.address} shows {path}; Ctrl-C stops")
        player, size, looked = Player(server, replay), _size(path), time.monotonic()
        while True:
            time.sleep(1.0 / window.frame_rate)
            player.advance(time.monotonic())
            if time.monotonic() - looked > POLL and _size(path) != size:
                size, looked = _size(path), time.monotonic()
                player.replace(extract(read(path), window))


def _size(path: Path) -> int:
    """Size of a log that is followed [B]; LogError where it is there no more."""
    try:
        return path.stat().st_size
    except OSError as error:
        raise LogError(f"{path}: cannot be followed any more, {reason(error)}; leave it where it is") from None


def _first(path: Path, window: ReplayWindow) -> Replay:
    """The replay of a log, as soon as it shows anything."""
    begin = time.monotonic()
    while True:
        log = read(path)
        try:
            return extract(log, window)
        except LogError:
            if not log.truncated or time.monotonic() - begin > PATIENCE:
                raise
        time.sleep(POLL)


class Player:
    """Timeline, play, speed, what follows what, and the scene that they move."""

    def __init__(self, server: "viser.ViserServer", replay: Replay) -> None:
        self._replay, self._scene, self._last = replay, ViserScene(server, replay), time.monotonic()
        first, last = float(replay.time[0]), float(replay.time[-1])
        gui: Any = server.gui
        gui.main_panel.dock_right()  # beside the picture, not over it
        self._slider = gui.add_slider(
            "time [s]", min=first, max=max(last, first + STEP), step=STEP, initial_value=first
        )
        self._playing = gui.add_checkbox("play", initial_value=True)
        self._following = gui.add_checkbox("follow the run", initial_value=False, hint="show the end of a growing log")
        self._camera = gui.add_checkbox("camera follows the robot", initial_value=True)
        self._speed = gui.add_dropdown("speed", options=tuple(SPEEDS), initial_value="1x")
        self._now = first
        self._slider.on_update(self._sought)
        with gui.add_folder("show"):
            for name, node in self._scene.layers.items():
                switch = gui.add_checkbox(name, initial_value=node.visible)
                switch.on_update(lambda event, node=node: setattr(node, "visible", event.target.value))

    def _sought(self, event: Any) -> None:
        """Stay where the user has moved the slider to."""
        if event.client is not None and math.isfinite(event.target.value):
            self._now, self._playing.value, self._following.value = event.target.value, False, False

    def replace(self, replay: Replay) -> None:
        """Show more of the run."""
        self._replay = replay
        self._scene.replace(replay)
        self._slider.max = float(replay.time[-1])

    def advance(self, now: float) -> None:
        """Show what is due at a wall-clock time [s]."""
        times = self._replay.time
        elapsed, self._last = now - self._last, now
        if self._following.value:
            self._now = float(times[-1])
        elif self._playing.value:
            self._now += elapsed * SPEEDS.get(self._speed.value, 1.0)
            self._now = self._now if self._now <= times[-1] else float(times[0])
        if self._playing.value or self._following.value:
            self._slider.value = round(self._now, 3)
        frame = int(rows_at(times, np.array(self._now)))
        self._scene.show(frame, follow=self._camera.value)
