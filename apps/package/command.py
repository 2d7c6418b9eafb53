"""``surefoot new``: a package of one's own, or a workflow for CI, to start from."""

from enum import StrEnum
from pathlib import Path
from shlex import quote
from typing import Annotated

import typer


class Server(StrEnum):
    """A kind of CI server."""

    GITHUB = "github"
    GITLAB = "gitlab"


def new(
    name: Annotated[str | None, typer.Argument(help="Of the package, such as my-package.")] = None,
    out: Annotated[Path, typer.Option(help="Directory that gets the package's own folder, or the workflow.")] = Path(),
    ci: Annotated[
        Server | None, typer.Option(help="Write a workflow for this CI server, which checks the folder walks.")
    ] = None,
) -> None:
    """Write a package with parts of one's own, or a workflow of CI."""
    if name is None and ci is None:
        raise typer.BadParameter("give the name of a package, or --ci with github or gitlab")
    from surefoot.apps.package.ci import add_ci
    from surefoot.apps.package.new import new as write

    place = out if name is None else write(name, out)
    written = () if ci is None else add_ci(ci.value, place, "" if name is None else "-e .")
    for line in (*(() if name is None else (place,)), *written):
        typer.echo(str(line))
    there = "" if place == Path() else f"cd {quote(str(place))} && "
    follow = [] if name is None else ["pip install -e '.[test]'", "pytest"]
    follow += [] if ci is None else ["surefoot check walks --update", "git add --all"]
    typer.echo(f"next: {there}{' && '.join(follow)}")
