"""Files by kind and name, which floors above the core and other packages bring, for `list` and `show`.

[project.entry-points."surefoot.files"]
campaign = "my_package.campaigns:files"    # a function without arguments: paths of texts by name
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from surefoot.errors import PluginError
from surefoot.parts.guard import MisfitError, shown
from surefoot.parts.plugins import Registry
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.source import decoded
from surefoot.scenarios.output import reason

FILES: Registry[Callable[[], Mapping[str, Path]]] = Registry("surefoot.files", None, {})
"""Functions by the kind of the files."""


class Brought(NamedTuple):
    """Files of a kind: paths by name, and the package that brings them."""

    files: Mapping[str, Path]
    package: str


def brought() -> tuple[dict[str, Brought], tuple[str, ...]]:
    """Files by kind, and a sentence for each kind whose package cannot be used."""
    found: dict[str, Brought] = {}
    refused: list[str] = []
    for kind in FILES:
        try:
            files = FILES.guard(kind).function(FILES[kind], _taken)()
        except PluginError as error:
            refused.append(f"files {error}")
        else:
            found[kind] = Brought(files, FILES.package(kind))
    return found, tuple(refused)


def content(path: Path) -> str:
    """Text of a file.

    Raises:
        ScenarioError: it cannot be read, is too large, or no UTF-8.
    """
    try:
        with path.open("rb") as file:
            return decoded(file, str(path))
    except OSError as error:
        raise ScenarioError([f"{path}: cannot be read, {reason(error)}; mend or remove it"]) from None


def first_line(path: Path) -> str:
    """The first comment line of a file, which says what it is; empty where it cannot be read."""
    try:
        return content(path).split("\n", 1)[0].lstrip("# ")
    except ScenarioError:
        return ""


def _taken(answer: Any) -> Mapping[str, Path]:
    """The answer of a function of another package, if it is what it should be.

    Raises:
        MisfitError: it is not.
    """
    whole = isinstance(answer, Mapping)
    if whole and all(isinstance(name, str) and isinstance(path, Path) for name, path in answer.items()):
        return dict(answer)
    raise MisfitError(f"gave {shown(answer)}, which has no paths by name")
