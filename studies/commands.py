"""The commands that make many runs: sweep, bench, paper and scenario."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.lazy import importing
from surefoot.scenarios.show.options import (
    INTERRUPTED,
    MISSED,
    AsJson,
    Cluster,
    Jobs,
    LogFile,
    Replace,
    SeatOf,
    overrides,
    settings,
    with_options,
)

if TYPE_CHECKING:
    from surefoot.studies.campaigns.campaign import Campaign
    from surefoot.studies.incident.regression import Trial


def _campaigns_from(incomplete: str) -> list[str]:
    """Campaigns that begin so."""
    from surefoot.studies.campaigns.shipped import shipped

    return [name for name in shipped() if name.startswith(incomplete)]


def _interrupted(folder: Path) -> typer.Exit:
    """Exit with the way to go on."""
    typer.echo(f"interrupted; finished runs are kept in {folder}, the same command goes on from there", err=True)
    return typer.Exit(INTERRUPTED)


@dataclass(frozen=True, slots=True)
class SweepOptions:
    """The arguments of `surefoot sweep`."""

    spec: Annotated[
        str,
        typer.Argument(help="A campaign's name, or its specification, a YAML file.", autocompletion=_campaigns_from),
    ]
    policy: SeatOf = None
    beside: Annotated[
        str | None,
        typer.Option(metavar="ROBOT", help="With --policy: Surefoot's own walk of this robot, under the same pushes."),
    ] = None
    set_: Annotated[list[str] | None, settings("Fix a key, even one that varies")] = None
    seeds: Annotated[int | None, typer.Option(min=1, help="Runs of each, over those of the campaign.")] = None
    jobs: Jobs = None
    cluster: Cluster = None
    out: Annotated[Path | None, typer.Option(help="Directory of the results; runs/NAME by default.")] = None
    against: Annotated[
        str | None,
        typer.Option(
            metavar="TABLE", help="Hold the thresholds against this table of them; `baseline` for the stored one."
        ),
    ] = None
    as_json: AsJson = False


@with_options(SweepOptions)
def sweep(options: SweepOptions) -> None:
    """Run a campaign: a grid, samples or thresholds over any key.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.many.journal import overlooked
        from surefoot.scenarios.many.slots import InterruptedRunsError
        from surefoot.scenarios.run.processes import cores
        from surefoot.studies.campaigns import against as holding
        from surefoot.studies.campaigns.sweep import sweep as run_sweep

    if options.jobs is not None and options.cluster is not None:
        raise typer.BadParameter("--jobs is of this machine; give it without --cluster")
    campaign = _campaign(options)
    before = None if options.against is None else holding.table(campaign, options.against)
    folder = options.out or Path("runs") / campaign.spec.name
    for text in overlooked(campaign.spec.model_dump(mode="json"), campaign.bases.values()):
        typer.echo(text, err=True)
    try:
        swept = run_sweep(campaign, folder, options.jobs or cores(), options.cluster)
    except InterruptedRunsError:
        raise _interrupted(folder) from None
    for text in swept.notes():
        typer.echo(text, err=True)
    if options.as_json:
        typer.echo(json.dumps(swept.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(swept.lines()))
    good = swept.complete and swept.ran
    if before is not None and good:
        held = before.against(swept.outcomes)
        typer.echo("\n".join(held.lines()), err=options.as_json)
        good = not held.worse
    raise typer.Exit(0 if good else MISSED)


def _campaign(options: SweepOptions) -> "Campaign":
    """The campaign that is asked for, with a policy alone or beside a walk."""
    from surefoot.studies.campaigns.beside import Beside
    from surefoot.studies.campaigns.campaign import read_campaign

    if options.beside is None:
        return read_campaign(options.spec, overrides(options.set_, policy=options.policy), options.seeds)
    if options.policy is None or options.against is not None:
        raise typer.BadParameter("--beside lays a walk beside a policy; give it with --policy and without --against")
    beside = Beside(options.policy, options.beside)
    return read_campaign(options.spec, overrides(options.set_), options.seeds, beside)


BENCHES = ("g1-tour", "g1-side")
"""Benchmarks, by name."""


def _benches_from(incomplete: str) -> list[str]:
    """Benchmarks that begin so."""
    return [name for name in BENCHES if name.startswith(incomplete)]


def _rows_from(incomplete: str) -> list[str]:
    """Rows of the tour that begin so."""
    from surefoot.studies.tour.rows import ROWS

    return [name for name in ROWS if name.startswith(incomplete)]


@dataclass(frozen=True, slots=True)
class BenchOptions:
    """The arguments of `surefoot bench`."""

    name: Annotated[str, typer.Argument(help="Of the benchmark: g1-tour or g1-side.", autocompletion=_benches_from)]
    row: Annotated[
        list[str] | None, typer.Option(help="This row alone; repeatable, all by default.", autocompletion=_rows_from)
    ] = None
    policy: Annotated[
        list[Path] | None, typer.Option(help="A policy's contract or folder, in place of all rows; repeatable.")
    ] = None
    start: Annotated[str, typer.Option(help="On the feet, or let go by the crane of the benchmark.")] = "feet"
    draws: Annotated[str, typer.Option(help="own random numbers, or those of the benchmark's runs.")] = "own"
    seeds: Annotated[int, typer.Option(min=1, max=100_000, help="Tours of each row.")] = 24
    seconds: Annotated[float, typer.Option(min=1.0, max=90.0, help="After which a tour is over.")] = 90.0
    workers: Jobs = None
    out: Annotated[Path | None, typer.Option(help="Directory of the results; runs/NAME by default.")] = None
    as_json: AsJson = False


@with_options(BenchOptions)
def bench(options: BenchOptions) -> None:
    """Send walkers of the G1 through a public benchmark.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.errors import ScenarioError, nearest

    if options.name not in BENCHES:
        raise ScenarioError([f"there is no benchmark '{options.name}'; {nearest(options.name, BENCHES)}"])
    folder = options.out or Path("runs") / options.name
    {"g1-tour": _tour, "g1-side": _side}[options.name](options, folder)


def _tour(options: BenchOptions, folder: Path) -> None:
    """Send walkers through the tour."""
    with importing():
        from surefoot.scenarios.many.slots import CampaignBar
        from surefoot.scenarios.run.processes import cores
        from surefoot.studies.tour.bench import Bench, lines
        from surefoot.studies.tour.entrants import entrants, setting

    taking_part = entrants(options.row or (), options.policy or ())
    tours = Bench(taking_part, options.seeds, folder, options.seconds, setting(options.start, options.draws))
    try:
        with CampaignBar(len(tours.left()), "tours") as bar:
            tours.run(options.workers or cores(), lambda _: bar.cell())
    except KeyboardInterrupt:
        raise _interrupted(folder) from None
    tours.write()
    found = tours.to_json()
    typer.echo(json.dumps(found, allow_nan=False) if options.as_json else "\n".join(lines(found)))
    raise typer.Exit(MISSED if tours.left() else 0)


def _side(options: BenchOptions, folder: Path) -> None:
    """Lay walkers beside each other."""
    with importing():
        from surefoot.scenarios.errors import ScenarioError
        from surefoot.scenarios.many.slots import CampaignBar
        from surefoot.scenarios.run.processes import cores
        from surefoot.studies.tour.entrants import entrants
        from surefoot.studies.tour.side import Side
        from surefoot.studies.tour.side_page import markdown

    if (options.start, options.draws, options.seconds) != ("feet", "own", 90.0):
        raise ScenarioError(["g1-side: has no start, draws or seconds; leave out --start, --draws and --seconds"])
    side = Side(entrants(options.row or ("contract",), options.policy or ()), options.seeds, folder)
    try:
        with CampaignBar(len(side.left()), "pieces") as bar:
            side.run(options.workers or cores(), bar.cell)
    except KeyboardInterrupt:
        raise _interrupted(folder) from None
    side.write()
    found = side.to_json()
    typer.echo(json.dumps(found, allow_nan=False) if options.as_json else markdown(found))
    raise typer.Exit(MISSED if side.left() else 0)


def paper(
    out: Annotated[Path, typer.Option(help="Directory for the page and its runs.")] = Path("runs/paper"),
    jobs: Jobs = None,
    force: Annotated[bool, typer.Option("--force", "-f", help="Replace the page of an earlier time.")] = False,
) -> None:
    """Run the paper's experiments; write what holds as an HTML page.

    Begun again, it goes on where it stopped.
    """
    with importing():
        from surefoot.scenarios.many.slots import InterruptedRunsError
        from surefoot.scenarios.run.processes import cores
        from surefoot.studies.paper.page import judged, tally
        from surefoot.studies.paper.page import paper as run_paper

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


_LONGEST = 1e9
"""No log is longer [s]."""

scenario = typer.Typer(help="Scenarios from what has happened.", no_args_is_help=True)


@scenario.callback()
def _scenario() -> None:
    """Make scenarios from what has happened."""


@dataclass(frozen=True, slots=True)
class FromOptions:
    """The arguments of `surefoot scenario from`."""

    log: LogFile
    around: Annotated[
        float | None, typer.Option(metavar="T", min=0.0, help="Moment to show; that of the incident by default [s].")
    ] = None
    seconds: Annotated[
        float | None,
        typer.Option(metavar="S", min=0.0, help="Begin in the state of the log so long before; 2 with --around [s]."),
    ] = None
    out: Annotated[Path | None, typer.Option(help="File to write; NAME-incident.yaml by default.")] = None
    whole: Annotated[bool, typer.Option("--whole", help="Keep all that acted, also what is not needed.")] = False
    force: Replace = False
    as_json: AsJson = False


@scenario.command("from")
@with_options(FromOptions)
def from_(options: FromOptions) -> None:
    """Write the smallest scenario that shows the incident of a log."""
    with importing():
        from surefoot.scenarios.errors import LogError
        from surefoot.scenarios.output import refuse_existing
        from surefoot.studies.incident import report
        from surefoot.studies.incident.regression import Incident, Trials, regression, write

    seconds = options.seconds
    for name, time in (("--around", options.around), ("--seconds", seconds)):
        if time is not None and not time <= _LONGEST:
            raise typer.BadParameter(f"{name} {time} is no time of a log; give seconds, such as 2.5")
    if options.out is not None and not options.out.parent.is_dir():
        raise LogError(f"{options.out}: cannot be written, there is no such folder; choose another file with --out")
    incident = Incident.of(options.log)
    path = options.out or Path(f"{incident.scenario.name}-incident.yaml")
    refuse_existing(path, options.force)
    trials = Trials(incident, incident.name_of(path), _say)
    try:
        found = regression(incident, trials, options.around, seconds, small=not options.whole)
        last = None
        if found.comes_back:
            write(found, path, report.comment(found, path), options.force)
            last = trials.of_file(path)
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    if options.as_json:
        typer.echo(json.dumps(report.to_json(found, path, last), allow_nan=False))
    else:
        typer.echo("\n".join(report.lines(found, path, last)))
    raise typer.Exit(0 if last is not None and last.same else MISSED)


def _say(trial: "Trial") -> None:
    """Say what became of a trial, while others are made."""
    acted = ", ".join(cause.text.partition(" ")[0] for cause in trial.causes) or "nothing"
    typer.echo(f"with {acted}: {trial.text}", err=True)
