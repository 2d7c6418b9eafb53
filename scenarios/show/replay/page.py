"""A replay as one page that opens offline, made by viser's recorder."""

import html
from pathlib import Path

from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.replay.content import Replay, write_whole
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


def write_page(replay: Replay, path: Path) -> None:
    """Write the page.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the file cannot be written.
    """
    with write_whole(path) as temporary:
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
