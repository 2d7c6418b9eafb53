"""The lines of a history: the findings of checks, scenario by scenario and commit by commit."""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, StringConstraints, TypeAdapter, ValidationError

from surefoot.scenarios.check.beside import Beside
from surefoot.scenarios.check.check import Checked
from surefoot.scenarios.check.record import scenario_json
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.file.source import decoded
from surefoot.scenarios.file.values import NAME
from surefoot.scenarios.output import reason
from surefoot.scenarios.record.provenance import git, versions

CHECKS, ENDING = "checks", ".jsonl"
"""Folder of the lines in that of a history, a file for each check; ending of the files."""

FORMAT = 1
"""Version of a line; it grows when a field goes or changes its meaning."""

MOST_BYTES = 50_000_000
"""Greatest file of lines."""

Name = Annotated[str, StringConstraints(pattern=NAME, max_length=100)]
Digest = Annotated[str, StringConstraints(pattern=r"^([0-9a-f]{16})?$")]
Text = Annotated[str, StringConstraints(max_length=10_000)]


@dataclass(frozen=True, slots=True)
class Commit:
    """A commit of the repository in which a check was given.

    Attributes:
        name: its hash, with ``-dirty`` where files were changed; empty outside of a repository.
        time: at which it was made, ISO 8601 in UTC; empty outside of one.
        subject: first line of its message.
    """

    name: Text = ""
    time: Text = ""
    subject: Text = ""

    @property
    def short(self) -> str:
        """Beginning of its name."""
        return re.sub(r"^([0-9a-f]{8})[0-9a-f]+", r"\1", self.name)

    @classmethod
    def here(cls, folder: Path) -> "Commit":
        """The commit that is checked out in a folder."""
        answer = git(folder, "log", "-1", "--format=%H%n%ct%n%s")
        if not answer:
            return cls()
        name, seconds, subject, *_ = (*answer.split("\n"), "", "")
        changed = git(folder, "status", "--porcelain", "--untracked-files=no")
        return cls(f"{name}-dirty" if changed else name, iso(datetime.fromtimestamp(int(seconds), UTC)), subject)


@dataclass(frozen=True, slots=True)
class Seeds:
    """Runs of several seeds.

    Attributes:
        passed: whether each met its criteria.
        values: by metric, element or part, one for each run; None where it means nothing there.
    """

    passed: tuple[bool, ...]
    values: Mapping[str, tuple[bool | int | float | None, ...]]


@dataclass(frozen=True, slots=True)
class Line:
    """The findings of a check about a scenario.

    Attributes:
        time: at which the check began, ISO 8601 in UTC.
        commit: that was checked.
        versions: of all that the result depends on.
        scenario: its name.
        status: of the check.
        passed: whether that is a pass.
        reasons: why it is not.
        metrics: of the run, by name, also those on the wall's clock.
        criteria: bounds of the scenario, by metric.
        took: time on the wall's clock [s].
        run: digest of all that is compared of it; empty where there was no run.
        copy: digest of the same without other seeds, by which the copy of its log is called.
        seeds: of several: what each measured, and the pass rate; None of one.
        margins: searches of the scenario by name.
        settings: of the scenario that are no defaults, in YAML.
        beside: the run before, where this one has parted from it.
    """

    time: Text
    commit: Commit
    versions: Mapping[str, str]
    scenario: Name
    status: Text
    passed: bool
    reasons: tuple[Text, ...] = ()
    metrics: Mapping[str, Any] = field(default_factory=dict)
    criteria: Mapping[str, Bound] = field(default_factory=dict)
    took: Annotated[float, Field(ge=0.0)] = 0.0
    run: Digest = ""
    copy: Digest = ""
    settings: str = ""
    margins: Mapping[str, Bisect] = field(default_factory=dict)
    beside: Beside | None = None
    seeds: Seeds | None = None

    @property
    def machine(self) -> str:
        """Kind of the machine."""
        return self.versions.get("machine", "")

    @property
    def order(self) -> tuple[str, str]:
        """Time of the commit, then of the check; outside of a repository that of the check alone."""
        return self.commit.time or self.time, self.time

    @classmethod
    def of(cls, checked: Checked, time: str, commit: Commit, run: str, copy: str) -> "Line":
        """The line of a scenario that was checked."""
        case = checked.case
        came = (checked.status, checked.passed, checked.reasons, checked.metrics, case.scenario.criteria, checked.took)
        margins = dict(case.scenario.margins or {})
        return cls(time, commit, dict(versions()), case.scenario.name, *came, run, copy, case.settings, margins)

    def text(self, checked: Checked) -> str:
        """The line as it is written: all that `surefoot check --json` says of it, and what a history adds."""
        own = {"format": FORMAT, "time": self.time, "commit": asdict(self.commit), "versions": dict(self.versions)}
        criteria = {name: bound.model_dump(exclude_none=True) for name, bound in self.criteria.items()}
        margins = {name: bisect.model_dump(mode="json", exclude_none=True) for name, bisect in self.margins.items()}
        line = {**own, "run": self.run, "copy": self.copy, "criteria": criteria, "margins": margins}
        line |= scenario_json(checked)
        return json.dumps(line, allow_nan=False)


