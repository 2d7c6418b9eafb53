"""``surefoot scenario from``: a regression test from the log of an incident."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.lazy import importing
from surefoot.scenarios.show.options import INTERRUPTED, MISSED, AsJson, LogFile, Replace, with_options

if TYPE_CHECKING:
    from surefoot.studies.incident.regression import Trial

_LONGEST = 1e9
"""No log is longer [s]."""

app = typer.Typer(help="Scenarios from what has happened.", no_args_is_help=True)


@app.callback()
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


@app.command("from")
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
