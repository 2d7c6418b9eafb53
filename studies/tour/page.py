"""The result of the bench in Markdown, for a page of the documentation or a summary of a CI run."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

Told = Mapping[str, Any]


def markdown(told: Told) -> str:
    """Tables of a result.

    Args:
        told: as `surefoot bench` writes it into ``result.json``.
    """
    parts = (_rows(told), _published(told), *_punches(told["rows"]), _falls(told["rows"]), _differences(told))
    return "\n".join(line for part in parts for line in (*part, "")).rstrip("\n") + "\n"


def _rows(told: Told) -> Iterator[str]:
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
            for row in told["rows"]
        ),
    )
    yield ""
    yield from _table(("row", "what goes in and out"), ((f"`{row['row']}`", row["meaning"]) for row in told["rows"]))


def _published(told: Told) -> Iterator[str]:
    yield f"Published of learned policies: {told['source']}."
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
            for row in told["published"]
        ),
    )


def _punches(rows: Sequence[Told]) -> Iterator[Iterator[str]]:
    for kind in rows[0]["punches"] if rows else ():
        yield _curve(kind, rows)


def _curve(kind: str, rows: Sequence[Told]) -> Iterator[str]:
    """Punches survived by one kind, a row of the table each, a column for each row of the bench."""
    found = {row["row"]: {share["of"]: share for share in row["punches"][kind]} for row in rows}
    every = sorted({of for shares in found.values() for of in shares})
    unit = " [N·s/kg]" if kind == "level impulse" else ""
    yield from _table(
        (f"{kind}{unit}", *(f"`{name}`" for name in found)),
        ((of, *(_share(shares[of]) if of in shares else "" for shares in found.values())) for of in every),
    )


def _falls(rows: Sequence[Told]) -> Iterator[str]:
    counts = {row["row"]: dict(map(tuple, row["falls"])) for row in rows}
    every = sorted({cause for falls in counts.values() for cause in falls})
    yield from _table(
        ("last punch before a fall", *(f"`{name}`" for name in counts)),
        ((cause, *(falls.get(cause, "") for falls in counts.values())) for cause in every),
    )


def _differences(told: Told) -> Iterator[str]:
    yield told["note"] + " What else is different from the benchmark:"
    yield ""
    yield from (f"- {difference}" for difference in told["differences"])
    yield ""
    names = ("surefoot", "mujoco", "pin", "proxsuite", "numpy", "python", "source_digest")
    known = (f"{name} {told['versions'][name]}" for name in names if name in told["versions"])
    yield f"Made with {', '.join(known)}."


def _table(head: Sequence[str], rows: Iterator[Sequence[Any]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    yield from (f"| {' | '.join(map(str, row))} |" for row in rows)


def _mean(mean: Told, factor: float, digits: int) -> str:
    if mean["value"] is None:
        return ""
    value, low, high = (f"{factor * mean[name]:.{digits}f}" for name in ("value", "low", "high"))
    return f"{value} ({low} to {high})"


def _share(share: Told) -> str:
    return f"{100 * share['kept'] / share['count']:.0f} % of {share['count']}"
