"""Damaged, cut, empty and foreign logs through every command that reads one: an answer or a sentence, never a trace."""

import random
import time

import numpy as np
import pytest
from mcap.writer import Writer
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.record.foxglove.views import EventLog
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

FLIPS, CUTS = 60, 25
SLOWEST = 5.0
"""No command may take longer on these short logs, on a busy machine [s]."""


@pytest.fixture
def run(motion, robot, two_steps, tmp_path):
    def simulate(walk, writer, on_progress):
        events = EventLog(writer)
        events.update(20_000_000, (True, False), np.zeros(3), False, False, False)
        return motion(duration=0.3)(walk, writer, on_progress)

    return run_scenario(two_steps, tmp_path / "runs", simulate=simulate, robot=robot).log


def commands(path, out):
    return (
        ["inspect", str(path), "--json"],
        ["inspect", str(path), "--topic", "/truth", "--from", "0.1", "--export", str(out.with_suffix(".csv")), "-f"],
        ["recover", str(path), str(out), "--force"],
    )


def survives(path, out):
    """Run every command; gives how many of them answered."""
    answered = 0
    for command in commands(path, out):
        start = time.perf_counter()
        result = CliRunner().invoke(app, command)
        assert time.perf_counter() - start < SLOWEST
        if isinstance(result.exception, LogError):
            assert "\n" not in str(result.exception)
        else:
            assert result.exception is None or isinstance(result.exception, SystemExit), (command, result.exception)
            answered += 1
    return answered


def test_bits_flipped_anywhere(run, tmp_path):
    data, path, out = run.read_bytes(), tmp_path / "flipped.mcap", tmp_path / "out.mcap"
    rng = random.Random(4)
    answered = noticed = 0
    for _ in range(FLIPS):
        damaged = bytearray(data)
        damaged[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        path.write_bytes(damaged)
        answered += survives(path, out)
        log = read(path) if damaged[:8] == data[:8] else None
        if log is not None:
            noticed += bool(log.losses())
    assert answered > 2.5 * FLIPS
    assert noticed > 0.75 * FLIPS  # the others are in the summary, out of which nothing is read


def test_cut_at_random_places(run, tmp_path):
    data, path = run.read_bytes(), tmp_path / "cut.mcap"
    rng = random.Random(5)
    for cut in (0, 3, 8, 9, len(data) - 1, *rng.sample(range(len(data)), CUTS)):
        path.write_bytes(data[:cut])
        survives(path, tmp_path / "out.mcap")


def test_long_runs_of_rubbish(run, tmp_path):
    data, path = run.read_bytes(), tmp_path / "holes.mcap"
    rng = random.Random(6)
    for size in (10, 100, 1000, 10_000, 100_000):
        for _ in range(3):
            start = rng.randrange(8, len(data) - 8)
            hole = bytearray(data)
            hole[start : start + size] = rng.randbytes(min(size, len(data) - start))
            path.write_bytes(hole)
            survives(path, tmp_path / "out.mcap")


def test_empty_and_foreign_files_are_refused_in_a_sentence(tmp_path):
    foreign = tmp_path / "foreign.mcap"
    with foreign.open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.add_message(writer.register_channel("/json", "json", 0), 1, b"{}", 1)
        writer.finish()
    (tmp_path / "empty.mcap").write_bytes(b"")
    (tmp_path / "text.mcap").write_text("time,x\n0,1\n")
    for name, message in {
        "foreign": "does not describe a run", "empty": "not an MCAP file", "text": "not an MCAP file",
    }.items():  # fmt: skip
        path = tmp_path / f"{name}.mcap"
        result = CliRunner().invoke(app, ["inspect", str(path)])
        assert isinstance(result.exception, LogError)
        assert message in str(result.exception)
        survives(path, tmp_path / "out.mcap")


def test_what_is_lost_is_said(run, tmp_path):
    path, log = tmp_path / "flipped.mcap", read(run)
    data, chunk = bytearray(run.read_bytes()), log.contents.chunks[1]
    data[chunk.data.start + 500] ^= 8
    path.write_bytes(data)
    damaged = read(path)
    rows = sum(len(part["/truth"]) for part in damaged.windows(["/truth"]))
    assert rows == log.count("/truth") - chunk.count(log._ids["/truth"])
    assert any(f"byte {chunk.position}" in loss for loss in damaged.damage)


def test_a_damaged_index_is_made_anew_from_its_chunk(run, tmp_path):
    path, log = tmp_path / "flipped.mcap", read(run)
    number = log._ids["/contact"]
    data = bytearray(run.read_bytes())
    data[log.contents.chunks[1].place(number)[0] - 4] ^= 1
    path.write_bytes(data)
    damaged = read(path)
    assert "message index" in damaged.damage[0]
    assert damaged["/contact"].content() == log["/contact"].content()
