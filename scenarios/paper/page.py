"""The page, and the command that writes it."""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import yaml

from surefoot.scenarios.loop.run import made_folder
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.paper import studies
from surefoot.scenarios.paper.claim import Claim, Finding, Verdict
from surefoot.scenarios.paper.claims import CLAIMS
from surefoot.scenarios.paper.energy import ENERGY_CLAIMS
from surefoot.scenarios.paper.figures import PLATES, Plate
from surefoot.scenarios.paper.results import Results, run_experiments
from surefoot.scenarios.paper.runs import provenance, runs_table
from surefoot.scenarios.paper.studies import Study, experiments
from surefoot.scenarios.paper.tables import (
    Table,
    balance_table,
    knee_table,
    listing,
    paragraphs,
    shove_table,
    table_html,
)
from surefoot.scenarios.show.html import document, escape, figure_html, tag
from surefoot.scenarios.sweep.engine import local_workers
from surefoot.scenarios.sweep.sweep import CampaignBar


@dataclass(frozen=True, slots=True)
class Section:
    """A section of the page.

    Attributes:
        name: its anchor.
        title: its heading.
        text: paragraphs, as HTML.
        points: entries of a list below them, as HTML.
    """

    name: str
    title: str
    text: tuple[str, ...]
    points: tuple[str, ...] = ()


def sections() -> tuple[Section, ...]:
    """All sections in the order of the page."""
    entries = yaml.safe_load((files(__package__) / "sections.yaml").read_text(encoding="utf-8"))
    return tuple(
        Section(entry["name"], entry["title"], tuple(entry["text"]), tuple(entry.get("points", ())))
        for entry in entries
    )


TITLE = "A Robust Closed-Loop Biped Locomotion Planner Based on Time Varying Model Predictive Control, measured"

_KINDS: dict[Verdict, str] = {
    "holds": "holds",
    "holds with a change": "change",
    "does not hold": "not",
    "not measured": "unknown",
}

Judged = Sequence[tuple[Claim, Finding]]


def judged(results: Results) -> Judged:
    """Every claim with what was found about it."""
    return [(claim, claim.judge(results)) for claim in (*CLAIMS, *ENERGY_CLAIMS)]


def tables(results: Results) -> dict[str, tuple[Table, ...]]:
    """Every table of numbers, by the section that it stands in."""

    def balance(name: str, *chosen: Study) -> Table:
        return balance_table(name, results.samples(chosen))

    plain = (
        studies.WALK,
        studies.WIDE_WALK,
        studies.STEP_LAW,
        studies.BRISK_WALK,
        *studies.STAIRS,
        studies.BRISK_STAIRS,
    )
    return {
        "profiles": (balance("profiles-table", *plain),),
        "noise": (
            balance("noise-table", studies.NOISE_WALK, studies.NOISE_STAIRS, studies.NOISE_ALONE, studies.ZMP_ONLY),
        ),
        "height-error": (balance("height-table", *studies.HEIGHTS),),
        "pushes": (balance("push-table", *studies.PUSHES), shove_table(results)),
        "energy": (knee_table(results),),
    }


def page(results: Results) -> str:
    """The whole page as HTML."""
    claims, numbers = judged(results), tables(results)
    content = {
        "claims": _claims_table(claims),
        "runs": provenance(results) + runs_table(results),
    }
    every = sections()
    written = [_section(section, content.get(section.name, ""), numbers, results) for section in every]
    return document(TITLE, "\n".join((_top(results, claims), _contents(every), *written)))


def tally(claims: Judged) -> dict[Verdict, int]:
    """How many claims have which verdict."""
    counts = Counter(finding.verdict for _, finding in claims)
    return {verdict: counts[verdict] for verdict in _KINDS}


def _top(results: Results, claims: Judged) -> str:
    runs = len(results.outcomes)
    fell = sum(bool(outcome.metrics.get("fell")) for outcome in results.outcomes)
    boxes = [(str(count), f"claims: {verdict}") for verdict, count in tally(claims).items() if count]
    boxes += [(str(runs), "runs"), (str(fell), "falls"), (str(len(results.failures)), "could not run")]
    shown = "".join(tag("div", f"<b>{count}</b>{tag('span', escape(label))}") for count, label in boxes)
    lead = (
        "The experiments of M. Kasaei, N. Lau and A. Pereira, run by Surefoot: on the paper's own plant, on a true "
        "pendulum and in full physics. Every number and every curve on this page is read from the logs of these runs."
    )
    return tag("h1", escape(TITLE)) + tag("p", lead, kind="lead") + tag("div", shown, kind="tally")


