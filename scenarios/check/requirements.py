"""Requirements that scenarios name, and what a check says of each: a table of requirement against state.

A requirement passes where every scenario that names it was run and passed. One that a scenario names which was not run
is not run, whatever the others did.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from surefoot.scenarios import catalogue
from surefoot.scenarios.check.check import Checked, CheckStatus, scenario_files
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.setup.load import load

RequirementState = Literal["fail", "not measured", "not run", "pass"]
"""States, the worst first: that of a requirement is the worst of its scenarios'."""

_WORST = get_args(RequirementState)

PROPERTY = "requirement"
"""Name of the property of a test case in JUnit XML that holds one."""

_MISSED: tuple[CheckStatus, ...] = ("failed", "moved", "worse")
_OPEN: CheckStatus = "not decided"


@dataclass(frozen=True, slots=True)
class Shown:
    """A scenario that names requirements, and its state.

    Attributes:
        scenario: its name.
        requirements: that it names.
        state: of its run, or that there was none.
        why: that state in the words of the check.
    """

    scenario: str
    requirements: tuple[str, ...]
    state: RequirementState
    why: str

    @classmethod
    def of(cls, scenario: str, requirements: Sequence[str], status: str, passed: bool) -> "Shown":
        """The state by the status of a check."""
        state: RequirementState = "fail" if status in _MISSED else "not measured"
        if passed and status != _OPEN:
            state = "pass"
        return cls(scenario, tuple(requirements), state, status)


@dataclass(frozen=True, slots=True)
class Requirement:
    """A requirement, and the scenarios that show whether it is kept.

    Attributes:
        name: of it.
        scenarios: that name it, the worst state first.
    """

    name: str
    scenarios: tuple[Shown, ...]

    @property
    def state(self) -> RequirementState:
        """The worst state of its scenarios."""
        return self.scenarios[0].state

    @property
    def by(self) -> str:
        """Its scenarios, each with what is said of it."""
        return ", ".join(f"{one.scenario} ({one.why})" for one in self.scenarios)


@dataclass(frozen=True, slots=True)
class Requirements:
    """All requirements of a check.

    Attributes:
        table: of them, by name.
        notes: files beside the scenarios that cannot be read, so that nobody knows what they name.
    """

    table: tuple[Requirement, ...]
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, checked: Iterable[Checked]) -> "Requirements":
        """The requirements of scenarios that were checked, and of those in the files beside them."""
        found = list(checked)
        shown = [
            Shown.of(one.case.scenario.name, one.case.scenario.requirements or (), one.status, one.passed)
            for one in found
        ]
        return cls.held(shown, {Path(one.case.reference) for one in found if one.case.reference not in catalogue.OURS})

    @classmethod
    def held(cls, shown: Sequence[Shown], files: Iterable[Path], more: Iterable[Path] = ()) -> "Requirements":
        """The requirements of scenarios that were run.

        Args:
            shown: what their runs have shown.
            files: of them; those beside them which name requirements were not run.
            more: files that were to be run.
        """
        ran = {file.resolve() for file in files}
        beside = (Path(file) for folder in sorted({file.parent for file in ran}) for file in scenario_files(folder))
        others = sorted({file.resolve() for file in (*beside, *more)} - ran)
        missed, notes = _not_run(file for file in others if _may_name(file))
        return cls(table([*shown, *missed]), notes)

    @property
    def lines(self) -> list[str]:
        """The table for a terminal: a line for each."""
        width = max((len(one.name) for one in self.table), default=0)
        rows = [f"{one.name:<{width}}  {one.state}: {one.by}" for one in self.table]
        return [*rows, *(f"note: {note}" for note in self.notes)]

    def to_json(self) -> list[dict[str, Any]]:
        """The same as JSON."""
        return [
            {
                "requirement": one.name,
                "state": one.state,
                "by": [{"scenario": by.scenario, "state": by.state, "status": by.why} for by in one.scenarios],
            }
            for one in self.table
        ]

    @property
    def markdown(self) -> list[str]:
        """The same for the page of a CI run; no line where nothing names a requirement."""
        if not self.table:
            return []
        rows = [f"| {one.name} | {_MARKS[one.state]} {one.state} | {one.by} |" for one in self.table]
        head = ["#### Requirements", "", "| requirement | state | by |", "|---|---|---|"]
        return [*head, *rows, "", *(f"{note}\n" for note in self.notes)]


_MARKS: Mapping[RequirementState, str] = {"fail": "❌", "not measured": "❔", "not run": "⬜", "pass": "✅"}


def table(shown: Sequence[Shown]) -> tuple[Requirement, ...]:
    """Requirements by name, each with the scenarios that name it."""
    names = sorted({name for one in shown for name in one.requirements})
    return tuple(Requirement(name, tuple(_naming(name, shown))) for name in names)


def _naming(name: str, shown: Sequence[Shown]) -> list[Shown]:
    named = [one for one in shown if name in one.requirements]
    return sorted(named, key=lambda one: (_WORST.index(one.state), one.scenario))


def _not_run(files: Iterable[Path]) -> tuple[list[Shown], tuple[str, ...]]:
    """Scenarios that were not run, and what of them cannot be read."""
    found, notes = [], []
    for file in files:
        try:
            scenario = load(str(file))
        except ScenarioError as refusal:
            notes.append(f"{str(refusal).partition(';')[0]}, so nobody knows its requirements")
        else:
            found.append(Shown(scenario.name, scenario.requirements or (), "not run", "not run"))
    return found, tuple(notes)


def _may_name(file: Path) -> bool:
    """Return true if a file has the word; to load every scenario of a folder takes long."""
    try:
        return b"requirements" in file.read_bytes()
    except OSError:
        return False
