"""The commands that make many runs: sweep, check, bench and paper."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from surefoot.lazy import importing
from surefoot.scenarios.show.options import (
    INTERRUPTED,
    MISSED,
    AsJson,
    Jobs,
    Replace,
    SeatOf,
    Settings,
    overrides,
    settings,
    with_options,
)

app = typer.Typer()


def _campaigns_from(incomplete: str) -> list[str]:
    """Campaigns that begin so."""
    from surefoot.scenarios.study.campaigns.shipped import shipped

    return [name for name in shipped() if name.startswith(incomplete)]


def _interrupted(folder: Path) -> typer.Exit:
    """Say how to go on."""
    typer.echo(f"interrupted; finished runs are kept in {folder}, the same command goes on from there", err=True)
    return typer.Exit(INTERRUPTED)


@app.command()
def sweep(
    spec: Annotated[
        str,
        typer.Argument(help="A campaign's name, or its specification, a YAML file.", autocompletion=_campaigns_from),
    ],
    policy: SeatOf = None,
    set_: Annotated[list[str] | None, settings("Fix a key, even one that varies")] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Runs of each, over those of the campaign.")] = None,
    jobs: Jobs = None,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this dask scheduler instead.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Directory of the results; runs/NAME by default.")] = None,
    against: Annotated[
        str | None,
        typer.Option(
            metavar="TABLE", help="Hold the thresholds against this table of them; `baseline` for the stored one."
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Run a campaign: a grid, samples or thresholds over any key.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.study.campaigns import against as holding
        from surefoot.scenarios.study.campaigns.campaign import read_campaign
        from surefoot.scenarios.study.campaigns.journal import overlooked
        from surefoot.scenarios.study.campaigns.sweep import InterruptedRunsError, cores
        from surefoot.scenarios.study.campaigns.sweep import sweep as run_sweep

    if jobs is not None and cluster is not None:
        raise typer.BadParameter("--jobs is of this machine; give it without --cluster")
    campaign = read_campaign(spec, overrides(set_, policy=policy), seeds)
    before = None if against is None else holding.table(campaign, against)
    folder = out or Path("runs") / campaign.spec.name
    for text in overlooked(campaign):
        typer.echo(text, err=True)
    try:
        swept = run_sweep(campaign, folder, jobs or cores(), cluster)
    except InterruptedRunsError:
        raise _interrupted(folder) from None
    for text in swept.notes():
        typer.echo(text, err=True)
    if as_json:
        typer.echo(json.dumps(swept.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(swept.lines()))
    good = swept.complete and swept.ran
    if before is not None and good:
        held = before.against(swept.outcomes)
        typer.echo("\n".join(held.lines()), err=as_json)
        good = not held.worse
    raise typer.Exit(0 if good else MISSED)


@dataclass(frozen=True, slots=True)
class CheckOptions:
    """What `surefoot check` is told."""

    scenarios: Annotated[
        list[str] | None, typer.Argument(help="Catalogue names, files or folders; all of the catalogue by default.")
    ] = None
    update: Annotated[bool, typer.Option("--update", help="Write the baselines anew, and show the change.")] = False
    baselines: Annotated[
        Path | None, typer.Option(help="Directory of the baselines; beside the scenario files by default.")
    ] = None
    policy: SeatOf = None
    set_: Settings = None
    jobs: Jobs = None
    out: Annotated[Path, typer.Option(help="Directory of the logs.")] = Path("runs/check")
    junit: Annotated[Path | None, typer.Option(help="Also write JUnit XML to this file.")] = None
    markdown: Annotated[Path | None, typer.Option(help="Also write a summary for a CI page to this file.")] = None
    force: Replace = False


@app.command()
@with_options(CheckOptions)
def check(told: CheckOptions) -> None:
    """Hold scenarios against their baselines."""
    with importing():
        from surefoot.scenarios.output import refuse_existing
        from surefoot.scenarios.study.campaigns.sweep import cores
        from surefoot.scenarios.study.checks import check as checking
        from surefoot.scenarios.study.checks import report

    for report_file in (told.junit, told.markdown):
        if report_file is not None:
            refuse_existing(report_file, told.force)
    chosen = checking.cases(told.scenarios or (), told.baselines, overrides(told.set_, policy=told.policy))
    try:
        found = checking.check(chosen, told.out, told.jobs or cores(), report.print_checked, told.update)
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    if told.junit is not None:
        report.write(told.junit, report.junit(found), told.force)
    if told.markdown is not None:
        report.write(told.markdown, report.markdown(found).encode(), told.force)
    typer.echo(report.summary(found))
    raise typer.Exit(checking.exit_code(found))


BENCHES = ("g1-tour",)
"""Benchmarks, by name."""


def _benches_from(incomplete: str) -> list[str]:
    """Benchmarks that begin so."""
    return [name for name in BENCHES if name.startswith(incomplete)]


def _rows_from(incomplete: str) -> list[str]:
    """Rows of the tour that begin so."""
    from surefoot.scenarios.study.tour.rows import ROWS

    return [name for name in ROWS if name.startswith(incomplete)]


@dataclass(frozen=True, slots=True)
class BenchOptions:
    """What `surefoot bench` is told."""

    name: Annotated[str, typer.Argument(help="Of the benchmark: g1-tour.", autocompletion=_benches_from)]
    row: Annotated[
        list[str] | None, typer.Option(help="This row alone; repeatable, all by default.", autocompletion=_rows_from)
    ] = None
    seeds: Annotated[int, typer.Option(min=1, max=100_000, help="Tours of each row.")] = 24
    seconds: Annotated[float, typer.Option(min=1.0, max=90.0, help="After which a tour is over.")] = 90.0
    workers: Jobs = None
    out: Annotated[Path, typer.Option(help="Directory that keeps every tour.")] = Path("runs/g1-tour")
    as_json: AsJson = False


@app.command()
@with_options(BenchOptions)
def bench(told: BenchOptions) -> None:
    """Send a walker through the tour of a public benchmark, many times.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.errors import ScenarioError, nearest
        from surefoot.scenarios.study.campaigns.sweep import CampaignBar, cores
        from surefoot.scenarios.study.tour.bench import Bench, lines
        from surefoot.scenarios.study.tour.rows import ROWS

    if told.name not in BENCHES:
        raise ScenarioError([f"there is no benchmark '{told.name}'; {nearest(told.name, BENCHES)}"])
    for name in told.row or ():
        if name not in ROWS:
            raise ScenarioError([f"{told.name}: no row '{name}'; {nearest(name, ROWS)}"])
    rows = [name for name in ROWS if name in (told.row or ROWS)]
    tours = Bench(rows, told.seeds, told.out, told.seconds)
    try:
        with CampaignBar(len(tours.left()), "tours") as bar:
            tours.run(told.workers or cores(), lambda _: bar.cell())
    except KeyboardInterrupt:
        raise _interrupted(told.out) from None
    tours.write()
    found = tours.to_json()
    typer.echo(json.dumps(found, allow_nan=False) if told.as_json else "\n".join(lines(found)))
    raise typer.Exit(MISSED if tours.left() else 0)


@app.command()
def paper(
    out: Annotated[Path, typer.Option(help="Directory for the page and its runs.")] = Path("runs/paper"),
    jobs: Jobs = None,
    force: Annotated[bool, typer.Option("--force", "-f", help="Replace the page of an earlier time.")] = False,
) -> None:
    """Run the paper's experiments; write what holds as an HTML page.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.study.campaigns.sweep import InterruptedRunsError, cores
        from surefoot.scenarios.study.paper.page import judged, tally
        from surefoot.scenarios.study.paper.page import paper as run_paper

    try:
        page, results = run_paper(out, jobs or cores(), force)
    except InterruptedRunsError:
        raise _interrupted(out) from None
    for failure in results.failures:
        typer.echo(f"could not run: {failure.experiment.folder}", err=True)
    verdicts = ", ".join(f"{verdict}: {count}" for verdict, count in tally(judged(results)).items() if count)
    typer.echo(f"{len(results.outcomes)} runs, {results.falls} falls, {len(results.failures)} could not run")
    typer.echo(f"claims: {verdicts}")
    typer.echo(str(page))
    raise typer.Exit(MISSED if results.failures else 0)
