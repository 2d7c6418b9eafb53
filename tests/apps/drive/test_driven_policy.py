"""A policy is driven from the page: it hears velocities and is not disturbed by others, and its log runs again."""

import json
import os
import signal
import subprocess
import sys
import time

import policies
import pytest
import yaml
from needs import POLICY

import surefoot
from surefoot.apps.drive.page import CHANNEL

pytestmark = [pytest.mark.physics, POLICY.mark]

GIVEN = (
    {"kind": "gait", "single_support": 0.4, "double_support": 0.1},  # which no policy hears
    {"kind": "velocity", "v_x": 0.2, "v_y": 0.0, "yaw_rate": 0.0},
)


@pytest.mark.parametrize(("robot", "height"), [("g1", 0.67), ("humanoid100", 1.0)])
def test_it_is_driven_and_its_log_runs_again(heeding_throughout, same_content, tmp_path, robot, height):
    client = pytest.importorskip("websockets.sync.client")
    pytest.importorskip("viser")
    stander = policies.stander(tmp_path / "stander", robot)
    values = {"robot": robot, "gait": {"steps": 0, "com_height": height}, "criteria": {"fell": False}}
    (tmp_path / "held.yaml").write_text(yaml.safe_dump(values))
    words = ["drive", "held.yaml", "--policy", str(stander), "--out", "driven"]
    process = subprocess.Popen(
        [sys.executable, "-m", "surefoot", *words],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    try:
        address = process.stdout.readline().split()[0]
        process.stdout.readline()  # the log
        with client.connect(f"{address.replace('http', 'ws')}{CHANNEL}") as socket:
            for given in GIVEN:
                socket.send(json.dumps(given))
                time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
        process.wait()
    assert "the logs are whole" in said and "Traceback" not in said, said
    (path,) = (tmp_path / "driven").rglob("log.mcap")
    log = surefoot.read(path)
    assert log.metadata["controller"]["name"] == "policy"
    assert log["/command"].field("velocity")[0, 0] == 0.2  # a slow machine may stop it after that
    again = surefoot.run(str(path), out=tmp_path / "again")
    told = surefoot.read(again.log)
    assert told["/truth"].field("q")[: log.count("/truth")].tobytes() == log["/truth"].field("q").tobytes()
