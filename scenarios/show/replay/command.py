"""The commands that show a log in 3D, and a run while it goes on."""

import contextlib
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from surefoot.scenarios.errors import LogError, require
from surefoot.scenarios.log import read
from surefoot.scenarios.loop.skeleton import OnProgress, Progress
from surefoot.scenarios.output import refuse_existing
from surefoot.scenarios.show.console import ProgressLine
from surefoot.scenarios.show.logview import LogView
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.poses import Window


def html_page(log: Path, out: Path, window: Window, replace: bool = False) -> None:
    """Write a page; errors as of `extract` and `write_page`."""
    from surefoot.scenarios.show.replay.page import charts, write_page

    refuse_existing(out, replace)
    opened = read(log)
    replay = extract(opened, window)
    write_page(replay, out, charts(LogView(opened), replay.time), replace)


@dataclass(frozen=True, slots=True)
class Filming:
    """How a video is asked for: speed, camera and size, as of `Film.of`."""

    speed: float = 1.0
    camera: str = "follow"
    size: str = "1280x720"


def video(log: Path, out: Path, window: Window, filming: Filming | None = None, replace: bool = False) -> None:
    """Write a video, with a progress line; errors as of `extract`, `Film.of` and `write_video`."""
    from surefoot.scenarios.show.replay.video import FRAME_RATE, Film, write_video

    filming = filming or Filming()
    film = Film.of(filming.speed, filming.camera, filming.size)
    refuse_existing(out, replace)
    recorded, begin = extract(read(log), film.window(window)), time.monotonic()
    length = len(recorded) / FRAME_RATE
    with ProgressLine(out.name) as line:

        def note(frames: int) -> None:
            done = frames / FRAME_RATE
            line(Progress(done, length, "drawn", done / max(time.monotonic() - begin, 1e-9)))

        write_video(recorded, out, note, film, replace)


def live(log: Path, window: Window, say: Callable[[str], None]) -> None:
    """Serve a log until Ctrl-C; errors as of `serve`."""
    from surefoot.scenarios.show.replay.live import serve

    with contextlib.suppress(KeyboardInterrupt):
        serve(log, window, say)


def check(fidelity: str, *, video: Path | None, view: bool, replace: bool = False) -> None:
    """Say before a run what its pictures would lack after it.

    Raises:
        MissingExtraError: an optional package is not installed.
        LogError: the fidelity has no body to show, or the video exists or its name does not end in .mp4.
    """
    if fidelity == "pendulum":
        raise LogError("a pendulum has no body to show; drop --video and --view, or run with fidelity full")
    if video is not None:
        if video.suffix != ".mp4":
            raise LogError(f"{video}: a video is an MP4 file; give a name that ends in .mp4")
        require("av", "video", "--video")
        refuse_existing(video, replace)
    if view:
        require("viser", "replay", "--view")


class LiveView:
    """Progress of a run, passed on; the first of it opens the replay, since the log holds something from then on."""

    def __init__(self, on_progress: OnProgress) -> None:
        self._log, self._on_progress = Path(), on_progress
        self._process: subprocess.Popen[bytes] | None = None

    def begin(self, log: Path) -> None:
        """Take note of where the log is."""
        self._log = log

    def __call__(self, progress: Progress) -> None:
        """See `OnProgress`."""
        if self._process is None:
            command = [sys.executable, "-m", "surefoot", "replay", str(self._log), "--live"]
            self._process = subprocess.Popen(command, stdout=sys.stderr)
        self._on_progress(progress)

    def wait(self) -> None:
        """Leave the replay open until Ctrl-C."""
        if self._process is None:
            return
        with contextlib.suppress(KeyboardInterrupt):
            self._process.wait()
        self._process.terminate()
