"""Page, video and live view of one log; what is missing is said in one sentence."""

import importlib
import json
import re
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
from needs import OPENGL

from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.page import column
from surefoot.scenarios.show.replay.scene import rgb
from surefoot.scenarios.show.replay.video import CAMERAS, Caption, Film, marks_of, stand
from surefoot.sim import gl
from surefoot.sim.render import Camera

pytestmark = pytest.mark.unit


@pytest.fixture
def surefoot(capsys):
    """Run a command; gives exit code, standard output and standard error."""

    def command(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.program([*map(str, arguments)])
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
    data = json.loads(re.findall(r"<script id=surefoot-data type=application/json>(.*?)</script>", text)[0])
    assert data["layers"][:2] == ["/Ground", "/Robot"]
    forward, left, margins, force = data["charts"]
    assert [chart["label"][-3:] for chart in data["charts"]] == ["[m]", "[m]", "[m]", "[N]"]
    assert [curve["name"] for curve in margins["curves"]] in ([], ["steps as planned", "steps moved"])
    assert [curve["name"] for curve in force["curves"]] == ["left foot", "right foot"]
    assert {curve["name"] for curve in left["curves"]} >= {"ZMP", "CoM", "DCM", "ZMP planned"}
    assert all(len(curve["values"]) == len(data["time"]) for chart in data["charts"] for curve in chart["curves"])
    zmp = next(curve["values"] for curve in forward["curves"] if curve["name"] == "ZMP")
    assert zmp[10] == pytest.approx(data["time"][10], abs=2e-3)  # the stance foot stands at the origin
    assert zmp[-1] is None


def test_a_page_with_a_hostile_name_stays_one_script(log):
    chart = {"label": "[m]", "digits": 1, "curves": [{"name": "</script>$x", "values": [0.0]}]}
    text = column(replace(extract(log, ReplayWindow(end=0.0)), title="<b>"), ("/a",), [chart])
    assert text.count("</script>") == 3
    assert "&lt;b&gt;" in text
    assert "$x" in text


def test_a_video_has_every_frame_with_its_clock(surefoot, log_path, tmp_path):
    OPENGL.or_skip()
    av = pytest.importorskip("av")
    path = tmp_path / "walk.mp4"
    code, out, err = surefoot(
        "replay", log_path, "--video", path, "--from", 0.3, "--to", 0.6, "--size", "160x96", "--speed", 2
    )
    assert (code, out) == (0, f"{path}\n"), err
    with av.open(str(path)) as container:
        frames = list(container.decode(video=0))
        assert container.streams.video[0].average_rate == 30
    assert len(frames) == 5
    assert (frames[0].width, frames[0].height) == (160, 96)
    first, last = (frame.to_ndarray(format="rgb24").astype(float) for frame in (frames[0], frames[-1]))
    assert first.std() > 10
    assert np.abs(first - last).max() > 30
    window = ReplayWindow(0.3, 0.6, 15.0)
    replay = extract(read(log_path), window)
    caption = Caption(replay, (160, 96), 2.0)
    for frame, seconds in ((first, replay.time[0]), (last, replay.time[-1])):
        on_black, on_white = (caption.drawn_on(np.full((96, 160, 3), v, np.uint8), seconds)[..., 0] for v in (0, 255))
        plate, letters = on_black > 170, on_white < 60
        assert frame[plate].mean() - frame[letters].mean() > 70


def test_a_caption_names_the_run_its_time_and_the_colours(log):
    replay = extract(log)
    caption = Caption(replay, (640, 360), 0.5)
    early, late = (caption.drawn_on(np.zeros((360, 640, 3), np.uint8), time) for time in (1.0, 2.0))
    rows, columns = np.nonzero((early != late).any(axis=2))
    assert 0 < rows.min() < rows.max() < 40
    assert columns.min() > 480
    assert early[:40, :200].any()
    below = early[300:].reshape(-1, 3).astype(int)
    assert next(iter(replay.legend())) == "CoM"
    for color in replay.legend().values():
        assert np.abs(below - np.array(rgb(color))).max(axis=1).min() < 30
    assert not early[100:300].any()


def test_a_fixed_camera_sees_the_whole_way_and_another_goes_along(log):
    replay = extract(log)
    base = np.column_stack([np.linspace(0, 10, 300), np.zeros(300), np.ones(300)])
    walk = replace(replay, time=np.arange(300) / 30, body_position=np.repeat(base[:, None], 2, axis=1))
    camera, look_at = stand(walk, CAMERAS["fixed"])
    assert look_at == pytest.approx(np.tile([5.0, 0.0, 1.0], (300, 1)), abs=0.1)
    assert camera.distance > 5.0
    camera, look_at = stand(walk, CAMERAS["side"])
    assert (camera, look_at[150]) == (CAMERAS["side"], pytest.approx(base[150]))


def test_a_film_is_what_was_asked_for():
    film = Film.of(0.5, "90,-5,3", "640x360")
    assert (film.size, film.camera) == ((640, 360), Camera(3.0, 90.0, -5.0))
    assert film.window(ReplayWindow(1.0, 2.0)) == ReplayWindow(1.0, 2.0, 60.0)
    assert Film().camera == CAMERAS["follow"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, "follow", "640x360"), "--speed 0: give a number from 0.1 to 10"),
        ((float("nan"), "follow", "640x360"), "--speed nan: give a number"),
        ((1.0, "sid", "640x360"), "--camera sid: choose follow, side, front, fixed, or azimuth,elevation,distance"),
        ((1.0, "1,2", "640x360"), "--camera 1,2: choose"),
        ((1.0, "0,-95,3", "640x360"), "elevation from -89 to 89 degrees"),
        ((1.0, "0,nan,3", "640x360"), "elevation from -89 to 89 degrees"),
        ((1.0, "follow", "640"), "--size 640: give width and height in pixels"),
        ((1.0, "follow", "641x360"), "--size 641x360: give even numbers from 64 to 3840"),
        ((1.0, "follow", "640x99999"), "give even numbers"),
    ],
)
def test_no_such_film(arguments, message):
    with pytest.raises(LogError, match=re.escape(message)):
        Film.of(*arguments)


