"""A live replay in a process of its own, beside the run that it shows."""

import contextlib
import subprocess
import sys
from pathlib import Path

from scenarios.errors import LogError
from scenarios.progress import OnProgress, Progress
from scenarios.replay.extras import require


def check(fidelity: str, *, video: Path | None, view: bool) -> None:
    """Say before a run what its pictures would lack after it.

    Raises:
        MissingExtraError: an optional package is not installed.
        LogError: the fidelity has no body to show, or the video's name does not end in .mp4.
    """
    if fidelity == "pendulum":
        raise LogError("a pendulum has no body to show; drop --video and --view, or run with fidelity full")
    if video is not None:
        if video.suffix != ".mp4":
            raise LogError(f"{video}: a video is an MP4 file; give a name that ends in .mp4")
        require("av", "video", "--video")
    if view:
        require("viser", "replay", "--view")


class LiveView:
    """Progress of a run, passed on; the first of it opens the replay, since the log exists from then on."""

    def __init__(self, log: Path, on_progress: OnProgress) -> None:
        self._log, self._on_progress = log, on_progress
        self._process: subprocess.Popen[bytes] | None = None

    def __call__(self, progress: Progress) -> None:
        """See `OnProgress`."""
        if self._process is None:
            command = [sys.executable, "-m", "scenarios", "replay", str(self._log), "--live"]
            self._process = subprocess.Popen(command, stdout=sys.stderr)
        self._on_progress(progress)

    def wait(self) -> None:
        """Leave the replay open until Ctrl-C."""
        if self._process is None:
            return
        with contextlib.suppress(KeyboardInterrupt):
            self._process.wait()
        self._process.terminate()
