"""The history of checks: a folder of lines, with what their runs measured, few logs, and pictures of what changed.

checks/TIME-COMMIT.jsonl          a file for each check, a line for each scenario
runs/SCENARIO-DIGEST.yaml         what a run measured, as a baseline has it; checks of like runs share one
logs/SCENARIO-DIGEST.mcap         copies with few messages: of the last run, and of the last one that passed
pictures/SCENARIO-DIGEST-DIGEST-  of runs that parted from those before
"""

import hashlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from surefoot.scenarios.check.baseline import Baseline, read_baseline
from surefoot.scenarios.check.beside import Beside, beside
from surefoot.scenarios.check.changes import Change, changes
from surefoot.scenarios.check.check import Checked
from surefoot.scenarios.check.lines import Commit, Line, append, iso, new_file, read_lines
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.log import read
from surefoot.scenarios.log.thinned import write_thinned
from surefoot.scenarios.output import reason, write_whole
from surefoot.scenarios.show.differences import WALL_CLOCK

RUNS, LOGS = "runs", "logs"

RATE = 25
"""Messages that a channel of a kept log has at most in a second [Hz]."""

_LEFT_OUT = frozenset((*WALL_CLOCK, "/plan"))
"""Topics that a kept log has not: plans are half of it, and what follows from them is in the others."""


class History:
    """A folder with the history of checks.

    Args:
        folder: of it.

    Attributes:
        folder: of it.
        lines: in order.
        notes: what of it cannot be read, a sentence each.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.lines, self.notes = read_lines(folder)
        self._runs: dict[str, Baseline | None] = {}

    def run_of(self, line: Line) -> Baseline | None:
        """The measured values of the run of a line; None where they are not there."""
        name = f"{line.scenario}-{line.run}.yaml"
        if name not in self._runs:
            self._runs[name] = None
            try:
                self._runs[name] = read_baseline(self.folder / RUNS / name) if line.run else None
            except ScenarioError as fault:
                self.notes.append(str(fault).partition(",")[0])
        return self._runs[name]

    def copy_of(self, scenario: str, copy: str) -> Path:
        """Path of the copy of a log of a scenario by its digest, whether it is there or not."""
        return self.folder / LOGS / f"{scenario}-{copy}.mcap"

    def changes(self, lines: list[Line]) -> Iterator[Change]:
        """The changes in lines of one scenario, in order."""
        return changes(lines, self.run_of)

    def pictures_of(self, beside: Beside | None) -> tuple[Path, ...]:
        """Paths of the two pictures of runs beside each other; () where they are not both there."""
        paths = tuple(self.folder / name for name in (beside.pictures if beside else ()))
        return paths if all(path.is_file() for path in paths) else ()


class Keeper:
    """Keeps the findings of one check in a history.

    Args:
        folder: of the history, which is made where it is not there.
        commit: that is checked; by default that of the working directory.

    Attributes:
        history: that it writes to.
        commit: of the lines.
        time: of the lines, ISO 8601 in UTC.

    Raises:
        LogError: the folder cannot be written.
    """

    def __init__(self, folder: Path, commit: Commit | None = None) -> None:
        self.time = iso(datetime.now(UTC))
        self.commit = Commit.here(Path.cwd()) if commit is None else commit
        self._file = new_file(folder, self.time, self.commit)
        self.history = History(folder)

    def hold(self, checked: Checked) -> None:
        """Keep a copy of the log of a run, if none was the same before.

        Raises:
            LogError: it cannot be written.
        """
        if checked.log is not None and checked.now is not None:
            copy = self.history.copy_of(checked.case.scenario.name, digest(replace(checked.now, sample=None)))
            self._make(copy.parent)
            if not copy.exists():
                write_thinned(read(checked.log), copy, RATE, _LEFT_OUT)

    def keep(self, checked: Checked) -> Checked:
        """Write the line of a scenario; what was checked comes back with the run before beside it, if they parted.

        Raises:
            LogError: it cannot be written.
        """
        run = "" if checked.now is None else digest(checked.now)
        own = "" if checked.now is None else digest(replace(checked.now, sample=None))
        line = Line.of(checked, self.time, self.commit, run, own)
        before = [
            one
            for one in self.history.lines
            if (one.scenario, one.machine) == (line.scenario, line.machine) and one.order <= line.order
        ]
        if checked.now is not None:
            path = self.history.folder / RUNS / f"{line.scenario}-{run}.yaml"
            self._make(path.parent)
            with write_whole(path, replace=True) as temporary:
                temporary.write_text(checked.now.text(), encoding="utf-8")
            checked, line = self._beside(checked, line, before)
            self._forget(line)
        self.history.lines = sorted([*self.history.lines, line], key=lambda one: one.order)
        append(self._file, line.text(checked))
        return checked

    def _make(self, folder: Path) -> None:
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise LogError(f"{folder}: cannot be written, {reason(error)}; give another --history") from None

    def _beside(self, checked: Checked, line: Line, before: list[Line]) -> tuple[Checked, Line]:
        """Hold a run that has changed, or is not as it should be, against the last one that was."""
        found = [*self.history.changes([*before, line])]
        changed = bool(found) and found[-1].now is line
        runs = [one for one in before if one.run and (checked.passed or one.passed)]
        against = runs[-1] if runs else None
        if against is None or against.copy == line.copy or (checked.passed and not changed):
            return checked, line
        was, now = (self.history.run_of(one) for one in (against, line))
        logs = [self.history.copy_of(one.scenario, one.copy) for one in (against, line)]
        if not all(path.exists() for path in logs) or was is None or now is None:
            held = Beside(against.commit.name, note="no pictures: the history has no log of the run before")
        else:
            name = f"{line.scenario}-{against.copy}-{line.copy}"
            partings = was.trace.partings(now.trace)
            both = read(logs[0]), read(logs[1])
            held = beside(*both, partings, self.history.folder, name, against.commit.name)
        return replace(checked, beside=held), replace(line, beside=held)

    def _forget(self, line: Line) -> None:
        """Remove logs of the scenario other than of the last run, and the last one that passed, of each machine."""
        kept = set()
        lines = [one for one in (*self.history.lines, line) if one.scenario == line.scenario and one.run]
        for machine in {one.machine for one in lines}:
            own = sorted((one for one in lines if one.machine == machine), key=lambda one: one.order)
            kept |= {one.copy for one in (*own[-1:], *[one for one in own if one.passed][-1:])}
        for copy in {one.copy for one in lines} - kept:
            with suppress(OSError):
                self.history.copy_of(line.scenario, copy).unlink(missing_ok=True)


def digest(baseline: Baseline) -> str:
    """Digest of what a run measured."""
    return hashlib.sha256(baseline.text().encode()).hexdigest()[:16]
