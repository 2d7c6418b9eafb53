"""``surefoot check``: runs scenarios side by side and holds each against its baseline."""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import yaml

from surefoot.errors import PluginError
from surefoot.scenarios import catalogue
from surefoot.scenarios.check.baseline import ENDING, Baseline, Move, read_baseline, write_baseline
from surefoot.scenarios.check.trace import Parting
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.verdict import Verdict
from surefoot.scenarios.log import read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.sweep.engine import side_by_side

OWN = Path(catalogue.__file__).resolve().parents[1] / "baselines"
"""Baselines of the catalogue."""

Status = Literal[
    "same", "better", "moved", "failed", "without baseline", "unreadable baseline", "other scenario", "could not run"
]

PASSING: tuple[Status, ...] = ("same", "better")


@dataclass(frozen=True, slots=True)
class Case:
    """A scenario and its baseline.

    Attributes:
        reference: as the user gave it: a catalogue name or a file.
        scenario: fit to run.
        baseline: where its baseline is, or would be.
    """

    reference: str
    scenario: Scenario
    baseline: Path

    @property
    def settings(self) -> str:
        """What shapes the run and is not a default, which a baseline is good for."""
        chosen = self.scenario.model_dump(mode="json", exclude_defaults=True, exclude={"name", "criteria"})
        return yaml.safe_dump(chosen, sort_keys=False)


@dataclass(frozen=True, slots=True)
class Checked:
    """What became of a case.

    Attributes:
        case: that was run.
        status: how the run compares with its baseline.
        reasons: why it failed or could not run, one sentence each.
        moves: metrics that are not where the baseline has them.
        partings: where the run first is not as its baseline, and where it is farthest from it, if that is elsewhere.
        log: of the run, None when there is none.
        now: what the run would be as a baseline, None when there was no run.
    """

    case: Case
    status: Status
    reasons: tuple[str, ...] = ()
    moves: tuple[Move, ...] = ()
    partings: tuple[Parting, ...] = ()
    log: Path | None = None
    now: Baseline | None = None

    @property
    def passed(self) -> bool:
        """Whether the run met its criteria and is no worse than its baseline."""
        return self.status in PASSING


def cases(references: Sequence[str], folder: Path | None = None, overrides: Sequence[str] = ()) -> tuple[Case, ...]:
    """The scenarios to check; all of the catalogue if none are named.

    Args:
        references: catalogue names, scenario files, or folders of scenario files.
        folder: of the baselines; by default ours for the catalogue, ``baselines`` beside a file.
        overrides: ``key=value``, for all of them.

    Raises:
        ScenarioError: one of them cannot be found, read or run, or two have the same name.
    """
    named = [name for reference in references for name in _unfolded(reference)] or list(catalogue.OWN)
    found: dict[str, Case] = {}
    for reference in named:
        scenario = load(reference, overrides)
        own = OWN if reference in catalogue.OWN else Path(reference).parent / "baselines"
        case = Case(reference, scenario, (folder or own) / f"{scenario.name}{ENDING}")
        if scenario.name in found:
            first = found[scenario.name].reference
            raise ScenarioError([f"{reference}: is named '{scenario.name}' as {first} is; give each a name of its own"])
        found[scenario.name] = case
    return tuple(found.values())


def _unfolded(reference: str) -> list[str]:
    """The scenario files of a folder, or the reference itself.

    Raises:
        ScenarioError: the folder holds none.
    """
    folder = Path(reference)
    if reference in catalogue.OWN or not folder.is_dir():
        return [reference]
    files = sorted(str(path) for path in folder.glob("*.yaml") if not path.name.endswith(ENDING))
    if not files:
        raise ScenarioError([f"{reference}: holds no scenario; give a folder with *.yaml files"])
    return files


def run_case(case: Case, out: Path) -> Checked:
    """Run a case and compare it with its baseline."""
    try:
        result = run_scenario(case.scenario, out)
        log = read(result.log)
        now = Baseline.of(case.scenario.name, case.settings, result.verdict.metrics, log)
    except (ScenarioError, SetupError, PluginError, LogError) as refusal:
        return Checked(case, "could not run", (" ".join(str(refusal).split()),))
    return _held_against_baseline(case, result.verdict, replace(Checked(case, "same"), log=result.log, now=now))


def _held_against_baseline(case: Case, verdict: Verdict, run: Checked) -> Checked:
    """What a run is by its verdict and by its baseline, in this order."""
    run = replace(run, reasons=verdict.reasons)
    status: Status
    try:
        before = read_baseline(case.baseline) if case.baseline.exists() else None
    except ScenarioError as refusal:
        status = "unreadable baseline" if verdict.passed else "failed"
        return replace(run, status=status, reasons=(*run.reasons, " ".join(str(refusal).split())))
    if before is None:
        return replace(run, status="without baseline" if verdict.passed else "failed")
    if others := before.other_settings(case.settings):
        status = "other scenario" if verdict.passed else "failed"
        return replace(run, status=status, reasons=(*run.reasons, *others))
    moves = tuple(before.moves(verdict.metrics, case.scenario.criteria))
    partings = _first_and_most(before.trace.partings(run.now.trace) if run.now is not None else [])
    run = replace(run, moves=moves, partings=partings)
    if not verdict.passed:
        return replace(run, status="failed")
    if partings or any(move.direction != "better" for move in moves):
        return replace(run, status="moved")
    return replace(run, status="better" if moves else "same")


def _first_and_most(partings: Sequence[Parting]) -> tuple[Parting, ...]:
    """Of partings in order, the first, and the one that is farthest off if that is another."""
    if not partings:
        return ()
    most = max(partings, key=lambda one: one.excess)
    return (partings[0],) if most is partings[0] else (partings[0], most)


def check(
    chosen: Sequence[Case], out: Path, jobs: int, on_done: Callable[[Checked], None] = lambda _: None
) -> tuple[Checked, ...]:
    """Run cases side by side; the logs of those that are the same as their baselines are not kept.

    Args:
        chosen: to run.
        out: directory of their logs.
        jobs: runs at once.
        on_done: is told each as it is done.

    Returns:
        what became of each, in their order.
    """
    done: dict[str, Checked] = {}
    for checked in side_by_side(run_case, [(case, out) for case in chosen], jobs, _lost):
        if checked.status == "same" and checked.log is not None:
            shutil.rmtree(checked.log.parent)
            checked = replace(checked, log=None)
        done[checked.case.scenario.name] = checked
        on_done(checked)
    return tuple(done[case.scenario.name] for case in chosen)


def _lost(case: Case, out: Path, why: str) -> Checked:
    return Checked(case, "could not run", (why,))


def update(checked: Sequence[Checked]) -> tuple[Path, ...]:
    """Write the baselines of the runs that met their criteria; returns the files that changed.

    Raises:
        LogError: one cannot be written.
    """
    written = []
    for one in checked:
        if one.now is None or one.status in ("failed", "could not run") or one.status == "same":
            continue
        write_baseline(one.case.baseline, one.now)
        written.append(one.case.baseline)
    return tuple(written)


def exit_code(checked: Sequence[Checked], updated: bool) -> int:
    """0 when all is as it should be, 2 where something could not be run or read, 1 otherwise.

    Args:
        checked: what became of the cases.
        updated: whether baselines were written, after which only runs without one are not as they should be.
    """
    statuses = {one.status for one in checked if not one.passed}
    if updated:
        statuses &= {"failed", "could not run"}
    return 2 if statuses & {"could not run", "unreadable baseline"} else int(bool(statuses))
