"""Compression of chunks."""

import lz4.frame
import zstandard

from scenarios.errors import LogError

_LZ4_LEVEL = -3
"""Twice as fast as the default, for 8 % more bytes of a log."""

_GREATEST_RATIO = 100_000
"""No sound chunk is compressed more; a damaged size must not exhaust the memory."""


def compress(data: bytes, method: str) -> bytes:
    """Compress a chunk by lz4, zstd or, for an empty method, not at all."""
    if method == "lz4":
        return bytes(lz4.frame.compress(data, store_size=True, compression_level=_LZ4_LEVEL))
    return zstandard.compress(data) if method == "zstd" else data


def decompress(data: bytes | memoryview, method: str, size: int) -> bytes:
    """Decompress a chunk.

    Args:
        data: compressed bytes.
        method: as of `compress`.
        size: bytes that must come out.

    Raises:
        LogError: the bytes are damaged or the method is unknown.
    """
    if size > _GREATEST_RATIO * len(data) + 1024:
        raise LogError("a chunk states more bytes than compression can yield; its bytes are damaged")
    try:
        if method == "lz4":
            whole = lz4.frame.decompress(data)
        elif method == "zstd":
            whole = zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
        elif method == "":
            whole = bytes(data)
        else:
            raise LogError(f"chunk compression '{method}' is unknown; use lz4, zstd or none")
    except (RuntimeError, zstandard.ZstdError, MemoryError, ValueError, OverflowError, EOFError):
        raise LogError("a chunk does not decompress; its bytes are damaged") from None
    if len(whole) != size:
        raise LogError(f"a chunk holds {len(whole)} bytes where it states {size}; its bytes are damaged")
    return bytes(whole)
