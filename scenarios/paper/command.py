"""``surefoot paper``: runs the experiments, writes the page, and the numbers behind it as JSON."""

import json
import os
from dataclasses import dataclass
from pathlib import Path

from surefoot.scenarios.loop.run import made_folder
from surefoot.scenarios.paper.claim import Verdict
from surefoot.scenarios.paper.page import judged, page, tally
from surefoot.scenarios.paper.results import Results
from surefoot.scenarios.paper.runner import ExperimentBar, run_all
from surefoot.scenarios.paper.studies import experiments
from surefoot.scenarios.show.replay.content import write_whole

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


def cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def paper(out: Path, jobs: int) -> Written:
    """Run what has not been run and write the page.

    Args:
        out: directory of the page and, below it, of the runs.
        jobs: how many runs at once.

    Raises:
        LogError: the directory or the page cannot be written.
        InterruptedRunsError: the user stopped it; what was run is kept.
    """
    runs = made_folder(out / RUNS_NAME)
    every = experiments()
    with ExperimentBar(len(every)) as bar:
        results = Results(run_all(every, runs, jobs, bar))
    return write(results, out)


def write(results: Results, out: Path) -> Written:
    """Write the page and the numbers behind it.

    Raises:
        LogError: they cannot be written.
    """
    with write_whole(out / PAGE_NAME) as temporary:
        temporary.write_text(page(results), encoding="utf-8")
    with write_whole(out / NUMBERS_NAME) as temporary:
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
