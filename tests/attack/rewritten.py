"""Logs that others have written again: read and written by the stock library, with one thing done to them between."""

import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from io import BytesIO

from mcap.records import Attachment, Channel, DataEnd, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, IndexType, Writer

from surefoot.scenarios.log.encoding import MAGIC, encoded

Change = Callable[["Records", "Records"], None]
"""A change of the records of a log; the second are those of another run."""


@dataclass
class Records:
    """All records of the data of a log.

    Attributes:
        raw: records as they are, written behind the channels and before the messages; of them no checksum is made.
        last: kinds of records that are written behind the messages.
    """

    metadata: list[Metadata] = field(default_factory=list)
    attachments: list[Attachment] = field(default_factory=list)
    schemas: list[Schema] = field(default_factory=list)
    channels: list[Channel] = field(default_factory=list)
    messages: list[Message] = field(default_factory=list)
    raw: list[bytes] = field(default_factory=list)
    last: tuple[type, ...] = ()

    @classmethod
    def of(cls, data: bytes) -> "Records":
        """Read a file as the stock library does."""
        made = cls()
        kinds = {Metadata: made.metadata, Attachment: made.attachments, Schema: made.schemas, Channel: made.channels}
        for record in StreamReader(BytesIO(data)).records:
            if isinstance(record, DataEnd):
                return made
            if isinstance(record, Message):
                made.messages.append(record)
            elif type(record) in kinds and record not in kinds[type(record)]:
                kinds[type(record)].append(record)
        raise ValueError("no end of the data")

    def bytes(self, **options: object) -> bytes:
        """Write a file as the stock library does, with options of its writer, which gives ids of its own."""
        out = BytesIO()
        writer = Writer(out, **(options | ({"enable_data_crcs": False} if self.raw else {})))
        writer.start()
        for kind in (Metadata, Attachment):
            if kind not in self.last:
                self._put(writer, kind)
        schemas = {one.id: writer.register_schema(one.name, one.encoding, one.data) for one in self.schemas}
        channels = {
            one.id: writer.register_channel(
                one.topic, one.message_encoding, schemas.get(one.schema_id, 0), one.metadata
            )
            for one in self.channels
        }
        if self.raw:
            writer.flush()
            out.write(b"".join(self.raw))
        for one in self.messages:
            writer.add_message(channels[one.channel_id], one.log_time, one.data, one.publish_time, one.sequence)
        for kind in self.last:
            writer.flush()
            self._put(writer, kind)
        writer.finish()
        return out.getvalue()

    def _put(self, writer: Writer, kind: type) -> None:
        if kind is Metadata:
            for one in self.metadata:
                writer.add_metadata(one.name, one.metadata)
        else:
            for one in self.attachments:
                writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)

    def channel(self, topic: str) -> Channel:
        """The channel of a topic."""
        return next(one for one in self.channels if one.topic == topic)

    def of_topic(self, topic: str) -> list[Message]:
        """Messages of a topic."""
        number = self.channel(topic).id
        return [one for one in self.messages if one.channel_id == number]

    def without(self, *messages: Message) -> None:
        """Leave messages out."""
        out = set(map(id, messages))
        self.messages = [one for one in self.messages if id(one) not in out]

    def rename(self, change: Callable[[Message], Message]) -> None:
        """Change each message."""
        self.messages = [change(one) for one in self.messages]

    def drop(self, topic: str) -> None:
        """Leave a topic out."""
        self.without(*self.of_topic(topic))
        self.channels.remove(self.channel(topic))

    def record(self, name: str) -> Metadata | Attachment:
        """A metadata record or attachment by name."""
        return next(one for one in (*self.metadata, *self.attachments) if one.name == name)

    def put(self, record: Metadata | Attachment) -> None:
        """Put a record in the place of the one of its name."""
        kind = self.metadata if isinstance(record, Metadata) else self.attachments
        kind[[one.name for one in kind].index(record.name)] = record


