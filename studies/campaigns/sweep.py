"""``surefoot sweep``: runs a campaign and writes its tables and its page."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import yaml

from surefoot.maths.chance import wilson
from surefoot.scenarios.many.journal import Journal, outcome_of
from surefoot.scenarios.many.points import Outcome, Record, Runs, RunStatus, facts
from surefoot.scenarios.many.slots import CampaignBar, InterruptedRunsError, run_cells, workers_of
from surefoot.scenarios.output import write_whole
from surefoot.studies.campaigns import reached
from surefoot.studies.campaigns.campaign import Campaign
from surefoot.studies.campaigns.points import cells
from surefoot.studies.campaigns.reached import reached_lines, varied
from surefoot.studies.campaigns.table import (
    has_parquet,
    runs_table,
    threshold_lines,
    thresholds_table,
    write_table,
)
from surefoot.version import install_command

SPEC_FILE, PAGE, RUNS_TABLE, THRESHOLDS_TABLE = "campaign.yaml", "report.html", "table", "thresholds"
STATUSES: tuple[RunStatus, ...] = get_args(RunStatus)


@dataclass(frozen=True, slots=True)
class Swept:
    """A campaign that was run.

    Attributes:
        campaign: its specification.
        folder: where its results are.
        outcomes: of its cells, in order.
        stale: results of other versions that were made anew.
    """

    campaign: Campaign
    folder: Path
    outcomes: tuple[Outcome, ...]
    stale: int = 0

    @property
    def runs(self) -> Runs:
        """Every run with what became of it."""
        return tuple(run for outcome in self.outcomes for run in outcome.runs)

    @property
    def facts(self) -> Runs:
        """Every run but those that only repeat another."""
        return facts(self.runs)

    @property
    def records(self) -> tuple[Record, ...]:
        """Results of every run."""
        return tuple(record for _, record in self.runs)

    def count(self, status: str) -> int:
        """Number of runs that ended so."""
        return sum(record.status == status for record in self.records)

    @property
    def complete(self) -> bool:
        """True if every cell has a result."""
        return all(outcome.complete for outcome in self.outcomes)

    @property
    def ran(self) -> bool:
        """True if any run was accepted."""
        return self.count("pass") + self.count("fail") > 0

    @property
    def files(self) -> tuple[Path, ...]:
        """The page and the tables."""
        tables = (f"{name}{ending}" for name in (THRESHOLDS_TABLE, RUNS_TABLE) for ending in (".csv", ".parquet"))
        return tuple(path for path in (self.folder / name for name in (PAGE, *tables)) if path.exists())

    def repeats(self) -> Iterator[str]:
        """Note on runs that only repeat another, a sentence if there are any."""
        runs, facts = len(self.runs), len(self.facts)
        if facts < runs:
            then = "they count once" if self.campaign.spec.bisect is None else "more seeds find no other threshold"
            alike = f"{runs - facts} of {runs} runs are those of another seed to the digit"
            yield f"{alike}, since nothing in them is random; {then}"

    def notes(self) -> Iterator[str]:
        """Notes on the result, a sentence each."""
        yield from self.repeats()
        if self.stale:
            others = "of another robot, another code or other versions, or lacked their log"
            yield f"{self.stale} results were {others}, and were not taken over"
        if not has_parquet():
            yield f"no parquet is written; install it with: {install_command('parquet')}"
        broken = (reason for record in self.records if record.status == "broken" for reason in record.reasons)
        yield from (f"a run gave no result: {reason}" for reason in dict.fromkeys(broken))
        if not self.ran:
            refused = next((record.reasons for record in self.records if record.status == "refused"), ())
            yield from (f"every run was refused, the first since {reason}" for reason in refused)

    def lines(self) -> Iterator[str]:
        """The result for a person."""
        runs = len(self.records)
        counts = ", ".join(f"{n} {status}" for status in STATUSES if (n := self.count(status)))
        yield f"{self.campaign.spec.name}: {runs} runs" + (f", {counts}" if counts else "")
        if self.campaign.spec.bisect is None and self.ran and not varied(self):
            judged = [record.status for _, record in self.facts if record.status in ("pass", "fail")]
            rate = wilson(judged.count("pass"), len(judged))
            yield f"success rate {100 * rate.rate:.1f} %, 95 % interval {rate.between} %"
        yield from threshold_lines(self.outcomes)
        yield from reached_lines(self)
        yield from map(str, reversed(self.files))

    def to_json(self) -> dict[str, Any]:
        """The result as one JSON object."""
        counts: dict[str, Any] = {status: self.count(status) for status in STATUSES}
        files = [path.name for path in self.files]
        name, runs = self.campaign.spec.name, len(self.records)
        counts["repeated"] = runs - len(self.facts)
        common = {"campaign": name, "runs": runs, **counts, "out": str(self.folder), "files": files}
        return {**common, **reached.to_json(self)}


def sweep(campaign: Campaign, out: Path, jobs: int, cluster: str | None = None) -> Swept:
    """Run what has no result yet, and write tables and page.

    Args:
        campaign: to run.
        out: its directory.
        jobs: runs at once on this machine.
        cluster: address of a dask scheduler, to run there.

    Raises:
        LogError: something cannot be written.
        ScenarioError: the cluster cannot be reached or used.
        InterruptedRunsError: the user stopped it; tables and page are of what was done.
    """
    keep_all, every = campaign.spec.keep == "all", tuple(cells(campaign))
    workers = workers_of(out, jobs, cluster, keep_all)
    with Journal(out, keep_all) as journal:
        stopped: InterruptedRunsError | None = None
        try:
            with CampaignBar(len(every), "searches" if campaign.spec.bisect else "runs") as bar:
                run_cells(every, journal, workers, bar.run, bar.cell)
        except InterruptedRunsError as error:
            stopped = error
        swept = Swept(campaign, out, tuple(outcome_of(cell, journal) for cell in every), journal.stale)
        write(swept)
    if stopped is not None:
        raise stopped
    return swept


def write(swept: Swept) -> None:
    """Write what a campaign found; files of an earlier time are replaced.

    Raises:
        LogError: one cannot be written.
    """
    from surefoot.studies.campaigns.report import page

    spec = swept.campaign.spec.model_dump(mode="json", exclude_defaults=True)
    with write_whole(swept.folder / SPEC_FILE, replace=True) as temporary:
        temporary.write_text(yaml.safe_dump(spec, sort_keys=False), encoding="utf-8")
    write_table(runs_table(swept.outcomes), swept.folder / RUNS_TABLE)
    if swept.campaign.spec.bisect is not None:
        write_table(thresholds_table(swept.outcomes), swept.folder / THRESHOLDS_TABLE)
    with write_whole(swept.folder / PAGE, replace=True) as temporary:
        temporary.write_text(page(swept), encoding="utf-8")
