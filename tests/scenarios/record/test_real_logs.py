"""The log of a run in full physics: whole, reproducible, readable by others, and worth reading after kill -9."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_doctor import complaints
from mcap_protobuf.decoder import DecoderFactory

from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.log import read
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.record.foxglove import DERIVED_TOPICS
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.physics

SHORT = (
    "sensing.source=truth",
    "gait.steps=2",
    "gait.single_support=0.8",
    "gait.initial_stand=0.2",
    "duration=3.5",
    "seed=5",
)
NOISE = ("start.position_noise=0.001", "start.angle_noise=0.01")


def walk(folder):
    return run_scenario(load_scenario("diagonal-walk", (*SHORT, *NOISE)), folder).log


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return walk(tmp_path_factory.mktemp("runs"))


def surefoot(*arguments, **options):
    return subprocess.run([sys.executable, "-m", "surefoot", *map(str, arguments)], text=True, **options)


def test_the_same_run_gives_the_same_content_but_for_the_clock_on_the_wall(log, tmp_path, from_sensors):
    """In another process, so that nothing left over in this one can help."""
    overrides = [word for override in (*SHORT, *NOISE) for word in ("--set", override)]
    surefoot("run", "diagonal-walk", *overrides, "--out", tmp_path, "--json", capture_output=True)
    first, second = read(log), read(tmp_path / "diagonal-walk-5" / "log.mcap")
    assert first.topics == second.topics
    different = [topic for topic in first.topics if list(first.messages(topic)) != list(second.messages(topic))]
    assert sorted(different) == ["/process", "/timing"]
    if not from_sensors:  # the other process does not read what is added to the catalogue
        assert first.attachments == second.attachments
        assert first.metadata == second.metadata


def test_the_stock_doctor_finds_nothing(log):
    assert not complaints(log)


def test_a_flight_recorder_and_thinned_channels_in_full_physics(log, tmp_path, same_content):
    """Each by itself and both together; the robot is felt by its sensors, whose readings do not judge."""
    felt = tuple(key for key in SHORT if not key.startswith("sensing"))
    whole = run_scenario(load_scenario("diagonal-walk", felt), tmp_path)
    thin = run_scenario(load_scenario("diagonal-walk", (*felt, "log.rate=10")), tmp_path)
    both = run_scenario(load_scenario("diagonal-walk", (*felt, "log.rate=10", "log.keep=1s")), tmp_path)
    logs = [read(result.log) for result in (whole, thin, both)]
    assert not any(complaints(each.path) or each.losses() for each in logs)
    assert thin.verdict.passed == whole.verdict.passed
    assert thin.verdict.reasons == whole.verdict.reasons
    for name, value in thin.verdict.metrics.items():
        assert value == whole.verdict.metrics[name] or not OWN[name].repeatable, name
    assert len(logs[1]["/readings"]) == 35 < len(logs[0]["/readings"])
    assert thin.log.stat().st_size < 0.85 * whole.log.stat().st_size
    assert not both.verdict.passed
    assert 1.0 <= logs[2]["/truth"].time[-1] + 0.002 - logs[2]["/truth"].time[0] < 2.2
    assert logs[2].count("/scene/world") >= 1
    begin = logs[2]["/truth"].time_ns[0]
    assert logs[2]["/truth"].content() == logs[0]["/truth"].between(begin, 10**12).content()
    assert not same_content(both.log, run_scenario(load_scenario(str(both.log)), tmp_path).log)


def test_the_stock_reader_decodes_every_channel_by_its_schema(log):
    ours = read(log)
    seen = dict.fromkeys(ours.topics, 0)
    with log.open("rb") as file:
        for _, channel, message, decoded in make_reader(
            file, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages():
            row = seen[channel.topic]
            seen[channel.topic] += 1
            if row % 100 or channel.topic in DERIVED_TOPICS:
                continue
            for field in ours[channel.topic].fields:
                expected = ours[channel.topic].field(field.name)[row].ravel()
                np.testing.assert_array_equal(np.ravel(getattr(decoded, field.name)), expected)
            assert message.log_time == ours[channel.topic].time_ns[row]
    assert seen == {topic: ours.count(topic) for topic in ours.topics}
    assert [topic for topic, count in seen.items() if count == 0] == ["/command"], "of a walk that was told nothing"


def test_it_says_by_itself_what_was_run(log):
    found = read(log)
    assert found.attachments["robot.xml"].startswith(b"<mujoco")
    assert found.attachments[WORLD_FILE].startswith(b"<mujoco")
    assert found.metadata["versions"]["mujoco"]
    assert b"steps: 2" in found.attachments["scenario.yaml"]


def test_sensors_and_plan_agree_with_the_truth(log):
    """From rest to rest the mean contact force carries the weight, and a plan begins at the true CoM."""
    found = read(log)
    force = found["/contact"].field("normal_force").sum(axis=1)
    assert np.mean(force) == pytest.approx(100.0 * 9.81, rel=2e-3)
    gap = found["/plan"].field("com")[:, 0] - found["/truth"].field("com")[:: 500 // 50]
    assert np.abs(gap[:, :2]).max() < 1e-9


def test_killed_in_the_middle_of_a_run(tmp_path):
    """At most 100 ms of simulated time are missing: here what the run had told to be done when it was killed."""
    log = tmp_path / "diagonal-walk-0" / "log.mcap"
    process = subprocess.Popen([sys.executable, "-c", _TELLING, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    told = 0.0
    while told < 3.0:
        told = float(process.stdout.readline())
    os.kill(process.pid, signal.SIGKILL)
    told = max([told, *map(float, process.stdout.read().split())])
    assert process.wait() == -signal.SIGKILL
    assert_readable_until(log, told, tmp_path)


def assert_readable_until(log, told, folder):
    found = inspect(read(log))
    assert found.truncated
    assert any("the file is truncated" in finding.cause for finding in found.health)
    assert "the run was cut off" in found.verdict.reasons[0]
    shown = surefoot("inspect", log, capture_output=True)
    assert shown.returncode == 1
    assert "the file is truncated" in shown.stdout
    recover(log, folder / "whole.mcap")
    whole = read(folder / "whole.mcap")
    assert not whole.truncated
    assert whole.time_range()[1] == found.end
    with (folder / "whole.mcap").open("rb") as file:
        assert make_reader(file).get_summary().statistics.message_count == sum(whole.count(t) for t in whole.topics)


_TELLING = """
import sys
from pathlib import Path
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.run.run import run_scenario
run_scenario(load("diagonal-walk"), Path(sys.argv[1]), lambda progress: print(progress.time, flush=True))
"""


@pytest.mark.usefixtures("heeding")
def test_interrupted_by_the_user(tmp_path):
    """Ctrl-C gives a whole log, a verdict beside it and exit code 130."""
    log = tmp_path / "diagonal-walk-0" / "log.mcap"
    command = [sys.executable, "-m", "surefoot", "run", "diagonal-walk", "--out", str(tmp_path), "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (log.exists() and log.stat().st_size > 1_000_000) and process.poll() is None:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted by the user" in json.loads(out)["reasons"][0]
    assert "Traceback" not in err
    assert not read(log).truncated


def test_a_directory_that_cannot_be_written(tmp_path):
    done = surefoot("run", "diagonal-walk", "--out", "/proc/surefoot", capture_output=True)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "/proc/surefoot: cannot be created" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_full_disk(tmp_path):
    """A limit on the size of files stands for it: the run stops with a clear error, and nothing is called a log."""
    limited = "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
    limited += "resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))\n"
    limited += "sys.argv = ['surefoot', 'run', 'stand', '--out', sys.argv[1]]\n"
    limited += "from surefoot.scenarios.cli.program import program\nprogram()"
    done = subprocess.run([sys.executable, "-c", limited, str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 2
    assert "cannot be written on, file too large; what was written is kept in log.mcap.incomplete" in done.stderr
    assert "Traceback" not in done.stderr
    assert [path.name for path in (tmp_path / "stand-0").iterdir()] == ["log.mcap.incomplete"]
