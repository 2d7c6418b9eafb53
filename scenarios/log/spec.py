"""The content of a channel of the log, and the bytes of its messages: protobuf that a numpy record describes.

Field 1 is the stamp (``fixed64``, always written). Every other field is always written whole: scalars as ``double``
or ``sfixed32``, arrays as packed ``repeated`` ones. So any protobuf reader decodes a message by its schema, and numpy
reads or writes a block of them without a loop.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any, Literal, NamedTuple

import numpy as np
from google.protobuf import descriptor_pb2
from mcap.opcode import Opcode
from numpy.typing import NDArray

Kind = Literal["double", "int"]


@dataclass(frozen=True, slots=True)
class FieldSpec:
    """One field of a channel.

    Attributes:
        name: field name, a lower-case identifier.
        shape: shape of the value, () for a scalar.
        unit: SI unit, "-" for none.
        frame: frame the value is expressed in, "" where none applies.
        doc: what it is.
        kind: double or 32-bit integer.
    """

    name: str
    shape: tuple[int, ...] = ()
    unit: str = "-"
    frame: str = ""
    doc: str = ""
    kind: Kind = "double"

    @property
    def size(self) -> int:
        """Number of elements."""
        return prod(self.shape)

    def columns(self, joints: Sequence[str] = ()) -> Iterator["Column"]:
        """Every element as a column of a table, called by the robot's joints in order where they are known."""
        units, names = self._element_units(), self._joint_names(joints)
        for place in np.ndindex(self.shape):
            name = f"{self.name}.{names[place[0]]}" if names else "_".join((self.name, *map(str, place)))
            yield Column(name, units[place[-1]] if place else self.unit, place)

    def element(self, place: tuple[int, ...], joints: Sequence[str] = ()) -> str:
        """An element in a sentence: by its joint where that is known, else by its indices, such as ``com[2]``."""
        names = self._joint_names(joints)
        return f"{self.name}.{names[place[0]]}" if names else self.name + "".join(f"[{index}]" for index in place)

    def _element_units(self) -> tuple[str, ...]:
        """Unit of each element of the last axis: of several, each is of three elements, or of four without a unit."""
        *first, last = self.unit.split(", ")
        units = [unit for unit in first for _ in range(4 if unit == "-" else 3)]
        return (*units, *([last] * (prod(self.shape[-1:]) - len(units))))

    def _joint_names(self, joints: Sequence[str]) -> tuple[str, ...]:
        """Names of the elements of a vector by joint, perhaps with the base before them; () of any other field."""
        units = self.unit.split(", ")
        if not joints or len(self.shape) != 1 or units[-1] not in _JOINT_UNITS:
            return ()
        base = _BASE.get(self.shape[0] - len(joints))
        if base is None or (not base and (len(units) > 1 or self.frame)):
            return ()
        return (*base, *joints)


class Column(NamedTuple):
    """An element of a field as a column of a table: its heading, its unit, and its place in the field."""

    name: str
    unit: str
    place: tuple[int, ...]


_JOINT_UNITS = ("rad", "rad/s", "rad/s^2", "N m")
_BASE: Mapping[int, tuple[str, ...]] = {
    0: (),
    6: tuple(f"base_{kind}_{axis}" for kind in ("linear", "angular") for axis in "xyz"),
    7: tuple(f"base_{part}" for part in ("x", "y", "z", "qx", "qy", "qz", "qw")),
}
"""Elements before the joints in a vector of so many elements more than joints: none, a velocity, a pose."""


@dataclass(frozen=True)
class ChannelSpec:
    """A channel: its topic, the name of its message type and the fields in the order in which they are appended.

    What a file needs of it is made once: run after run of a campaign opens the same channels.
    """

    topic: str
    message: str
    fields: tuple[FieldSpec, ...]
    doc: str = ""

    @cached_property
    def metadata(self) -> Mapping[str, str]:
        """Metadata of the MCAP channel that the schema cannot hold: layout, units, frames, meanings."""
        layout = [[f.name, f.kind, list(f.shape)] for f in self.fields]
        notes = {f.name: " ".join(part for part in (f.doc, f"[{f.unit}]", f.frame) if part) for f in self.fields}
        return {
            "layout": json.dumps(layout),
            "doc": self.doc,
            **{f"field.{name}": note for name, note in notes.items()},
        }

    @cached_property
    def descriptors(self) -> bytes:
        """Serialized protobuf ``FileDescriptorSet`` of its message, with units and frames as comments."""
        return _file_descriptor_set(self)

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """Numpy type of a whole message record."""
        return record_dtype(self.fields)

    @cached_property
    def places(self) -> Mapping[str, int]:
        """Begin of each part of a message record in it [bytes]."""
        return {name: part[1] for name, part in (self.dtype.fields or {}).items()}

    @cached_property
    def blank(self) -> bytes:
        """A message record with every constant byte in place: opcode, length and field tags."""
        record = np.zeros((), self.dtype)
        record["_opcode"] = Opcode.MESSAGE
        record["_length"] = record.dtype.itemsize - PREFIX_BYTES
        record["_stamp_tag"] = 1 << 3 | _FIXED64
        for number, field in enumerate(self.fields, start=2):
            record[f"_tag_{field.name}"] = np.frombuffer(_tag(number, field), np.uint8)
        return record.tobytes()


