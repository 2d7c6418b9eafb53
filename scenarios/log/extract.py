"""Message records of one channel out of a block of bytes."""

from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from scenarios.log.layout import PREFIX_BYTES


def block_of(data: memoryview, index: NDArray[np.void], size: int) -> memoryview | bytes:
    """Bytes of a channel's messages of `size` bytes, one after the other; those beyond the chunk are left out.

    Args:
        data: a decompressed chunk.
        index: times and offsets of the channel's messages in it.
        size: of a message record.
    """
    offsets = index["offset"].astype(np.int64)
    if not len(offsets):
        return b""
    first, last = int(offsets[0]), int(offsets[-1])
    if 0 <= first and last + size <= len(data) and (offsets[1:] - offsets[:-1] == size).all():
        return data[first : last + size]
    inside = offsets[(offsets >= 0) & (offsets <= len(data) - size)]
    return b"".join(data[start : start + size] for start in inside.tolist())


def sound_records(block: NDArray[np.uint8], channel_id: int, dtype: np.dtype[Any]) -> NDArray[np.void]:
    """Message records of one channel out of whole records one after the other; others are left out."""
    records = block.view(dtype)
    sound = (
        (records["_opcode"] == Opcode.MESSAGE)
        & (records["_length"] == dtype.itemsize - PREFIX_BYTES)
        & (records["_channel"] == channel_id)
    )
    return records if sound.all() else records[sound]
