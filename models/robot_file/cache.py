"""Descriptions once derived, kept in the user's cache folder under a digest of all that they are derived from."""

import hashlib
import json
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, fields
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.engines import mimic
from surefoot.models import kept
from surefoot.models.robot_file.document import MESH, Kind, content, raw, signature
from surefoot.models.types import Coupling, ImuPlace, JointRoles, RobotDescription, RobotError

_ENGINES = ("pin", "coal", "mujoco", "numpy", "scipy", "fast-simplification")
_ROOM = "robots"
_KEPT = 64
"""Descriptions in the folder; older ones go."""

_ENTRY = Kind((), "", MESH.most, "")


def digest(files: Iterable[tuple[str, Path | None]], code: bytes | None = None) -> str:
    """Digest of files, each with what refers to it, of the code that reads them and of the engines' versions.

    Args:
        files: each with what refers to it.
        code: digest of code and versions, those of this process if None.

    Raises:
        RobotError: a file cannot be read.
    """
    sha, read = hashlib.sha256(_code() if code is None else code), dict[tuple[int, ...], str]()
    for reference, file in files:
        key = () if file is None else signature(file)
        if file is not None and key not in read:
            read[key] = hashlib.sha256(raw(file, MESH)).hexdigest()
        sha.update(repr((reference, str(file), read.get(key))).encode())
    return sha.hexdigest()


@lru_cache(maxsize=1)
def _code() -> bytes:
    """Digest of everything in this package that a description depends on."""
    sha = hashlib.sha256()
    folder = Path(__file__).parent
    for file in (*sorted((*folder.glob("*.py"), *folder.parent.glob("*.py"))), Path(mimic.__file__)):
        sha.update(file.read_bytes())
    for name in _ENGINES:
        with suppress(metadata.PackageNotFoundError):
            sha.update(f"{name} {metadata.version(name)} ".encode())
    return sha.digest()


def load(key: str) -> tuple[RobotDescription, tuple[str, ...], tuple[str, ...]] | None:
    """A description with what was derived and noted; None if it is not there or not as it was stored."""
    try:
        text = kept.opened(key, content(kept.place(_ROOM, key), _ENTRY))
    except RobotError:
        return None
    if text is None:
        return None
    found = json.loads(text)
    return _description(found["description"]), tuple(found["derived"]), tuple(found["notes"])


def store(key: str, description: RobotDescription, derived: tuple[str, ...], notes: tuple[str, ...]) -> None:
    """Keep a description; where the folder cannot be written nothing is kept."""
    values = {name: _plain(value) for name, value in asdict(description).items()}
    text = json.dumps({"description": values, "derived": derived, "notes": notes}).encode()
    kept.store(_ROOM, key, text, _KEPT)


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _description(values: dict[str, Any]) -> RobotDescription:
    """Back from JSON: lists of numbers are arrays, other lists are tuples."""
    roles, imu = ({name: _tuples(value) for name, value in values.pop(group).items()} for group in ("roles", "imu"))
    found: dict[str, Any] = {"couplings": tuple(Coupling(**one) for one in values.pop("couplings"))}
    for field in fields(RobotDescription):
        if field.name in ("roles", "imu", "couplings"):
            continue
        value = values[field.name]
        if field.type in ("Array", np.ndarray) or field.name.endswith(("_limit", "_lower", "_upper", "_positions")):
            value = np.array(value, dtype=np.float64)
            value.setflags(write=False)
        found[field.name] = _tuples(value)
    return RobotDescription(roles=JointRoles(**roles), imu=ImuPlace(**imu), **found)


def _tuples(value: Any) -> Any:
    return tuple(_tuples(part) for part in value) if isinstance(value, list) else value
