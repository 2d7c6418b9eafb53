"""Logs made to hurt: each a sound log of a run in which one thing is not as it should be, with checksums that agree."""

import json
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import lz4.frame
import zstandard
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, ChunkIndex, Header, MessageIndex, Metadata

from surefoot.scenarios.log import Log
from surefoot.scenarios.log.encoding import MAGIC, Summary, chunk_head, encoded
from surefoot.scenarios.record.provenance import STOPPED

MB = 1 << 20
Edit = Callable[["Draft"], None]


@dataclass
class Draft:
    """A log in parts, to be changed and then written."""

    metadata: dict[str, dict[str, str]]
    attachments: dict[str, bytes]
    channels: dict[int, Channel]
    schemas: list
    chunks: list[tuple[Chunk, list[tuple[int, bytes]]]] = field(default_factory=list)
    tail: Callable[[bytes], bytes] = bytes

    def bytes(self) -> bytes:
        """The file: the end record last, the checksum of the data right."""
        summary, out = Summary(), bytearray(MAGIC + encoded(Header("", "surefoot")))
        end = {name: values for name, values in self.metadata.items() if name == "end"}
        for name, values in self.metadata.items():
            if name != "end":
                out += summary.add_metadata(Metadata(name, values), len(out))
        for name, data in self.attachments.items():
            out += summary.add_attachment(Attachment(0, 0, name, "", data), len(out))
        for schema in self.schemas:
            out += encoded(schema)
        for channel in self.channels.values():
            out += encoded(channel)
        for chunk, indexes in self.chunks:
            head = chunk_head(chunk)
            summary.add_chunk(chunk, len(out), len(head) + len(chunk.data), indexes)
            out += b"".join((head, chunk.data, *(index for _, index in indexes)))
        for name, values in end.items():
            out += summary.add_metadata(Metadata(name, values), len(out))
        return self.tail(bytes(out + summary.finish(len(out), {}, zlib.crc32(out))))

    def constant(self, name: str, value: str) -> None:
        """Set a constant of the run, JSON."""
        self.metadata["run"][name] = value


def draft(log: Log) -> Draft:
    """The parts of a sound log."""
    contents = log.contents
    made = Draft(
        {name: dict(values) for name, values in log.metadata.items()},
        dict(log.attachments),
        dict(contents.channels),
        list(contents.schemas.values()),
    )
    for place in contents.chunks:
        data = bytes(log.data[place.data])
        chunk = Chunk(place.compression, data, place.end_ns, place.start_ns, place.crc, place.size)
        entries = {number: place.entries(number, log.data).tolist() for number in sorted(place.channels)}
        made.chunks.append((chunk, [(n, encoded(MessageIndex(n, rows))) for n, rows in entries.items()]))
    return made


def recipes() -> Iterator[tuple[str, Edit]]:
    """Every recipe with its name."""
    yield from _constants()
    yield from _ends()
    yield from _scenarios()
    yield from _layouts()
    yield from _chunks()


def _constants() -> Iterator[tuple[str, Edit]]:
    wrong = ("NaN", "0", "-1", "1e300", '"x"', "null", "[1]")
    for name in ("mass", "com_height", "foot_length", "control_rate", "sample_time"):
        for value in wrong:
            yield f"{name} {value}", lambda log, name=name, value=value: log.constant(name, value)
    others = {
        "steps_planned": "-3", "fidelity": '"dream"', "torque_limit": "[1.0]", "position_lower": "[]",
        "joint_names": '["a"]', "boxes": "[[1.0]]", "roles": "[" * 50_000, "seed": "9" * 9000,
    }  # fmt: skip
    for name, value in others.items():
        yield f"{name} {value[:9]}", lambda log, name=name, value=value: log.constant(name, value)
    yield "no constants", lambda log: log.metadata.pop("run")


def _ends() -> Iterator[tuple[str, Edit]]:
    for kind, time in (("completed", "9"), ("completed", "nan"), ("completed", ""), ("fall", "0.3"), ("bliss", "1")):
        end = {"kind": kind, "time": time, "reason": ""}
        yield f"end {kind} {time}", lambda log, end=end: log.metadata.update(end=end)
    yield "end of nothing", lambda log: log.metadata.update(end={})
    yield "no end", lambda log: log.metadata.pop("end")


def _scenarios() -> Iterator[tuple[str, Edit]]:
    laughs = "a0: &a0 [x, x]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 12))
    merges = "a0: &a0 {x: 1}\n" + "".join(
        f"a{i}: &a{i} {{<<: [{', '.join([f'*a{i - 1}'] * 9)}]}}\n" for i in range(1, 12)
    )
    texts = {
        "laughs": laughs.encode(), "merges": merges.encode(), "deep": b"[" * 100_000, "latin": b"name: \xe9",
        "huge": b"# " * 2 * MB, "list": b"[1, 2]", "empty": b"", "itself": b"a: &a [*a]",
    }  # fmt: skip
    for name, text in texts.items():
        yield f"scenario {name}", lambda log, text=text: log.attachments.update({"scenario.yaml": text})
    yield "no scenario", lambda log: log.attachments.pop("scenario.yaml")
    for text in ("[1, 2]", "pushes: [1]", "pushes: [{time: x}]", "faults: {a: 1}", "commands: 3"):
        yield f"stopped in {text}", lambda log, text=text: _stopped(log, text.encode())


