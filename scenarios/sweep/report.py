"""The page of a campaign: what was run, what came of it, and how to run any failure of it again."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, get_args
from urllib.parse import quote

import numpy as np
import yaml

from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.show.html import MISSING, document, escape, figure_html, number, tag
from surefoot.scenarios.sweep import figures
from surefoot.scenarios.sweep.bars import are_named, bars
from surefoot.scenarios.sweep.capturability import Limits
from surefoot.scenarios.sweep.figures import Axis, Found, Square
from surefoot.scenarios.sweep.journal import JOURNAL
from surefoot.scenarios.sweep.points import Cell, Point, Record, Status
from surefoot.scenarios.sweep.repeats import Runs
from surefoot.scenarios.sweep.spreads import drawn, of_criteria
from surefoot.scenarios.sweep.table import wilson

if TYPE_CHECKING:
    from surefoot.scenarios.sweep.sweep import Swept

MOST_ROWS = 200
"""Failing runs that the page lists."""

Row = Sequence[str]


def write_page(swept: "Swept") -> None:
    """Write ``report.html``; one of an earlier time is replaced.

    Raises:
        LogError: it cannot be written.
    """
    from surefoot.scenarios.sweep.sweep import PAGE

    with write_whole(swept.folder / PAGE, replace=True) as temporary:
        temporary.write_text(page(swept), encoding="utf-8")


def page(swept: "Swept") -> str:
    """The whole page as HTML."""
    spec = swept.campaign.spec
    runs = swept.facts
    axes = [Axis(name, tuple(one.label for one in settings)) for name, settings in swept.campaign.axes.items()]
    parts = [tag("h1", escape(spec.name)), tag("p", escape(spec.about), kind="lead") if spec.about else ""]
    parts += [_tally(swept, runs), _what_was_run(swept)]
    if not runs:
        parts.append(tag("p", "No run has a result yet."))
    elif spec.bisect is not None:
        parts.append(_thresholds(swept, axes))
    else:
        parts += [_success(swept, runs, axes), _maps(swept, runs, axes)]
    parts += [_distributions(swept, runs), _failures(swept, swept.runs)]
    return document(f"{spec.name}: campaign", "\n".join(part for part in parts if part))


def _tally(swept: "Swept", runs: Runs) -> str:
    boxes = [(str(len(swept.runs)), "runs")]
    boxes += [(str(swept.count(status)), _WORDS[status]) for status in get_args(Status) if swept.count(status)]
    judged = _judged(runs)
    if swept.campaign.spec.bisect is not None:
        done = sum(outcome.threshold is not None for outcome in swept.outcomes)
        boxes.append((f"{done} of {len(swept.outcomes)}", "thresholds found"))
    elif judged:
        rate = wilson(_passed(judged), len(judged))
        interval = f"success rate, 95 % interval {100 * rate.low:.1f} to {100 * rate.high:.1f} %"
        boxes.append((f"{100 * rate.rate:.1f} %", interval))
    return tag(
        "div", "".join(tag("div", f"<b>{one}</b>{tag('span', escape(what))}") for one, what in boxes), kind="tally"
    )


_WORDS: Mapping[Status, str] = {
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
    said = [f"{len(swept.outcomes)} {'searches' if spec.bisect else 'runs'} were asked for"]
    said += [f"{incomplete} of them have no result yet"] if incomplete else []
    said += [f"the last result is of {when:%Y-%m-%d %H:%M} UTC"] if when else []
    said += [f"the runs took {_time(total)} in sum"]
    written = yaml.safe_dump(spec.model_dump(mode="json", exclude_defaults=True), sort_keys=False)
    versions = "  ".join(f"{name} {version}" for name, version in relevant_versions().items())
    return tag(
        "section",
        tag("h2", "What was run")
        + tag("p", escape("; ".join(said)) + ".")
        + "".join(tag("p", f"{escape(note[:1].upper() + note[1:])}.") for note in swept.repeats())
        + tag("details", tag("summary", "Specification") + tag("pre", escape(written)))
        + tag("details", tag("summary", "Versions") + tag("p", escape(versions)))
        + tag("p", "The same as tables: " + ", ".join(_file_link(name) for name in _tables(swept)) + ".", kind="note"),
    )


def _tables(swept: "Swept") -> list[str]:
    return [path.name for path in swept.files if path.suffix != ".html"] or [JOURNAL]


def _file_link(name: str) -> str:
    return tag("a", escape(name), href=quote(name))


def _time(seconds: float) -> str:
    return (
        f"{seconds:.0f} s"
        if seconds < 120
        else f"{seconds / 60:.0f} min"
        if seconds < 7200
        else f"{seconds / 3600:.1f} h"
    )


def _thresholds(swept: "Swept", axes: Sequence[Axis]) -> str:
    bisect = swept.campaign.spec.bisect
    assert bisect is not None
    ends = _searches(swept)
    found = [one for one, _ in ends]
    parts = [tag("h2", "Thresholds")]
    parts.append(tag("p", escape(_searched(bisect.ratio is not None, bisect.key))))
    if not found:
        return tag("section", parts[0] + tag("p", "No search has come to its end."))
    varied = [axis for axis in axes if len({one.labels[axis.name] for one in found}) > 1]
    angle = figures.angle_of(axes)
    logs = ((one.labels, swept.folder / record.log) for one, runs in ends for _, record in runs if record.log)
    limits = Limits(bisect.key, logs, angle.name if angle else "")
    if are_named(axes):
        records = swept.campaign.spec.records
        drawn = bars(found, axes, bisect.key, lambda labels: limits.at(labels, None), records)
        caption = "Thresholds. Hollow bars lie beyond the end of the searched range."
        caption += " Black: the most that a linear inverted pendulum survives by one step." if limits else ""
        told = {f"{record.name}: {record.source}" for record in records}
        parts.append(figure_html(drawn, " ".join((caption, *(f"{one}." for one in sorted(told)))), "thresholds-figure"))
    elif figures.is_around(varied):
        drawn = figures.compass(found, varied, bisect.key, limits.at)
        caption = (
            "Thresholds by direction in the world. Hollow marks lie beyond the end of the searched range. "
            "Dashed, where it is known: the most that a linear inverted pendulum survives by one step."
        )
        parts.append(figure_html(drawn, caption, "thresholds-figure"))
    elif varied:
        drawn = figures.along(found, varied, bisect.key)
        caption = "Thresholds. Hollow marks lie beyond the end of the searched range."
        parts.append(figure_html(drawn, caption, "thresholds-figure"))
    parts.append(_thresholds_table(swept, ends, axes, limits))
    if limits:
        parts.append(tag("p", _LIMIT_NOTE, kind="note"))
    return tag("section", "\n".join(parts))


_LIMIT_NOTE = (
    "Limit: one-step capturability. The largest impulse after which some centre of pressure within the soles until the "
    "landing, and some landing, bring a linear inverted pendulum to rest: where and when the adaptation of steps may "
    "put it, within reach of the legs and of how hard hips can swing them. Its state is that in which the push began "
    "in a run of the same kind, by its log. Turning the torso and a second step are not in it; a threshold beyond it "
    "uses one of these."
)


def _searched(ladder: bool, key: str) -> str:
    if ladder:
        return f"The greatest value of {key} up to which every rung of a ladder was passed by all seeds."
    return f"The value of {key} at which passing turns into failing, by halving the range."


def _searches(swept: "Swept") -> list[tuple[Found, Runs]]:
    """Where every search ended that came to its end, with its runs."""
    found: list[tuple[Found, Runs]] = []
    for outcome in swept.outcomes:
        cell = outcome.cell
        assert isinstance(cell, Cell)
        bisect = swept.campaign.bisect(cell.keys)
        if outcome.threshold is not None and bisect is not None:
            found.append((Found(cell.labels, outcome.threshold, (bisect.low, bisect.high)), outcome.runs))
    return found


def _thresholds_table(swept: "Swept", ends: Sequence[tuple[Found, Runs]], axes: Sequence[Axis], limits: Limits) -> str:
    angle, bisect = figures.angle_of(axes), swept.campaign.spec.bisect
    assert bisect is not None
    head = [*(axis.heading for axis in axes), figures.with_unit(bisect.key)]
    head += ["limit", "threshold over limit [%]"] if limits else []
    rows: list[Row] = []
    for one, runs in ends:
        value = one.threshold.value
        beyond = {"below": "below ", "above": "above "}.get(one.threshold.side, "")
        shown = number(value) if value is not None and not beyond else f"{beyond}{number(one.shown)}"
        row = [escape(figures.text(one.labels[axis.name])) for axis in axes]
        row.append(tag("span", escape(shown), data_value="" if value is None else repr(value)))
        if limits:
            limit = limits.at(one.labels, float(one.labels[angle.name]) if angle else None)
            row += [tag("span", number(limit), data_limit="" if limit is None else repr(limit))]
            row += [MISSING if not limit or value is None else f"{100 * value / limit:.0f}"]
        failed = next((run for run in runs if run[1].status == "fail"), None)
        rows.append([*row, str(len(runs)), _again(swept, *failed, most=1) if failed else MISSING])
    return _table([*head, "runs", "first failure"], rows, "thresholds")


def _success(swept: "Swept", runs: Runs, axes: Sequence[Axis]) -> str:
    judged = _judged(runs)
    if not judged:
        return tag("section", tag("h2", "Success") + tag("p", "No run was judged, so that there is no success rate."))
    rows = [_rate_row("all runs", "", runs)]
    for axis in axes:
        if len(axis.values) > 1:
            groups = [
                (figures.text(one), [run for run in runs if run[0].labels[axis.name] == one]) for one in axis.values
            ]
            rows += [_rate_row(axis.heading, name, group) for name, group in groups]
    for key in swept.campaign.spec.sample:
        rows += [_rate_row(figures.with_unit(key), name, group) for name, group in _split(key, runs)]
    head = ["by", "value", "judged", "passed", "rate [%]", "95 % interval [%]", "refused or broken"]
    note = "Rates are of runs that were judged; intervals are Wilson&#39;s."
    return tag("section", tag("h2", "Success") + _table(head, rows, "success") + tag("p", note, kind="note"))


def _rate_row(name: str, value: str, runs: Runs) -> Row:
    judged = _judged(runs)
    counts = [str(len(judged)), str(_passed(judged))]
    rest = str(len(runs) - len(judged))
    if not judged:
        return [escape(name), escape(value), *counts, MISSING, MISSING, rest]
    rate = wilson(_passed(judged), len(judged))
    shown = tag("span", f"{100 * rate.rate:.1f}", data_value=repr(rate.rate))
    return [escape(name), escape(value), *counts, shown, f"{100 * rate.low:.1f} to {100 * rate.high:.1f}", rest]


def _split(key: str, runs: Runs) -> Iterator[tuple[str, Runs]]:
    """Runs by the quarter of a drawn number, or by a drawn choice."""
    values = [point.labels[key] for point, _ in runs]
    if len(set(map(str, values))) <= 4 or not Axis(key, tuple(values)).numeric:
        for one in sorted(set(map(str, values))):
            yield one, [run for run in runs if str(run[0].labels[key]) == one]
        return
    edges = np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0])
    quarter = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, 3)
    for i in range(4):
        name = f"{figures.text(float(edges[i]))} to {figures.text(float(edges[i + 1]))}"
        yield name, [run for run, at in zip(runs, quarter, strict=True) if at == i]


def _maps(swept: "Swept", runs: Runs, axes: Sequence[Axis]) -> str:
    varied = [axis for axis in axes if len(axis.values) > 1]
    if not varied:
        return ""
    first = next(iter(swept.campaign.spec.first), None)
    groups: dict[tuple[str, ...], list[tuple[Point, Record]]] = {}
    for run in runs:
        groups.setdefault(tuple(str(run[0].labels[axis.name]) for axis in varied), []).append(run)

    def square(labels: Mapping[str, Any]) -> Square:
        return _square(groups.get(tuple(str(labels[axis.name]) for axis in varied), []), first)

    parts = [tag("h2", "Map")]
    if len(varied) == 1 and first is None:
        (axis,) = varied
        judged = [_judged(groups.get((str(value),), [])) for value in axis.values]
        drawn = figures.success_along(axis, [(_passed(group), len(group)) for group in judged])
        parts.append(figure_html(drawn, f"Success rate by {axis.name}.", "success-along"))
    else:
        drawn = figures.success_map(varied, square, f"{first} accepted" if first else "")
        caption = "Runs that passed, of those that were judged; grey where none was." + (
            f" Below, the first value of {first} that was accepted." if first else ""
        )
        panels = int(np.prod([len(axis.values) for axis in varied[:-2]]))
        left = panels - figures.MOST_PANELS
        caption += f" {left} more panels are left out; the tables have all." if left > 0 else ""
        parts.append(figure_html(drawn, caption, "success-map"))
    return tag("section", "\n".join(parts))


def _square(runs: Runs, first: str | None) -> Square:
    judged = _judged(runs)
    if not judged:
        return Square("refused" if runs and all(one.status == "refused" for _, one in runs) else "", float("nan"))
    passed = _passed(judged)
    counts = f"{passed}/{len(judged)}"
    accepted = sorted({figures.text(point.labels[first]) for point, _ in judged}) if first else []
    return Square("\n".join((counts, *accepted)), passed / len(judged))


def _distributions(swept: "Swept", runs: Runs) -> str:
    judged = _judged(runs)
    if not judged:
        return ""
    sampled = [drawn(key, draw.choice is not None, judged) for key, draw in swept.campaign.spec.sample.items()]
    measured = list(of_criteria(judged))
    parts = []
    for name, spreads, caption in (
        ("sampled", sampled, "What was drawn, of runs that met their criteria and that missed them."),
        ("measured", measured, "What the criteria bound; dashed their bounds."),
    ):
        if spreads:
            parts.append(figure_html(figures.distributions(spreads), caption, name))
    return tag("section", tag("h2", "Distributions") + "\n".join(parts)) if parts else ""


def _failures(swept: "Swept", runs: Runs) -> str:
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
    shown, rows = 0, []
    for kind, group in sorted(groups.items(), key=lambda item: (item[0] in _WORDS, -len(item[1]))):
        rows.append([tag("b", escape(kind)), f"{len(group)} runs"])
        taken = group[: max(MOST_ROWS - shown, 0)]
        rows += [[escape(point.name), _again(swept, point, record)] for point, record in taken]
        shown += len(taken)
    total = sum(map(len, groups.values()))
    left = f" Listed are {shown} of {total}; the table has all." if shown < total else ""
    table = _table(["run", "why, its log, and the command that makes it again"], rows, "failures")
    return tag("section", tag("h2", "Runs that did not pass") + tag("p", escape(intro + left)) + table)


def kind_of(record: Record) -> str:
    """What a run ended by: the metric of the first criterion that it missed, or its status."""
    if record.status != "fail" or not record.reasons:
        return record.status
    return record.reasons[0].split()[0].rstrip(":,;")


def _again(swept: "Swept", point: Point, record: Record, most: int | None = None) -> str:
    """Why a run did not pass, by at most so many reasons, its log, and how to make it again."""
    log = f" {tag('a', 'log', href=quote(record.log))}" if record.log and (swept.folder / record.log).exists() else ""
    command = tag("details", tag("summary", "command") + tag("code", escape(point.command), kind="command"))
    return escape("; ".join(record.reasons[:most])) + log + command


def _table(head: Sequence[str], rows: Iterable[Row], name: str) -> str:
    top = tag("tr", "".join(tag("th", escape(one), scope="col") for one in head))
    body = "\n".join(tag("tr", "".join(tag("td", cell) for cell in row)) for row in rows)
    return tag("div", tag("table", f"<thead>{top}</thead>\n<tbody>\n{body}\n</tbody>", id=name), kind="wide")


def _judged(runs: Runs) -> Runs:
    return [run for run in runs if run[1].status in ("pass", "fail")]


def _passed(runs: Runs) -> int:
    return Counter(record.status for _, record in runs)["pass"]
