"""What `surefoot replay` does once its options are sound."""

import contextlib
import time
from collections.abc import Callable
from pathlib import Path

from scenarios.console import ProgressLine
from scenarios.log import read
from scenarios.progress import Progress
from scenarios.replay.extract import extract
from scenarios.replay.frames import Window


def html_page(log: Path, out: Path, window: Window) -> None:
    """Write a page; errors as of `extract` and `write_page`."""
    from scenarios.replay.html import write_page

    write_page(extract(read(log), window), out)


def video(log: Path, out: Path, window: Window) -> None:
    """Write a video, with a progress line; errors as of `extract` and `write_video`."""
    from scenarios.replay.video import write_video

    replay, begin = extract(read(log), window), time.monotonic()
    length = len(replay) / replay.frame_rate
    with ProgressLine(out.name) as line:

        def note(frames: int) -> None:
            done = frames / replay.frame_rate
            line(Progress(done, length, "drawn", done / max(time.monotonic() - begin, 1e-9)))

        write_video(replay, out, note)


def live(log: Path, window: Window, say: Callable[[str], None]) -> None:
    """Serve a log until Ctrl-C; errors as of `serve`."""
    from scenarios.replay.live import serve

    with contextlib.suppress(KeyboardInterrupt):
        serve(log, window, say)