def alike() -> Iterator[tuple[str, Change | None, dict[str, object]]]:
    """Ways to write the same again: name, change and options of the stock writer."""
    unzipped = {"compression": CompressionType.NONE}
    plain: dict[str, dict[str, object]] = {
        "zstd": {"enable_data_crcs": True},
        "lz4": {"compression": CompressionType.LZ4, "enable_data_crcs": True},
        "uncompressed": {**unzipped, "enable_data_crcs": True},
        "small chunks": {"chunk_size": 1000, "enable_data_crcs": True},
        "one chunk": {"chunk_size": 1 << 30, "enable_data_crcs": True},
        "no index": {"index_types": IndexType.NONE, "enable_data_crcs": True},
        "no message index": {"index_types": IndexType.CHUNK, "enable_data_crcs": True},
        "no statistics": {"use_statistics": False, "enable_data_crcs": True},
        "no summary": {"repeat_channels": False, "repeat_schemas": False, "enable_data_crcs": True},
    }
    for name, options in plain.items():
        yield name, None, options
    sealed: dict[str, object] = {"enable_data_crcs": True}
    yield "metadata last", lambda log, _: setattr(log, "last", (Metadata,)), sealed
    yield "attachments last", lambda log, _: setattr(log, "last", (Attachment, Metadata)), sealed
    yield "in order of time", lambda log, _: log.messages.sort(key=lambda one: one.log_time), sealed
    yield "topic by topic", lambda log, _: log.messages.sort(key=lambda one: one.channel_id), sealed
    yield "backwards", lambda log, _: log.messages.reverse(), sealed
    yield "shuffled", lambda log, _: random.Random(1).shuffle(log.messages), sealed
    yield "other ids", _reversed, sealed
    yield "schemas doubled", _double_schemas, sealed
    yield "counted from 1", lambda log, _: log.rename(lambda one: replace(one, sequence=one.sequence + 1)), sealed


def unproven() -> Iterator[tuple[str, Change | None, dict[str, object]]]:
    """The same again, without some of the evidence that it is the same."""
    yield "no data checksum", None, {}
    yield "no checksum", None, {"enable_crcs": False}
    yield "unchunked", None, {"use_chunking": False}
    yield "unchunked without checksum", None, {"use_chunking": False, "enable_crcs": False}
    yield "not numbered", lambda log, _: log.rename(lambda one: replace(one, sequence=0)), {"enable_data_crcs": True}
    yield "numbered together", _number, {"enable_data_crcs": True}


def filtered() -> Iterator[tuple[str, Change | None, dict[str, object]]]:
    """Without a topic that every run writes, and that the verdict does not need."""
    for topic in ("/timing", "/contact", "/reference", "/plan"):
        yield f"without {topic}", lambda log, _, topic=topic: log.drop(topic), {"enable_data_crcs": True}


def of_two_runs() -> Iterator[tuple[str, Change]]:
    """Changes after which a file is not the log of one run."""
    yield "merged", _merge
    yield "merged into its channels", lambda log, other: _merge(log, other, True)
    yield "merged with itself", lambda log, _: _merge(log, Records.of(log.bytes()), True)
    yield "messages of two runs alone", _messages_of
    for name in ("scenario.yaml", "robot.xml"):
        yield f"{name} twice", lambda log, _, name=name: log.attachments.append(log.record(name))
        yield f"{name} of both", lambda log, other, name=name: log.attachments.append(other.record(name))
        yield f"{name} of both, first", lambda log, other, name=name: log.attachments.insert(0, other.record(name))
    for name in ("end", "run", "agenda", "versions"):
        yield f"{name} twice", lambda log, _, name=name: log.metadata.append(log.record(name))
    yield "end of both", lambda log, other: log.metadata.append(other.record("end"))
    yield "end of both, first", lambda log, other: log.metadata.insert(0, other.record("end"))
    for topic in ("/truth", "/plan", "/footstep", "/events"):
        yield f"{topic} doubled", lambda log, _, topic=topic: log.messages.extend(log.of_topic(topic))
        yield f"one of {topic} doubled", lambda log, _, topic=topic: log.messages.insert(0, log.of_topic(topic)[-1])
    yield "a channel of the other run", lambda log, other: _messages_of(log, other, "/truth")
    yield "a second channel, empty", lambda log, _: log.channels.append(replace(log.channel("/truth"), id=900))
    yield "a topic in two channels", _split
    yield "a topic in two encodings", lambda log, _: _split(log, log, "json")
    yield "a channel defined twice", lambda log, _: log.raw.append(encoded(Channel(2, "/else", "protobuf", {}, 1)))
    yield "a schema defined twice", lambda log, _: log.raw.append(encoded(Schema(1, b"", "protobuf", "Else")))
    yield "a key twice in one record", _key_twice


