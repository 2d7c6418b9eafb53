"""Digests of what a run has written first into its log, by name, so that another run's record in its place is seen.

They go with the log where other tools write it again, in any order and any chunks, and with any checksums.
"""

import zlib
from collections.abc import Iterable, Sequence

from mcap.records import Attachment, Metadata

RECORD = "manifest"
"""Metadata record of the digests."""


def manifest(records: Iterable[Metadata | Attachment]) -> Metadata:
    """The record of the digests of some others, CRC-32 of their content, by their kind and name."""
    return Metadata(RECORD, {_name(record): _digest(record) for record in records})


def not_as_written(records: Sequence[Metadata | Attachment]) -> tuple[list[str], list[str]]:
    """Hold the records of a log against its manifest; a log of an earlier version has none.

    Returns:
        which are missing, and which are not as the run has written them, in words.
    """
    said = next((one.metadata for one in records if isinstance(one, Metadata) and one.name == RECORD), {})
    there = {_name(record): record for record in records}
    missing = [f"its {name} is missing" for name in said if name not in there]
    other = [name for name, digest in said.items() if name in there and _digest(there[name]) != digest]
    return missing, [f"its {name} is not as its run has written it" for name in other]


def _name(record: Metadata | Attachment) -> str:
    return f"{'metadata' if isinstance(record, Metadata) else 'attachment'} '{record.name}'"


def _digest(record: Metadata | Attachment) -> str:
    data = repr(sorted(record.metadata.items())).encode() if isinstance(record, Metadata) else record.data
    return f"{zlib.crc32(data):08x}"
