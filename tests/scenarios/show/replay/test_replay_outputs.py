"""Page, video and live view of one log; what is missing is said in one sentence."""

import importlib
import re
import sys
import time

import numpy as np
import pytest

from surefoot.scenarios import cli
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.show.replay import content as extras
from surefoot.scenarios.show.replay import video
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.poses import Window
from surefoot.scenarios.show.replay.video import marks_of
from surefoot.sim import gl

pytestmark = pytest.mark.unit


@pytest.fixture
def surefoot(monkeypatch, capsys):
    """Run a command; gives exit code, standard output and standard error."""

    def command(*arguments):
        monkeypatch.setattr(sys, "argv", ["surefoot", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return command


def test_a_page_is_whole_and_alone(surefoot, log_path, tmp_path):
    pytest.importorskip("viser")
    page = tmp_path / "walk.html"
    code, out, err = surefoot("replay", log_path, "--html", page)
    assert (code, out, err) == (0, f"{page}\n", "")
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < 3e6
    assert "<title>invented</title>" in text
    assert "__VISER_EMBED_DATA__" in text
    assert not re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"']?(?:https?:)?//", text)
    assert [file.name for file in tmp_path.iterdir()] == ["walk.html"]


def test_a_video_has_every_frame(surefoot, log_path, tmp_path, monkeypatch):
    av = pytest.importorskip("av")
    monkeypatch.setattr(video, "WIDTH", 160)
    monkeypatch.setattr(video, "HEIGHT", 96)
    path = tmp_path / "walk.mp4"
    code, out, err = surefoot("replay", log_path, "--video", path, "--from", 0.3, "--to", 0.6)
    if "no off-screen OpenGL" in err:
        pytest.skip(err)
    assert (code, out) == (0, f"{path}\n")
    with av.open(str(path)) as container:
        frames = list(container.decode(video=0))
        assert container.streams.video[0].average_rate == 30
    assert len(frames) == 10
    assert (frames[0].width, frames[0].height) == (160, 96)
    first, last = (frame.to_ndarray(format="rgb24").astype(float) for frame in (frames[0], frames[-1]))
    assert first.std() > 10
    assert np.abs(first - last).max() > 30


def test_marks_are_what_a_frame_shows(log):
    replay = extract(log)
    early, late = list(marks_of(replay, 3)), list(marks_of(replay, 28))
    assert all(np.isfinite(mark.ends).all() for mark in early + late)
    arrows = [mark for mark in late if mark.kind == "arrow"]
    assert len(arrows) == 1
    lines = [sum(mark.kind == "line" and mark.color == replay.footprints[3].color for mark in m) for m in (early, late)]
    assert lines[1] >= lines[0] + 4


@pytest.mark.parametrize(
    ("option", "module", "message"),
    [
        ("--html", "viser", "needs the package viser; install it with: pip install 'surefoot[replay]'"),
        ("--video", "av", "needs the package av; install it with: pip install 'surefoot[video]'"),
    ],
)
def test_a_missing_extra_is_named(surefoot, log_path, tmp_path, monkeypatch, option, module, message):
    def absent(name):
        raise ImportError(name) if name == module else AssertionError(name)

    monkeypatch.setattr(extras.importlib, "import_module", absent)
    code, out, err = surefoot("replay", log_path, option, tmp_path / "out")
    assert (code, out) == (2, "")
    assert message in err
    assert len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_missing_opengl_is_named(surefoot, log_path, tmp_path, monkeypatch):
    pytest.importorskip("av")
    monkeypatch.setattr(gl, "BACKENDS", {"egl": "libNoSuchEGL.so.1"})
    code, _, err = surefoot("replay", log_path, "--video", tmp_path / "out.mp4")
    assert code == 2
    assert "install the Debian packages" in err
    assert len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give one of --html FILE, --video FILE and --live"),
        (["--html", "x", "--live"], "give one of --html FILE, --video FILE and --live"),
        (["--html", "x", "--from", "9"], "the log goes from"),
        (["--html", "/no/such/x.html"], "cannot be written"),
    ],
)
def test_bad_usage_is_one_message_and_2(surefoot, log_path, arguments, message):
    if "/no/such/x.html" in arguments:
        pytest.importorskip("viser")
    code, out, err = surefoot("replay", log_path, *arguments)
    assert (code, out) == (2, "")
    assert message in err
    assert "Traceback" not in err


def test_a_foreign_file_is_no_log(surefoot, tmp_path):
    foreign = tmp_path / "x.mcap"
    foreign.write_text("hello")
    assert surefoot("replay", foreign, "--live")[0] == 2


def test_a_failure_leaves_the_older_file(tmp_path):
    path = tmp_path / "out"
    path.write_text("older")
    for place in (path, tmp_path / "new"):
        with pytest.raises(RuntimeError), write_whole(place, replace=True) as temporary:
            temporary.write_text("half")
            raise RuntimeError
    with pytest.raises(RuntimeError), write_whole(tmp_path / "new"):
        raise RuntimeError
    assert path.read_text() == "older"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(LogError, match="is a directory"), write_whole(tmp_path):
        pass


def test_a_live_view_plays_and_follows_a_growing_log(log_path, tmp_path):
    pytest.importorskip("viser")
    from surefoot.scenarios.show.replay.live import Player
    from surefoot.scenarios.show.replay.scene import serving

    growing = tmp_path / "growing.mcap"
    growing.write_bytes(log_path.read_bytes()[: log_path.stat().st_size // 2])
    part, whole = extract(read(growing)), extract(read(log_path))
    with serving() as server:
        player, begin = Player(server, part), time.monotonic()
        pelvis = server.scene.get_handle_by_name("/Robot/pelvis")
        player.advance(begin + 0.2)
        frame = np.searchsorted(part.time, server_time(server), side="right") - 1
        assert 0.1 < server_time(server) < 0.3
        assert pelvis.position == pytest.approx(part.body_position[frame, part.body_names.index("pelvis")])
        player.replace(whole)
        following = next(h for h in handles(server) if h.label == "follow the run")
        following.value = True
        player.advance(begin + 0.3)
        assert server_time(server) == pytest.approx(whole.time[-1], abs=1e-3)
        assert pelvis.position == pytest.approx(whole.body_position[-1, whole.body_names.index("pelvis")])


def handles(server):
    return list(server.gui._gui_input_handle_from_uuid.values())


def server_time(server) -> float:
    return next(handle.value for handle in handles(server) if handle.label == "time [s]")


def test_importing_the_command_needs_no_extra(monkeypatch):
    for name in ("viser", "av"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("command", "live", "video"):
        importlib.reload(importlib.import_module(f"surefoot.scenarios.show.replay.{name}"))
    assert Window().frame_rate == 30.0
