"""The page, and the command that writes it."""

import json
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from matplotlib.figure import Figure

from surefoot.scenarios.many.engine import Worker, local_workers
from surefoot.scenarios.many.slots import CampaignBar
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.run.run import made_folder
from surefoot.scenarios.show.kit import html
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, escape, section, tag
from surefoot.scenarios.show.kit.html import tally as tally_html
from surefoot.scenarios.show.kit.svg import figure_html
from surefoot.studies.paper import studies
from surefoot.studies.paper.claims import Assessment, Claim, Grade, claims
from surefoot.studies.paper.figures import PLATES
from surefoot.studies.paper.results import (
    MM,
    PERCENT,
    WORLD_NAMES,
    Results,
    Sample,
    fell_text,
    first_fall,
    run_experiments,
    spread_cell,
)
from surefoot.studies.paper.studies import Experiment, Study, experiments


class PageSection(NamedTuple):
    """A section of the page.

    Attributes:
        name: its anchor.
        title: its heading.
        text: paragraphs, as HTML.
        points: entries of a list below them, as HTML.
        figures: of each its anchor, its caption, and whether it takes half of the page's width.
    """

    name: str
    title: str
    text: tuple[str, ...]
    points: tuple[str, ...] = ()
    figures: tuple[dict[str, Any], ...] = ()


def sections() -> tuple[PageSection, ...]:
    """All sections in the order of the page."""
    entries = yaml.safe_load((files(__package__) / "sections.yaml").read_text(encoding="utf-8"))
    return tuple(PageSection(**entry) for entry in entries)


TITLE = "A Robust Closed-Loop Biped Locomotion Planner Based on Time Varying Model Predictive Control, measured"

_KINDS: dict[Grade, str] = {
    "holds": "holds",
    "holds with a change": "change",
    "does not hold": "not",
    "not measured": "unknown",
}

Judged = Sequence[tuple[Claim, Assessment]]


def judged(results: Results) -> Judged:
    """Every claim with what was found about it."""
    return [(claim, claim.judge(results)) for claim in claims()]


Columns = tuple[tuple[str, str, int | None, float], ...]
"""Columns of a table of metrics: heading, metric, element of it, None for the whole, and factor of what is shown."""

_BALANCE: Columns = (
    ("ZMP error RMS x [mm]", "zmp_error_rms", 0, MM),
    ("y [mm]", "zmp_error_rms", 1, MM),
    ("largest ZMP error x [mm]", "zmp_error_max", 0, MM),
    ("y [mm]", "zmp_error_max", 1, MM),
    ("beyond the 90 % box [mm]", "zmp_excursion_max", None, MM),
    ("ZMP inside it [% of time]", "zmp_inside_fraction", None, PERCENT),
)
_EFFORT: Columns = (
    ("speed [m/s]", "speed_mean", None, 1.0),
    ("knee angle, mean [deg]", "knee_angle_mean", None, 180.0 / math.pi),
    ("cost of transport [-]", "cost_of_transport", None, 1.0),
    ("knee torque RMS [N m]", "knee_torque_rms", None, 1.0),
    ("largest torque [% of limit]", "torque_ratio_max", None, PERCENT),
)


def balance_table(name: str, samples: Iterable[Sample]) -> PageTable:
    """Feasibility, ZMP errors and falls of some samples, study by study."""
    head = ("profile", "world", "fell", "feasible plans [%]", *(column[0] for column in _BALANCE))
    rows: list[TableRow | str] = []
    for sample in samples:
        if sample.study.title not in rows:
            rows.append(sample.study.title)
        rows.append([TableCell(sample.profile), TableCell(WORLD_NAMES[sample.world], "short"), *_balance(sample)])
    return PageTable(name, head, rows)


def _balance(sample: Sample) -> Iterator[TableCell]:
    if not sample.runs:
        yield TableCell("could not run", "bad short")
        yield from (TableCell(MISSING, "number"),) * (1 + len(_BALANCE))
        return
    yield TableCell(
        f"{sample.falls} of {len(sample.runs)}", "short bad" if sample.falls else "short", None, first_fall(sample)
    )
    share = sample.feasible
    yield spread_cell(share, PERCENT, "number" if share is None or share.least >= 1.0 else "number bad")
    for _, metric, element, scale in _BALANCE:
        spread, kind = sample.spread(metric, element), "number past" if sample.falls else "number"
        outside = metric == "zmp_excursion_max" and spread is not None and spread.greatest > 0.0
        yield spread_cell(spread, scale, f"{kind} bad" if outside else kind)


