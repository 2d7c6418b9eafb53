"""A log is of one run: what stands in it twice or in two ways is refused, and what may stand twice is not."""

from io import BytesIO

import numpy as np
import pytest
from mcap.records import Channel, Header, MessageIndex, Metadata, Schema
from mcap.writer import CompressionType, Writer

from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.encoding import MAGIC, encoded
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.log.spec import blank_records
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/x", "X", (FieldSpec("a"),))
TICK = 2_000_000


def content(tick):
    """A message of a tick."""
    record = blank_records(SPEC, 1, 1)
    record["a"], record["_stamp"] = tick, tick * TICK
    return record.tobytes()[31:]


class File:
    """A log by the stock writer.

    Args:
        path: where it is written.
        options: of the writer.
    """

    def __init__(self, path, **options):
        self.path, self._out = path, BytesIO()
        self.writer = Writer(self._out, **options)
        self.writer.start()
        self._sent = {}
        schema = self.writer.register_schema(f"surefoot.{SPEC.message}", "protobuf", SPEC.descriptors)
        self.x = self.writer.register_channel("/x", "protobuf", schema, SPEC.metadata)

    def send(self, tick, channel=None, data=None):
        channel = self.x if channel is None else channel
        number = self._sent[channel] = self._sent.get(channel, -1) + 1
        self.writer.add_message(channel, tick * TICK, content(tick) if data is None else data, tick * TICK, number)

    def raw(self, *records):
        self.writer.flush()
        self._out.write(b"".join(map(encoded, records)))

    def read(self):
        self.writer.finish()
        self.path.write_bytes(self._out.getvalue())
        return read(self.path)


@pytest.fixture(params=[{}, {"use_chunking": False}, {"chunk_size": 200}], ids=["chunk", "no chunk", "chunks"])
def file(tmp_path, request):
    made = File(tmp_path / "log.mcap", **request.param)
    for tick in range(20):
        made.send(tick)
    return made


def refused(file, what):
    with pytest.raises(LogError, match=f"not the log of one run, {what}; give the log of each run by itself"):
        file.read()
    with pytest.raises(LogError, match="not the log of one run"):
        recover(file.path, file.path.with_name("recovered.mcap"))


def test_a_file_of_one_run_is_read_and_has_no_fault(file):
    log = file.read()
    assert np.array_equal(log["/x"].field("a"), np.arange(20))
    assert log.losses() == ()
    assert log.unproven() == ("it has no checksum of its data",)


@pytest.mark.parametrize("second", [{"kind": "fall"}, {"kind": "completed"}])
def test_metadata_of_one_name(file, second):
    file.writer.add_metadata("end", {"kind": "completed"})
    file.writer.add_metadata("end", second)
    refused(file, "its metadata 'end' stands there twice")


@pytest.mark.parametrize("third", [b"c", b"a"])
def test_attachments_of_one_name(file, third):
    for data in (b"a", b"b", third):
        file.writer.add_attachment(0, 0, "scenario.yaml", "", data)
    refused(file, "its attachment 'scenario.yaml' stands there 3 times")


@pytest.mark.parametrize("used", [True, False])
def test_two_channels_of_one_topic(file, used):
    other = file.writer.register_channel("/x", "json", 0)
    if used:
        file.send(30, other, b"{}")
    refused(file, "its topic /x has 2 channels")


def test_one_number_for_two_channels_or_schemas(file, tmp_path):
    file.raw(Channel(1, "/y", "protobuf", {}, 1))
    refused(file, "its channel 1 is defined as /[xy] and as /[xy]")
    other = File(tmp_path / "other.mcap")
    other.raw(Schema(1, b"", "protobuf", "surefoot.X"))
    other.send(0)
    refused(other, "its schema 1 is defined as surefoot.X, in two ways")


def test_the_same_channel_and_schema_may_stand_again(file):
    file.raw(Channel(1, "/x", "protobuf", SPEC.metadata, 1), Schema(1, SPEC.descriptors, "protobuf", "surefoot.X"))
    assert file.read().losses() == ()


def test_a_key_twice_in_a_record(file):
    twice = encoded(Metadata("end", {"kind": "completed", "kinD": "fall"})).replace(b"kinD", b"kind")
    file.writer.flush()
    file._out.write(twice)
    refused(file, "metadata 'end' holds key 'kind' twice")


@pytest.mark.parametrize("tick", [0, 7, 19])
def test_two_messages_of_ours_at_one_time(file, tick):
    file.send(tick)
    refused(file, rf"its topic /x has more than one message at {tick * TICK * 1e-9:.3f} s")


def test_words_may_stand_twice_at_one_time_but_not_the_same(file, tmp_path):
    words = file.writer.register_channel("/events", "json", 0)
    file.send(5, words, b"touchdown")
    file.send(5, words, b"push")
    file.send(6, words, b"push")
    log = file.read()
    assert [data for _, data in log.messages("/events")] == [b"touchdown", b"push", b"push"]
    other = File(tmp_path / "other.mcap")
    words = other.writer.register_channel("/events", "json", 0)
    for _ in range(2):
        other.writer.add_message(words, 5 * TICK, b"push", 5 * TICK, 0)
    refused(other, r"its topic /events has a message twice at 0.010 s")


