"""A package of one's own to start from: parts of every kind with their tests, written from the files of `template`."""

import keyword
import re
import sys
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.output import reason

if TYPE_CHECKING:
    from collections.abc import Iterator

_NAME = re.compile(r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*")
_LONGEST = 60
_SUFFIX, _DOT = ".tmpl", "dot-"
"""Ending of a file of the template, which is no module of this package; begin of a name that begins with a dot."""


def new(name: str, folder: Path) -> Path:
    """Write a package of that name.

    Args:
        name: of the distribution; its modules have underscores in the place of dashes.
        folder: that gets the package's own folder.

    Returns:
        The package's folder.

    Raises:
        ScenarioError: it is no name of a package, something is there already, or the folder cannot be written.
    """
    module = name.replace("-", "_")
    if not _NAME.fullmatch(name) or len(name) > _LONGEST:
        right = "take small letters and digits with single dashes between them, such as my-package"
        raise ScenarioError([f"{name}: is no name of a package; {right}"])
    if keyword.iskeyword(module) or module in {*sys.stdlib_module_names, "surefoot", "tests"}:
        raise ScenarioError([f"{name}: Python means something else by {module}; take another name"])
    place = folder / name
    try:
        place.mkdir(parents=True)
        for path, text in _template():
            target = place / path.replace("my_package", module)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text.replace("my_package", module).replace("my-package", name), encoding="utf-8")
    except FileExistsError:
        raise ScenarioError([f"{place}: is there already; take another name, or another folder with --out"]) from None
    except OSError as error:
        raise ScenarioError([f"{place}: cannot be written, {reason(error)}; take another folder with --out"]) from None
    return place


def _template(folder: Traversable | None = None, before: str = "") -> "Iterator[tuple[str, str]]":
    """Path and text of every file of the template, in order."""
    folder = folder or files(__package__) / "template"
    for entry in sorted(folder.iterdir(), key=lambda one: one.name):
        name = before + entry.name.replace(_DOT, ".")
        if entry.is_dir():
            yield from _template(entry, f"{name}/")
        elif name.endswith(_SUFFIX):
            yield name.removesuffix(_SUFFIX), entry.read_text(encoding="utf-8")
