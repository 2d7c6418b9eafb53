"""Messages of any other schema than the log's own, of which only numbers and stamps are written anew.

A message becomes a `Template`: encoded once, by the schema's own class with recognisable numbers
where values shall come, and then only these are written anew. Doubles take eight bytes anyway; the two varints of a
``google.protobuf.Timestamp`` are padded by zero groups, which every decoder accepts, so that they keep their size.
"""

import re
import struct

import numpy as np
from google.protobuf.message import Message
from numpy.typing import ArrayLike, NDArray

Bytes = NDArray[np.uint8]

SECONDS, NANOS = (1 << 34) + 0x5EED5, (1 << 29) + 0xF00D
"""Stand for the stamp in a message that is to become a template; both take five bytes as varints."""

_SLOT = 0x7E57_AB1E_0000_0000
_STAMP_BYTES = 12
_SECONDS_TAG, _NANOS_TAG = 0x08, 0x10


def slot(index: int) -> float:
    """The number that stands for value `index` of a template; it may stand in several places."""
    return float(struct.unpack("<d", _slot_bytes(index))[0])


class Template:
    """An encoded message and the places of its values.

    Args:
        message: with slots 0 to size - 1.
        size: how many values it takes.

    Raises:
        ValueError: a slot stands nowhere in the message.
    """

    def __init__(self, message: Message, size: int) -> None:
        data = message.SerializeToString(deterministic=True)
        places = [(place, index) for index in range(size) for place in _all(data, _slot_bytes(index))]
        missing = set(range(size)) - {index for _, index in places}
        if missing:
            raise ValueError(f"value {min(missing)} has no place in the message; it must stand in it at least once")
        self.size, self._bytes = size, np.frombuffer(data, np.uint8)
        # Of each place of a value its first byte, and the first byte of the value.
        self._places = np.array([(place, 8 * index) for place, index in places], np.intp)
        self._stamps = np.array(_all(data, _stamp(SECONDS, NANOS)), np.intp)

    def encode(self, time_ns: int, values: ArrayLike) -> bytes:
        """Encode the message with these values, shape (size,), and this time [ns] in every stamp."""
        given = np.ascontiguousarray(values, "<f8")
        if given.shape != (self.size,):
            raise ValueError(f"values of the shape {given.shape}, where the message takes {self.size}")
        made = self._bytes.copy()
        seconds, nanos = divmod(time_ns, 1_000_000_000)
        self._write(made, given.view(np.uint8), seconds, nanos)
        return made.tobytes()

    def _write(self, message: Bytes, values: Bytes, seconds: int, nanos: int) -> None:
        """Write values and stamps into a message."""
        for k in range(len(self._places)):
            for i in range(8):
                message[self._places[k, 0] + i] = values[self._places[k, 1] + i]
        for k in range(len(self._stamps)):
            _put_stamp(message, self._stamps[k], seconds, nanos)


def _put_stamp(message: Bytes, place: int, seconds: int, nanos: int) -> None:
    """Write the content of a ``google.protobuf.Timestamp`` of a fixed size, of `_STAMP_BYTES`."""
    message[place] = _SECONDS_TAG
    _put_varint(message, place + 1, seconds)
    message[place + 6] = _NANOS_TAG
    _put_varint(message, place + 7, nanos)


def _put_varint(message: Bytes, place: int, value: int) -> None:
    """Write a varint of five bytes; the value is below 2^35."""
    for k in range(4):
        message[place + k] = value >> 7 * k & 127 | 128
    message[place + 4] = value >> 28


def _stamp(seconds: int, nanos: int) -> bytes:
    """Content of a stamp."""
    content = np.zeros(_STAMP_BYTES, np.uint8)
    _put_stamp(content, 0, seconds, nanos)
    return content.tobytes()


def _slot_bytes(index: int) -> bytes:
    return struct.pack("<Q", _SLOT | index)


def _all(data: bytes, part: bytes) -> list[int]:
    """Every offset of a part."""
    return [found.start() for found in re.finditer(re.escape(part), data)]
