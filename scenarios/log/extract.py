"""Message records of one channel out of a block of bytes."""

from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from scenarios.log.layout import PREFIX_BYTES
from scenarios.log.scan import PREFIX, Buffer, ChunkPlace

MESSAGE_BYTES = PREFIX_BYTES + 22
"""A message record without its content."""


def content_at(data: Buffer, offset: int) -> bytes:
    """Content of the message record at an offset; cut where the data end."""
    _, length = PREFIX.unpack_from(data, offset)
    return bytes(data[offset + MESSAGE_BYTES : offset + PREFIX_BYTES + length])


def block_of(data: memoryview, chunk: ChunkPlace, channel_id: int, size: int, file: Buffer) -> memoryview | bytes:
    """Bytes of a channel's messages of `size` bytes, one after the other; those beyond the chunk are left out.

    Where the first and the last one are as far apart as their number says, they stand in a row; `sound_records` shows
    whether they do.

    Args:
        data: the decompressed chunk.
        chunk: its place.
        channel_id: the channel, which has messages in it.
        size: of a message record.
        file: bytes of the file.
    """
    first, last = chunk.extent(channel_id, file)
    if last - first == (chunk.count(channel_id) - 1) * size and last + size <= len(data):
        return data[first : last + size]
    return gathered(data, chunk.entries(channel_id, file), size)


def gathered(data: memoryview, index: NDArray[np.void], size: int) -> bytes:
    """Bytes of messages that stand anywhere, one after the other; those beyond the data are left out."""
    last = len(data) - size
    return b"".join(data[start : start + size] for start in index["offset"].tolist() if start <= last)


def sound_records(block: NDArray[np.uint8], channel_id: int, dtype: np.dtype[Any]) -> NDArray[np.void]:
    """Message records of one channel out of whole records one after the other; others are left out."""
    records = block.view(dtype)
    sound = (
        (records["_opcode"] == Opcode.MESSAGE)
        & (records["_length"] == dtype.itemsize - PREFIX_BYTES)
        & (records["_channel"] == channel_id)
    )
    return records if sound.all() else records[sound]
