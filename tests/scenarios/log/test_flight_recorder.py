"""A flight recorder keeps the last of a run, on a bounded disk, whatever ends it, and says what it has dropped."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from mcap_doctor import complaints
from test_log_writer import ENDLESS, SPEC, full_disk_at

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import AttachedFile, Kept, LogWriter, read
from surefoot.scenarios.log.file import Output
from surefoot.scenarios.log.recorder import KEPT_RECORD

pytestmark = pytest.mark.unit

PERIOD = 2_000_000


def writer_of(path, keep, compression="lz4"):
    writer = LogWriter(path, {"run": {"seed": "3"}}, [AttachedFile("a", "text/plain", b"b")], compression, keep)
    return writer, writer.channel(SPEC)


def fill(channel, start, ticks):
    for tick in range(start, start + ticks):
        channel.append(tick * PERIOD, tick / 3, (1, 2, tick), tick)


def files(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("keep", [1.0, 2.5])
@pytest.mark.parametrize("seconds", [0.5, 2.6, 6.0, 11.3])
def test_it_keeps_what_came_last(tmp_path, keep, seconds):
    for name, kept in (("all.mcap", None), ("last.mcap", keep)):
        writer, channel = writer_of(tmp_path / name, kept)
        with writer:
            fill(channel, 0, round(seconds * 500))
    assert files(tmp_path) == ["all.mcap", "last.mcap"]
    whole, last = read(tmp_path / "all.mcap"), read(tmp_path / "last.mcap")
    assert not complaints(last.path)
    assert not last.losses()
    told = Kept.from_metadata(last.metadata, "last.mcap")
    begin = 0.0 if told is None else told.begin
    assert last["/x"].time[0] == pytest.approx(begin, abs=1e-9)
    assert last["/x"].content() == whole["/x"].between(round(begin * 1e9), 10**12).content()
    assert min(seconds, keep) - 0.002 <= seconds - begin < 2.0 * keep + 0.2
    if told is not None:
        assert (told.keep, told.dropped) == (keep, len(whole["/x"]) - len(last["/x"]))
    else:
        assert begin == 0.0
        assert (tmp_path / "all.mcap").read_bytes() == (tmp_path / "last.mcap").read_bytes()


@pytest.mark.parametrize("rate", [100, 500, 2000, 5000])
def test_it_keeps_the_same_however_often_records_are_written_beside(tmp_path, rate):
    begins = []
    for every in (10**9, 7, 333):
        writer = LogWriter(tmp_path / f"{every}.mcap", {}, keep=1.0)
        with writer:
            channel = writer.channel(SPEC)
            for tick in range(round(4.7 * rate)):
                channel.append(tick * 10**9 // rate, tick / 3, (1, 2, tick), tick)
                if tick % (every * rate // 500 or 1) == 1:
                    writer.add_metadata(f"push {tick}", {"push": "hard"})
        begins.append(read(tmp_path / f"{every}.mcap")["/x"].time[0])
    assert begins[0] == begins[1] == begins[2] > 2.5


def test_whatever_stands_beside_the_messages_is_kept(tmp_path):
    writer, channel = writer_of(tmp_path / "log.mcap", 1.0)
    with writer:
        for second in range(6):
            fill(channel, 500 * second, 500)
            writer.add_metadata(f"push {second}", {"push": "hard"})
            writer.attach(AttachedFile(f"file {second}", "text/plain", b"c"))
            if second == 3:
                more = writer.channel(SPEC.__class__("/late", "Late", SPEC.fields))
                more.append((2_000 * PERIOD) - 1, 0.0, (1, 2, 3), 4)
    log = read(tmp_path / "log.mcap")
    assert not complaints(log.path)
    assert [name for name in log.metadata if name != KEPT_RECORD] == ["run", *(f"push {k}" for k in range(6))]
    assert list(log.attachments) == ["a", *(f"file {k}" for k in range(6))]
    assert log.topics == ("/x", "/late")
    assert log.count("/late") == 0


def test_at_no_moment_is_less_on_the_disk_and_never_more_than_three_times_as_much(tmp_path):
    keep, most = 1.0, 0
    writer, channel = writer_of(tmp_path / "log.mcap", keep, "")
    second = None
    for tick in range(0, 6_000, 20):
        fill(channel, tick, 20)
        now = (tick + 19) * 0.002
        if now < 0.1:
            continue  # no chunk has been due
        log = read(tmp_path / "log.mcap")
        assert log["/x"].time[0] <= max(now - keep, 0.0)
        assert log["/x"].time[-1] > now - 0.11
        size = sum(path.stat().st_size for path in tmp_path.iterdir())
        most = max(most, size)
        second = size if second is None and now > 1.0 else second
    writer.close()
    assert most < 3.5 * second
    assert len(read(tmp_path / "log.mcap").contents.chunks) < 2 * keep / 0.09 + 3


_ENDLESS = ENDLESS.replace("keep=None", "keep=1.0")


@pytest.mark.parametrize("ticks", [300, 1_013, 2_600])
def test_a_killed_run_leaves_its_last_seconds(tmp_path, ticks):
    path, root = tmp_path / "log.mcap", str(Path(__file__).parents[3])
    child = subprocess.Popen([sys.executable, "-c", _ENDLESS, str(path)], stdout=subprocess.PIPE, text=True, cwd=root)
    written = [int(child.stdout.readline()) for _ in range(ticks)]
    child.send_signal(signal.SIGKILL)
    written += [int(line) for line in child.stdout.read().split("\n")[:-1]]
    child.wait()
    log = read(path)
    assert log.truncated
    assert not log.damage
    assert log["/x"].time[-1] > written[-1] * 0.002 - 0.1
    assert log["/x"].time[0] <= max(written[-1] * 0.002 - 1.0, 0.0)
    again, channel = writer_of(tmp_path / "other.mcap", 1.0)
    fill(channel, 0, 10)
    again.close()


def test_what_a_killed_recorder_left_beside_its_log_stands_in_nobodys_way(tmp_path):
    (tmp_path / "log.mcap.next").write_bytes(b"of a killed run")
    writer, channel = writer_of(tmp_path / "log.mcap", 1.0)
    with writer:
        fill(channel, 0, 1_500)
    assert files(tmp_path) == ["log.mcap"]
    assert len(read(tmp_path / "log.mcap")["/x"]) <= 1_500


@pytest.mark.parametrize("full_at", [25_000, 60_000])
def test_a_full_disk_leaves_one_file_with_what_was_written(tmp_path, full_at):
    writer, channel = writer_of(tmp_path / "log.mcap", 1.0, "")
    with full_disk_at(full_at), pytest.raises(LogError, match=r"kept in log\.mcap\.incomplete"):
        fill(channel, 0, 10_000)
    writer.close()
    assert files(tmp_path) == ["log.mcap.incomplete"]
    assert len(read(tmp_path / "log.mcap.incomplete")["/x"]) > 100


@pytest.mark.parametrize("records", [1, 2, 5])
def test_the_same_where_the_next_log_finds_no_room(tmp_path, monkeypatch, records):
    write, done = Output._write, []

    def refusing(self, data):
        done.extend([1] if self.path.name.endswith(".next") else [])
        if len(done) >= records and self.path.name.endswith(".next"):
            raise OSError(28, "No space left on device")
        write(self, data)

    monkeypatch.setattr(Output, "_write", refusing)
    writer, channel = writer_of(tmp_path / "log.mcap", 1.0)
    with pytest.raises(LogError, match=r"log\.mcap: cannot be written on, .*kept in log\.mcap\.incomplete"):
        fill(channel, 0, 10_000)
    writer.close()
    assert files(tmp_path) == ["log.mcap.incomplete"]
    assert read(tmp_path / "log.mcap.incomplete")["/x"].time[-1] > 0.9


def test_of_no_run_nothing_stays(tmp_path):
    writer, channel = writer_of(tmp_path / "log.mcap", 1.0)
    fill(channel, 0, 800)
    assert files(tmp_path) == ["log.mcap", "log.mcap.next"]
    writer.discard()
    assert files(tmp_path) == []


@pytest.mark.parametrize(
    "record",
    [
        {},
        {"keep": "1", "from": "2"},
        {"keep": "1", "from": "NaN", "messages_dropped": "3"},
        {"keep": "1", "from": "-3", "messages_dropped": "3"},
        {"keep": "inf", "from": "2", "messages_dropped": "3"},
        {"keep": "1", "from": "2", "messages_dropped": "many"},
        {"keep": "1", "from": "2", "messages_dropped": "-1"},
    ],
)
def test_a_record_that_nobody_has_written_is_refused(record):
    with pytest.raises(LogError, match="what of its run it keeps"):
        Kept.from_metadata({KEPT_RECORD: record}, "log.mcap")
