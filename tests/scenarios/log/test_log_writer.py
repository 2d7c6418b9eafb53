"""The log on disk: every MCAP reader decodes it, and a disk that refuses leaves no half-written log."""

import resource
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.records import Attachment, Chunk, ChunkIndex, Metadata
from mcap_protobuf.decoder import DecoderFactory

import surefoot.scenarios.log.file as log_file
import surefoot.scenarios.log.writer as log_writer
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import AttachedFile, ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.encoding import Packed, _attachment, _chunk_index, _metadata, encoded
from surefoot.scenarios.record import channels

pytestmark = pytest.mark.unit

SIZES = channels.Sizes(nj=21, nq=28, nv=27, horizon=50)
ALL = (
    *(
        channels.measurement,
        channels.readings,
        channels.truth,
        channels.estimate,
        channels.contact,
        channels.reference,
        channels.plan,
    ),
    *(channels.footsteps, channels.footstep, channels.wbc, channels.torque, channels.timing),
)
SPEC = ChannelSpec("/x", "X", (FieldSpec("a"), FieldSpec("b", (3,)), FieldSpec("n", kind="int")))


def values_of(spec, rng):
    """Random values of a channel's fields."""
    drawn = []
    for field in spec.fields:
        integers = rng.integers(-(2**31), 2**31, field.shape)
        drawn.append(integers if field.kind == "int" else rng.normal(size=field.shape))
    return drawn


