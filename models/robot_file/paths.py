"""Where the files of a model are: beside it, or in a package that is installed."""

import os
import re
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from surefoot.models.types import RobotError

SCHEME = "package://"
_EXTRA = ("jvrc_description", "fourier_robot_descriptions")
"""Packages of the extra that brings more robots."""

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,99}")
"""Of a package: it is a folder's name, and none above it."""

_SHARES = ("cmeel.prefix/share", "share")
"""Folders of an environment in which packages put their data, from those of ``sys.path``."""


def is_file(path: Path) -> bool:
    """Whether there is a file; never an error, however the path is spelt."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def resolve(reference: str, beside: Path, key: str = "model") -> Path:
    """The file that a reference means, whether or not it is there.

    Args:
        reference: a path, absolute or from ``beside``, or ``package://NAME/...``; ``file://`` may stand before it.
        beside: folder of the file in which it stands.
        key: of the robot file, for messages.

    Raises:
        RobotError: it is in a package that is not installed, or leaves the package.
    """
    if not reference.startswith(SCHEME):
        return Path(os.path.normpath(beside / reference.removeprefix("file://")))
    name, _, rest = reference.removeprefix(SCHEME).lstrip("/").partition("/")
    rest = os.path.normpath(rest.lstrip("/"))
    if not _NAME.fullmatch(name) or rest.partition("/")[0] == os.pardir:
        what = f"{key} {reference} {'leads out of its' if _NAME.fullmatch(name) else 'names no'} package"
        raise RobotError((key,), what, f"write {SCHEME}NAME/PATH, with a path inside of the package")
    first = None
    for root in _roots(name, beside):
        if is_file(root / rest):
            return root / rest
        if first is None and root.is_dir():
            first = root
    if first is not None:
        return first / rest
    what = f"{key} {reference}: package '{name}' is not installed"
    if name in _EXTRA:
        raise RobotError((key,), what, "pip install 'surefoot[robots]'")
    raise RobotError((key,), what, f"install it, or name in ROS_PACKAGE_PATH the folder that holds '{name}'")


def _roots(name: str, beside: Path) -> Iterator[Path]:
    """Folders that may be the package of that name, the nearest first."""
    yield from (folder / name if folder.name != name else folder for folder in (beside, *beside.parents))
    ros = [Path(place) for place in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if place]
    yield from (place / name for place in ros)
    yield from (place for place in ros if place.name == name)
    yield from (Path(place) / share / name for place in sys.path for share in _SHARES)
    yield from _module(name)


def _module(name: str) -> list[Path]:
    """Folder of the Python package of that name, which is not imported."""
    try:
        spec = find_spec(name) if name.isidentifier() else None
    except (ImportError, ValueError):
        return []
    return [Path(place) for place in (spec.submodule_search_locations or ())] if spec else []
