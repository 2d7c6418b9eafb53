"""A recording for rerun has the robot, the marks, the forces and the curves of a replay, laid out."""

import subprocess
import sys
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest
from needs import RERUN

from surefoot.scenarios.errors import LogError, MissingExtraError
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.page import CHARTS
from surefoot.scenarios.show.replay.rrd import Recorder, layout, write_rrd

pytestmark = pytest.mark.unit


def test_without_rerun_it_says_how_to_install_it_and_writes_nothing(log_path, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(MissingExtraError, match=r"an rrd file needs the package rerun; .*\[rerun\]"):
        write_rrd(log_path, tmp_path / "walk.rrd")
    assert not (tmp_path / "walk.rrd").exists()


def test_a_file_is_not_replaced(log_path, tmp_path):
    (tmp_path / "walk.rrd").write_text("mine")
    with pytest.raises(LogError, match="exists already"):
        write_rrd(log_path, tmp_path / "walk.rrd")


def test_the_layout_has_the_scene_and_a_plot_for_every_chart():
    blueprint = MagicMock()
    layout(blueprint)
    assert blueprint.Spatial3DView.call_args.kwargs["origin"] == "/scene"
    assert [call.kwargs["name"] for call in blueprint.TimeSeriesView.call_args_list] == [c.label for c in CHARTS]


@pytest.fixture
def sent(log):
    """Data that a recorder sends: a replay, the columns by kind, and the paths."""
    rerun, replay = MagicMock(), extract(log)
    Recorder(rerun, MagicMock(), replay).write(log)
    return rerun, replay


def test_every_body_moves_as_in_the_replay(sent):
    rerun, replay = sent
    given = [call.kwargs for call in rerun.Transform3D.columns.call_args_list]
    bodies = sorted({surface.body for surface in replay.surfaces})
    assert len(given) == len(bodies)
    for body, moved in zip(bodies, given, strict=True):
        np.testing.assert_array_equal(moved["translation"], replay.body_position[:, body])
        np.testing.assert_array_equal(moved["quaternion"][:, 3], replay.body_quaternion[:, body, 0])


def test_a_mark_is_in_the_frames_in_which_it_is_shown(sent):
    rerun, replay = sent
    points = [track for track in replay.tracks if track.kind == "point" and np.isfinite(track.vertices).any()]
    assert rerun.Points3D.columns.call_count == len(points)
    counts = [call.args[0] for call in rerun.Points3D.columns.return_value.partition.call_args_list]
    for track, count in zip(points, counts, strict=True):
        assert count.tolist() == [int(track.shown(frame)) for frame in range(len(replay))]


def test_rerun_opens_what_is_written(log_path, tmp_path):
    RERUN.or_skip()
    out = tmp_path / "walk.rrd"
    write_rrd(log_path, out)
    program = [str(Path(sys.executable).with_name("rerun")), "rrd"]
    done = subprocess.run([*program, "verify", str(out)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    told = subprocess.run([*program, "stats", str(out)], capture_output=True, text=True, check=False).stdout
    assert "num_entity_paths" in told
    out.write_bytes(out.read_bytes()[: len(out.read_bytes()) // 2] + b"x" * 100)
    done = subprocess.run([*program, "verify", str(out)], capture_output=True, text=True, check=False)
    assert done.returncode != 0, "a damaged file is found"
