"""``surefoot new``: a package of one's own, to start from."""

from pathlib import Path
from shlex import quote
from typing import Annotated

import typer


def new(
    name: Annotated[str, typer.Argument(help="Of the package, such as my-package.")],
    out: Annotated[Path, typer.Option(help="Directory that gets the package's own folder.")] = Path(),
) -> None:
    """Write a package with parts of one's own, to start from."""
    from surefoot.apps.package.new import new as write

    place = write(name, out)
    typer.echo(f"{place}\nnext: cd {quote(str(place))} && pip install -e '.[test]' && pytest")