@cache
def _adapter() -> TypeAdapter[Line]:
    return TypeAdapter(Line)


def read_lines(folder: Path) -> tuple[list[Line], list[str]]:
    """All lines of a history in their order, and a sentence for each that cannot be read.

    Raises:
        ScenarioError: there is no such folder.
    """
    place = folder / CHECKS
    if not place.is_dir():
        right = "give a folder that `surefoot check --history` has written to"
        raise ScenarioError([f"{folder}: holds no history; {right}"])
    found: list[Line] = []
    notes: list[str] = []
    for file in sorted(path for path in place.iterdir() if path.name.endswith(ENDING)):
        for number, text in _texts(file, notes):
            try:
                found.append(_line(text))
            except (ValueError, RecursionError) as fault:
                notes.append(f"{file}:{number}: is no line of a history, {_why(fault)}")
    return sorted(found, key=lambda line: line.order), notes


def _texts(file: Path, notes: list[str]) -> Iterator[tuple[int, str]]:
    """Lines of a file that are not empty, with their numbers; a file that cannot be read is noted."""
    try:
        if not file.is_file():
            raise ValueError("it is no regular file")
        with file.open("rb") as opened:
            text = decoded(opened, str(file), MOST_BYTES)
    except OSError as error:
        notes.append(f"{file}: cannot be read, {reason(error)}")
    except (ScenarioError, ValueError) as fault:
        notes.append(f"{file}: {str(fault).removeprefix(f'{file}: ').partition(';')[0]}")
    else:
        yield from ((number, line) for number, line in enumerate(text.split("\n"), 1) if line.strip())


def _line(text: str) -> Line:
    """Read one line back; ValueError where it is none."""
    values = json.loads(text, parse_constant=_no_constant)
    if not isinstance(values, dict):
        raise ValueError("it is no object")
    if values.get("format") != FORMAT:
        raise ValueError(f"its format is {values.get('format')}, {FORMAT} is known")
    return _adapter().validate_python(values)


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _why(fault: Exception) -> str:
    if isinstance(fault, ValidationError):
        first = fault.errors()[0]
        return f"{'.'.join(map(str, first['loc']))}: {first['msg'].lower()}"
    return "it is no JSON" if isinstance(fault, json.JSONDecodeError | RecursionError) else str(fault)


def iso(time: datetime) -> str:
    """A time as lines have it, whose order is that of their letters."""
    return time.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def new_file(folder: Path, time: str, commit: Commit) -> Path:
    """A new file of lines in a history, which belongs to one check alone.

    Raises:
        LogError: it cannot be written.
    """
    place = folder / CHECKS
    begin = "-".join(filter(None, (re.sub(r"[^0-9TZ]", "", time), commit.short[:8])))
    try:
        place.mkdir(parents=True, exist_ok=True)
        for name in _names(begin):
            try:
                (place / name).open("xb").close()
            except FileExistsError:
                continue
            return place / name
    except OSError as error:
        raise LogError(f"{place}: cannot be written, {reason(error)}; give another --history") from None
    raise AssertionError


def _names(begin: str) -> Iterable[str]:
    yield f"{begin}{ENDING}"
    yield from (f"{begin}-{number}{ENDING}" for number in range(2, 1 << 30))


def append(file: Path, text: str) -> None:
    """Add a line to a file, on the disk when this returns.

    Raises:
        LogError: it cannot be written.
    """
    try:
        with file.open("a", encoding="utf-8") as opened:
            opened.write(f"{text}\n")
            opened.flush()
            os.fsync(opened.fileno())
    except OSError as error:
        raise LogError(f"{file}: cannot be written, {reason(error)}; give another --history") from None
