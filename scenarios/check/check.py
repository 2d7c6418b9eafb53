"""``surefoot check``: runs scenarios side by side and holds each against its baseline."""

import os
import re
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

import yaml

from surefoot.errors import PluginError
from surefoot.scenarios import catalogue
from surefoot.scenarios.check.baseline import ENDING, Baseline, Move, read_baseline, write_baseline
from surefoot.scenarios.check.blunt import blunt
from surefoot.scenarios.check.sampled import Sampled
from surefoot.scenarios.check.signs import Parting
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.verdict import Verdict
from surefoot.scenarios.log import read
from surefoot.scenarios.run.processes import side_by_side
from surefoot.scenarios.run.run import Result, run_scenario
from surefoot.scenarios.setup.load import load

if TYPE_CHECKING:
    from surefoot.scenarios.check.beside import Beside

OWN = Path(catalogue.__file__).resolve().parents[1] / "baselines"
"""Baselines of the catalogue."""

_MEANT = re.compile(r"\.ya?ml|baseline", re.IGNORECASE)
"""In the name of a file that may be a baseline, also of one with a mistyped ending."""

CheckStatus = Literal[
    "same",
    "better",
    "written",
    "not decided",
    "worse",
    "moved",
    "failed",
    "without baseline",
    "unreadable baseline",
    "incomplete baseline",
    "other scenario",
    "could not run",
    "could not write",
]

PASSING: tuple[CheckStatus, ...] = ("same", "better", "written", "not decided")
"""Statuses in which nothing was found to be worse."""

UNMOVED = "its run is as that of the baseline all the same"
"""Finding of a run of other settings that moves nothing."""

INCONCLUSIVE: tuple[CheckStatus, ...] = ("could not run", "could not write", "unreadable baseline")
"""Statuses in which the run says nothing for or against the walk."""


UNSHAPING = ("name", "criteria", "seeds", "margins", "requirements")
"""Keys of a scenario that do not shape its run."""


@dataclass(frozen=True, slots=True)
class Case:
    """A scenario, fit to run, that a user referred to.

    Attributes:
        reference: catalogue name or path by which it was found.
        scenario: as it is run.
        baseline: where its baseline is, or would be.
        overrides: ``key=value``, set over what its file says.
    """

    reference: str
    scenario: Scenario
    baseline: Path
    overrides: tuple[str, ...] = ()

    @property
    def settings(self) -> str:
        """Settings that shape the run and are not defaults, for which a baseline is good."""
        chosen = self.scenario.model_dump(mode="json", exclude_defaults=True, exclude=set(UNSHAPING))
        return yaml.safe_dump(chosen, sort_keys=False)


@dataclass(frozen=True, slots=True)
class Checked:
    """The result of a case.

    Attributes:
        case: that was run.
        status: how the run compares with its baseline.
        reasons: why it failed or could not run, one sentence each.
        moves: metrics that are not where the baseline has them.
        partings: where the run first is not as its baseline, and where it is farthest from it, if that is elsewhere.
        log: of the run, None when there is none.
        now: what the run would be as a baseline, None when there was no run.
        verdict: on the run, None when there was none.
        sampled: what runs of several seeds say, None when there was one.
        took: time on the wall's clock of the run and of its comparison [s].
        beside: the run before, of a history in which this one parts from it.
    """

    case: Case
    status: CheckStatus
    reasons: tuple[str, ...] = ()
    moves: tuple[Move, ...] = ()
    partings: tuple[Parting, ...] = ()
    log: Path | None = None
    now: Baseline | None = None
    verdict: Verdict | None = None
    sampled: Sampled | None = None
    took: float = 0.0
    beside: "Beside | None" = None

    @property
    def metrics(self) -> Mapping[str, Any]:
        """All that the run measured, by name."""
        return {} if self.verdict is None else self.verdict.metrics

    @property
    def passed(self) -> bool:
        """True if the run met its criteria and is no worse than its baseline, or is its baseline now."""
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
    named = [name for reference in references for name in _unfolded(reference)] or list(catalogue.OURS)
    found: dict[str, Case] = {}
    for reference in named:
        scenario = load(reference, overrides)
        own = OWN if reference in catalogue.OURS else Path(reference).parent / "baselines"
        case = Case(reference, scenario, (folder or own) / f"{scenario.name}{ENDING}", tuple(overrides))
        if scenario.name in found:
            first = found[scenario.name].reference
            raise ScenarioError([f"{reference}: is named '{scenario.name}' as {first} is; give each a name of its own"])
        found[scenario.name] = case
    return tuple(found.values())


def _unfolded(reference: str) -> list[str]:
    """The scenario files of a folder, or the reference itself; ScenarioError for a folder without any."""
    folder = Path(reference)
    if reference in catalogue.OURS or not folder.is_dir():
        return [reference]
    files = scenario_files(folder)
    if not files:
        raise ScenarioError([f"{reference}: holds no scenario; give a folder with *.yaml files"])
    return files


def scenario_files(folder: Path) -> list[str]:
    """The scenario files of a folder in order."""
    return sorted(str(path) for path in folder.iterdir() if _is_scenario(path))


def strays(case: Case) -> tuple[Path, ...]:
    """Files where the baseline of a case would be that belong to no scenario file beside them.

    What is called like one counts, also with another ending or in a folder, and what lies in place of the folder.
    """
    folder = case.baseline.parent
    if not folder.is_dir():
        return (folder,) if os.path.lexists(folder) else ()
    beside = (path for path in Path(case.reference).parent.iterdir() if path.suffix.lower() in (".yaml", ".yml"))
    own = {f"{_name(path)}{ENDING}" for path in beside}
    found = sorted(path for path in folder.rglob("*") if _MEANT.search(path.name))
    return tuple(path for path in found if path.parent != folder or path.name not in own)


