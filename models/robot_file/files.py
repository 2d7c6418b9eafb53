"""The files that a model is made of, found in its text without an engine."""

import re
from pathlib import Path

from surefoot.models.robot_file.paths import resolve
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.types import RobotError


def model_files(path: Path) -> tuple[Path, ...]:
    """The file of a model and all that it refers to, as far as they are there.

    Raises:
        RobotError: the file is missing.
    """
    text = text_of(path)
    folders = [
        path.parent,
        *(path.parent / name for name in re.findall(r'(?:mesh|texture|asset)dir\s*=\s*"([^"]*)"', text)),
    ]
    found = [path]
    for reference in sorted(set(re.findall(r'(?:<mesh\b[^>]*?filename|\bfile)\s*=\s*"([^"]+)"', text))):
        try:
            candidates = [resolve(reference, folder) for folder in folders]
        except RobotError:  # of a package that is not there, which whoever needs its meshes says
            continue
        file = next((file for file in candidates if file.is_file() and file not in found), None)
        if file is not None:
            found += model_files(file) if file.suffix in (".xml", ".mjcf") else [file]
    return tuple(found)


def text_of(path: Path) -> str:
    """Text of a model.

    Raises:
        RobotError: it cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise RobotError(("model",), f"{path}: cannot be read, {reason}", "give the path of a URDF or MJCF") from None


def srdf_of(file: RobotFile, path: Path) -> Path | None:
    """The SRDF that the file names, or the one beside the model that is of a robot of its name.

    Raises:
        RobotError: the file names one that is not there.
    """
    if file.srdf is not None:
        place = resolve(file.srdf, path.parent, "srdf")
        if not place.is_file():
            raise RobotError(("srdf",), f"srdf {file.srdf} of {file.name} is not there", f"put it at {place}")
        return place
    of = re.search(r'<robot\b[^>]*\bname\s*=\s*"([^"]*)"', text_of(path))
    beside = [*path.parent.glob("*.srdf"), *(path.parent.parent / "srdf").glob("*.srdf")]
    named = [place for place in sorted(beside) if of and f'name="{of[1]}"' in place.read_text(encoding="utf-8")[:2000]]
    return named[0] if len(named) == 1 else None
