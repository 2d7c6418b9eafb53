"""``surefoot bench g1-tour``: many tours, kept as they come, and the table of what they say."""

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason, write_whole
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.processes import side_by_side
from surefoot.scenarios.run.run import made_folder
from surefoot.studies.tour.page import markdown
from surefoot.studies.tour.results import RowResult, to_json
from surefoot.studies.tour.ride import PunchTaken, TourResult, run_tour
from surefoot.studies.tour.rows import ROWS
from surefoot.studies.tour.rules import DURATION

NOTE = "Own implementation, not calibrated: no learned policy has been run in it yet."

JOURNAL, RESULT, PAGE = "tours.jsonl", "result.json", "result.md"


@lru_cache(maxsize=1)
def published() -> dict[str, Any]:
    """Rows that others have published with their source, and what is different here."""
    found: dict[str, Any] = yaml.safe_load(_text("published.yaml"))
    return found


def _text(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


class Bench:
    """Tours of some rows, of which those in the folder are not run again.

    Args:
        rows: names of them.
        seeds: tours of each.
        folder: that keeps every tour as soon as it is over.
        duration: after which a tour is over [s].

    Raises:
        LogError: the folder cannot be written.
    """

    def __init__(self, rows: Sequence[str], seeds: int, folder: Path, duration: float = DURATION) -> None:
        self._rows, self._seeds, self._duration = tuple(rows), seeds, duration
        self._folder = made_folder(folder)
        texts = [_text(name) for name in ("g1.yaml", "tour.yaml")]
        self._made_by = _digest({"versions": dict(relevant_versions()), "duration": duration, "texts": texts})
        self._results: dict[tuple[str, int], TourResult] = {}
        self._read()

    def left(self) -> list[tuple[str, int, float]]:
        """Tours that are still to be run: row, seed, duration; of every row those of a seed together."""
        tours = [(row, seed) for seed in range(self._seeds) for row in self._rows]
        return [(*tour, self._duration) for tour in tours if tour not in self._results]

    def run(self, workers: int, on_tour: Callable[[TourResult], None] = lambda _: None) -> None:
        """Run what is left.

        Args:
            workers: processes.
            on_tour: called with each new result.

        Raises:
            LogError: a result cannot be written.
        """
        left = self.left()
        for result in side_by_side(run_tour, left, workers, _lost) if left else ():
            if result.fault != _LOST:
                self._results[result.row, result.seed] = result
                self._write(result)
            on_tour(result)

    def rows(self) -> list[RowResult]:
        """Results of the tours of each row together."""
        found = []
        for row in self._rows:
            results = [self._results[row, seed] for seed in range(self._seeds) if (row, seed) in self._results]
            if results:
                found.append(RowResult.of(results, self._duration))
        return found

    def to_json(self) -> dict[str, Any]:
        """All that the bench says."""
        return {
            "bench": "g1-tour",
            "note": NOTE,
            "seconds": self._duration,
            "rows": [{**to_json(row), "meaning": ROWS[row.row].meaning} for row in self.rows()],
            "published": published()["rows"],
            "source": published()["source"].strip(),
            "differences": published()["differences"],
            "versions": dict(relevant_versions()),
        }

    def write(self) -> Path:
        """Write the result into the folder, in JSON and in Markdown.

        Returns:
            path of the former.
        """
        record = self.to_json()
        texts = {RESULT: json.dumps(record, indent=1, allow_nan=False) + "\n", PAGE: markdown(record)}
        for name, text in texts.items():
            with write_whole(self._folder / name, replace=True) as temporary:
                temporary.write_text(text, encoding="utf-8")
        return self._folder / RESULT

    def _read(self) -> None:
        """Find the tours that the folder has of these versions."""
        path = self._folder / JOURNAL
        if not path.is_file():
            return
        for line in path.read_text(encoding="utf-8").splitlines():
            try:
                record = json.loads(line)
                if record.pop("made_by") == self._made_by:
                    result = _result(record)
                    self._results[result.row, result.seed] = result
            except (ValueError, TypeError, KeyError):  # the last line of a process that was killed
                continue

    def _write(self, result: TourResult) -> None:
        path = self._folder / JOURNAL
        try:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps({**asdict(result), "made_by": self._made_by}) + "\n")
        except OSError as error:
            raise LogError(f"{path}: cannot be written, {reason(error)}; choose another --out") from None


_LOST = "lost"


def _lost(row: str, seed: int, duration: float, record: str) -> TourResult:
    """In place of a tour whose process ended unexpectedly, which is run again when the command is given again."""
    return TourResult(row, seed, 0.0, False, (), (), (), (), _LOST, 0, None)


def _digest(record: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()[:16]


def _result(record: dict[str, Any]) -> TourResult:
    punches = (PunchTaken(**{**punch, "direction": tuple(punch["direction"])}) for punch in record["punches"])
    lists: dict[str, Any] = {name: tuple(record[name]) for name in ("position_errors", "heading_errors", "energy")}
    return TourResult(**{**record, **lists, "punches": tuple(punches)})


def lines(record: dict[str, Any]) -> Iterator[str]:
    """The table, as `Bench.to_json` says it, for a terminal."""
    yield f"{'row':<26} {'tours':>5}  {'survival s':<19} {'completed':<12} {'cm':>5} {'deg':>5} {'kJ':>5}"
    for row in record["rows"]:
        yield " ".join(_line(row))
    yield f"published, {record['source']}:"
    for row in record["published"]:
        energy = f"{row['energy']:5.1f}" if "energy" in row else "     "
        yield (
            f"{row['name']:<26} {'':>5}  {row['survival']:<19.1f} {str(row['completed']) + ' %':<12}"
            f" {row['position']:5.0f} {row['heading']:5.0f} {energy}"
        )
    for row in record["rows"]:
        yield ""
        yield f"{row['row']}: punches survived"
        for kind, shares in row["punches"].items():
            shares_text = ", ".join(f"{share['of']} {share['kept']}/{share['count']}" for share in shares)
            yield f"  by {kind}: {shares_text}"
        yield "  falls: " + (", ".join(f"{cause} {count}" for cause, count in row["falls"]) or "none")
    yield ""
    yield record["note"]
    yield from (f"- {difference}" for difference in record["differences"])


def _line(row: dict[str, Any]) -> Iterator[str]:
    survival, done = row["survival"], row["completed"]
    yield f"{row['row']:<26} {row['tours']:>5} "
    interval = f"{survival['value']:.1f} ({survival['low']:.1f} to {survival['high']:.1f})"
    yield f"{interval:<19} {100 * done['kept'] / done['count']:.0f} %".ljust(32)
    yield _number(row["position_error"]["value"], 100.0)
    yield _number(row["heading_error"]["value"], math.degrees(1.0))
    yield _number(row["energy"]["value"], 1.0)


def _number(value: float | None, factor: float) -> str:
    return f"{'-':>5}" if value is None else f"{value * factor:5.1f}"