def test_another_log_behind_its_end_and_what_is_no_log(file):
    file.read()
    data = file.path.read_bytes()
    file.path.write_bytes(data + data)
    with pytest.raises(LogError, match=f"another log follows behind its end, of {len(data)} bytes"):
        read(file.path)
    file.path.write_bytes(data + bytes(100))
    assert read(file.path).faults() == ("100 bytes stand behind its end",)


def test_a_second_header_is_a_fault(file):
    file.raw(Header("", "other"))
    (fault,) = file.read().faults()
    assert "a second header stands at byte" in fault


def test_the_index_of_a_chunk_twice_is_made_anew(tmp_path):
    made = File(tmp_path / "log.mcap")
    for tick in range(20):
        made.send(tick)
    made.raw(MessageIndex(1, [(0, 0)]))
    log = made.read()
    assert log.count("/x") == len(log["/x"]) == 20
    assert log.losses() == ()


def test_channels_of_two_runs_at_other_times_are_told_by_their_numbers(tmp_path):
    path = tmp_path / "log.mcap"
    made = File(path, compression=CompressionType.NONE)
    for tick in range(20):
        made.send(tick)
    made._sent.clear()
    for tick in range(20, 40):
        made.send(tick)
    assert made.read().faults() == ("20 messages of /x have the number of another one",)


def test_a_log_holds_a_manifest_of_what_was_written_first(tmp_path):
    path = tmp_path / "log.mcap"
    with LogWriter(path, {"run": {"seed": "3"}}) as writer:
        writer.channel(SPEC).append(0, 1.0)
        writer.add_metadata("end", {"kind": "completed"})
    log = read(path)
    assert log.metadata == {"run": {"seed": "3"}, "end": {"kind": "completed"}}
    records = {one.name: one for one in log.contents.metadata}
    assert list(records["manifest"].metadata) == ["metadata 'run'"]
    for change, lacks, faults in (
        ({}, (), ()),
        ({"run": {"seed": "4"}}, (), ("its metadata 'run' is not as its run has written it",)),
        ({"run": None}, ("its metadata 'run' is missing",), ()),
        ({"end": {"kind": "fall"}}, (), ()),  # it is written later, and held against the data
    ):
        made = File(tmp_path / "again.mcap")
        made.send(0)
        for name, record in records.items():
            values = change.get(name, record.metadata)
            if values is not None:
                made.writer.add_metadata(name, values)
        again = made.read()
        assert (again.lacks(), again.faults()) == (lacks, faults)


def test_what_recover_makes_is_no_more_proven_than_its_source(file):
    file.read()
    recover(file.path, file.path.with_name("recovered.mcap"))
    log = read(file.path.with_name("recovered.mcap"))
    assert log.unproven() == ("it has no checksum of its data",)
    assert log.losses() == ()


def test_a_channel_that_an_earlier_chunk_defines_is_found_without_a_summary(tmp_path):
    made = File(tmp_path / "log.mcap", chunk_size=200, repeat_channels=False, repeat_schemas=False)
    for tick in range(20):
        made.send(tick)
    words = made.writer.register_channel("/events", "json", 0)
    for tick in range(20):
        made.send(tick, words, b"x" * 300)
    assert made.read().count("/events") == 20


@pytest.mark.parametrize("extra", [b"", bytes([3]) + bytes(8)])
def test_nothing_is_recovered_of_nothing(tmp_path, extra):
    (tmp_path / "magic.mcap").write_bytes(MAGIC + extra)
    with pytest.raises(LogError, match="there is nothing of a log to recover"):
        recover(tmp_path / "magic.mcap", tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()


def test_a_git_lfs_pointer_is_called_so(tmp_path):
    path = tmp_path / "log.mcap"
    path.write_text("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n")
    with pytest.raises(LogError, match="a Git LFS pointer, not the file itself; run 'git lfs pull'"):
        read(path)
    with pytest.raises(ScenarioError, match="a Git LFS pointer, not the file itself; run 'git lfs pull'"):
        load(path)
    path.rename(tmp_path / "scenario.yaml")
    with pytest.raises(ScenarioError, match="a Git LFS pointer, not the file itself; run 'git lfs pull'"):
        load(tmp_path / "scenario.yaml")


def test_a_plan_may_be_made_twice_at_a_tick(tmp_path):
    """After states that got lost, also one of the same content; one of the same number is a message twice."""
    for number, accepted in ((1, True), (0, False)):
        file = File(tmp_path / f"{number}.mcap")
        schema = file.writer.register_schema("surefoot.Y", "protobuf", SPEC.descriptors)
        plans = file.writer.register_channel("/y", "protobuf", schema, SPEC.metadata)
        for tick in range(10):
            file.send(tick)
        for sequence in (0, number):
            file.writer.add_message(plans, 3 * TICK, content(3), 3 * TICK, sequence)
        if accepted:
            assert file.read().count("/y") == 2
        else:
            with pytest.raises(LogError, match="its topic /y has a message twice"):
                file.read()
