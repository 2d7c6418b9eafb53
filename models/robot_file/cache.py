"""Descriptions once derived, kept in the user's cache folder under a digest of all that they are derived from."""

import hashlib
import json
import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, fields
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.models.robot_file.document import MESH, Kind, content, signature
from surefoot.models.types import ImuPlace, JointRoles, RobotDescription, RobotError

_ENGINES = ("pin", "coal", "mujoco", "numpy", "scipy", "fast-simplification")
_KEPT = 64
"""Descriptions in the folder; older ones go."""

_ENTRY = Kind((), "", MESH.most, "")


def digest(files: Iterable[tuple[str, Path | None]]) -> str:
    """Of files, each with what refers to it, of the code that reads them and of the engines' versions.

    Raises:
        RobotError: a file cannot be read.
    """
    sha, read = hashlib.sha256(_code()), dict[tuple[int, ...], str]()
    for reference, file in files:
        key = () if file is None else signature(file)
        if file is not None and key not in read:
            read[key] = hashlib.sha256(content(file, MESH)).hexdigest()
        sha.update(repr((reference, str(file), read.get(key))).encode())
    return sha.hexdigest()


@lru_cache(maxsize=1)
def _code() -> bytes:
    """Digest of everything in this package that a description depends on."""
    sha = hashlib.sha256()
    folder = Path(__file__).parent
    for file in sorted((*folder.glob("*.py"), *folder.parent.glob("*.py"))):
        sha.update(file.read_bytes())
    for name in _ENGINES:
        with suppress(metadata.PackageNotFoundError):
            sha.update(f"{name} {metadata.version(name)} ".encode())
    return sha.digest()


def load(key: str) -> tuple[RobotDescription, tuple[str, ...], tuple[str, ...]] | None:
    """A description with what was derived and noted; None if it is not there or not as it was stored."""
    try:
        seal, _, text = content(_entry(key), _ENTRY).partition(b"\n")
    except RobotError:
        return None
    if seal != _seal(key, text):
        return None
    kept = json.loads(text)
    return _description(kept["description"]), tuple(kept["derived"]), tuple(kept["notes"])


def store(key: str, description: RobotDescription, derived: tuple[str, ...], notes: tuple[str, ...]) -> None:
    """Keep a description; where the folder cannot be written nothing is kept."""
    values = {name: _plain(value) for name, value in asdict(description).items()}
    text = json.dumps({"description": values, "derived": derived, "notes": notes}).encode()
    entry = _entry(key)
    with suppress(OSError):
        entry.parent.mkdir(parents=True, exist_ok=True)
        unfinished = entry.with_suffix(f".{os.getpid()}")
        unfinished.write_bytes(_seal(key, text) + b"\n" + text)
        unfinished.replace(entry)
        for old in sorted(entry.parent.glob("*.json"), key=lambda file: file.lstat().st_mtime)[:-_KEPT]:
            old.unlink()


def _entry(key: str) -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "surefoot" / "robots" / f"{key}.json"


def _seal(key: str, text: bytes) -> bytes:
    """Digest of an entry under its key, by which one that was changed or moved is known."""
    return hashlib.sha256(f"{key}\n".encode() + text).hexdigest().encode()


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _description(values: dict[str, Any]) -> RobotDescription:
    """Back from JSON: lists of numbers are arrays, other lists are tuples."""
    roles, imu = ({name: _tuples(value) for name, value in values.pop(group).items()} for group in ("roles", "imu"))
    found = {}
    for field in fields(RobotDescription):
        if field.name in ("roles", "imu"):
            continue
        value = values[field.name]
        if field.type in ("Array", np.ndarray) or field.name.endswith(("_limit", "_lower", "_upper", "_positions")):
            value = np.array(value, dtype=np.float64)
            value.setflags(write=False)
        found[field.name] = _tuples(value)
    return RobotDescription(roles=JointRoles(**roles), imu=ImuPlace(**imu), **found)


def _tuples(value: Any) -> Any:
    return tuple(_tuples(part) for part in value) if isinstance(value, list) else value