def knee_table(results: Results) -> PageTable:
    """Effort with stretched and with bent knees, gait by gait."""
    rows = []
    for gait in studies.GAITS:
        for knee in studies.KNEES:
            sample = results.sample(studies.knee_study(gait, knee), "default", "full")
            fell = TableCell(fell_text(sample) if sample.runs else "could not run", "bad" if sample.falls else "")
            cells = (spread_cell(sample.spread(metric, part), scale) for _, metric, part, scale in _EFFORT)
            rows.append((TableCell(gait), TableCell(knee), fell, *cells))
    return PageTable("knees", ("gait", "knees", "fell", *(column[0] for column in _EFFORT)), rows)


def shove_table(results: Results) -> PageTable:
    """Table of strong pushes that were survived, with and without adaptation of the footsteps."""
    head = ("adaptation of footsteps", *(f"{direction} [N s]" for direction in studies.SHOVE_DIRECTIONS))
    rows = [
        (
            TableCell(adaptation),
            *(_survived_cell(results.survived(adaptation, way)) for way in studies.SHOVE_DIRECTIONS),
        )
        for adaptation in studies.ADAPTATIONS
    ]
    tried = ", ".join(map(str, studies.SHOVE_IMPULSES))
    return PageTable("shoves", head, rows, f"Largest impulse survived of {tried} N s.")


def _survived_cell(impulses: list[int] | None) -> TableCell:
    if not impulses:
        return TableCell(MISSING if impulses is None else f"less than {min(studies.SHOVE_IMPULSES)}", "number")
    return TableCell(str(max(impulses)), "number", float(max(impulses)))


def provenance(results: Results) -> str:
    """Versions that made the logs, and when."""
    rows = [(escape(name), escape(", ".join(values))) for name, values in results.versions.items()]
    written = sorted(outcome.written.replace("T", " ") for outcome in results.outcomes if outcome.written)
    if written:
        first, last = (date.removesuffix("+00:00") for date in (written[0], written[-1]))
        rows.append(("logs written (UTC)", escape(f"{first} to {last}")))
    return PageTable("versions", ("made by", "version"), rows).html


def runs_table(results: Results) -> str:
    """Every run: how it ended and how to make it again; before them those that could not run, and why."""
    reasons: dict[str, list[str]] = {}
    for outcome in results.failures:
        reasons.setdefault(outcome.failure, []).append(outcome.experiment.folder)
    failed = [(TableCell(", ".join(runs), "bad"), escape(reason)) for reason, runs in reasons.items()]
    rows = [
        (
            escape(outcome.experiment.folder),
            TableCell(outcome.end, "bad" if outcome.failure or outcome.fell else ""),
            tag("code", escape(outcome.experiment.command)),
        )
        for outcome in results.outcomes
    ]
    failures = PageTable("failures", ("could not run", "why"), failed).html if failed else ""
    table = PageTable("runs-table", ("run", "end", "command"), rows, kind="runs").html
    return failures + html.details(f"All {len(rows)} runs with their commands", table, name="all-runs")


_BALANCES: dict[str, tuple[str, tuple[Study, ...]]] = {
    "profiles": (
        "profiles-table",
        (studies.WALK, studies.WIDE_WALK, studies.STEP_LAW, studies.BRISK_WALK, *studies.STAIRS, studies.BRISK_STAIRS),
    ),
    "noise": ("noise-table", (studies.NOISE_WALK, studies.NOISE_STAIRS, studies.NOISE_ALONE, studies.ZMP_ONLY)),
    "height-error": ("height-table", studies.HEIGHTS),
    "pushes": ("push-table", studies.PUSHES),
}
"""Tables of falls and ZMP errors by the section that they stand in: the anchor, and the studies."""


Plates = Mapping[str, Callable[[Results], Figure]]
"""Functions that draw figures, by their anchors; those that it has not got are left out."""


def page(results: Results, plates: Plates = PLATES) -> str:
    """The whole page as HTML, with these figures."""
    found, every = judged(results), sections()
    content = {
        "claims": [_claims_table(found)],
        "runs": [provenance(results) + runs_table(results)],
        **{name: [balance_table(anchor, results.samples(of)).html] for name, (anchor, of) in _BALANCES.items()},
        "energy": [knee_table(results).html],
    }
    content["pushes"].append(shove_table(results).html)
    written = (_section(part, content.get(part.name, []), results, plates) for part in every)
    return html.document(TITLE, "\n".join((_top(results, found), _contents(every), *written)))


def tally(claims: Judged) -> dict[Grade, int]:
    """Number of claims for each verdict."""
    counts = Counter(finding.verdict for _, finding in claims)
    return {verdict: counts[verdict] for verdict in _KINDS}


