"""``surefoot check``: holds scenarios against their baselines."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from surefoot.lazy import importing
from surefoot.scenarios.show.options import (
    INTERRUPTED,
    AsJson,
    Cluster,
    Jobs,
    Replace,
    SeatOf,
    Settings,
    overrides,
    with_options,
)

app = typer.Typer()


@dataclass(frozen=True, slots=True)
class CheckOptions:
    """The arguments of `surefoot check`."""

    scenarios: Annotated[
        list[str] | None, typer.Argument(help="Catalogue names, files or folders; all of the catalogue by default.")
    ] = None
    update: Annotated[bool, typer.Option("--update", help="Write the baselines anew, and show the change.")] = False
    baselines: Annotated[
        Path | None, typer.Option(help="Directory of the baselines; beside the scenario files by default.")
    ] = None
    policy: SeatOf = None
    seeds: Annotated[
        int | None,
        typer.Option(min=1, help="Runs of each at most; as its file or its baseline says by default, or one."),
    ] = None
    set_: Settings = None
    jobs: Jobs = None
    cluster: Cluster = None
    out: Annotated[Path, typer.Option(help="Directory of the logs.")] = Path("runs/check")
    junit: Annotated[Path | None, typer.Option(help="Also write JUnit XML to this file.")] = None
    markdown: Annotated[Path | None, typer.Option(help="Also write a summary for a CI page to this file.")] = None
    history: Annotated[
        Path | None, typer.Option(help="Also keep what was found in this folder, for `surefoot history`.")
    ] = None
    pictures_at: Annotated[
        str | None, typer.Option(metavar="URL", help="Address of the history's folder, for pictures in --markdown.")
    ] = None
    annotations: Annotated[
        bool, typer.Option("--annotations", help="Also print findings as GitHub shows them beside a file.")
    ] = False
    force: Replace = False
    as_json: AsJson = False


@app.command()
@with_options(CheckOptions)
def check(options: CheckOptions) -> None:
    """Hold scenarios against their baselines."""
    if options.annotations and options.as_json:
        raise typer.BadParameter("--json prints nothing beside it; give it without --annotations")
    with importing():
        from surefoot.scenarios.check import check as checking
        from surefoot.scenarios.check import record, report, seeds
        from surefoot.scenarios.check.annotations import annotations
        from surefoot.scenarios.check.history import Keeper
        from surefoot.scenarios.check.pictures import Gallery
        from surefoot.scenarios.check.requirements import Requirements
        from surefoot.scenarios.many.slots import InterruptedRunsError
        from surefoot.scenarios.output import refuse_existing
        from surefoot.scenarios.run.processes import cores

    for report_file in (options.junit, options.markdown):
        if report_file is not None:
            refuse_existing(report_file, options.force)
    chosen = checking.cases(options.scenarios or (), options.baselines, overrides(options.set_, policy=options.policy))
    keeper = None if options.history is None else Keeper(options.history)
    show: Callable[[checking.Checked], None] = (lambda _: None) if options.as_json else report.print_checked
    how = (options.jobs or cores(), options.seeds, options.cluster, options.update, keeper)
    running = seeds.Running(options.out, *how)
    try:
        found = seeds.check(chosen, running, show)
    except InterruptedRunsError:
        kept = options.out / seeds.FOLDER
        typer.echo(f"interrupted; finished runs are kept in {kept}, the same command goes on from there", err=True)
        raise typer.Exit(INTERRUPTED) from None
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    requirements = Requirements.of(found)
    if options.junit is not None:
        report.write(options.junit, report.junit(found), options.force)
    if options.markdown is not None:
        gallery = Gallery.of(options.history, options.markdown, options.pictures_at)
        report.write(options.markdown, report.markdown(found, requirements, gallery).encode(), options.force)
    for line in annotations(found) if options.annotations else ():
        typer.echo(line)
    if options.as_json:
        typer.echo(json.dumps(record.to_json(found, requirements), allow_nan=False))
    else:
        typer.echo("\n".join([*requirements.lines, report.summary(found)]))
    raise typer.Exit(checking.exit_code(found))


@dataclass(frozen=True, slots=True)
class HistoryOptions:
    """The arguments of `surefoot history`."""

    folder: Annotated[Path, typer.Argument(help="A folder that `surefoot check --history` has written to.")]
    out: Annotated[Path | None, typer.Option(help="Also write the page with all trends to this .html file.")] = None
    force: Replace = False
    as_json: AsJson = False


@app.command()
@with_options(HistoryOptions)
def history(options: HistoryOptions) -> None:
    """Tell which commits changed something, by checks that were kept."""
    with importing():
        from surefoot.scenarios.check import history_page
        from surefoot.scenarios.check.history import History
        from surefoot.scenarios.output import refuse_existing, write_whole

    if options.out is not None:
        refuse_existing(options.out, options.force)
    found = History(options.folder)
    if options.as_json:
        typer.echo(json.dumps(history_page.to_json(found), allow_nan=False))
    else:
        walks = history_page.walks(found)
        typer.echo("\n".join(history_page.summary(walks)) or "no commit changed anything")
    if options.out is not None:
        with write_whole(options.out, options.force) as temporary:
            temporary.write_text(history_page.page(found), encoding="utf-8")
        typer.echo(str(options.out), err=True)
    for note in dict.fromkeys(found.notes):
        typer.echo(f"note: {note}", err=True)
