"""Which scenarios of the catalogue a robot takes, and which it walks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, NamedTuple

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.simulation import Simulation
from surefoot.scenarios.sweep.engine import side_by_side

Outcome = Literal["accepted", "walks", "fails", "refused"]


@dataclass(frozen=True, slots=True)
class Row:
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
    outcome: Outcome
    why: tuple[str, ...] = ()
    log: Path | None = None
    duration: float = 0.0


class Watcher:
    """Is told how far the catalogue is; this one does nothing with it."""

    def begun(self, runs: int, duration: float) -> None:
        """So many runs of so much simulated time in all [s] are to come."""

    def done(self, row: Row) -> None:
        """A row is known for good."""


class _Looked(NamedTuple):
    """A row before any run, and the scenario that a run takes; None where it is refused."""

    row: Row
    scenario: Scenario | None


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """Those of the catalogue that are named, in its order; all where none is.

    Raises:
        ScenarioError: the catalogue has no such scenario.
    """
    for name in names:
        if name not in catalogue.OWN:
            raise catalogue.unknown(name, "no such catalogue name")
    return tuple(name for name in catalogue.OWN if not names or name in names)


def rows(
    robot: str, names: Sequence[str], walk: bool, jobs: int, out: Path, watcher: Watcher | None = None
) -> tuple[Row, ...]:
    """Scenarios of the catalogue on a robot.

    Each is looked at once. The longest runs come first, so that no process waits for the others at the end.

    Args:
        robot: name or path of its file.
        names: of the scenarios.
        walk: whether to run what it accepts.
        jobs: runs at once.
        out: directory of the logs.
        watcher: is told how far it is.

    Returns:
        a row for each scenario, in the given order.
    """
    watcher = watcher or Watcher()
    found: dict[str, Row] = {}
    for row in _walked(robot, names, jobs, out, watcher) if walk else (_look(name, robot).row for name in names):
        found[row.scenario] = row
        watcher.done(row)
    return tuple(found[name] for name in names)


def _walked(robot: str, names: Sequence[str], jobs: int, out: Path, watcher: Watcher) -> Iterator[Row]:
    """Rows as they come: what is refused, then the runs."""
    looked = list(side_by_side(_look, [(name, robot) for name in names], jobs, _unseen))
    runs = sorted((one for one in looked if one.scenario is not None), key=lambda one: -one.row.duration)
    watcher.begun(len(runs), sum(one.row.duration for one in runs))
    yield from (one.row for one in looked if one.scenario is None)
    if runs:
        yield from side_by_side(_run, [(*one, out) for one in runs], jobs, _lost)


def _look(name: str, robot: str) -> _Looked:
    try:
        scenario = load(name, {"robot": robot})
        with Simulation(scenario) as simulation:
            return _Looked(Row(name, "accepted", duration=simulation.walk.duration), scenario)
    except (ScenarioError, SetupError) as refusal:
        return _Looked(Row(name, "refused", tuple(str(refusal).splitlines())), None)


def _run(row: Row, scenario: Scenario, out: Path) -> Row:
    try:
        result = run_scenario(scenario, out)
    except (ScenarioError, SetupError) as refusal:
        return replace(row, outcome="refused", why=tuple(str(refusal).splitlines()))
    except LogError as error:
        return replace(row, outcome="fails", why=(str(error),))
    outcome: Outcome = "walks" if result.verdict.passed else "fails"
    return replace(row, outcome=outcome, why=tuple(result.verdict.reasons), log=result.log)


def _unseen(name: str, robot: str, why: str) -> _Looked:
    return _Looked(Row(name, "fails", (why,)), None)


def _lost(row: Row, scenario: Scenario, out: Path, why: str) -> Row:
    return replace(row, outcome="fails", why=(why,))
