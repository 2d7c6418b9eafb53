"""A signal that is ignored when a command begins stays ignored, as under ``nohup``: in it, and in its processes."""

import os
import signal
import subprocess
import sys
import time

import pytest

from surefoot.scenarios.run.interrupts import SIGNALS
from surefoot.scenarios.run.processes import processes

CAMPAIGN = "scenario: stand\nset: {duration: 2, criteria: {fell: false}}\n"


def ignoring():
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def begun(folder, *arguments):
    """A command that is under way: of its run there is a log."""
    command = [sys.executable, "-m", "surefoot", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    process = subprocess.Popen(command, cwd=folder, preexec_fn=ignoring, start_new_session=True, **pipes)
    while not list(folder.rglob("log.mcap")) and process.poll() is None:
        time.sleep(0.05)
    return process


def signal_all(process):
    for number in SIGNALS * 5:
        os.killpg(process.pid, number)
        time.sleep(0.05)


@pytest.mark.physics
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("run", "stand", "--set", "duration=2", "--set", "criteria={fell: false}"), "stand: verdict pass"),
        (("sweep", "short.yaml", "--jobs", "1"), "short: 1 runs, 1 pass"),
        pytest.param(("check", "stand", "--jobs", "1"), "stand: same", marks=pytest.mark.long),
    ],
)
def test_a_command_goes_on_to_its_end(tmp_path, arguments, said):
    (tmp_path / "short.yaml").write_text(CAMPAIGN)
    process = begun(tmp_path, *arguments)
    signal_all(process)
    out, _ = process.communicate(timeout=120)
    assert (process.returncode, said in out) == (0, True), out


@pytest.mark.physics
def test_a_drive_and_a_replay_go_on(tmp_path):
    drive = begun(tmp_path, "drive")
    (log,) = tmp_path.rglob("log.mcap")
    replay = begun(tmp_path, "replay", str(log), "--live")
    replay.stdout.readline()
    for process in (drive, replay):
        signal_all(process)
        time.sleep(1.0)
        assert process.poll() is None
        process.kill()
        process.communicate()


@pytest.mark.unit
@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL])
def test_a_worker_is_ended_by_what_its_parent_was_begun_to_be_ended_by(handler, heeding):
    signal.signal(signal.SIGTERM, handler)
    with processes() as pool:
        assert pool.submit(signal.getsignal, signal.SIGTERM).result() == handler
        assert pool.submit(signal.getsignal, signal.SIGHUP).result() == signal.SIG_IGN
