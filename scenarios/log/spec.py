"""What a channel of the log carries: fields with shape, unit and frame."""

import json
from dataclasses import dataclass
from math import prod
from typing import Literal

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


@dataclass(frozen=True, slots=True)
class ChannelSpec:
    """A channel: its topic, the name of its message type and the fields in the order in which they are appended."""

    topic: str
    message: str
    fields: tuple[FieldSpec, ...]
    doc: str = ""

    def metadata(self) -> dict[str, str]:
        """What the schema cannot say, as metadata of the MCAP channel: layout, units, frames, meanings."""
        layout = [[f.name, f.kind, list(f.shape)] for f in self.fields]
        notes = {f.name: " ".join(part for part in (f.doc, f"[{f.unit}]", f.frame) if part) for f in self.fields}
        return {
            "layout": json.dumps(layout),
            "doc": self.doc,
            **{f"field.{name}": note for name, note in notes.items()},
        }


def layout_of(metadata: dict[str, str]) -> tuple[FieldSpec, ...]:
    """Read the fields back from a channel's metadata.

    Raises:
        ValueError: the metadata give no layout.
    """
    try:
        rows = json.loads(metadata["layout"])
        fields = tuple(FieldSpec(str(name), tuple(int(n) for n in shape), kind=kind) for name, kind, shape in rows)
    except (KeyError, TypeError, ValueError, RecursionError):
        raise ValueError("no layout") from None
    sound = all(f.kind in ("double", "int") and all(0 < n < 1 << 20 for n in f.shape) for f in fields)
    names = [f.name for f in fields]
    if not sound or len(set(names)) < len(names) or not all(name.isidentifier() for name in names):
        raise ValueError("no sound layout")
    return fields