def left_out() -> Iterator[tuple[str, Change]]:
    """Changes that the verdict must not call a pass: something is missing, moved in time or of another run."""
    for topic in ("/truth", "/plan", "/contact", "/footstep"):
        middle = lambda log, _, topic=topic: log.without(log.of_topic(topic)[len(log.of_topic(topic)) // 2])  # noqa: E731
        yield f"one of {topic} left out", middle
        yield f"the first of {topic} left out", lambda log, _, topic=topic: log.without(log.of_topic(topic)[0])
    yield "the last of /truth left out", lambda log, _: log.without(log.of_topic("/truth")[-1])
    yield "every second of /plan", lambda log, _: log.without(*log.of_topic("/plan")[::2])
    yield "a tenth of a second left out", lambda log, _: _only(log, lambda time: not 2e8 < time < 3e8)
    yield "its beginning left out", lambda log, _: _only(log, lambda time: time > 2e8)
    yield "its end left out", lambda log, _: _only(log, lambda time: time < 4e8)
    for name in ("end", "run", "agenda", "versions"):
        yield f"no {name}", lambda log, _, name=name: log.metadata.remove(log.record(name))
    for name in ("scenario.yaml", "robot.xml"):
        yield f"no {name}", lambda log, _, name=name: log.attachments.remove(log.record(name))
    for name in ("scenario.yaml", "end", "agenda"):
        yield f"{name} of the other run", lambda log, other, name=name: log.put(other.record(name))
    for name, key, value in (("run", "steps_planned", "0"), ("versions", "surefoot", "9.9"), ("end", "time", "9")):
        changed = lambda log, _, name=name, pair={key: value}: log.put(  # noqa: E731
            Metadata(name, log.record(name).metadata | pair)
        )
        yield f"another {key} in {name}", changed
    yield "no /truth", lambda log, _: log.drop("/truth")
    yield "moved in time", lambda log, _: log.rename(lambda one: replace(one, log_time=one.log_time + 10**9))
    yield "two messages in each other's place", _swap
    yield "a message of /truth cut", _cut


def _reversed(log: Records, _: Records) -> None:
    log.channels.reverse()
    log.schemas.reverse()


def _double_schemas(log: Records, _: Records) -> None:
    log.schemas += [replace(one, id=one.id + 500) for one in log.schemas]
    log.channels = [replace(one, schema_id=one.schema_id + 500 * (one.id % 2)) for one in log.channels]


def _number(log: Records, _: Records) -> None:
    log.messages = [replace(one, sequence=number) for number, one in enumerate(log.messages)]


def _merge(log: Records, other: Records, coalesced: bool = False) -> None:
    """As tools merge: schemas and channels that are the same once, or all of them; all metadata and attachments."""
    log.metadata += other.metadata
    log.attachments += other.attachments
    _messages_of(log, other, coalesced=coalesced)


def _messages_of(log: Records, other: Records, *topics: str, coalesced: bool = True) -> None:
    """Messages of another run, of some topics or all, in the channels of this one or in others."""
    channels = [one for one in other.channels if one.topic in topics or not topics]
    number = {one.id: one.id + (0 if coalesced else 400) for one in channels}
    if not coalesced:
        log.channels += [replace(one, id=number[one.id]) for one in channels]
    log.messages += [
        replace(one, channel_id=number[one.channel_id]) for one in other.messages if one.channel_id in number
    ]
    log.messages.sort(key=lambda one: one.log_time)


def _split(log: Records, _: Records, encoding: str = "protobuf") -> None:
    """The second half of the messages of a topic in another channel of it."""
    own = log.channel("/truth")
    log.channels.append(replace(own, id=901, message_encoding=encoding))
    later = set(map(id, log.of_topic("/truth")[100:]))
    log.rename(lambda one: replace(one, channel_id=901) if id(one) in later else one)


def _key_twice(log: Records, _: Records) -> None:
    """An end that says both that the run was completed and that it fell."""
    end = log.record("end")
    log.metadata.remove(end)
    twin = encoded(Metadata("end", {**end.metadata, "kinD": "fall"}))
    log.raw.append(twin.replace(b"kinD", b"kind"))


def _only(log: Records, wanted: Callable[[int], bool]) -> None:
    log.messages = [one for one in log.messages if wanted(one.log_time)]


def _swap(log: Records, _: Records) -> None:
    """Two messages of /truth with each other's times."""
    first, second = log.of_topic("/truth")[50], log.of_topic("/truth")[60]
    turned = {id(first): replace(first, data=second.data), id(second): replace(second, data=first.data)}
    log.rename(lambda one: turned.get(id(one), one))


def _cut(log: Records, _: Records) -> None:
    one = log.of_topic("/truth")[70]
    log.rename(lambda other: replace(other, data=other.data[:-8]) if other is one else other)


def joined(first: bytes, second: bytes) -> dict[str, bytes]:
    """One file behind another one, and a file with something behind it."""
    return {"two files in one": first + second, "twice the same file": first + first, "magic": first + MAGIC}