_MOST_FIELDS, _MOST_AXES, _MOST_NUMBERS = 1000, 8, 1 << 17
"""Greatest size of a message: a layout that asks for more is damaged, or made to exhaust the memory."""


def layout_of(metadata: Mapping[str, str]) -> tuple[FieldSpec, ...]:
    """Read the fields back from a channel's metadata, as `ChannelSpec.metadata` writes them.

    Raises:
        ValueError: the metadata give no layout.
    """
    try:
        rows = json.loads(metadata["layout"])
        if len(rows) > _MOST_FIELDS:
            raise ValueError("too many fields")
        fields = tuple(
            FieldSpec(str(name), tuple(int(n) for n in shape), *_noted(metadata.get(f"field.{name}", "")), kind=kind)
            for name, kind, shape in rows
        )
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError):
        raise ValueError("no layout") from None
    sound = all(
        f.kind in ("double", "int") and len(f.shape) <= _MOST_AXES and all(0 < n <= _MOST_NUMBERS for n in f.shape)
        for f in fields
    )
    names = [f.name for f in fields]
    if not sound or sum(f.size for f in fields) > _MOST_NUMBERS or len(set(names)) < len(names):
        raise ValueError("no sound layout")
    if not all(name.isidentifier() and not name.startswith("_") for name in names):
        raise ValueError("no sound layout")
    return fields


def _noted(note: str) -> tuple[str, str, str]:
    """Unit, frame and meaning of a field from the note on it; what is no such note is all meaning."""
    doc, _, rest = note.rpartition("[")
    unit, closed, frame = rest.partition("]")
    return (unit, frame.strip(), doc.strip()) if closed else ("-", "", note)


PACKAGE = "surefoot"
HEADER = ("_opcode", "_length", "_channel", "_sequence", "_log_time", "_publish_time", "_stamp_tag", "_stamp")
PREFIX_BYTES = 9
"""Opcode and length of an MCAP record, which the record's length does not count."""

_FIXED64, _PACKED, _FIXED32 = 1, 2, 5
_Descriptor = descriptor_pb2.FieldDescriptorProto


def record_dtype(fields: tuple[FieldSpec, ...]) -> np.dtype[Any]:
    """Numpy type of a whole MCAP message record with these fields."""
    header: list[Any] = list(zip(HEADER, ("u1", "<u8", "<u2", "<u4", "<u8", "<u8", "u1", "<u8"), strict=True))
    body: list[Any] = []
    for number, field in enumerate(fields, start=2):
        body.append((f"_tag_{field.name}", "u1", (len(_tag(number, field)),)))
        body.append((field.name, "<f8" if field.kind == "double" else "<i4", field.shape))
    return np.dtype(header + body)


def blank_records(spec: ChannelSpec, channel_id: int, count: int) -> NDArray[np.void]:
    """Message records of a channel with every constant byte in place."""
    records: NDArray[np.void] = np.frombuffer(bytearray(spec.blank) * count, spec.dtype)
    records["_channel"] = channel_id
    return records


def _file_descriptor_set(spec: ChannelSpec) -> bytes:
    file = descriptor_pb2.FileDescriptorProto(name=f"{PACKAGE}/{spec.message}.proto", package=PACKAGE, syntax="proto3")
    message = file.message_type.add(name=spec.message)
    message.field.add(name="stamp_ns", number=1, type=_Descriptor.TYPE_FIXED64, label=_Descriptor.LABEL_OPTIONAL)
    for index, field in enumerate(spec.fields, start=1):
        message.field.add(
            name=field.name,
            number=index + 1,
            type=_Descriptor.TYPE_DOUBLE if field.kind == "double" else _Descriptor.TYPE_SFIXED32,
            label=_Descriptor.LABEL_REPEATED if field.shape else _Descriptor.LABEL_OPTIONAL,
        )
        comment = f" {field.doc} [{field.unit}] {field.frame}".rstrip()
        file.source_code_info.location.add(path=[4, 0, 2, index], span=[index, 0, 0], leading_comments=comment)
    return bytes(descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString(deterministic=True))


def _tag(number: int, field: FieldSpec) -> bytes:
    """Tag of a field and, for an array, its length in bytes."""
    width = 8 if field.kind == "double" else 4
    if field.shape:
        return _varint(number << 3 | _PACKED) + _varint(field.size * width)
    return _varint(number << 3 | (_FIXED64 if width == 8 else _FIXED32))


def _varint(value: int) -> bytes:
    parts = []
    while value > 0x7F:
        parts.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*parts, value])
