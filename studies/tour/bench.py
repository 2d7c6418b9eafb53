"""``surefoot bench g1-tour``: many tours, kept as they come, and the table of what they say."""

import csv
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.processes import side_by_side
from surefoot.scenarios.run.run import made_folder
from surefoot.studies.tour.journal import Journal, digest
from surefoot.studies.tour.page import markdown
from surefoot.studies.tour.results import RowResult, punches_table, to_json, tours_table
from surefoot.studies.tour.ride import OWN, PunchTaken, Setting, TourResult, run_tour
from surefoot.studies.tour.rules import DURATION
from surefoot.studies.tour.walker import Entrant

NOTE = "Own implementation. Policies that were run in it stand beside their published rows in docs/benchmark-g1.md."

JOURNAL, RESULT, PAGE, TOURS, PUNCHES = "tours.jsonl", "result.json", "result.md", "tours.csv", "punches.csv"


@lru_cache(maxsize=1)
def published() -> dict[str, Any]:
    """Rows that others have published with their source, and what is different here."""
    found: dict[str, Any] = yaml.safe_load(_text("published.yaml"))
    return found


def differences(setting: Setting) -> list[str]:
    """Differences from the benchmark in a setting."""
    written: list[Any] = published()["differences"]
    ours = [one if isinstance(one, dict) else {"what": one} for one in written]
    return [one["what"] for one in ours if all(asdict(setting)[key] == one[key] for key in one if key != "what")]


def _text(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


class Bench:
    """Tours of some walkers, of which those in the folder are not run again.

    Args:
        entrants: walkers that take part.
        seeds: tours of each.
        folder: that keeps every tour as soon as it is over.
        duration: after which a tour is over [s].
        setting: how a tour begins, and what draws it.

    Raises:
        LogError: the folder cannot be written.
    """

    def __init__(
        self,
        entrants: Sequence[Entrant],
        seeds: int,
        folder: Path,
        duration: float = DURATION,
        setting: Setting = OWN,
    ) -> None:
        self._entrants = {entrant.name: entrant for entrant in entrants}
        self._seeds, self._duration, self._setting = seeds, duration, setting
        self._folder = made_folder(folder)
        self._journal = Journal(self._folder / JOURNAL)
        texts = [_text(name) for name in ("g1.yaml", "tour.yaml")]
        made = {"versions": dict(relevant_versions()), "duration": duration, "texts": texts, **asdict(setting)}
        self._made_by = {name: digest({**made, "walker": one.digest()}) for name, one in self._entrants.items()}
        self._results: dict[tuple[str, int], TourResult] = {}
        self._read()

    def left(self) -> list[tuple[Entrant, int, float, Setting]]:
        """Tours that are still to be run, as `run_tour` takes them; of every walker those of a seed together."""
        tours = [(row, seed) for seed in range(self._seeds) for row in self._entrants]
        left = [tour for tour in tours if tour not in self._results]
        return [(self._entrants[row], seed, self._duration, self._setting) for row, seed in left]

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
                self._journal.add(asdict(result), self._made_by[result.row])
            on_tour(result)

    def rows(self) -> list[RowResult]:
        """Results of the tours of each row together."""
        found = []
        for row in self._entrants:
            results = [self._results[row, seed] for seed in range(self._seeds) if (row, seed) in self._results]
            if results:
                found.append(RowResult.of(results, self._duration))
        return found

    def tours(self) -> list[TourResult]:
        """Results of the tours that were asked for, one walker after the other."""
        asked = ((row, seed) for row in self._entrants for seed in range(self._seeds))
        return [self._results[tour] for tour in asked if tour in self._results]

    def to_json(self) -> dict[str, Any]:
        """All that the bench says."""
        return {
            "bench": "g1-tour",
            "note": NOTE,
            "seconds": self._duration,
            **asdict(self._setting),
            "rows": [{**to_json(row), "meaning": self._entrants[row.row].meaning} for row in self.rows()],
            "published": published()["rows"],
            "source": published()["source"].strip(),
            "differences": differences(self._setting),
            "versions": dict(relevant_versions()),
        }

    def write(self) -> Path:
        """Write the result into the folder: in JSON and in Markdown, and its tours and punches as tables.

        Returns:
            path of the former.
        """
        record = self.to_json()
        texts = {RESULT: json.dumps(record, indent=1, allow_nan=False) + "\n", PAGE: markdown(record)}
        for name, text in texts.items():
            with write_whole(self._folder / name, replace=True) as temporary:
                temporary.write_text(text, encoding="utf-8")
        for name, table in ((TOURS, tours_table(self.tours())), (PUNCHES, punches_table(self.rows()))):
            with write_whole(self._folder / name, replace=True) as temporary, temporary.open("w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows(table)
        return self._folder / RESULT

    def _read(self) -> None:
        """Find the tours that the folder has of this making."""
        for kept, made_by in self._journal.lines():
            try:
                if made_by == self._made_by.get(kept["row"]):
                    result = _result(kept)
                    self._results[result.row, result.seed] = result
            except (TypeError, KeyError):
                continue


_LOST = "lost"


def _lost(entrant: Entrant, seed: int, duration: float, setting: Setting, why: str) -> TourResult:
    """In place of a tour whose process ended unexpectedly, which is run again when the command is given again."""
    return TourResult(entrant.name, seed, 0.0, False, (), (), (), (), _LOST, 0, None)


def _result(kept: Mapping[str, Any]) -> TourResult:
    punches = (PunchTaken(**{**punch, "direction": tuple(punch["direction"])}) for punch in kept["punches"])
    lists: dict[str, Any] = {name: tuple(kept[name]) for name in ("position_errors", "heading_errors", "energy")}
    left_over = kept["left_over"] and tuple(kept["left_over"])
    return TourResult(**{**kept, **lists, "punches": tuple(punches), "left_over": left_over})


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
