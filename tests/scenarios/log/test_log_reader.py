"""Reading logs: whole, truncated, damaged, recovered, by other writers, and none at all."""

import random

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.log.spec import blank_records

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/x", "X", (FieldSpec("a"), FieldSpec("b", (2, 3)), FieldSpec("n", (), kind="int")))
OTHER = ChannelSpec("/y", "Y", (FieldSpec("values", (60,)),))
TICKS = 300


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("logs") / "log.mcap"
    with LogWriter(path, {"run": {"seed": "3"}}, compression="lz4") as writer:
        x, y = writer.channel(SPEC), writer.channel(OTHER)
        for tick in range(TICKS):
            x.append(tick * 2_000_000, tick / 4, np.full((2, 3), tick), tick)
            y.append(tick * 2_000_000, np.arange(60) + tick)
        writer.add_metadata("end", {"kind": "completed"})
    return path


def touch(log):
    """Read everything there is in a log."""
    for topic in log.topics:
        for field in log[topic].fields:
            log[topic].field(field.name)
        log.count(topic)
    log.verify()
    log.time_range()


def test_fields_come_back_by_name(whole):
    log = read(whole)
    assert not log.truncated
    assert not log.damage
    assert log.topics == ("/x", "/y")
    assert log.metadata == {"run": {"seed": "3"}, "end": {"kind": "completed"}}
    x = log["/x"]
    assert np.array_equal(x.time_ns, np.arange(TICKS) * 2_000_000)
    assert np.array_equal(x.field("a"), np.arange(TICKS) / 4)
    assert x.field("b").shape == (TICKS, 2, 3)
    assert np.array_equal(x.field("n"), np.arange(TICKS))
    assert log["/y"].field("values")[7, 5] == 12
    assert log.count("/x") == len(x) == TICKS
    touch(log)
    assert not log.damage


def test_unknown_names_are_answered_with_the_nearest(whole):
    log = read(whole)
    with pytest.raises(LogError, match="no topic '/z'; valid are /x, /y"):
        log["/z"]
    with pytest.raises(LogError, match="no field 'value'; did you mean 'values'"):
        log["/y"].field("value")


def test_a_use_names_the_topic_that_it_needs(whole):
    log = read(whole)
    log.require("a replay", "/x", "/y")
    with pytest.raises(LogError, match="has no messages of /z, which a replay needs; give a log that has them"):
        log.require("a replay", "/x", "/z")


def test_no_log_at_all(tmp_path):
    (tmp_path / "empty").write_bytes(b"")
    (tmp_path / "text").write_text("hello")
    for name, message in {
        "empty": "not an MCAP",
        "text": "not an MCAP",
        "none": "cannot be read",
        "": "directory",
    }.items():
        with pytest.raises(LogError, match=message):
            read(tmp_path / name)


def test_cut_anywhere_the_rest_reads(whole, tmp_path):
    data, path = whole.read_bytes(), tmp_path / "cut.mcap"
    random.seed(1)
    counts = []
    for cut in sorted(random.sample(range(len(data)), 200)):
        path.write_bytes(data[:cut])
        if cut < 8:
            with pytest.raises(LogError):
                read(path)
            continue
        log = read(path)
        assert log.truncated
        touch(log)
        counts.append(len(log["/x"]) if "/x" in log else 0)
        if counts[-1]:
            assert np.array_equal(log["/x"].field("n"), np.arange(counts[-1]))
    assert counts == sorted(counts)
    assert counts[-1] >= TICKS - 21


def test_flipped_bits_never_surprise(whole, tmp_path):
    data, path = whole.read_bytes(), tmp_path / "flipped.mcap"
    random.seed(2)
    recovered = 0
    for _ in range(200):
        damaged = bytearray(data)
        damaged[random.randrange(len(data))] ^= 1 << random.randrange(8)
        path.write_bytes(damaged)
        (tmp_path / "recovered.mcap").unlink(missing_ok=True)
        try:
            log = read(path)
            touch(log)
            recover(path, tmp_path / "recovered.mcap")
        except LogError:
            continue
        kept = read(tmp_path / "recovered.mcap")
        touch(kept)
        recovered += "/x" in kept and len(kept["/x"]) > 0
    assert recovered > 150  # a bit is in one chunk, and the others are as whole as before


def test_a_chunk_that_states_an_absurd_size_is_lost_alone(whole, tmp_path):
    first, second = read(whole).contents.chunks[:2]
    data = bytearray(whole.read_bytes())
    stated = data.index(first.size.to_bytes(8, "little"), first.position)
    data[stated + 6] ^= 1 << 3
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    log = read(damaged)
    assert any("may hold" in loss for loss in log.losses())
    assert log.time_range()[1] > second.start_ns / 1e9


