"""Findings of a check as workflow commands of GitHub, which its pages show beside the lines of a pull request.

The form of a command and of what is escaped in it: docs.github.com, Workflow commands for GitHub Actions, and
`packages/core/src/command.ts` of github.com/actions/toolkit.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

from surefoot.scenarios import catalogue
from surefoot.scenarios.check.check import Case, Checked
from surefoot.scenarios.check.report import lines_of
from surefoot.scenarios.output import shown

_DATA = {"%": "%25", "\r": "%0D", "\n": "%0A"}
_PROPERTY = {**_DATA, ":": "%3A", ",": "%2C"}


def annotations(found: Sequence[Checked]) -> Iterator[str]:
    """A line for each scenario that is not as it should be: an error where the check fails, else a warning."""
    for one in found:
        if not one.passed:
            yield _command("error", one)
        elif one.status != "same" and one.status != "written":
            yield _command("warning", one)


def _command(kind: str, one: Checked) -> str:
    file = _file(one.case)
    place = f"file={_escaped(file, _PROPERTY)}," if file else ""
    title = _escaped(f"{one.case.scenario.name}: {one.status}", _PROPERTY)
    return f"::{kind} {place}title={title}::{_escaped(chr(10).join(lines_of(one)) or one.status, _DATA)}"


def _file(case: Case) -> str:
    """Path of a scenario's file from the working directory, as a repository knows it; empty of a catalogue's."""
    if case.reference in catalogue.OURS:
        return ""
    path, here = Path(case.reference).absolute(), Path.cwd()
    return shown(path.relative_to(here).as_posix() if path.is_relative_to(here) else case.reference)


def _escaped(text: str, signs: dict[str, str]) -> str:
    return "".join(signs.get(sign, sign) for sign in text)