def _top(results: Results, claims: Judged) -> str:
    boxes = [(str(count), f"claims: {verdict}") for verdict, count in tally(claims).items() if count]
    boxes += [
        (str(len(results.outcomes)), "runs"),
        (str(results.falls), "falls"),
        (str(len(results.failures)), "could not run"),
    ]
    lead = (
        "The experiments of M. Kasaei, N. Lau and A. Pereira, run by Surefoot: on the paper's own plant, on a true "
        "pendulum and in full physics. Every number and every curve on this page is read from the logs of these runs."
    )
    return tag("h1", escape(TITLE)) + tag("p", lead, kind="lead") + tally_html(boxes)


def _contents(every: Sequence[PageSection]) -> str:
    links = (tag("a", escape(section.title), href=f"#{section.name}") for section in every)
    return tag("nav", tag("ol", "".join(tag("li", link) for link in links)))


def _section(part: PageSection, content: Sequence[str], results: Results, plates: Plates) -> str:
    """Its text, its figures, its tables."""
    points = tag("ul", "".join(tag("li", entry) for entry in part.points)) if part.points else ""
    figures = (
        figure_html(plates[one["name"]](results), one["caption"], one["name"], "half" if one.get("half") else "")
        for one in part.figures
        if one["name"] in plates
    )
    text = (tag("p", paragraph) for paragraph in part.text)
    return section(part.title, *text, points, *figures, *content, name=part.name)


def _claims_table(claims: Judged) -> str:
    head = ("the paper says", "the pendulum shows", "full physics shows", "verdict")
    return PageTable("claims-table", head, [_claim_row(*one) for one in claims], kind="claims").html


def _claim_row(claim: Claim, found: Assessment) -> TableRow:
    where = tag("span", f"section {escape(claim.section)}", kind="section", id=claim.name)
    verdict = tag("span", found.verdict, kind=f"verdict {_KINDS[found.verdict]}")
    says = f"{escape(claim.text)} {where}{html.details('rule', escape(claim.rule))}"
    return says, _sentences(found.pendulum), _sentences(found.full), verdict


def _sentences(text: str) -> str:
    """Sentences on lines of their own."""
    return "<br>".join(escape(part.strip()) for part in text.split(". "))


PAGE_NAME, NUMBERS_NAME, RUNS_NAME = "paper.html", "paper.json", "runs"


def paper(
    out: Path,
    jobs: int,
    replace: bool = False,
    every: Sequence[Experiment] | None = None,
    workers: Callable[[Path, int, bool], Sequence[Worker]] = local_workers,
    plates: Plates = PLATES,
) -> tuple[Path, Results]:
    """Run what has not been run and write the page.

    Args:
        out: directory of the page and, below it, of the runs.
        jobs: how many runs at once.
        replace: the page and the numbers of an earlier time; runs that were done are taken as they are.
        every: experiment; all of `experiments` by default.
        workers: makes what makes the runs, as `local_workers`.
        plates: figures of the page.

    Raises:
        LogError: the directory or the page cannot be written, or the page exists.
        InterruptedRunsError: the user stopped it; what was run is kept.
    """
    runs = made_folder(out) / RUNS_NAME
    for name in (PAGE_NAME, NUMBERS_NAME):
        refuse_existing(out / name, replace)
    every = experiments() if every is None else every
    with CampaignBar(len(every), "experiments") as bar:
        results = Results(run_experiments(every, runs, workers(runs, jobs, True), bar))
    return write(results, out, replace, plates)


def write(results: Results, out: Path, replace: bool = False, plates: Plates = PLATES) -> tuple[Path, Results]:
    """Write the page with these figures, and the numbers behind it.

    Raises:
        LogError: they exist or cannot be written.
    """
    with write_whole(out / PAGE_NAME, replace) as temporary:
        temporary.write_text(page(results, plates), encoding="utf-8")
    with write_whole(out / NUMBERS_NAME, replace) as temporary:
        temporary.write_text(json.dumps(_numbers(results), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return out / PAGE_NAME, results


def _numbers(results: Results) -> dict[str, object]:
    claims = [
        {"claim": claim.text, "section": claim.section, "verdict": finding.verdict, "rule": claim.rule,
         "pendulum": finding.pendulum, "full": finding.full}
        for claim, finding in judged(results)
    ]  # fmt: skip
    runs = [
        {"run": outcome.experiment.folder, "command": outcome.experiment.command, "failure": outcome.failure or None,
         "metrics": dict(outcome.metrics), "versions": dict(outcome.versions), "written": outcome.written}
        for outcome in results.outcomes
    ]  # fmt: skip
    return {"claims": claims, "runs": runs}
