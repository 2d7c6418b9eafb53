"""A log of any length is read in bounded memory: what is too long to be held comes part by part, and is the same."""

import tracemalloc

import numpy as np
import pytest

from benchmarks.lengthened import lengthened
from surefoot.scenarios.columns import Memory
from surefoot.scenarios.judge.inspection import topic_summary
from surefoot.scenarios.judge.metrics import compute
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.long_channel import LongChannel
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.show.differences import compare_channels
from surefoot.scenarios.show.export import export, selected
from surefoot.scenarios.show.touching import touching

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/x", "X", (FieldSpec("a"), FieldSpec("b", (2, 3)), FieldSpec("n", (), kind="int")))
TICKS, TICK_NS = 3000, 2_000_000


def written(path, ticks, later=()):
    """A log of chunks of a hundred ticks, of which some are written after all others."""
    chunks = [range(begin, min(begin + 100, len(ticks))) for begin in range(0, len(ticks), 100)]
    chunks = [one for one in chunks if one.start not in later] + [one for one in chunks if one.start in later]
    with LogWriter(path, {}) as writer:
        x = writer.channel(SPEC)
        for chunk in chunks:
            for row in chunk:
                x.append(ticks[row] * TICK_NS, row / 4, np.full((2, 3), row), row)
            writer.flush()
    return path


NOTHING = Memory(held=0)
"""Nothing of any topic is held."""


@pytest.mark.parametrize("later", [(), (500,), (0, 2900)])
def test_a_channel_that_is_not_held_is_the_same(tmp_path, later):
    path = written(tmp_path / "x.mcap", range(TICKS), later)
    channel = read(path, NOTHING)["/x"]
    held = read(path)["/x"]
    assert isinstance(channel, LongChannel)
    assert not isinstance(held, LongChannel)
    assert len(channel) == len(held) == TICKS
    assert np.array_equal(channel.time_ns, held.time_ns)
    for name in ("a", "b", "n"):
        assert channel.field(name).dtype == held.field(name).dtype
        assert np.array_equal(channel.field(name), held.field(name))
        assert np.array_equal(channel.only(name).columns()["time"], held.time)
    assert {name: one.tolist() for name, one in channel.columns().items()} == {
        name: one.tolist() for name, one in held.columns().items()
    }
    assert channel.content() == held.content()
    assert channel.between(0, 10 * TICK_NS).content() == held.between(0, 10 * TICK_NS).content()
    assert channel.notes() == held.notes()


def test_a_data_frame_of_a_channel_that_is_not_held_is_the_same(tmp_path):
    pandas = pytest.importorskip("pandas")
    path = written(tmp_path / "x.mcap", range(TICKS))
    frame = read(path, NOTHING).frame("/x")
    pandas.testing.assert_frame_equal(frame, read(path).frame("/x"))
    assert frame.index.name == "time"
    assert frame["n"].dtype == np.int32


@pytest.mark.parametrize("later", [(), (500,), (0, 2900)])
def test_parts_come_in_order_of_time_and_lose_nothing(tmp_path, later):
    log = read(written(tmp_path / "x.mcap", range(TICKS), later), Memory(window=0.5))
    parts = list(log.parts("/x"))
    assert len(parts) > 5
    assert np.array_equal(np.concatenate([part.field("n") for part in parts]), np.arange(TICKS))
    inside = np.concatenate([part.field("n") for part in log.parts("/x", 1.0, 2.5)])
    assert np.array_equal(inside, np.arange(500, 1251))
    kept = log.gather({"/x": ("n",)}, 1.0, 2.5)["/x"]
    assert np.array_equal(kept.field("n"), inside)
    assert np.array_equal(kept.field("a"), inside / 4), "what was not kept is read for the same stretch"


