"""The commands that show a log in 3D, and a run while it goes on."""

import contextlib
import html
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.loop.skeleton import OnProgress, Progress
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.console import ProgressLine
from surefoot.scenarios.show.replay.content import Replay, require
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.poses import Window
from surefoot.scenarios.show.replay.scene import ViserScene, rgb, serving

_STYLE = """
#surefoot { position: fixed; left: 1em; bottom: 4.5em; z-index: 1; font: 13px/1.5 system-ui, sans-serif;
  color: #333; background: rgba(255, 255, 255, 0.75); padding: 0.4em 0.8em; border-radius: 4px; pointer-events: none }
#surefoot b { display: inline-block; width: 0.8em; height: 0.8em; margin-right: 0.5em; border-radius: 50% }
"""

_OPEN_SCENE_TREE = """
const opening = setInterval(() => {
  const button = document.querySelector('[aria-label="Show scene tree"]');
  if (button) { clearInterval(opening); button.click(); }
}, 200);
"""
"""The scene tree holds the switches of the layers, and viser keeps it closed at first."""


def write_page(replay: Replay, path: Path, replace: bool = False) -> None:
    """Write the page.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the file exists, and shall not be replaced, or cannot be written.
    """
    with write_whole(path, replace) as temporary:
        temporary.write_text(page(replay), encoding="utf-8")


def page(replay: Replay) -> str:
    """The page as text.

    Raises:
        MissingExtraError: viser is not installed.
    """
    with serving() as server:
        scene = ViserScene(server, replay)
        recorder = server.get_scene_serializer()
        for frame in range(1, len(replay)):
            recorder.insert_sleep(float(replay.time[frame] - replay.time[frame - 1]))
            scene.show(frame)
        recorded: str = recorder.as_html()
    return _with_legend(recorded, replay)


def _with_legend(recorded: str, replay: Replay) -> str:
    """Add title, legend and open switches to a recorded page."""
    span = f"{replay.time[0]:.1f} s to {replay.time[-1]:.1f} s"
    layers: dict[str, Color] = {}
    for track in replay.tracks:
        layers.setdefault(
            track.layer if track.layer != "Contact forces" else f"{track.layer}, {track.name}", track.color
        )
    entries = "".join(f'<div><b style="background:rgb{rgb(color)}"></b>{name}</div>' for name, color in layers.items())
    title = html.escape(replay.title)
    legend = (
        f"<style>{_STYLE}</style><div id=surefoot>{title}, {span}{entries}</div><script>{_OPEN_SCENE_TREE}</script>"
    )
    head, tail = recorded.rsplit("</body>", 1)
    before, after = head.split("<head>", 1)
    return f"{before}<head><title>{title}</title>{after}{legend}</body>{tail}"


def html_page(log: Path, out: Path, window: Window, replace: bool = False) -> None:
    """Write a page; errors as of `extract` and `write_page`."""
    refuse_existing(out, replace)
    write_page(extract(read(log), window), out, replace)


def video(log: Path, out: Path, window: Window, replace: bool = False) -> None:
    """Write a video, with a progress line; errors as of `extract` and `write_video`."""
    from surefoot.scenarios.show.replay.video import write_video

    refuse_existing(out, replace)
    replay, begin = extract(read(log), window), time.monotonic()
    length = len(replay) / replay.frame_rate
    with ProgressLine(out.name) as line:

        def note(frames: int) -> None:
            done = frames / replay.frame_rate
            line(Progress(done, length, "drawn", done / max(time.monotonic() - begin, 1e-9)))

        write_video(replay, out, note, replace)


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
