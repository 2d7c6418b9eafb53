"""A replay beside a run while it goes on, by a process of its own: what a run without one need not import."""

import contextlib
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from surefoot.scenarios.errors import LogError, require
from surefoot.scenarios.output import refuse_existing
from surefoot.scenarios.run.skeleton import OnProgress, Progress


def check(fidelity: str, *, video: Path | None, view: bool, replace: bool = False) -> None:
    """Report before a run what its pictures would lack after it.

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


def _beside(log: Path) -> "subprocess.Popen[bytes]":
    """Open the replay of a log that grows."""
    command = [sys.executable, "-m", "surefoot", "replay", str(log), "--live"]
    return subprocess.Popen(command, stdout=sys.stderr)


LEAVE = 3.0
"""Time that a replay may take to end when it is asked to [s]."""


class LiveView:
    """Progress of a run, passed on; the first of it opens the replay, since the log holds something from then on.

    The replay ends with the context, however that ends.

    Args:
        on_progress: gets the progress.
        start: starts the process of a replay of a log.
    """

    def __init__(self, on_progress: OnProgress, start: "Callable[[Path], subprocess.Popen[bytes]]" = _beside) -> None:
        self._log, self._on_progress, self._start = Path(), on_progress, start
        self._process: subprocess.Popen[bytes] | None = None

    def begin(self, log: Path) -> None:
        """Take note of where the log is."""
        self._log = log

    def __call__(self, progress: Progress) -> None:
        """See `OnProgress`."""
        if self._process is None:
            self._process = self._start(self._log)
        self._on_progress(progress)

    def wait(self) -> None:
        """Leave the replay open until Ctrl-C."""
        if self._process is not None:
            with contextlib.suppress(KeyboardInterrupt):
                self._process.wait()

    def __enter__(self) -> "LiveView":
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is None:
            return
        self._process.terminate()
        try:
            self._process.wait(LEAVE)
        except subprocess.TimeoutExpired:
            self._process.kill()