def test_a_flipped_bit_in_a_message_is_noticed(whole, tmp_path):
    data = bytearray(whole.read_bytes())
    chunk = read(whole).contents.chunks[3]
    data[chunk.data.start + 300] ^= 4
    path = tmp_path / "flipped.mcap"
    path.write_bytes(data)
    log = read(path)
    log.verify()
    assert any(f"byte {chunk.position}" in note for note in log.damage)


def test_after_a_broken_length_reading_resumes_at_the_next_chunk(whole, tmp_path):
    data = bytearray(whole.read_bytes())
    chunk = read(whole).contents.chunks[3]
    data[chunk.position + 5] ^= 0x80
    path = tmp_path / "flipped.mcap"
    path.write_bytes(data)
    log = read(path)
    assert len(log["/x"]) >= TICKS - 50
    assert "cannot be read" in log.damage[0]
    assert log.metadata["end"] == {"kind": "completed"}


def test_recover_makes_a_whole_file_of_a_cut_one(whole, tmp_path):
    data = whole.read_bytes()
    cut, out = tmp_path / "cut.mcap", tmp_path / "out.mcap"
    cut.write_bytes(data[: len(data) * 2 // 3])
    recovery = recover(cut, out)
    with out.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_summary().statistics.message_count == recovery.messages
        assert sum(1 for _ in reader.iter_messages()) == recovery.messages
    log = read(out)
    assert not log.truncated
    assert "recovered" in log.metadata
    assert np.array_equal(log["/x"].field("n"), read(cut)["/x"].field("n"))


def test_recover_never_touches_its_source(whole, tmp_path):
    with pytest.raises(LogError, match="give another file"):
        recover(whole, whole)
    with pytest.raises(LogError, match="cannot be written"):
        recover(whole, tmp_path / "none" / "out.mcap")
    assert len(read(whole)["/x"]) == TICKS


@pytest.mark.parametrize(
    "settings",
    [
        {"compression": CompressionType.ZSTD},
        {"compression": CompressionType.NONE, "use_chunking": False},
        {"compression": CompressionType.LZ4, "index_types": IndexType.NONE, "repeat_channels": False},
    ],
)
def test_our_channels_by_any_writer_in_any_order(tmp_path, settings):
    path = tmp_path / "other.mcap"
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=10_000, **settings)
        writer.start()
        channels = []
        for spec in (SPEC, OTHER):
            schema = writer.register_schema(f"surefoot.{spec.message}", "protobuf", spec.descriptors)
            channels.append(writer.register_channel(spec.topic, "protobuf", schema, spec.metadata))
        for tick in np.random.default_rng(0).permutation(TICKS).tolist():
            for spec, channel in zip((SPEC, OTHER), channels, strict=True):
                record = blank_records(spec, channel, 1)
                record[spec.fields[0].name] = tick
                writer.add_message(channel, tick * 2_000_000, record.tobytes()[31:], tick * 2_000_000)
        writer.finish()
    for log in (read(path), read_recovered(path)):
        assert np.array_equal(log["/x"].field("a"), np.arange(TICKS))
        assert np.array_equal(log["/y"].field("values")[:, 3], np.arange(TICKS))
        assert not log.damage


def read_recovered(path):
    out = path.with_name("recovered.mcap")
    recover(path, out)
    return read(out)


def test_foreign_channels_are_listed_and_refused(tmp_path):
    path = tmp_path / "foreign.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/json", "json", 0)
        writer.add_message(channel, 1, b"{}", 1)
        writer.finish()
    log = read(path)
    assert log.topics == ("/json",)
    assert log.count("/json") == 1
    with pytest.raises(LogError, match="states no layout"):
        log["/json"]


def test_a_long_channel_among_others_loads_whole(tmp_path):
    path = tmp_path / "long.mcap"
    rows = np.random.default_rng(0).normal(size=(500, 60))
    with LogWriter(path, {}) as writer:
        y = writer.channel(OTHER)
        other = writer.channel(ChannelSpec("/z", "Z", (FieldSpec("v", (60,)),)))
        for tick in range(4_000):
            y.append(tick * 2_000_000, rows[tick % 500])
            other.append(tick * 2_000_000, rows[-tick % 500])
    values = read(path)["/y"].field("values")
    np.testing.assert_array_equal(values, np.tile(rows, (8, 1)))
