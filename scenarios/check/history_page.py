"""The page of a history: which commits changed something, how it looked before and after, and a trend per metric."""

import base64
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from surefoot.scenarios.check.changes import Change, series
from surefoot.scenarios.check.history import History
from surefoot.scenarios.check.lines import Line
from surefoot.scenarios.check.report import move_text
from surefoot.scenarios.check.trends import Trend, picture, trends
from surefoot.scenarios.judge.verdict import value_text
from surefoot.scenarios.show.kit import html
from surefoot.scenarios.show.kit.html import TableCell, details, escape, section, tag
from surefoot.scenarios.show.kit.svg import svg

_MOST_MOVES = 8
"""Metrics of a change that are named; the others are counted."""


@dataclass(frozen=True, slots=True)
class Walk:
    """The checks of one scenario on one kind of machine.

    Attributes:
        scenario: its name.
        machine: the kind.
        lines: in order.
        changes: among them, in order.
    """

    scenario: str
    machine: str
    lines: tuple[Line, ...]
    changes: tuple[Change, ...]

    @property
    def anchor(self) -> str:
        """Name of its section."""
        return f"{self.scenario}-{self.machine}".replace(" ", "-")


def walks(history: History) -> tuple[Walk, ...]:
    """All that a history tells of, by scenario."""
    return tuple(
        Walk(scenario, machine, tuple(lines), tuple(history.changes(lines)))
        for (scenario, machine), lines in series(history.lines).items()
    )


def changed_commits(found: Sequence[Walk]) -> list[tuple[Line, list[tuple[Walk, Change]]]]:
    """Checks at which something changed, in order, each with the changes of its scenarios; one commit counts once."""
    groups: dict[tuple[str, str], list[tuple[Walk, Change]]] = {}
    for walk in found:
        for change in walk.changes:
            line = change.now
            groups.setdefault((line.commit.time or line.time, line.commit.name or line.time), []).append((walk, change))
    return [(changes[0][1].now, changes) for _, changes in sorted(groups.items())]


def page(history: History) -> str:
    """The whole page as HTML."""
    found = walks(history)
    commits = changed_commits(found)
    names = {id(change): str(number) for number, (_, changes) in enumerate(commits, 1) for _, change in changes}
    parts = [
        tag("h1", "History of checks"),
        tag("p", escape(_span(history.lines)), kind="lead"),
        _tally(found, commits),
    ]
    parts.append(_commits(history, commits))
    parts += [_walk(walk, names) for walk in found]
    if history.notes:
        notes = "".join(tag("li", escape(note)) for note in dict.fromkeys(history.notes))
        parts.append(section("What could not be read", tag("ul", notes)))
    return html.document("History of checks", "\n".join(part for part in parts if part))


def _span(lines: Sequence[Line]) -> str:
    if not lines:
        return "It holds no check yet."
    days = sorted(line.order[0][:10] for line in lines)
    machines = sorted({line.machine for line in lines})
    return f"{days[0]} to {days[-1]}, on {', '.join(machines)}."


def _tally(found: Sequence[Walk], commits: Sequence[object]) -> str:
    lines = [line for walk in found for line in walk.lines]
    checks = len({(line.time, line.commit.name) for line in lines})
    names = len({line.commit.name for line in lines if line.commit.name})
    boxes = [(str(checks), "checks"), (str(names), "commits"), (str(len({one.scenario for one in lines})), "scenarios")]
    return html.tally([*boxes, (str(len(commits)), "commits that changed something")])


def _commits(history: History, commits: Sequence[tuple[Line, list[tuple[Walk, Change]]]]) -> str:
    title = "Commits that changed something"
    if not commits:
        return section(title, tag("p", "None: every run was as the first one, within the tolerances."))
    intro = "The newest first. The numbers are those in the figures below."
    numbered = list(enumerate(commits, 1))
    parts = (_commit(history, number, *one) for number, one in reversed(numbered))
    return section(title, tag("p", intro), *parts, name="changes")


def _commit(history: History, number: int, line: Line, changes: Sequence[tuple[Walk, Change]]) -> str:
    what = f"{number}. {line.commit.short or line.time}"
    heading = tag(
        "h3", f"{escape(what)} {tag('span', escape(line.commit.subject), kind='subject')}", id=f"change-{number}"
    )
    before = changes[0][1].before
    since = f"{line.order[0].replace('T', ' ').rstrip('Z')} UTC"
    since += f", after {before.commit.short}" if before.commit.name else ""
    return "\n".join([heading, tag("p", escape(since), kind="note"), *(_change(history, *one) for one in changes)])


def _change(history: History, walk: Walk, change: Change) -> str:
    link = tag("a", escape(walk.scenario), href=f"#{walk.anchor}")
    kind = "holds" if change.now.passed else "not"
    head = tag("p", f"{tag('b', link)}: {tag('span', escape(change.now.status), kind=f'verdict {kind}')}")
    items = "".join(tag("li", escape(text)) for text in _texts(change))
    return "\n".join(filter(None, (head, tag("ul", items), _pair(history, change))))


def _texts(change: Change) -> Iterator[str]:
    """Sentences on a change, those nearest to the cause first."""
    yield from change.reasons
    if change.partings:
        yield f"parts first: {change.partings[0].text}".replace("in the baseline", "before").replace(
            "the baseline", "before"
        )
    yield from map(move_text, change.moves[:_MOST_MOVES])
    if len(change.moves) > _MOST_MOVES:
        yield f"and {len(change.moves) - _MOST_MOVES} metrics more"
    if change.now.beside is not None:
        yield from (f"parts first of the channels: {text}" for text in change.now.beside.channels)
    yield from change.versions