@contextmanager
def full_disk_at(size):
    """No file may grow beyond a size [bytes]; the error is that of a full disk but for its number."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("places", [{}, {7: 1000, 3: 2**40}])
def test_the_index_of_a_chunk_is_that_of_the_mcap_library(places):
    chunk = Chunk("lz4", b"packed", 2**50, 5, 0, 12345)
    wanted = ChunkIndex(77, 99, "lz4", 6, 2**50, 321, places, 5, 12345)
    assert _chunk_index(chunk, 99, 77, places, 321) == encoded(wanted)


@pytest.mark.parametrize("values", [{}, {"a": "1"}, {"größe": "π", "": "", "long": "x" * 70000}])
def test_metadata_and_attachments_are_those_of_the_mcap_library(values):
    record = Metadata("run", values)
    assert _metadata(record) == encoded(record)
    data = "".join(values.values()).encode()
    file = Attachment(3, 2**40, "räder.xml", "application/xml", data)
    assert _attachment(file) == encoded(file)


@pytest.mark.parametrize("compression", ["lz4", "zstd", ""])
def test_the_stock_reader_decodes_every_channel(tmp_path, compression):
    rng = np.random.default_rng(0)
    specs = [make(SIZES) for make in ALL]
    sent = {spec.topic: [values_of(spec, rng) for _ in range(3)] for spec in specs}
    path = tmp_path / "log.mcap"
    attached = AttachedFile("robot.xml", "application/xml", b"<mujoco/>")
    with LogWriter(path, {"run": {"seed": "3"}}, [attached], compression) as writer:
        for spec in specs:
            channel = writer.channel(spec)
            for tick, values in enumerate(sent[spec.topic]):
                channel.append(tick * 30_000_000, *values)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            spec = next(spec for spec in specs if spec.topic == channel.topic)
            assert schema.name == f"surefoot.{spec.message}"
            assert decoded.stamp_ns == message.log_time == message.publish_time
            for field, value in zip(spec.fields, sent[spec.topic][message.sequence], strict=True):
                assert np.array_equal(np.ravel(getattr(decoded, field.name)), np.ravel(value)), field
        summary = reader.get_summary()
        assert summary.statistics.message_count == 3 * len(specs)
        assert [record.name for record in reader.iter_metadata()] == ["run", "manifest"]
        assert [record.data for record in reader.iter_attachments()] == [b"<mujoco/>"]


def test_units_and_frames_travel_with_every_channel(tmp_path):
    path = tmp_path / "log.mcap"
    with LogWriter(path, {}) as writer:
        for make in ALL:
            writer.channel(make(SIZES))
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    truth = next(channel for channel in summary.channels.values() if channel.topic == "/truth")
    assert truth.metadata["field.com"] == "CoM [m] world"
    for channel in summary.channels.values():
        assert all("[" in note for name, note in channel.metadata.items() if name.startswith("field."))


def test_messages_are_in_order_of_time_for_every_reader(tmp_path):
    path = tmp_path / "log.mcap"
    with LogWriter(path, {}) as writer:
        first, second = writer.channel(SPEC), writer.channel(ChannelSpec("/y", "Y", (FieldSpec("a"),)))
        for tick in range(200):
            first.append(tick * 2_000_000, tick, (1, 2, 3), tick)
            second.append(tick * 2_000_000, -tick)
    with path.open("rb") as file:
        messages = [(m.log_time, c.topic) for _, c, m in make_reader(file).iter_messages()]
    assert len(messages) == 400
    assert [time for time, _ in messages] == sorted(time for time, _ in messages)


@pytest.mark.parametrize("rate", [100, 500, 2000])
def test_a_chunk_is_written_every_90_ms_of_simulated_time_within_8_ms(tmp_path, rate):
    path = tmp_path / "log.mcap"
    writer = LogWriter(path, {})
    channel = writer.channel(SPEC)
    for tick in range(2 * rate):
        channel.append(tick * 1_000_000_000 // rate, 0.0, (1, 2, 3), tick)
        if tick % max(rate // 500, 1) == 0:
            on_disk = read(path)
            assert on_disk.truncated
            assert tick / rate - on_disk.time_range()[1] < 0.098 + 1.5 / rate
    writer.close()
    assert len(read(path)["/x"]) == 2 * rate


@pytest.mark.parametrize("gaps", [(100,), (1000,), (2, 2, 500), (95, 2, 2, 95)])
def test_nothing_is_lost_in_gaps_of_time(tmp_path, gaps):
    """Between two messages more time may pass than a chunk has, as on a machine that does not answer for a while."""
    path, times = tmp_path / "log.mcap", [0]
    while len(times) < 60:
        times.append(times[-1] + gaps[len(times) % len(gaps)] * 1_000_000)
    with LogWriter(path, {}) as writer:
        channel = writer.channel(SPEC)
        for tick, time in enumerate(times):
            channel.append(time, 0.0, (1, 2, 3), tick)
    assert read(path)["/x"].time_ns.tolist() == times


def test_no_tick_does_all_of_a_chunk(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(log_writer, "compress", lambda data, _: done.append("compressed") or data)
    write = log_file.Output.write
    monkeypatch.setattr(log_file.Output, "write", lambda self, data: done.append("written") or write(self, data))
    with LogWriter(tmp_path / "log.mcap", {}, compression="") as writer:
        channel = writer.channel(SPEC)
        for tick in range(60):
            done.clear()
            channel.append(tick * 2_000_000, 0.0, (1, 2, 3), tick)
            assert len(done) <= 1


def test_wrong_values_are_refused(tmp_path):
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        channel = writer.channel(SPEC)
        for values in ((1.0, (1, 2, 3)), (1.0, (1, 2, 3), 4, 5), (1.0, (1, 2), 3)):
            with pytest.raises(ValueError, match=r"argument|broadcast"):
                channel.append(0, *values)


def test_a_message_is_put_together_by_the_names_of_its_fields(tmp_path):
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        channel = writer.channel(SPEC)
        channel.put(0, SimpleNamespace(a=1.0, other=9), SimpleNamespace(a=7.0, b=(1, 2, 3)), n=4)
        channel.append(1, 1.0, (1, 2, 3), 4)
        for sources, given in (((), {"a": 1.0, "n": 4}), ((SimpleNamespace(a=1, b=(1, 2, 3)),), {"n": 4, "m": 5})):
            with pytest.raises(ValueError, match=r"/x: .*: [bm]$"):
                channel.put(2, *sources, **given)
    log = read(tmp_path / "log.mcap")
    assert [log["/x"].field(name)[0].tolist() for name in "abn"] == [1.0, [1.0, 2.0, 3.0], 4]
    assert all(len(set(map(str, log["/x"].field(name)))) == 1 for name in "abn")


def test_equal_messages_give_equal_files(tmp_path):
    for name in ("a", "b"):
        with LogWriter(tmp_path / name, {"run": {"seed": "1"}}) as writer:
            channel = writer.channel(SPEC)
            for tick in range(100):
                channel.append(tick * 2_000_000, tick / 3, (1, 2, tick), tick)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_metadata_and_attachments_are_on_disk_before_any_message(tmp_path):
    writer = LogWriter(tmp_path / "log.mcap", {"run": {"seed": "3"}}, [AttachedFile("a", "text/plain", b"b")])
    writer.attach(AttachedFile("world.xml", "application/xml", b"c"))
    log = read(tmp_path / "log.mcap")
    assert log.metadata == {"run": {"seed": "3"}}
    assert log.attachments == {"a": b"b", "world.xml": b"c"}
    writer.close()


def test_an_unwritable_place_gives_one_error_and_no_file(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(LogError, match=r"cannot be created, not a directory; choose another"):
        LogWriter(tmp_path / "file" / "log.mcap", {})
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]


def test_no_log_replaces_another_one(tmp_path):
    path = tmp_path / "log.mcap"
    LogWriter(path, {"run": {"seed": "old"}}).close()
    with pytest.raises(LogError, match="exists already"):
        LogWriter(path, {})
    assert read(path).metadata == {"run": {"seed": "old"}}


def test_a_full_disk_at_the_beginning_leaves_no_log(tmp_path):
    big = AttachedFile("robot.xml", "application/xml", bytes(100_000))
    with full_disk_at(50_000), pytest.raises(LogError, match="no log was created"):
        LogWriter(tmp_path / "log.mcap", {}, [big])
    assert not list(tmp_path.iterdir())


def test_a_full_disk_on_the_way_keeps_what_was_written_under_another_name(tmp_path):
    writer = LogWriter(tmp_path / "log.mcap", {"run": {"seed": "3"}}, compression="")
    channel = writer.channel(SPEC)
    with full_disk_at(50_000), pytest.raises(LogError, match=r"kept in log\.mcap\.incomplete"):
        for tick in range(10_000):
            channel.append(tick * 2_000_000, tick, (1, 2, 3), tick)
    writer.close()
    assert [entry.name for entry in tmp_path.iterdir()] == ["log.mcap.incomplete"]
    kept = read(tmp_path / "log.mcap.incomplete")
    assert kept.truncated
    assert not kept.damage
    assert kept["/x"].field("n").tolist() == list(range(len(kept["/x"])))
    assert len(kept["/x"]) > 300


ENDLESS = """
import sys
from pathlib import Path
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter
writer = LogWriter(Path(sys.argv[1]), {"run": {"seed": "3"}}, keep=None)
channel = writer.channel(ChannelSpec("/x", "X", (FieldSpec("a"),)))
tick = 0
while True:
    channel.append(tick * 2_000_000, tick)
    sys.stdout.write(f"{tick}\\n")
    sys.stdout.flush()
    tick += 1
"""


def test_a_killed_run_loses_less_than_100_ms(tmp_path):
    path = tmp_path / "log.mcap"
    root = str(Path(__file__).parents[3])
    child = subprocess.Popen([sys.executable, "-c", ENDLESS, str(path)], stdout=subprocess.PIPE, text=True, cwd=root)
    written = [int(child.stdout.readline()) for _ in range(1000)]
    child.send_signal(signal.SIGKILL)
    written += [int(line) for line in child.stdout.read().split("\n")[:-1]]
    child.wait()
    log = read(path)
    assert log.truncated
    assert log.metadata == {"run": {"seed": "3"}}
    assert log["/x"].time[-1] > written[-1] * 0.002 - 0.1


def test_records_that_wait_come_out_in_order_and_take_little_room():
    rng = np.random.default_rng(0)
    records = [bytes(rng.integers(0, 4, 300, dtype=np.uint8)) for _ in range(3000)]
    packed, blocks = Packed(), []
    for record in records:
        packed.append(record)
        blocks.append(sum(map(len, packed._blocks)) + len(packed._last))
    assert bytes(packed) == b"".join(records)
    assert packed.count == 3000
    assert max(blocks) < 0.5 * sum(map(len, records))
