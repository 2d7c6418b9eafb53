"""The page of a campaign: what was run, what came of it, and how to run any failure of it again."""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import TYPE_CHECKING, get_args
from urllib.parse import quote

import yaml

from surefoot.scenarios.many.journal import JOURNAL
from surefoot.scenarios.many.points import Point, Record, Runs, RunStatus
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.show.kit import html
from surefoot.scenarios.show.kit.html import TableRow, details, escape, section, tag
from surefoot.studies.campaigns import success
from surefoot.studies.campaigns.maps import map_section
from surefoot.studies.campaigns.searches import searches_section
from surefoot.studies.campaigns.spec import Axis

if TYPE_CHECKING:
    from surefoot.studies.campaigns.sweep import Swept

MOST_ROWS = 200
"""Failing runs that the page lists."""


def page(swept: "Swept", most: int = MOST_ROWS) -> str:
    """The whole page as HTML, with at most so many failing runs."""
    spec = swept.campaign.spec
    runs = swept.facts
    axes = [Axis(name, tuple(one.label for one in settings)) for name, settings in swept.campaign.axes.items()]
    parts = [tag("h1", escape(spec.name)), tag("p", escape(spec.about), kind="lead") if spec.about else ""]
    parts += [_tally(swept, runs), _what_was_run(swept)]
    if not runs:
        parts.append(tag("p", "No run has a result yet."))
    elif spec.bisect is not None:
        parts.append(searches_section(swept, axes, _again))
    else:
        parts.append(success.success_section(swept, runs, axes))
        if any(len(axis.values) > 1 for axis in axes):
            parts.append(map_section(swept, runs, axes))
    parts += [success.distributions_section(swept, runs), _failures(swept, swept.runs, most)]
    return html.document(f"{spec.name}: campaign", "\n".join(part for part in parts if part))


def _tally(swept: "Swept", runs: Runs) -> str:
    boxes = [(str(len(swept.runs)), "runs")]
    boxes += [(str(swept.count(status)), _WORDS[status]) for status in get_args(RunStatus) if swept.count(status)]
    judged = success.judged_of(runs)
    if swept.campaign.spec.bisect is not None:
        done = sum(outcome.threshold is not None for outcome in swept.outcomes)
        boxes.append((f"{done} of {len(swept.outcomes)}", "thresholds found"))
    elif judged:
        rate = success.rate_of(judged)
        boxes.append((f"{100 * rate.rate:.1f} %", f"success rate, 95 % interval {rate.between} %"))
    return html.tally(boxes)


_WORDS: Mapping[RunStatus, str] = {
    "pass": "met their criteria",
    "fail": "missed them",
    "refused": "refused: no such scenario can run",
    "broken": "gave no result",
}


def _what_was_run(swept: "Swept") -> str:
    spec = swept.campaign.spec
    total = sum(record.wall_time for record in swept.records)
    journal = swept.folder / JOURNAL
    when = datetime.fromtimestamp(journal.stat().st_mtime, UTC) if journal.exists() else None
    incomplete = sum(not outcome.complete for outcome in swept.outcomes)
    tables = [path.name for path in swept.files if path.suffix != ".html"] or [JOURNAL]
    said = [f"{len(swept.outcomes)} {'searches' if spec.bisect else 'runs'} were asked for"]
    said += [f"{incomplete} of them have no result yet"] if incomplete else []
    said += [f"the last result is of {when:%Y-%m-%d %H:%M} UTC"] if when else []
    said += [f"the runs took {_time(total)} in sum"]
    written = yaml.safe_dump(spec.model_dump(mode="json", exclude_defaults=True), sort_keys=False)
    versions = "  ".join(f"{name} {version}" for name, version in relevant_versions().items())
    return section(
        "What was run",
        tag("p", escape("; ".join(said)) + "."),
        *(tag("p", f"{escape(note[:1].upper() + note[1:])}.") for note in swept.repeats()),
        details("Specification", tag("pre", escape(written))),
        details("Versions", tag("p", escape(versions))),
        tag(
            "p",
            f"The same as tables: {', '.join(tag('a', escape(name), href=quote(name)) for name in tables)}.",
            kind="note",
        ),
    )


def _time(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def _failures(swept: "Swept", runs: Runs, most: int) -> str:
    groups: dict[str, list[tuple[Point, Record]]] = {}
    for point, record in runs:
        if record.status != "pass":
            groups.setdefault(kind_of(record), []).append((point, record))
    if not groups:
        return ""
    if swept.campaign.spec.bisect is not None:
        intro = "A search has failing runs by its nature: it ends at one."
    else:
        intro = "By the first criterion that each missed; refused ones and those without a result stand last."
    shown = 0
    rows: list[TableRow] = []
    for kind, group in sorted(groups.items(), key=lambda item: (item[0] in _WORDS, -len(item[1]))):
        rows.append([tag("b", escape(kind)), f"{len(group)} runs"])
        taken = group[: max(most - shown, 0)]
        rows += [[escape(point.name), _again(swept, point, record)] for point, record in taken]
        shown += len(taken)
    total = sum(map(len, groups.values()))
    left = f" Listed are {shown} of {total}; the table has all." if shown < total else ""
    table = html.PageTable("failures", ["run", "why, its log, and the command that makes it again"], rows).html
    return section("Runs that did not pass", tag("p", escape(intro + left)), table)


def kind_of(record: Record) -> str:
    """Kind of a run's end: the metric of the first criterion that it missed, or its status."""
    if record.status != "fail" or not record.reasons:
        return record.status
    return record.reasons[0].split()[0].rstrip(":,;")


def _again(swept: "Swept", point: Point, record: Record, most: int | None = None) -> str:
    """Reasons why a run did not pass, at most so many, its log, and how to make it again."""
    log = f" {tag('a', 'log', href=quote(record.log))}" if record.log and (swept.folder / record.log).exists() else ""
    command = details("command", tag("code", escape(point.command), kind="command"))
    return escape("; ".join(record.reasons[:most])) + log + command
