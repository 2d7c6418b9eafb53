"""Descriptions once derived, kept in the user's cache folder under a digest of all that they are derived from."""

import hashlib
import json
import os
from contextlib import suppress
from dataclasses import asdict, fields
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.models.types import JointRoles, RobotDescription

_ENGINES = ("pin", "coal", "mujoco", "numpy", "scipy", "fast-simplification")
_KEPT = 64
"""Descriptions in the folder; older ones go."""


def digest(files: list[Path]) -> str:
    """Of the content of files, of the code that reads them and of the engines' versions."""
    sha = hashlib.sha256(_code())
    for file in files:
        content = file.read_bytes()
        sha.update(f"{file.name} {len(content)} ".encode())
        sha.update(content)
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
    """A description with what was derived and noted; None if it is not there or cannot be read."""
    try:
        kept = json.loads((_folder() / f"{key}.json").read_text(encoding="utf-8"))
        return _description(kept["description"]), tuple(kept["derived"]), tuple(kept["notes"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def store(key: str, description: RobotDescription, derived: tuple[str, ...], notes: tuple[str, ...]) -> None:
    """Keep a description; where the folder cannot be written nothing is kept."""
    values = {name: _plain(value) for name, value in asdict(description).items()}
    text = json.dumps({"description": values, "derived": derived, "notes": notes})
    folder = _folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        unfinished = folder / f"{key}.{os.getpid()}"
        unfinished.write_text(text, encoding="utf-8")
        unfinished.replace(folder / f"{key}.json")
        for old in sorted(folder.glob("*.json"), key=lambda file: file.stat().st_mtime)[:-_KEPT]:
            old.unlink()


def _folder() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "surefoot" / "robots"


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _description(values: dict[str, Any]) -> RobotDescription:
    """Back from JSON: lists of numbers are arrays, other lists are tuples."""
    roles = JointRoles(**{name: _tuples(value) for name, value in values.pop("roles").items()})
    found = {}
    for field in fields(RobotDescription):
        if field.name == "roles":
            continue
        value = values[field.name]
        if field.type in ("Array", np.ndarray) or field.name.endswith(("_limit", "_lower", "_upper", "_positions")):
            value = np.array(value, dtype=np.float64)
            value.setflags(write=False)
        found[field.name] = _tuples(value)
    return RobotDescription(roles=roles, **found)


def _tuples(value: Any) -> Any:
    return tuple(_tuples(part) for part in value) if isinstance(value, list) else value
