"""The places of a model's files: beside it, or in a package that is installed."""

import os
import re
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote

from surefoot.models.types import RobotError
from surefoot.version import install_command

SCHEME = "package://"
_PACKAGES = ("package", "model")
"""Schemes of what is in a package, by ROS and by Gazebo."""

_EXTRA = ("jvrc_description", "fourier_robot_descriptions")
"""Packages of the extra that brings more robots."""

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,99}")
"""Name of a package: it is a folder's name, and none above it."""

_VARIABLES = ("ROS_PACKAGE_PATH", "GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH")
"""Environment variables with folders of packages."""

_SHARES = ("cmeel.prefix/share", "share")
"""Folders of an environment in which packages put their data, from those of ``sys.path``."""


def is_file(path: Path) -> bool:
    """Return true if there is a file; never an error, however the path is spelt."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def resolve(reference: str, beside: Path, key: str = "model") -> Path:
    """The file that a reference means, whether or not it is there.

    Args:
        reference: a path, absolute or from ``beside``, with ``file://`` before it or not, or ``package://NAME/...``,
            of which ``model://NAME/...`` is another spelling. What is not there as written is sought without its
            percent-encoding, and with slashes for backslashes.
        beside: folder of the file in which it stands.
        key: of the robot file, for messages.

    Raises:
        RobotError: it is in a package that is not installed, leaves the package, or is on a network.
    """
    written = dict.fromkeys((reference, unquote(reference), reference.replace("\\", "/")))
    places = (_place(spelling, beside, key) for spelling in written)
    first = next(places)
    return first if is_file(first) else next((place for place in places if is_file(place)), first)


def _place(reference: str, beside: Path, key: str) -> Path:
    scheme, rest = _split(reference)
    if scheme in _PACKAGES:
        return _in_package(reference, rest, beside, key)
    if scheme not in ("", "file"):
        what = f"{key} {reference} is not on this machine"
        raise RobotError((key,), what, "put a copy of it beside the model, and name that")
    return Path(os.path.normpath(beside / (rest if scheme else reference)))


def _split(reference: str) -> tuple[str, str]:
    """Scheme and path of an address; no scheme where it is a plain path."""
    found = re.match(r"([A-Za-z][A-Za-z0-9+.-]+):/", reference)
    if found is None:
        return "", reference
    scheme, rest = found[1].lower(), reference[found.end() - 1 :]
    if scheme == "file":  # file:///PATH and file://localhost/PATH by RFC 8089, file://PATH as URDFs have it
        return scheme, re.sub("^//(localhost(?=/))?", "", rest)
    return scheme, rest.removeprefix("//")


def _in_package(reference: str, path: str, beside: Path, key: str) -> Path:
    """The file of a package that is meant.

    Raises:
        RobotError: the package is not installed, or the path leaves it.
    """
    name, _, rest = path.lstrip("/").partition("/")
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
        raise RobotError((key,), what, f"install it with: {install_command('robots')}")
    raise RobotError((key,), what, f"install it, or name in ROS_PACKAGE_PATH the folder that holds '{name}'")


def _roots(name: str, beside: Path) -> Iterator[Path]:
    """Folders that may be the package of that name, the nearest first."""
    yield from (folder / name if folder.name != name else folder for folder in (beside, *beside.parents))
    named = (place for variable in _VARIABLES for place in os.environ.get(variable, "").split(os.pathsep))
    ros = [Path(place) for place in named if place]
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
