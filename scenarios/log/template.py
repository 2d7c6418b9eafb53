"""Protobuf messages of any schema with a fixed size: encoded once, then only their numbers are written anew.

The message is built with the schema's own class, with recognisable numbers where values shall come. Their places in the
encoded bytes make the message a template. Doubles take eight bytes anyway; the two varints of a
``google.protobuf.Timestamp`` are written with leading zero groups, which every decoder accepts, so they keep their size.
"""

import struct
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

SECONDS, NANOS = (1 << 34) + 0x5EED5, (1 << 29) + 0xF00D
"""Stand for the stamp in a message that is to become a template; both take five bytes as varints."""

_SLOT = 0x7E57_AB1E_0000_0000
_VARINT_BYTES = 5
_STAMP_BYTES = 2 * (1 + _VARINT_BYTES)
_SHIFTS = np.arange(0, 7 * _VARINT_BYTES, 7, dtype=np.uint64)
_CONTINUED = np.array([0x80] * (_VARINT_BYTES - 1) + [0], np.uint64)
_STAMP_TAGS = (0x08, 0x10)
_NANOS_PER_SECOND = np.uint64(10**9)


class Message(Protocol):
    """What is used of a protobuf message."""

    def SerializeToString(self, *, deterministic: bool = ...) -> bytes:  # noqa: N802  protobuf's name
        """Encode."""
        ...


def slot(index: int) -> float:
    """The number that stands for value `index` of a template; it may stand in several places."""
    return float(struct.unpack("<d", struct.pack("<Q", _SLOT + index))[0])


@dataclass(frozen=True, slots=True)
class Template:
    """An encoded message and the places of its values.

    Attributes:
        data: the bytes.
        size: how many values it takes.
        places: byte offsets of the doubles, shape (p, 8).
        sources: which value stands at each place, shape (p,).
        stamps: byte offsets of the timestamps' contents, shape (s, 12).
    """

    data: bytes
    size: int
    places: NDArray[np.intp]
    sources: NDArray[np.intp]
    stamps: NDArray[np.intp]

    @classmethod
    def of(cls, message: Message, size: int) -> "Template":
        """Make a template of a message with slots 0 to size - 1.

        Raises:
            ValueError: a slot stands nowhere in the message.
        """
        data = message.SerializeToString(deterministic=True)
        found = [(place, index) for index in range(size) for place in _all(data, struct.pack("<Q", _SLOT + index))]
        missing = set(range(size)) - {index for _, index in found}
        if missing:
            raise ValueError(f"value {min(missing)} has no place in the message; it must stand in it at least once")
        places, sources = (np.array(column, np.intp) for column in zip(*found, strict=True))
        stamps = _all(data, _stamps(np.array([SECONDS], np.uint64), np.array([NANOS], np.uint64)).tobytes())
        stamp_places = np.array(stamps, np.intp)[:, None] + np.arange(_STAMP_BYTES)
        return cls(data, size, places[:, None] + np.arange(8), sources, stamp_places)

    def write(self, target: NDArray[np.uint8], values: NDArray[np.float64], times_ns: NDArray[np.uint64]) -> None:
        """Write values and stamps into copies of the message.

        Args:
            target: the copies, shape (n, bytes).
            values: shape (n, size).
            times_ns: shape (n,) [ns].
        """
        doubles = np.take(values, self.sources, axis=1)
        target[:, self.places] = doubles.view(np.uint8).reshape(len(values), -1, 8)
        target[:, self.stamps] = _stamps(*np.divmod(times_ns, _NANOS_PER_SECOND))[:, None]


def _stamps(seconds: NDArray[np.uint64], nanos: NDArray[np.uint64]) -> NDArray[np.uint8]:
    """Contents of ``google.protobuf.Timestamp`` messages of a fixed size, shape (n, 12)."""
    stamps = np.empty((len(seconds), 2, 1 + _VARINT_BYTES), np.uint8)
    stamps[:, :, 0] = _STAMP_TAGS
    stamps[:, 0, 1:] = _varint(seconds)
    stamps[:, 1, 1:] = _varint(nanos)
    return stamps.reshape(-1, _STAMP_BYTES)


def _varint(values: NDArray[np.uint64]) -> NDArray[np.uint8]:
    """Varints of five bytes each, shape (n, 5)."""
    return ((values[:, None] >> _SHIFTS) & np.uint64(0x7F) | _CONTINUED).astype(np.uint8)


def _all(data: bytes, part: bytes) -> list[int]:
    """Every offset of a part."""
    offsets, start = [], data.find(part)
    while start >= 0:
        offsets.append(start)
        start = data.find(part, start + len(part))
    return offsets
