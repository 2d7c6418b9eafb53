"""Message records of one channel out of a block of bytes."""

from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from scenarios.log.layout import PREFIX_BYTES
from scenarios.log.scan import Buffer


def records_of(
    data: Buffer, index: NDArray[np.void], channel_id: int, dtype: np.dtype[Any]
) -> tuple[NDArray[np.uint8], int]:
    """Collect a channel's message records.

    Args:
        data: a decompressed chunk.
        index: times and offsets of the channel's messages in it.
        channel_id: the channel.
        dtype: type of a whole message record.

    Returns:
        bytes of the sound records, one after the other, and the number of others.
    """
    offsets, size = index["offset"].astype(np.int64), dtype.itemsize
    inside = offsets[(offsets >= 0) & (offsets <= len(data) - size)]
    contiguous = len(inside) and np.all(np.diff(inside) == size)
    if contiguous:
        block = np.frombuffer(data, np.uint8, len(inside) * size, inside[0])
    else:
        block = np.frombuffer(b"".join(data[start : start + size] for start in inside.tolist()), np.uint8)
    records = block.view(dtype)
    sound = (
        (records["_opcode"] == Opcode.MESSAGE)
        & (records["_length"] == size - PREFIX_BYTES)
        & (records["_channel"] == channel_id)
    )
    if not sound.all():
        block = records[sound].view(np.uint8)
    return block, len(offsets) - int(np.count_nonzero(sound))
