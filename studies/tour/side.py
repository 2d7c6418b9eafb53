"""``surefoot bench g1-side``: walkers beside each other on one robot, by pushes, velocities and places."""

import csv
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.scenarios.judge.metrics import plain
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.processes import side_by_side
from surefoot.scenarios.run.run import made_folder
from surefoot.studies.tour.drill import DIRECTIONS, PHASES, followed, largest
from surefoot.studies.tour.journal import Journal, digest
from surefoot.studies.tour.ride import Setting, run_tour
from surefoot.studies.tour.side_page import figure, markdown
from surefoot.studies.tour.walker import Entrant

JOURNAL, RESULT, PAGE, TABLE, FIGURE = "side.jsonl", "result.json", "result.md", "side.csv", "side.svg"

PLACES_TIME = 30.0
"""Time for which it goes from place to place without punches [s]."""

MEASURES = {
    "velocity_error": "error of the velocity, RMS [m/s]",
    "yaw_rate_error": "error of the yaw rate, RMS [rad/s]",
    "place_error": "distance from places after 5 s [m]",
    "turn_error": "angle from their headings [rad]",
    "cost_of_transport": "cost of transport [-]",
    "power": "power of all joints [W]",
    "slip": "slip [m/m]",
    "peak_force": "peak force [body weights]",
    "jerkiness": "change of joint acceleration [rad/s² a tick]",
}
"""Measures of each walker, the less the better, in words and with their units."""


@dataclass(frozen=True, slots=True)
class Task:
    """A piece of work, which goes to another process.

    Attributes:
        entrant: that does it.
        kind: velocities, places or push.
        which: number of the seed, or of the push.
    """

    entrant: Entrant
    kind: str
    which: int

    @property
    def key(self) -> tuple[str, str, int]:
        """Walker, kind and number."""
        return self.entrant.name, self.kind, self.which


def pushes() -> list[tuple[str, str]]:
    """Phase and direction of every push."""
    return [(phase, direction) for phase in PHASES for direction in DIRECTIONS]


def done(task: Task) -> dict[str, Any]:
    """Do it; gives its result as JSON has it."""
    row, kind, which = task.key
    one: dict[str, Any] = {"row": row, "kind": kind, "which": which}
    if kind == "velocities":
        return {**one, **plain(asdict(followed(task.entrant, which)))}
    if kind == "push":
        return {**one, "threshold": largest(task.entrant, *pushes()[which])}
    result = run_tour(task.entrant, which, PLACES_TIME, Setting(punched=False))
    place, turn = (
        float(np.mean(errors)) if errors else None for errors in (result.position_errors, result.heading_errors)
    )
    return {**one, "fell": not result.completed, "place_error": place, "turn_error": turn}


class Side:
    """Walkers beside each other, of whose work that in the folder is not done again.

    Args:
        entrants: walkers that take part.
        seeds: of velocities and of places.
        folder: that keeps every result as soon as it is there.

    Raises:
        LogError: the folder cannot be written.
    """

    def __init__(self, entrants: Sequence[Entrant], seeds: int, folder: Path) -> None:
        self._entrants, self._seeds, self._folder = list(entrants), seeds, made_folder(folder)
        versions = dict(relevant_versions())
        self._made_by = {one.name: digest({"versions": versions, "walker": one.digest()}) for one in entrants}
        self._journal = Journal(self._folder / JOURNAL)
        self._results: dict[tuple[str, str, int], Mapping[str, Any]] = {}
        for one, made_by in self._journal.lines():
            if made_by == self._made_by.get(one.get("row", "")):
                self._results[one["row"], one["kind"], one["which"]] = one

    def left(self) -> list[Task]:
        """Tasks that are still to be done, of every walker the same piece together."""
        pieces = [("velocities", seed) for seed in range(self._seeds)]
        pieces += [("places", seed) for seed in range(self._seeds)]
        pieces += [("push", number) for number in range(len(pushes()))]
        tasks = (Task(entrant, *piece) for piece in pieces for entrant in self._entrants)
        return [task for task in tasks if task.key not in self._results]

    def run(self, workers: int, on_task: Callable[[], None] = lambda: None) -> None:
        """Do what is left.

        Args:
            workers: processes.
            on_task: is called each time that one is done.

        Raises:
            LogError: a result cannot be written.
        """
        left = [(task,) for task in self.left()]
        for one in side_by_side(done, left, workers, lambda *_: {}) if left else ():
            if one:
                self._results[one["row"], one["kind"], one["which"]] = one
                self._journal.add(one, self._made_by[one["row"]])
            on_task()

    def to_json(self) -> dict[str, Any]:
        """All that is known of each walker."""
        rows = [self._row(entrant) for entrant in self._entrants]
        one = {"bench": "g1-side", "seeds": self._seeds, "rows": rows, "versions": dict(relevant_versions())}
        return {**one, "measures": MEASURES, "pushes": pushes()}

    def _row(self, entrant: Entrant) -> dict[str, Any]:
        of = [one for key, one in sorted(self._results.items()) if key[0] == entrant.name]
        found: dict[str, Any] = {"row": entrant.name, "meaning": entrant.meaning}
        for name in MEASURES:
            values = [one[name] for one in of if one.get(name) is not None and not one.get("fell")]
            found[name] = {"value": float(np.mean(values)) if values else None, "count": len(values)}
        found["fell"] = [sum(bool(one.get("fell")) for one in of), sum("fell" in one for one in of)]
        known = {one["which"]: one["threshold"] for one in of if one["kind"] == "push"}
        return {**found, "thresholds": [known.get(number) for number in range(len(pushes()))]}

    def write(self) -> Path:
        """Write the result into the folder: JSON, Markdown, a table and a figure.

        Returns:
            path of the first.
        """
        one = self.to_json()
        texts = {RESULT: json.dumps(one, indent=1, allow_nan=False) + "\n", PAGE: markdown(one)}
        for name, text in texts.items():
            with write_whole(self._folder / name, replace=True) as temporary:
                temporary.write_text(text, encoding="utf-8")
        with write_whole(self._folder / TABLE, replace=True) as temporary, temporary.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(table(one))
        with write_whole(self._folder / FIGURE, replace=True) as temporary:
            figure(one).savefig(temporary, format="svg")
        return self._folder / RESULT


def table(one: Mapping[str, Any]) -> Iterator[Sequence[Any]]:
    """Rows of cells, of which the first is the heading: walker, what, value, of how many."""
    yield "row", "what", "value", "count"
    for row in one["rows"]:
        for name in one["measures"]:
            value = row[name]["value"]
            yield row["row"], name, "" if value is None else f"{value:.5g}", row[name]["count"]
        yield row["row"], "fell", *row["fell"]
        for (phase, direction), threshold in zip(one["pushes"], row["thresholds"], strict=True):
            yield row["row"], f"push {phase} {direction}", "" if threshold is None else f"{threshold:.4g}", 1


def read_table(rows: Sequence[Sequence[str]]) -> dict[str, Any]:
    """The result that such a table tells, as `Side.to_json` has it but for meanings and versions."""
    found: dict[str, dict[str, Any]] = {}
    for name, what, value, count in rows[1:]:
        row = found.setdefault(name, {"row": name, "thresholds": []})
        if what.startswith("push "):
            row["thresholds"].append(float(value) if value else None)
        elif what == "fell":
            row["fell"] = [int(value), int(count)]
        else:
            row[what] = {"value": float(value) if value else None, "count": int(count)}
    seeds = max((row[name]["count"] for row in found.values() for name in MEASURES), default=0)
    return {"seeds": seeds, "rows": list(found.values()), "measures": MEASURES, "pushes": pushes()}
