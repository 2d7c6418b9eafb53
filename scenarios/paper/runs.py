"""The section of the page that says what was run, how it ended and how to run it again."""

from collections.abc import Iterable

from surefoot.scenarios.paper.results import Outcome, Results
from surefoot.scenarios.record.provenance import ABSENT
from surefoot.scenarios.show.html import MISSING, escape, number, tag


def provenance(results: Results) -> str:
    """Versions that made the logs, and when."""
    rows = [(name, ", ".join(values)) for name, values in _versions(results.outcomes).items()]
    written = sorted(outcome.written for outcome in results.outcomes if outcome.written)
    if written:
        rows.append(("logs written (UTC)", f"{_date(written[0])} to {_date(written[-1])}"))
    body = "".join(tag("tr", tag("td", escape(name)) + tag("td", escape(value))) for name, value in rows)
    head = tag("tr", tag("th", "made by") + tag("th", "version"))
    return tag("table", f"<thead>{head}</thead><tbody>{body}</tbody>", id="versions", style="max-width: 46rem")


def runs_table(results: Results) -> str:
    """Every run: how it ended and how to make it again."""
    head = tag("tr", "".join(tag("th", text) for text in ("run", "end", "command")))
    rows = "\n".join(_run_row(outcome) for outcome in results.outcomes)
    table = tag("table", f"<thead>{head}</thead>\n<tbody>\n{rows}\n</tbody>", kind="runs", id="runs-table")
    count = f"All {len(results.outcomes)} runs with their commands"
    opened = tag("details", tag("summary", count) + tag("div", table, kind="wide"), id="all-runs")
    return _failures(results) + opened


def _failures(results: Results) -> str:
    if not results.failures:
        return ""
    head = tag("tr", tag("th", "could not run") + tag("th", "why"))
    reasons: dict[str, list[str]] = {}
    for outcome in results.failures:
        reasons.setdefault(outcome.failure, []).append(outcome.experiment.folder)
    rows = (tag("tr", tag("td", escape(", ".join(runs)), kind="bad") + tag("td", escape(reason)))
            for reason, runs in reasons.items())  # fmt: skip
    table = tag("table", f"<thead>{head}</thead><tbody>{''.join(rows)}</tbody>", id="failures")
    return tag("div", table, kind="wide")


def _run_row(outcome: Outcome) -> str:
    cells = (
        tag("td", escape(outcome.experiment.folder)),
        tag("td", escape(_end(outcome)), kind="bad" if outcome.failure or outcome.metrics.get("fell") else ""),
        tag("td", tag("code", escape(outcome.experiment.command))),
    )
    return tag("tr", "".join(cells))


def _end(outcome: Outcome) -> str:
    if outcome.failure:
        return "could not run"
    if outcome.metrics.get("fell"):
        return f"fell at {number(outcome.metrics['fall_time'])} s"
    return f"{outcome.metrics.get('steps_taken', MISSING)} of {outcome.metrics.get('steps_planned', MISSING)} steps"


def _versions(outcomes: Iterable[Outcome]) -> dict[str, list[str]]:
    """Every version that occurs, by name."""
    found: dict[str, dict[str, None]] = {}
    for outcome in outcomes:
        for name, value in outcome.versions.items():
            if value not in ("", ABSENT):
                found.setdefault(name.replace("_", " "), {})[value] = None
    return {name: list(values) for name, values in found.items()}


def _date(iso: str) -> str:
    return iso.replace("T", " ").removesuffix("+00:00")
