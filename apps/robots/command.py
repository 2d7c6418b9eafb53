"""``surefoot robot``: what a robot of one's own is worth, and a first file for it."""

import json
from pathlib import Path
from typing import Annotated

import typer

from surefoot.scenarios.show.options import INTERRUPTED, MISSED, AsJson, Jobs, Replace

app = typer.Typer(help="Check a robot of one's own, or write a first file for it.", no_args_is_help=True)


@app.command()
def check(
    robot: Annotated[str, typer.Argument(metavar="FILE", help="A robot file, or the name of a robot.")],
    walk: Annotated[bool, typer.Option("--walk", help="Run the scenarios that it accepts.")] = False,
    only: Annotated[
        list[str] | None, typer.Option(metavar="SCENARIO", help="Of the catalogue this scenario alone; repeatable.")
    ] = None,
    jobs: Jobs = None,
    out: Annotated[Path, typer.Option(help="Directory of the logs.")] = Path("runs/robot"),
    as_json: AsJson = False,
) -> None:
    """Print what was derived of a robot, measure it, and list the scenarios that it takes."""
    from surefoot.apps.robots.examine import examine, known, print_examination, to_json
    from surefoot.apps.robots.taken import CatalogueBar, chosen, rows, summary
    from surefoot.scenarios.run.processes import cores

    names = chosen(only or ())
    explained = known(robot)
    found = examine(explained.description)
    if not as_json:
        print_examination(explained, found)
    try:
        with CatalogueBar(names, not as_json) as bar:
            table = bar.shown(rows(robot, names, walk, jobs or cores(), out, bar.begun))
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    if as_json:
        shown = {**to_json(explained, found), "scenarios": [row.to_json() for row in table]}
        typer.echo(json.dumps(shown, allow_nan=False))
    else:
        typer.echo(summary(table))
    sound = not found.faults and any(row.outcome in ("walks", "accepted") for row in table)
    raise typer.Exit(0 if sound and not any(row.outcome == "fails" for row in table) else MISSED)


@app.command()
def new(
    model: Annotated[str, typer.Argument(help="URDF or MJCF: a path, or package://NAME/...")],
    out: Annotated[
        Path | None, typer.Option(help="Write it to this file, once it is made, rather than print it.")
    ] = None,
    force: Replace = False,
) -> None:
    """Print or write a first robot file for a model.

    One that is printed is to be saved where the model's path is right. A xacro is expanded into a URDF beside it, where
    the package `xacro` is installed.
    """
    from surefoot.apps.robots.first import first_file, written
    from surefoot.models.types import RobotError
    from surefoot.scenarios.errors import ScenarioError

    try:
        made, notes = first_file(model, Path() if out is None else out.parent)
    except RobotError as error:
        raise ScenarioError([str(error)]) from None
    for line in notes:
        typer.echo(line, err=True)
    if out is None:
        typer.echo(made.text, nl=False)
    else:
        written(out, made.text, force)
        typer.echo(f"robot file: {out}")
    if made.refusal:
        typer.echo(f"not yet usable: {made.refusal}", err=True)
        raise typer.Exit(MISSED)
