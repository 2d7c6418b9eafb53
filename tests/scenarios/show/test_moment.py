"""Findings lead to the moment: by a link where a replay is there, else by the command that makes one."""

import json
import os
import shlex
from pathlib import Path

import pytest

from surefoot.scenarios.show.moment import AFTER, BEFORE, Moment

pytestmark = pytest.mark.unit


def test_the_link_is_there_where_the_replay_is_as_new_as_its_log(tmp_path):
    log, page = tmp_path / "a walk" / "log.mcap", tmp_path / "a walk" / "replay.html"
    log.parent.mkdir()
    log.write_bytes(b"")
    moment = Moment(log, 2.5)
    assert moment.link is None and moment.text == moment.command
    page.write_text("")
    assert moment.text == moment.link == f"{page}#t=2.500"
    os.utime(page, (1.0, 1.0))
    assert moment.link is None, "a replay of an earlier run shows another one"


def test_the_command_shows_the_time_about_the_moment():
    words = shlex.split(Moment(Path("runs/a walk/log.mcap"), 2.5).command)
    assert words[:3] == ["surefoot", "replay", "runs/a walk/log.mcap"]
    options = dict(zip(words[3:-1:2], words[4:-1:2], strict=True))
    assert options == {
        "--html": "runs/a walk/replay.html",
        "--from": f"{2.5 - BEFORE:.3f}",
        "--to": f"{2.5 + AFTER:.3f}",
    }
    assert "--from 0.000" in Moment(Path("log.mcap"), 0.2).command


def test_moments_go_into_json():
    assert set(json.loads(json.dumps(Moment(Path("log.mcap"), 1.0).to_json()))) == {"command", "link"}