def _pair(history: History, change: Change) -> str:
    """The pictures of both runs, or why there are none."""
    held = change.now.beside
    paths = history.pictures_of(held)
    if held is None or not paths:
        why = held.note if held is not None and held.note else "no pictures: the history has none of this change"
        return tag("p", escape(f"{why[:1].upper()}{why[1:]}."), kind="note")
    before = next((line.commit.short for line in history.lines if line.commit.name == held.commit), "")
    good = "before" if change.now.passed else "last good"
    words = (f"{good}, {before}" if before else good, f"now, {change.now.commit.short}".rstrip(", "))
    shown = []
    for path, word in zip(paths, words, strict=True):
        data = base64.b64encode(path.read_bytes()).decode()
        image = tag("img", "", src=f"data:image/png;base64,{data}", alt=f"{change.now.scenario}, {word}")
        shown.append(tag("div", image.removesuffix("</img>") + tag("figcaption", escape(word))))
    caption = tag("figcaption", escape(f"Both at {held.time:.3f} s, by one camera."))
    return tag("figure", tag("div", "".join(shown), kind="pair") + caption)


def _walk(walk: Walk, names: Mapping[int, str]) -> str:
    lines = walk.lines
    changed = {_place(lines, change.now): names[id(change)] for change in walk.changes}
    every = trends(lines)
    moved = {move.name for change in walk.changes for move in change.moves}
    drawn = [one for one in every if one.repeatable and (one.bound is not None or one.name in moved or one.spread)]
    clocks = [one for one in every if not one.repeatable]
    rest = [one for one in every if one.repeatable and one not in drawn]
    title = f"{walk.scenario}, {walk.machine}"
    return section(
        title,
        _strip(lines),
        _panels(drawn, changed, f"Metrics of {walk.scenario} that a criterion bounds or that moved"),
        tag("p", _LEGEND, kind="note") if drawn else "",
        details(f"{len(rest)} metrics that never moved and have no bound", _table(rest)) if rest else "",
        details("On the wall's clock", _panels(clocks, {}, "Times") + tag("p", _CLOCK, kind="note")) if clocks else "",
        name=walk.anchor,
    )


_LEGEND = (
    "Over the checks in order: grey is what a check allows about the first value since a change. A dashed line is a "
    "bound of the scenario, a number one of the commits above, a cross a check that did not pass. "
    "A bar is an interval over seeds that holds with 95 %."
)
_CLOCK = (
    "Grey is the median of each level. A shift of level may be the program's or the machine's, so no commit is marked "
    "for it. It takes at least four checks."
)


def _place(lines: Sequence[Line], line: Line) -> int:
    return next(at for at, one in enumerate(lines) if one is line)


def _strip(lines: Sequence[Line]) -> str:
    """A mark for each check, with what it found."""
    marks = (
        tag("span", "", kind="pass" if line.passed else "fail", title=f"{line.commit.short} {line.status}".strip())
        for line in lines
    )
    passed = sum(line.passed for line in lines)
    words = tag("p", escape(f"{passed} of {len(lines)} checks passed; the last is {lines[-1].status}."))
    label = f"{passed} of {len(lines)} checks passed"
    return words + tag("div", "".join(marks), kind="strip", role="img", aria_label=label)


def _panels(found: Sequence[Trend], changed: Mapping[int, str], caption: str) -> str:
    if not found:
        return ""
    pictures = "\n".join(tag("div", svg(picture(one, changed)), role="img", aria_label=one.label) for one in found)
    return tag(
        "figure", tag("div", pictures, kind="panels") + tag("figcaption", escape(f"{caption}.")), kind="histograms"
    )


def _table(rest: Sequence[Trend]) -> str:
    """First and last value of metrics that stay, and the span between."""
    rows = []
    for one in rest:
        values = [value for value in one.values if value is not None]
        name = one.name.partition("[")[0]
        first, last, span = (value_text(name, value) for value in (values[0], values[-1], max(values) - min(values)))
        allowed = value_text(name, one.allowed(values[0]))
        rows.append([TableCell(one.label), *(TableCell(text, "number") for text in (first, last, span, allowed))])
    return html.PageTable("", ("metric", "first", "last", "greatest difference", "allowed"), rows).html


def summary(found: Sequence[Walk]) -> Iterator[str]:
    """Lines for a terminal: the commits that changed something, each with the scenarios in which."""
    for line, changes in changed_commits(found):
        name = line.commit.short or line.time
        yield f"{name} {line.commit.subject}".rstrip()
        for walk, change in changes:
            first = next(_texts(change), "")
            yield (
                f"  {walk.scenario}: {change.now.status}, {first}"
                if first
                else f"  {walk.scenario}: {change.now.status}"
            )


def to_json(history: History) -> dict[str, object]:
    """The findings of a history as JSON: the commits that changed something, with scenarios and metrics."""
    found = walks(history)
    checks = {(line.time, line.commit.name) for line in history.lines}
    return {
        "checks": len(checks),
        "scenarios": sorted({walk.scenario for walk in found}),
        "changes": [
            {
                "commit": line.commit.name,
                "subject": line.commit.subject,
                "time": line.order[0],
                "scenarios": [_json_of(walk, change) for walk, change in changes],
            }
            for line, changes in changed_commits(found)
        ],
        "notes": list(dict.fromkeys(history.notes)),
    }


def _json_of(walk: Walk, change: Change) -> dict[str, object]:
    return {
        "scenario": walk.scenario,
        "machine": walk.machine,
        "status": change.now.status,
        "after": change.before.commit.name,
        "reasons": list(change.reasons),
        "parts_first": change.partings[0].text if change.partings else None,
        "metrics": [move.name for move in change.moves],
        "versions": list(change.versions),
    }
