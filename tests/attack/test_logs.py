"""Attacks on logs and on their runs: an answer or a sentence, in time and in memory, and never a pass that is not true.

`SUREFOOT_TRIALS` says how many mutations the long test makes.
"""

import hashlib
import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from crafted import draft, recipes

import surefoot
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.log import read
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.differences import WALL_CLOCK

TRIALS = int(os.environ.get("SUREFOOT_TRIALS", "2000"))
SLOWEST, MOST = 10.0, 300 << 10
"""Most that one log may take, on a busy machine [s, KiB]."""

STAND = {"fidelity": "pendulum", "duration": 0.6, "criteria.standing_time_final": {"min": 0.1}}


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """A run that passes, and one that falls."""
    folder = tmp_path_factory.mktemp("runs")
    good = surefoot.run(surefoot.load("stand", STAND), out=folder)
    pushes = [{"time": 0.05, "duration": 0.3, "force": [3000, 0, 0]}]
    fallen = surefoot.run(surefoot.load("stand", {**STAND, "pushes": pushes}), out=folder)
    assert good.verdict.passed
    assert fallen.verdict["fell"]
    return good.log, fallen.log


def content(log):
    """Digest of every numeric channel but that of wall-clock times."""
    digest = hashlib.sha256()
    for topic in sorted(log.numeric):
        digest.update(topic.encode() + (b"" if topic in WALL_CLOCK else log[topic].content()))
    return digest.hexdigest()


def passes(path):
    """Return true if a log is judged a pass, in time and memory; refusing it in a sentence is no pass."""
    begin, peak = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        found = inspect(read(path))
        json.dumps(found.to_json(), allow_nan=False)
        return found.verdict.passed
    except LogError as refusal:
        assert "\n" not in str(refusal)
        return False
    finally:
        assert time.perf_counter() - begin < SLOWEST
        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - peak < MOST


def mutated(data, chunks, rng):
    """A log with one to eight flips, a cut, a hole, or its chunks swapped, doubled or missing."""
    kind, out = rng.randrange(6), bytearray(data)
    if kind == 0:
        for _ in range(rng.randint(1, 8)):
            out[rng.randrange(8, len(out))] ^= 1 << rng.randrange(8)
    elif kind == 1:
        del out[rng.randrange(8, len(out)) :]
    elif kind == 2:
        start = rng.randrange(8, len(out))
        del out[start : start + rng.randint(1, 2000)]
    else:
        first, second = sorted(rng.sample(chunks, 2), key=lambda place: place.start)
        parts = {3: (second, first), 4: (first, first, second), 5: (second,)}[kind]
        between = data[first.stop : second.start]
        joined = [data[part] for part in parts]
        out[first.start : second.stop] = joined[0] + between + b"".join(joined[1:])
    return bytes(out)


def attack(logs, tmp_path, trials, seed):
    """Mutate both logs so many times; gives how many passed."""
    rng, path, saved, passed = random.Random(seed), tmp_path / "mutated.mcap", tmp_path / "saved.mcap", 0
    for which, origin in enumerate(logs):
        log, data = read(origin), origin.read_bytes()
        chunks = [slice(chunk.position, chunk.position + chunk.length) for chunk in log.contents.chunks]
        original = content(log)
        for _ in range(trials // 2):
            path.write_bytes(mutated(data, chunks, rng))
            tried = [path]
            try:
                recover(path, saved, replace=True)
                tried.append(saved)
            except LogError as refusal:
                assert "\n" not in str(refusal)
            for one in tried:
                if passes(one):
                    assert which == 0, "a fallen run passes"
                    assert content(read(one)) == original, "other content passes"
                    passed += 1
    return passed


@pytest.mark.unit
def test_mutated_logs(logs, tmp_path):
    attack(logs, tmp_path, 30, seed=1)


@pytest.mark.long
def test_many_mutated_logs(logs, tmp_path):
    passed = attack(logs, tmp_path, TRIALS, seed=2)
    assert passed < 0.5 * TRIALS


RECIPES = dict(recipes())


@pytest.mark.unit
def test_there_are_recipes_and_a_draft_changes_nothing(logs, tmp_path):
    assert len(RECIPES) >= 60
    (tmp_path / "same.mcap").write_bytes(draft(read(logs[0])).bytes())
    assert passes(tmp_path / "same.mcap")


@pytest.mark.unit
@pytest.mark.parametrize("name", RECIPES)
def test_crafted_logs(logs, tmp_path, name):
    made = draft(read(logs[0]))
    RECIPES[name](made)
    path, saved = tmp_path / "crafted.mcap", tmp_path / "saved.mcap"
    path.write_bytes(made.bytes())
    with suppress(LogError):
        recover(path, saved)
    with suppress(ScenarioError):
        load(path)
    for one in (path, saved):
        assert not (one.exists() and passes(one)) or content(read(one)) == content(read(logs[0]))


def surefoot_command(*arguments, **named):
    """A command in a process of its own."""
    return subprocess.Popen([sys.executable, "-m", "surefoot", *map(str, arguments)], text=True, **named)


@pytest.mark.usefixtures("heeding")
@pytest.mark.long
@pytest.mark.parametrize(
    ("number", "trials"), [(signal.SIGKILL, 20), (signal.SIGTERM, 34), (signal.SIGHUP, 33), (signal.SIGINT, 33)]
)
def test_runs_that_are_ended_at_any_time(tmp_path, number, trials):
    rng, pipes = random.Random(int(number)), {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    for trial in range(trials):
        out = tmp_path / str(trial)
        run = surefoot_command(
            "run", "stand", "--set", "duration=3", "--set", "criteria={fell: false}", "--out", out, **pipes
        )
        while not out.exists() and run.poll() is None:  # before that Python itself starts, with a traceback on Ctrl-C
            time.sleep(0.01)
        time.sleep(rng.uniform(0.0, 2.5))
        run.send_signal(number)
        said, _ = run.communicate(timeout=60)
        assert "Traceback" not in said
        assert run.returncode in (0, -number, 128 + number)
        for path in out.glob("*/log.mcap"):
            log = read(path)
            assert number == signal.SIGKILL or not log.truncated
            assert passes(path) == (log.metadata.get("end", {}).get("kind") == "completed" and not log.losses())


@pytest.mark.long
def test_closed_pipes_and_full_devices(logs):
    for command in (["list"], ["schema"], ["inspect", logs[0]], ["inspect", logs[0], "--json"], ["show", "walk-level"]):
        piped = surefoot_command(*command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        piped.stdout.close()
        assert piped.stderr.read() == ""
        assert piped.wait() == 141
        with open("/dev/full", "w") as full:  # noqa: PTH123
            done = surefoot_command(*command, stdout=full, stderr=subprocess.PIPE)
            assert "no space left on device" in done.communicate()[1]
            assert done.returncode == 2
