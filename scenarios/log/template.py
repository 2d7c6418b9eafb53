"""Protobuf messages of any schema with a fixed size: encoded once, then only their numbers are written anew.

The message is built with the schema's own class, with recognisable numbers where values shall come. Their places in the
encoded bytes make the message a template. Doubles take eight bytes anyway; the two varints of a
``google.protobuf.Timestamp`` are padded by zero groups, which every decoder accepts, so that they keep their size.
"""

import struct
from collections.abc import Sequence
from operator import itemgetter
from typing import Protocol

SECONDS, NANOS = (1 << 34) + 0x5EED5, (1 << 29) + 0xF00D
"""Stand for the stamp in a message that is to become a template; both take five bytes as varints."""

_SLOT = 0x7E57_AB1E_0000_0000
_STAMP = struct.Struct("<B5sB5s")
_SECONDS_TAG, _NANOS_TAG = 0x08, 0x10


class Message(Protocol):
    """What is used of a protobuf message."""

    def SerializeToString(self, *, deterministic: bool = ...) -> bytes:  # noqa: N802  protobuf's name
        """Encode."""
        ...


def slot(index: int) -> float:
    """The number that stands for value `index` of a template; it may stand in several places."""
    return float(struct.unpack("<d", _slot_bytes(index))[0])


class Template:
    """An encoded message and the places of its values.

    Attributes:
        size: how many values it takes.
    """

    def __init__(self, message: Message, size: int) -> None:
        """Make a template of a message with slots 0 to size - 1.

        Raises:
            ValueError: a slot stands nowhere in the message.
        """
        data = message.SerializeToString(deterministic=True)
        places = [(place, "d", index) for index in range(size) for place in _all(data, _slot_bytes(index))]
        missing = set(range(size)) - {index for _, _, index in places}
        if missing:
            raise ValueError(f"value {min(missing)} has no place in the message; it must stand in it at least once")
        places += [(place, f"{_STAMP.size}s", size) for place in _all(data, _stamp(SECONDS, NANOS))]
        form, constants, end = "<", [], 0
        for place, kind, _ in sorted(places):
            form += f"{place - end}s{kind}"
            constants.append(data[end:place])
            end = place + (_STAMP.size if kind != "d" else 8)
        self.size = size
        self._struct = struct.Struct(f"{form}{len(data) - end}s")
        self._parts: list[bytes | float] = [b""] * (2 * len(places) + 1)
        self._parts[::2] = [*constants, data[end:]]
        self._pick = itemgetter(*(index for _, _, index in sorted(places)), size)

    def encode(self, time_ns: int, values: Sequence[float]) -> bytes:
        """Encode the message with these values and this time [ns] in every stamp."""
        parts = self._parts
        parts[1::2] = self._pick((*values, _stamp(*divmod(time_ns, 1_000_000_000))))[:-1]
        return self._struct.pack(*parts)


def _slot_bytes(index: int) -> bytes:
    return struct.pack("<Q", _SLOT + index)


def _stamp(seconds: int, nanos: int) -> bytes:
    """Content of a ``google.protobuf.Timestamp`` of a fixed size."""
    return _STAMP.pack(_SECONDS_TAG, _varint(seconds), _NANOS_TAG, _varint(nanos))


def _varint(value: int) -> bytes:
    """A varint of five bytes; the value is below 2^35."""
    return bytes(
        (value & 127 | 128, value >> 7 & 127 | 128, value >> 14 & 127 | 128, value >> 21 & 127 | 128, value >> 28)
    )


def _all(data: bytes, part: bytes) -> list[int]:
    """Every offset of a part."""
    offsets, start = [], data.find(part)
    while start >= 0:
        offsets.append(start)
        start = data.find(part, start + len(part))
    return offsets
