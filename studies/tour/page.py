"""The result of the bench in Markdown, for a page of the documentation or a summary of a CI run."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

Record = Mapping[str, Any]


def markdown(record: Record) -> str:
    """Tables of a result.

    Args:
        record: as `surefoot bench` writes it into ``result.json``.
    """
    parts = (_rows(record), _published(record), *_punches(record["rows"]), _falls(record["rows"]), _differences(record))
    return "\n".join(line for part in parts for line in (*part, "")).rstrip("\n") + "\n"


def _rows(record: Record) -> Iterator[str]:
    yield from _table(
        ("row", "tours", "survival [s]", "median", "completed", "place [cm]", "heading [deg]", "energy [kJ]"),
        (
            (
                f"`{row['row']}`",
                row["tours"],
                _mean(row["survival"], 1.0, 1),
                f"{row['survival_median']:.1f}",
                _share(row["completed"]),
                _mean(row["position_error"], 100.0, 1),
                _mean(row["heading_error"], math.degrees(1.0), 1),
                _mean(row["energy"], 1.0, 1),
            )
            for row in record["rows"]
        ),
    )
    yield ""
    yield from _table(("row", "what goes in and out"), ((f"`{row['row']}`", row["meaning"]) for row in record["rows"]))


def _published(record: Record) -> Iterator[str]:
    yield f"Published of learned policies: {record['source']}."
    yield ""
    yield from _table(
        ("policy", "survival [s]", "completed", "place [cm]", "heading [deg]", "energy [kJ]"),
        (
            (
                row["name"],
                f"{row['survival']:.1f}",
                f"{row['completed']} %",
                row["position"],
                row["heading"],
                row.get("energy", ""),
            )
            for row in record["published"]
        ),
    )


def _punches(rows: Sequence[Record]) -> Iterator[Iterator[str]]:
    for kind in rows[0]["punches"] if rows else ():
        yield _curve(kind, rows)


def _curve(kind: str, rows: Sequence[Record]) -> Iterator[str]:
    """Punches survived by one kind, a row of the table each, a column for each row of the bench."""
    found = {row["row"]: {share["of"]: share for share in row["punches"][kind]} for row in rows}
    every = sorted({of for shares in found.values() for of in shares})
    unit = " [N·s/kg]" if kind == "level impulse" else ""
    yield from _table(
        (f"{kind}{unit}", *(f"`{name}`" for name in found)),
        ((of, *(_share(shares[of]) if of in shares else "" for shares in found.values())) for of in every),
    )


def _falls(rows: Sequence[Record]) -> Iterator[str]:
    counts = {row["row"]: dict(map(tuple, row["falls"])) for row in rows}
    every = sorted({cause for falls in counts.values() for cause in falls})
    yield from _table(
        ("last punch before a fall", *(f"`{name}`" for name in counts)),
        ((cause, *(falls.get(cause, "") for falls in counts.values())) for cause in every),
    )


def _differences(record: Record) -> Iterator[str]:
    yield record["note"] + " What else is different from the benchmark:"
    yield ""
    yield from (f"- {difference}" for difference in record["differences"])
    yield ""
    names = ("surefoot", "mujoco", "pin", "proxsuite", "numpy", "python", "source_digest")
    known = (f"{name} {record['versions'][name]}" for name in names if name in record["versions"])
    yield f"Made with {', '.join(known)}."


def _table(head: Sequence[str], rows: Iterator[Sequence[Any]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    yield from (f"| {' | '.join(map(str, row))} |" for row in rows)


def _mean(mean: Record, factor: float, digits: int) -> str:
    if mean["value"] is None:
        return ""
    value, low, high = (f"{factor * mean[name]:.{digits}f}" for name in ("value", "low", "high"))
    return f"{value} ({low} to {high})"


def _share(share: Record) -> str:
    return f"{100 * share['kept'] / share['count']:.0f} % of {share['count']}"