def _stopped(log: Draft, scenario: bytes) -> None:
    """As a run that was ended by hand, of which only what had begun is run again."""
    log.attachments["scenario.yaml"] = scenario
    log.metadata["end"] = {"kind": "completed", "time": "1", "reason": STOPPED}


def _layouts() -> Iterator[tuple[str, Edit]]:
    rows: dict[str, object] = {
        "huge": [["com", "double", [1 << 19, 1 << 19]]], "axes": [["com", "double", [1] * 100]],
        "endless": [["com", "double", [1 << 19] * 20_000]], "negative": [["com", "double", [-3]]],
        "inner": [["_opcode", "double", [3]]], "twice": [["com", "double", [3]], ["com", "double", [3]]],
        "infinite": [["com", "double", [float("inf")]]], "scalar": [["com", "double", []]], "kind": [["com", [], [3]]],
        "many": [[f"f{i}", "double", [1]] for i in range(50_000)], "flat": 3, "wide": [["com", "double", [100_000]]],
    }  # fmt: skip
    for name, layout in rows.items():
        yield f"layout {name}", lambda log, layout=layout: _relayout(log, json.dumps(layout))
    yield "layout deep", lambda log: _relayout(log, "[" * 100_000)
    yield "empty channel", lambda log: log.channels.update({99: replace(log.channels[1], id=99, topic="/wbc")})


def _relayout(log: Draft, text: str) -> None:
    number = next(number for number, channel in log.channels.items() if channel.topic == "/truth")
    old = log.channels[number]
    log.channels[number] = replace(old, metadata={**old.metadata, "layout": text})


def _chunks() -> Iterator[tuple[str, Edit]]:
    zeros = bytes(256 * MB)
    inflating = {"zstd": zstandard.compress(zeros), "lz4": lz4.frame.compress(zeros, store_size=True)}
    for method, data in inflating.items():
        yield f"{method} lies", lambda log, m=method, d=data: _put(log, 3, Chunk(m, d, 10**9, 0, 0, 5000))
        yield f"{method} bomb", lambda log, m=method, d=data: _put(log, 3, Chunk(m, d, 10**9, 0, 0, len(zeros)))
    small = zstandard.compress(bytes(60 * MB))
    yield "many bombs", lambda log: [_put(log, 3, Chunk("zstd", small, 1, 0, 0, 60 * MB)) for _ in range(500)] and None
    yield "states 2^62", lambda log: _put(log, 3, Chunk("lz4", b"x", 1, 0, 0, 1 << 62))
    yield "unknown method", lambda log: _put(log, 3, Chunk("bz3", b"x", 1, 0, 0, 1))
    yield "swapped", lambda log: log.chunks.reverse()
    yield "missing", lambda log: log.chunks.pop(2) and None
    yield "doubled", lambda log: log.chunks.insert(3, log.chunks[2])
    yield "no chunks", lambda log: log.chunks.clear()
    for name, entries in {
        "same place": [(1, 0)] * 50_000,
        "beyond": [(2**63, 2**63)] * 1000,
        "rubbish": [(7, 13 * i) for i in range(20_000)],
    }.items():
        yield f"index {name}", lambda log, entries=entries: _reindex(log, entries)
    many = range(200, 30_000)
    yield "index of many", lambda log: log.chunks[1][1].extend((n, encoded(MessageIndex(n, []))) for n in many)
    yield "summary of rubbish", lambda log: setattr(log, "tail", _rubbish)


def _put(log: Draft, at: int, chunk: Chunk) -> None:
    log.chunks.insert(at, (chunk, [(1, encoded(MessageIndex(1, [(0, 0)])))]))


def _reindex(log: Draft, entries: list[tuple[int, int]]) -> None:
    chunk, indexes = log.chunks[1]
    log.chunks[1] = (chunk, [(number, encoded(MessageIndex(number, entries))) for number, _ in indexes])


def _rubbish(data: bytes) -> bytes:
    """A hole in the data, and an index of ten thousand places that begin no chunk."""
    start = 8 + data[8:].index(bytes([Opcode.CHUNK]), 5000)
    footer = struct.pack("<BQQQI", Opcode.FOOTER, 20, len(data), 0, 0)
    index = b"".join(encoded(ChunkIndex(1, start + i, "", 0, 0, 0, {}, 0, 0)) for i in range(1, 10_001))
    return data[:start] + b"\xff" * 5000 + data[start + 5000 :] + index + footer + MAGIC
