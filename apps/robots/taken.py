"""The scenarios of the catalogue that a robot takes, looked at or run, and how far that is."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import typer

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.run.processes import side_by_side
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.console import TerminalLine

if TYPE_CHECKING:
    from rich.progress import ProgressColumn

CatalogueOutcome = Literal["accepted", "walks", "fails", "refused"]


@dataclass(frozen=True, slots=True)
class CatalogueRow:
    """A scenario and what a robot makes of it.

    Attributes:
        scenario: name in the catalogue.
        outcome: accepted (it may be run, and was not), walks (it ran and met every criterion), fails (it ran and did
            not), or refused before any run.
        why: it fails or is refused, one sentence each.
        log: of the run, None where there was none.
        duration: simulated time of the run, also of one that is still to come; 0 where it is refused [s].
    """

    scenario: str
    outcome: CatalogueOutcome
    why: tuple[str, ...] = ()
    log: Path | None = None
    duration: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        log = None if self.log is None else str(self.log)
        return {"scenario": self.scenario, "outcome": self.outcome, "why": list(self.why), "log": log}


class Looked(NamedTuple):
    """A row before any run, and the scenario that a run takes; None where it is refused."""

    row: CatalogueRow
    scenario: Scenario | None


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """Scenarios of the catalogue that are named, in its order; all where none is.

    Raises:
        ScenarioError: the catalogue has no such scenario.
    """
    for name in names:
        if name not in catalogue.OWN:
            raise catalogue.unknown(name, "no such catalogue name")
    return tuple(name for name in catalogue.OWN if not names or name in names)


def rows(
    robot: str, names: Sequence[str], walk: bool, jobs: int, out: Path, begun: Callable[[int, float], None]
) -> Iterator[CatalogueRow]:
    """Scenarios on a robot as they are known; ``begun`` gets the number of runs to come, and their seconds.

    The longest runs come first, so that no process waits for the others at the end.
    """
    if not walk:
        yield from (_look(name, robot).row for name in names)
        return
    looked = list(side_by_side(_look, [(name, robot) for name in names], jobs, _unseen))
    runs = longest_first(looked)
    begun(len(runs), sum(one.row.duration for one in runs))
    yield from (one.row for one in looked if one.scenario is None)
    if runs:
        yield from side_by_side(_run, [(*one, out) for one in runs], jobs, _lost)


def longest_first(looked: Iterable[Looked]) -> list[Looked]:
    """Scenarios that are not refused, in the order in which they are run."""
    return sorted((one for one in looked if one.scenario is not None), key=lambda one: -one.row.duration)


def _look(name: str, robot: str) -> Looked:
    try:
        scenario = load(name, {"robot": robot})
        with Simulation(scenario) as simulation:
            return Looked(CatalogueRow(name, "accepted", duration=simulation.walk.duration), scenario)
    except (ScenarioError, SetupError) as refusal:
        return Looked(CatalogueRow(name, "refused", tuple(str(refusal).splitlines())), None)


def _run(row: CatalogueRow, scenario: Scenario, out: Path) -> CatalogueRow:
    try:
        result = run_scenario(scenario, out)
    except (ScenarioError, SetupError) as refusal:
        return replace(row, outcome="refused", why=tuple(str(refusal).splitlines()))
    except LogError as error:
        return replace(row, outcome="fails", why=(str(error),))
    outcome: CatalogueOutcome = "walks" if result.verdict.passed else "fails"
    return replace(row, outcome=outcome, why=tuple(result.verdict.reasons), log=result.log)


def _unseen(name: str, robot: str, why: str) -> Looked:
    return Looked(CatalogueRow(name, "fails", (why,)), None)


def _lost(row: CatalogueRow, scenario: Scenario, out: Path, why: str) -> CatalogueRow:
    return replace(row, outcome="fails", why=(why,))


_STYLES: Mapping[CatalogueOutcome, Mapping[str, Any]] = {
    "walks": {"fg": "green", "bold": True},
    "accepted": {},
    "fails": {"fg": "red", "bold": True},
    "refused": {"fg": "yellow"},
}


class CatalogueBar(TerminalLine):
    """Shows on a terminal how much simulated time is left, and how long that takes.

    Args:
        names: of the scenarios.
        printing: whether each row is printed.
    """

    def __init__(self, names: Sequence[str], printing: bool) -> None:
        super().__init__(_columns, None, f"looking at {len(names)} scenarios")
        self._names, self._printing = names, printing
        self._left = 0

    def begun(self, runs: int, duration: float) -> None:
        """See `rows`."""
        self._left = runs
        self.update(total=duration, state=f"{runs} runs, {duration:.0f} s of simulated time")

    def shown(self, rows: Iterable[CatalogueRow]) -> tuple[CatalogueRow, ...]:
        """Show rows as they come; gives them in the order of the names."""
        found = {}
        for row in rows:
            found[row.scenario] = row
            if row.outcome in ("walks", "fails"):
                self._left -= 1
                self.update(advance=row.duration, state=f"{self._left} runs left")
            if self._printing:
                with self.hidden():
                    self._print(row)
        return tuple(found[name] for name in self._names)

    def _print(self, row: CatalogueRow) -> None:
        typer.echo(f"{row.scenario:<{max(map(len, self._names))}}  {typer.style(row.outcome, **_STYLES[row.outcome])}")
        for reason in row.why:
            typer.echo(f"  - {reason}")


def _columns() -> "Iterable[ProgressColumn]":
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    left = (TextColumn("left"), TimeRemainingColumn(elapsed_when_finished=True))
    return TextColumn("{task.fields[state]}"), BarColumn(), TimeElapsedColumn(), *left


def summary(rows: Sequence[CatalogueRow]) -> str:
    """All rows in a sentence."""
    counts = {outcome: sum(row.outcome == outcome for row in rows) for outcome in _STYLES}
    return f"{len(rows)} scenarios: {', '.join(f'{count} {outcome}' for outcome, count in counts.items() if count)}"