def test_options_of_a_video_belong_to_a_video(surefoot, log_path, tmp_path):
    code, out, err = surefoot("replay", log_path, "--html", tmp_path / "x.html", "--speed", 2)
    assert (code, out) == (2, "")
    assert "are of a video; give them with --video FILE" in err


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
        ("--html", "viser", "needs the package viser; install it with: "),
        ("--video", "av", "needs the package av; install it with: "),
    ],
)
def test_a_missing_extra_is_named(surefoot, log_path, tmp_path, monkeypatch, option, module, message):
    monkeypatch.setitem(sys.modules, module, None)
    code, out, err = surefoot("replay", log_path, option, tmp_path / "out")
    assert (code, out) == (2, "")
    assert message in err
    assert len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_missing_opengl_is_named(surefoot, log_path, tmp_path, monkeypatch):
    pytest.importorskip("av")
    for backend in gl.BACKENDS:
        monkeypatch.setitem(sys.modules, f"mujoco.{backend}", None)
    code, _, err = surefoot("replay", log_path, "--video", tmp_path / "out.mp4")
    assert code == 2
    assert "install the Debian packages" in err
    assert len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give one of --html FILE, --video FILE, --rrd FILE and --live"),
        (["--html", "x", "--live"], "give one of --html FILE, --video FILE, --rrd FILE and --live"),
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
    from surefoot.scenarios.show.replay.gate import serving
    from surefoot.scenarios.show.replay.live import Player

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
        robot = server.scene.get_handle_by_name("/Robot")
        assert part.followed()[frame] + robot.position == pytest.approx(part.followed()[0])
        camera = next(h for h in handles(server) if h.label == "camera follows the robot")
        camera.value, stays = False, robot.position
        player.replace(whole)
        following = next(h for h in handles(server) if h.label == "follow the run")
        following.value = True
        player.advance(begin + 0.3)
        assert server_time(server) == pytest.approx(whole.time[-1], abs=1e-3)
        assert pelvis.position == pytest.approx(whole.body_position[-1, whole.body_names.index("pelvis")])
        assert robot.position == pytest.approx(stays)


def test_a_camera_follows_the_walk_and_not_its_sway(log):
    replay = extract(log)
    time = np.arange(0, 10, 1 / 30)
    base = np.column_stack([0.5 * time, 0.03 * np.sin(2 * np.pi * time), 1.0 + 0.1 * time])
    position = np.repeat(base[:, None], 2, axis=1)
    followed = replace(replay, time=time, body_position=position).followed()
    inside = slice(20, -20)
    assert followed[inside, 0] == pytest.approx(base[inside, 0])
    assert followed[inside, 2] == pytest.approx(base[inside, 2])
    assert np.abs(followed[inside, 1]).max() < 0.003


def handles(server):
    return list(server.gui._gui_input_handle_from_uuid.values())


def server_time(server) -> float:
    return next(handle.value for handle in handles(server) if handle.label == "time [s]")


def test_importing_the_command_needs_no_extra(monkeypatch):
    for name in ("viser", "av"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("live", "page", "video"):
        importlib.reload(importlib.import_module(f"surefoot.scenarios.show.replay.{name}"))
    assert ReplayWindow().frame_rate == 30.0
