"""Which scenarios of the catalogue a robot takes, and which it walks."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import starmap
from pathlib import Path
from typing import Literal

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
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
    """

    scenario: str
    outcome: Outcome
    why: tuple[str, ...] = ()
    log: Path | None = None


def rows(
    robot: str, walk: bool, jobs: int, out: Path, on_done: Callable[[Row], None] = lambda _: None
) -> tuple[Row, ...]:
    """The catalogue on a robot.

    Args:
        robot: name or path of its file.
        walk: whether to run what it accepts.
        jobs: runs at once.
        out: directory of the logs.
        on_done: is told each row as it is known.

    Returns:
        a row for each scenario, in the order of the catalogue.
    """
    tasks = [(name, robot, out) for name in catalogue.OWN]
    found: dict[str, Row] = {}
    for row in side_by_side(_walk, tasks, jobs, _lost) if walk else starmap(_look, tasks):
        found[row.scenario] = row
        on_done(row)
    return tuple(found[name] for name in catalogue.OWN)


def _look(name: str, robot: str, out: Path) -> Row:
    try:
        Simulation(load(name, {"robot": robot})).close()
    except (ScenarioError, SetupError) as refusal:
        return Row(name, "refused", tuple(str(refusal).splitlines()))
    return Row(name, "accepted")


def _walk(name: str, robot: str, out: Path) -> Row:
    try:
        result = run_scenario(load(name, {"robot": robot}), out)
    except (ScenarioError, SetupError) as refusal:
        return Row(name, "refused", tuple(str(refusal).splitlines()))
    except LogError as error:
        return Row(name, "fails", (str(error),))
    return Row(name, "walks" if result.verdict.passed else "fails", tuple(result.verdict.reasons), result.log)


def _lost(name: str, robot: str, out: Path, why: str) -> Row:
    return Row(name, "fails", (why,))