def _contents(every: Sequence[Section]) -> str:
    links = (tag("a", escape(section.title), href=f"#{section.name}") for section in every)
    return tag("nav", tag("ol", "".join(tag("li", link) for link in links)))


def _section(section: Section, content: str, numbers: dict[str, tuple[Table, ...]], results: Results) -> str:
    parts = [tag("h2", escape(section.title), id=section.name), paragraphs(section.text), content]
    if section.points:
        parts.insert(2, listing(section.points))
    parts += [_figure(plate, results) for plate in PLATES.get(section.name, ())]
    parts += [table_html(table) for table in numbers.get(section.name, ())]
    return tag("section", "\n".join(part for part in parts if part))


def _figure(plate: Plate, results: Results) -> str:
    return figure_html(plate.draw(results), plate.caption, plate.name, "half" if plate.half else "")


def _claims_table(claims: Judged) -> str:
    heads = ("the paper says", "the pendulum shows", "full physics shows", "verdict")
    head = tag("tr", "".join(tag("th", text, scope="col") for text in heads))
    rows = "\n".join(_claim_row(claim, finding) for claim, finding in claims)
    table = tag("table", f"<thead>{head}</thead>\n<tbody>\n{rows}\n</tbody>", kind="claims", id="claims-table")
    return tag("div", table, kind="wide")


def _claim_row(claim: Claim, finding: Finding) -> str:
    rule = tag("details", tag("summary", "rule") + escape(claim.rule))
    section = tag("span", f"section {escape(claim.section)}", kind="section")
    verdict = tag("span", finding.verdict, kind=f"verdict {_KINDS[finding.verdict]}")
    cells = (
        f"{escape(claim.text)} {section}{rule}",
        _sentences(finding.pendulum),
        _sentences(finding.full),
        verdict,
    )
    return tag("tr", "".join(tag("td", cell) for cell in cells), id=claim.name)


def _sentences(text: str) -> str:
    """Sentences on lines of their own."""
    return "<br>".join(escape(part.strip()) for part in text.split(". "))


PAGE_NAME, NUMBERS_NAME, RUNS_NAME = "paper.html", "paper.json", "runs"


@dataclass(frozen=True, slots=True)
class Written:
    """What the command left behind.

    Attributes:
        page: path of the page.
        runs: how many experiments there are.
        falls: how many fell.
        failures: names of those that gave no result.
        verdicts: how many claims have which verdict.
    """

    page: Path
    runs: int
    falls: int
    failures: tuple[str, ...]
    verdicts: dict[Verdict, int]


def paper(out: Path, jobs: int, replace: bool = False) -> Written:
    """Run what has not been run and write the page.

    Args:
        out: directory of the page and, below it, of the runs.
        jobs: how many runs at once.
        replace: the page and the numbers of an earlier time; runs that were done are taken as they are.

    Raises:
        LogError: the directory or the page cannot be written, or the page exists.
        InterruptedRunsError: the user stopped it; what was run is kept.
    """
    runs = made_folder(out) / RUNS_NAME
    for name in (PAGE_NAME, NUMBERS_NAME):
        refuse_existing(out / name, replace)
    every = experiments()
    with CampaignBar(len(every), "experiments") as bar:
        results = Results(run_experiments(every, runs, local_workers(runs, jobs, keep_all=True), bar))
    return write(results, out, replace)


def write(results: Results, out: Path, replace: bool = False) -> Written:
    """Write the page and the numbers behind it.

    Raises:
        LogError: they exist or cannot be written.
    """
    with write_whole(out / PAGE_NAME, replace) as temporary:
        temporary.write_text(page(results), encoding="utf-8")
    with write_whole(out / NUMBERS_NAME, replace) as temporary:
        temporary.write_text(json.dumps(_numbers(results), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    falls = sum(bool(outcome.metrics.get("fell")) for outcome in results.outcomes)
    failures = tuple(outcome.experiment.folder for outcome in results.failures)
    return Written(out / PAGE_NAME, len(results.outcomes), falls, failures, tally(judged(results)))


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
