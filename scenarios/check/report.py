"""The findings of a check, for a person, for a CI page and for a CI server."""

import math
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as Xml

import typer

from surefoot.scenarios.check.baseline import Move
from surefoot.scenarios.check.check import Checked, CheckStatus
from surefoot.scenarios.check.pictures import Gallery
from surefoot.scenarios.check.requirements import PROPERTY, Requirements
from surefoot.scenarios.check.signs import FAR, Parting
from surefoot.scenarios.check.wording import seed_lines
from surefoot.scenarios.judge.verdict import shown_unit, value_text
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.show.moment import Moment

_SHOWN_MOVES = 12
"""Moves of a run that are named; the others are counted."""

_REMEDIES: dict[CheckStatus, str] = {
    "other scenario": "{} is of other settings; --update writes it anew",
    "incomplete baseline": "{} does not hold all that is compared; --update writes it anew",
    "without baseline": "no baseline at {}; --update writes it",
    "written": "written: {}",
}
"""Remedies for a baseline, by the status of its run."""

_ERRORS: tuple[CheckStatus, ...] = ("could not run", "could not write")

_LEAST_WINDOW = 0.2
"""Least time that a figure is asked to show [s]."""


def move_text(move: Move) -> str:
    """One move: from where to where, how it is meant, and what would have been allowed."""
    name = move.name.partition("[")[0]
    unit = shown_unit(name)
    before, now = (value_text(name, value) for value in (move.before, move.now))
    allowed = "" if not move.allowed else f", {value_text(name, move.allowed)} {unit} is allowed".replace("  ", " ")
    direction = "" if move.direction == "other" else f", {move.direction}"
    direction += f" by more than {FAR:g} tolerances" if move.far else ""
    return f"{move.name}: {before} -> {now} {unit}".rstrip() + direction + allowed


def lines_of(checked: Checked) -> list[str]:
    """Lines on one run, worst first: why it failed, in what it parts, what moved, where to look."""
    order = {"worse": 0, "other": 1, "better": 2}
    moves = [move_text(move) for move in sorted(checked.moves, key=lambda move: order[move.direction])]
    partings = zip(("first", "most"), checked.partings, strict=False)
    seeds = [] if checked.sampled is None else seed_lines(checked.sampled)
    lines = [*checked.reasons, *seeds, *(f"parts {when}: {one.text}" for when, one in partings), *moves[:_SHOWN_MOVES]]
    if len(moves) > _SHOWN_MOVES:
        lines.append(f"and {len(moves) - _SHOWN_MOVES} metrics more")
    if checked.status in _REMEDIES:
        lines.append(_REMEDIES[checked.status].format(checked.case.baseline))
    parted = bool(checked.moves or checked.partings)
    if checked.log is not None and (checked.status == "failed" or parted):
        lines += [f"look at: surefoot plot {checked.log}{where}" for where in _figures(checked.partings)]
        lines += [f"look at: {Moment(checked.log, one.begin).text}" for one in checked.partings[:1]]
    return lines


def _with_channels(checked: Checked) -> list[str]:
    """The same, and the channels that part first, where a history has the run before."""
    channels = () if checked.beside is None else checked.beside.channels
    return [*lines_of(checked), *(f"parts first of the channels: {text}" for text in channels)]


def _figures(partings: Sequence[Parting]) -> list[str]:
    """Options by which `surefoot plot` shows each; none of them for the page of all figures."""
    shown = []
    for parting in partings:
        until = f" --to {max(parting.end, parting.begin + _LEAST_WINDOW):g}" if math.isfinite(parting.end) else ""
        shown.append(f" --what {parting.figure} --from {parting.begin:g}{until}")
    return list(dict.fromkeys(shown)) or [""]


def print_checked(checked: Checked) -> None:
    """Print one run as soon as it is done; of one that was printed, and whose baseline is written now, no more."""
    color = "yellow" if checked.status == "not decided" else "green" if checked.passed else "red"
    status = typer.style(checked.status, fg=color, bold=True)
    typer.echo(f"{checked.case.scenario.name}: {status}")
    lines = {"written": [str(checked.case.baseline)], "could not write": list(checked.reasons[-1:])}
    for line in lines.get(checked.status, _with_channels(checked)):
        typer.echo(f"  - {line}")


def summary(checked: Sequence[Checked]) -> str:
    """All in a sentence."""
    counts = {
        status: sum(one.status == status for one in checked) for status in dict.fromkeys(c.status for c in checked)
    }
    return f"{len(checked)} scenario{'s' if len(checked) != 1 else ''}: " + ", ".join(
        f"{count} {status}" for status, count in counts.items()
    )


def markdown(checked: Sequence[Checked], requirements: Requirements, gallery: Gallery) -> str:
    """A summary for the page of a CI run: a narrow table, and what was found of each run that is not the same."""
    rows = ["| scenario | result |", "|---|---|"]
    rows += [f"| {one.case.scenario.name} | {_MARKS[one.passed]} {one.status} |" for one in checked]
    lines = [f"### surefoot check: {summary(checked)}", "", *rows, ""]
    for one in checked:
        if found := lines_of(one):
            lines += [f"#### {one.case.scenario.name}", "", *map(_item, found), "", *gallery.markdown(one)]
    return "\n".join([*lines, *gallery.note(checked), *requirements.markdown])


_MARKS = {True: "✅", False: "❌"}


def _item(line: str) -> str:
    """A line as an item of a list; a command is code, and text is no HTML."""
    what, look, command = line.partition("look at: ")
    if look and not what:
        return f"- look at: `{command}`"
    return "- " + line.replace("&", "&amp;").replace("<", "&lt;")


def junit(checked: Sequence[Checked]) -> bytes:
    """JUnit XML: a test case for each scenario, with the time that it took on the wall's clock."""
    errors = sum(one.status in _ERRORS for one in checked)
    failures = sum(not one.passed for one in checked) - errors
    numbers = {"tests": str(len(checked)), "failures": str(failures), "errors": str(errors)}
    suite = Xml.Element("testsuite", {"name": "surefoot check", **numbers})
    for one in checked:
        name, time = one.case.scenario.name, f"{one.took:.3f}"
        case = Xml.SubElement(suite, "testcase", classname="surefoot", name=name, time=time)
        text = "\n".join(_with_channels(one))
        if one.case.scenario.requirements:
            properties = Xml.SubElement(case, "properties")
            for requirement in dict.fromkeys(one.case.scenario.requirements):
                Xml.SubElement(properties, "property", name=PROPERTY, value=requirement)
        if not one.passed:
            kind = "error" if one.status in _ERRORS else "failure"
            Xml.SubElement(case, kind, message=one.status).text = text
        elif text:
            Xml.SubElement(case, "system-out").text = text
    return bytes(Xml.tostring(suite, encoding="utf-8", xml_declaration=True))


def write(path: Path, content: bytes, replace: bool = False) -> None:
    """Write a report.

    Raises:
        LogError: the file exists, and shall not be replaced, or cannot be written.
    """
    with write_whole(path, replace) as temporary:
        temporary.write_bytes(content)