def test_a_comparison_in_parts_is_that_of_the_whole(tmp_path):
    a = read(written(tmp_path / "a.mcap", range(TICKS)))
    b = read(written(tmp_path / "b.mcap", [*range(1500), *range(1501, TICKS + 1)], later=(700,)))
    cut = read(written(tmp_path / "c.mcap", range(TICKS - 300)))
    whole = [compare_channels(a, other, 1e-6) for other in (a, b, cut)]
    a, b, cut = (read(log.path, Memory(window=0.3)) for log in (a, b, cut))
    assert [compare_channels(a, other, 1e-6) for other in (a, b, cut)] == whole
    same, parted, shorter = (found[0] for found in whole)
    assert same.same
    assert parted.only_one == pytest.approx(3.0)
    assert parted.exact.time == pytest.approx(3.002)
    assert shorter.messages == (TICKS, TICKS - 300)


def test_a_summary_and_exports_in_parts_are_those_of_the_whole(tmp_path):
    log = read(written(tmp_path / "x.mcap", range(TICKS)))
    told = [topic_summary(selected(log, "/x", None, None, None))]
    export(selected(log, "/x", None, None, None), tmp_path / "whole.csv")
    log = read(log.path, Memory(window=0.3))
    told.append(topic_summary(selected(log, "/x", None, None, None)))
    assert told[0] == told[1]
    assert told[0]["b"] | {"mean": 0} == told[1]["b"] | {"mean": 0}
    assert told[0]["n"]["max"] == TICKS - 1
    assert export(selected(log, "/x", None, None, None), tmp_path / "parts.csv") == TICKS
    assert (tmp_path / "parts.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


SECONDS = (12.0, 24.0)
"""Lengths of the two logs that are held against each other."""


@pytest.fixture(scope="module")
def logs(tmp_path_factory, motion, two_steps, robot):
    """A log, and one twice as long."""
    folder = tmp_path_factory.mktemp("long")
    source = run_scenario(two_steps, folder, simulate=motion(duration=2.2), robot=robot).log
    return [lengthened(source, folder / f"{seconds:.0f}.mcap", seconds) for seconds in SECONDS]


def peak(function, path, folder):
    """The most memory that a function takes of its own while it reads a log [B]."""
    log = read(path, NOTHING)
    tracemalloc.start()
    try:
        function(log, folder)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def exported(ending):
    topic = "/plan" if ending == "npz" else "/contact"
    return lambda log, folder: export(selected(log, topic, None, None, None), folder / f"x.{ending}", replace=True)


READERS = {
    "metrics": lambda log, _: compute(log),
    "summary": lambda log, _: topic_summary(selected(log, "/plan", None, None, None)),
    "csv": exported("csv"),
    "npz": exported("npz"),
    "compare": lambda log, _: compare_channels(log, read(log.path, NOTHING), 1e-6),
    "recover": lambda log, folder: recover(log.path, folder / "r.mcap", replace=True),
    "touching": lambda log, _: touching(log),
    "messages": lambda log, _: sum(len(data) for _, data in log.messages("/plan")),
}


@pytest.mark.parametrize("reader", READERS)
def test_twice_the_log_takes_no_more_memory(logs, tmp_path, reader):
    """Beside a few numbers for each tick, which are 8 bytes each, in the metrics."""
    peak(READERS[reader], logs[0], tmp_path)  # what is made once, such as caches
    shorter, longer = (peak(READERS[reader], path, tmp_path) for path in logs)
    ticks = 500 * (SECONDS[1] - SECONDS[0])
    assert longer - shorter < (40 * 8 * ticks if reader == "metrics" else 1e6)


def test_a_field_costs_that_field_and_all_messages_cost_all(logs, tmp_path):
    field = [peak(lambda log, _: log["/plan"].field("omega"), path, tmp_path) for path in logs]
    every = [peak(lambda log, _: log.window("/plan", None, None), path, tmp_path) for path in logs]
    omega = 51 * 8 * 50 * (SECONDS[1] - SECONDS[0])
    assert field[1] - field[0] < 1.5 * omega
    assert every[1] - every[0] > 10 * omega, "the law above can see what grows with a log"


def test_what_lengthens_a_log_makes_one_of_whole_ticks(logs):
    log = read(logs[0])
    assert log.losses() == ()
    stamps = log["/truth"].time_ns
    assert len(stamps) == 500 * SECONDS[0]
    assert np.array_equal(np.diff(stamps), np.full(len(stamps) - 1, TICK_NS))
