"""The ends of a campaign's searches: their section of its page."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from surefoot.scenarios.many.points import Point, Record, Runs
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, escape, number, section, tag
from surefoot.scenarios.show.kit.svg import figure_html
from surefoot.studies.campaigns.beside_figure import turned
from surefoot.studies.campaigns.capturability import LIMIT_NOTE, Limits
from surefoot.studies.campaigns.points import Cell
from surefoot.studies.campaigns.spec import Axis, angle_of, is_around, text, with_unit
from surefoot.studies.campaigns.thresholds import Found, along, are_named, bars, compass

if TYPE_CHECKING:
    from surefoot.studies.campaigns.sweep import Swept


class Again(Protocol):
    """A text in HTML on a run that did not pass: so many reasons, and the command that makes it again."""

    def __call__(self, swept: "Swept", point: Point, record: Record, most: int | None = None) -> str:
        """Write the reasons of a run, and the command that makes it again."""
        ...


def searches_section(swept: "Swept", axes: Sequence[Axis], again: Again) -> str:
    """Thresholds of all searches that came to their end, as a figure and as a table."""
    bisect = swept.campaign.spec.bisect
    assert bisect is not None
    ends = _searches(swept)
    found = [one for one, _ in ends]
    if not found:
        return section("Thresholds", tag("p", "No search has come to its end."))
    angle = angle_of(axes)
    logs = ((one.labels, swept.folder / record.log) for one, runs in ends for _, record in runs if record.log)
    limits = Limits(bisect.key, logs, angle.name if angle else "")
    searched = f"The value of {bisect.key} at which passing turns into failing, by halving the range."
    if bisect.ratio is not None:
        searched = f"The greatest value of {bisect.key} up to which every rung of a ladder was passed by all seeds."
    note = tag("p", LIMIT_NOTE, kind="note") if limits else ""
    return section(
        "Thresholds",
        tag("p", escape(searched)),
        _figure(swept, found, axes, limits),
        _table(swept, ends, axes, limits, again),
        note,
    )


def _figure(swept: "Swept", found: Sequence[Found], axes: Sequence[Axis], limits: Limits) -> str:
    """Bars among named settings, a compass of directions, or curves; none where nothing varies."""
    assert swept.campaign.spec.bisect is not None
    key, records = swept.campaign.spec.bisect.key, swept.campaign.spec.records
    varied = [axis for axis in axes if len({one.labels[axis.name] for one in found}) > 1]
    laid = turned(swept.campaign, found, axes)
    if laid is not None:
        drawn = compass(*laid, key, lambda *_: None)
        caption = f"The largest survived of {key} by direction in the world, of both walkers. Hollow marks{_BEYOND}"
    elif are_named(axes):
        drawn, caption = bars(found, axes, key, limits.at, records), "Thresholds. Hollow bars" + _BEYOND
        caption += " Black: the most that a linear inverted pendulum survives by one step." if limits else ""
        caption = " ".join((caption, *(f"{one}." for one in sorted({f"{one.name}: {one.source}" for one in records}))))
    elif is_around(varied):
        drawn, caption = compass(found, varied, key, limits.at), "Thresholds by direction in the world. Hollow marks"
        most = "the most that a linear inverted pendulum survives by one step"
        caption += f"{_BEYOND} Dashed, where it is known: {most}."
    elif varied:
        drawn, caption = along(found, varied, key), "Thresholds. Hollow marks" + _BEYOND
    else:
        return ""
    return figure_html(drawn, caption, "thresholds-figure")


_BEYOND = " lie beyond the end of the searched range."


def _searches(swept: "Swept") -> list[tuple[Found, Runs]]:
    """The end of every search that came to its end, with its runs."""
    found: list[tuple[Found, Runs]] = []
    for outcome in swept.outcomes:
        cell = outcome.cell
        assert isinstance(cell, Cell)
        bisect = swept.campaign.bisect(cell.keys)
        if outcome.threshold is not None and bisect is not None:
            found.append((Found(cell.labels, outcome.threshold, (bisect.low, bisect.high)), outcome.runs))
    return found


def _table(
    swept: "Swept", ends: Sequence[tuple[Found, Runs]], axes: Sequence[Axis], limits: Limits, again: Again
) -> str:
    angle, bisect = angle_of(axes), swept.campaign.spec.bisect
    assert bisect is not None
    head = [*(axis.heading for axis in axes), with_unit(bisect.key)]
    head += ["limit", "threshold over limit [%]"] if limits else []
    rows: list[TableRow] = []
    for one, runs in ends:
        value = one.threshold.value
        beyond = {"below": "below ", "above": "above "}.get(one.threshold.side, "")
        shown = number(value) if value is not None and not beyond else f"{beyond}{number(one.shown)}"
        row: list[TableCell | str] = [escape(text(one.labels[axis.name])) for axis in axes]
        row.append(TableCell(shown, value=value))
        if limits:
            limit = limits.at(one.labels, float(one.labels[angle.name]) if angle else None)
            row.append(tag("span", number(limit), data_limit="" if limit is None else repr(limit)))
            row.append(MISSING if not limit or value is None else f"{100 * value / limit:.0f}")
        failed = next((again(swept, *run, most=1) for run in runs if run[1].status == "fail"), MISSING)
        rows.append([*row, str(len(runs)), failed])
    return PageTable("thresholds", [*head, "runs", "first failure"], rows).html