def _is_scenario(path: Path) -> bool:
    """Return true if a path in a folder is named as a scenario, in great or small letters."""
    name = path.name.lower()
    return name.endswith(".yaml") and not name.endswith(ENDING)


def _name(file: Path) -> str:
    """Name of a scenario, or of its file where it cannot be read."""
    try:
        return load(str(file)).name
    except ScenarioError:
        return file.stem


def run_case(case: Case, out: Path, run: Callable[[Scenario, Path], Result] | None = None) -> Checked:
    """Run a case, by another function of its scenario and a folder if given, and compare it with its baseline."""
    begin = time.perf_counter()
    try:
        result = (run or run_scenario)(case.scenario, out)
        metrics, criteria = result.verdict.metrics, case.scenario.criteria
        now = Baseline.of(case.scenario.name, case.settings, metrics, read(result.log), criteria)
    except (ScenarioError, SetupError, PluginError, LogError) as refusal:
        return Checked(case, "could not run", (" ".join(str(refusal).split()),), took=time.perf_counter() - begin)
    found = _held_against_baseline(case, result.verdict, now)
    return replace(found, log=result.log, verdict=result.verdict, took=time.perf_counter() - begin)


def _held_against_baseline(case: Case, verdict: Verdict, now: Baseline) -> Checked:
    """The result of a run by its verdict and by its baseline, in this order."""
    try:
        before = read_baseline(case.baseline) if os.path.lexists(case.baseline) else None
    except ScenarioError as refusal:
        found = Checked(case, "unreadable baseline", (" ".join(str(refusal).split()),))
    else:
        found = compared(case, before, now) if before is not None else Checked(case, "without baseline")
    failures = (*verdict.reasons, *blunt(verdict))
    return replace(found, status="failed" if failures else found.status, reasons=(*failures, *found.reasons), now=now)


def compared(case: Case, before: Baseline, now: Baseline) -> Checked:
    """The result of a run by its baseline alone; one of other settings is held against it all the same."""
    others = before.others(case.scenario.name, case.settings)
    gaps, world = before.gaps(now, case.scenario.criteria), before.other_world(now)
    moves = tuple(before.moves(now.metrics, case.scenario.criteria))
    partings = _first_and_most(before.trace.partings(now.trace))
    status: CheckStatus = "better" if moves else "same"
    if world or partings or not all(move.welcome for move in moves):
        status = "moved"
    elif gaps:
        status = "incomplete baseline"
    if others:
        others += [UNMOVED] if status == "same" else []
        status = "other scenario"
    return Checked(case, status, (*others, *gaps, *world), moves, partings)


def _first_and_most(partings: Sequence[Parting]) -> tuple[Parting, ...]:
    """The first of some partings in order, and the one that is farthest off if that is another."""
    if not partings:
        return ()
    most = max(partings, key=lambda one: one.excess)
    return (partings[0],) if most is partings[0] else (partings[0], most)


class Keeping(Protocol):
    """Keeps what a check finds, as a history does."""

    def hold(self, checked: Checked) -> None:
        """Copy the log of a run, which may be removed afterwards."""

    def keep(self, checked: Checked) -> Checked:
        """Keep the result of a scenario; gives it with what is known of the runs before."""


def check(
    chosen: Sequence[Case],
    out: Path,
    jobs: int,
    on_done: Callable[[Checked], None] = lambda _: None,
    update: bool = False,
    keeping: Keeping | None = None,
) -> tuple[Checked, ...]:
    """Run cases side by side; the logs of those that are the same as their baselines are not kept.

    Args:
        chosen: to run.
        out: directory of their logs.
        jobs: runs at once.
        on_done: called with each as it is done, and again with what `update` made of it.
        keeping: takes what it needs of each log, and keeps each that is done.
        update: whether to write the baselines anew of the runs that met their criteria and are not the same.

    Returns:
        what became of each, in their order.
    """
    done: dict[str, Checked] = {}
    for checked in side_by_side(run_case, [(case, out) for case in chosen], jobs, _lost):
        if keeping is not None:
            keeping.hold(checked)
            checked = keeping.keep(checked)
        if checked.status == "same" and checked.log is not None:
            shutil.rmtree(checked.log.parent)
            checked = replace(checked, log=None)
        on_done(checked)
        if update and (written := updated(checked)) is not checked:
            checked = written
            on_done(checked)
        done[checked.case.scenario.name] = checked
    return tuple(done[case.scenario.name] for case in chosen)


def _lost(case: Case, out: Path, why: str) -> Checked:
    return Checked(case, "could not run", (why,))


def updated(checked: Checked) -> Checked:
    """Write the baseline of a run that met its criteria, if it is not the same; what became of it then."""
    unfit = checked.now is None or checked.status in ("same", "failed", "could not run")
    return checked if unfit else rewritten(checked)


def rewritten(checked: Checked) -> Checked:
    """Write the baseline of a run anew; what became of it then.

    One from which the run has not moved gains what it lacks, and keeps its numbers: they tell what has crept since.
    """
    assert checked.now is not None
    path, now = checked.case.baseline, checked.now
    try:
        fills = checked.status == "incomplete baseline" and not checked.moves
        write_baseline(path, read_baseline(path).filled(now) if fills else now)
    except (LogError, ScenarioError) as error:
        return replace(checked, status="could not write", reasons=(*checked.reasons, str(error)))
    return replace(checked, status="written", reasons=(f"was: {checked.status}", *checked.reasons))


def exit_code(checked: Sequence[Checked]) -> int:
    """0 when all is as it should be, 2 where something could not be run, read or written, 1 otherwise."""
    statuses = {one.status for one in checked if not one.passed}
    return 2 if statuses & set(INCONCLUSIVE) else int(bool(statuses))
