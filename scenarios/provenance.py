"""Where a run comes from: versions of the packages, of the interpreter and of the code."""

import hashlib
import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("surefoot", "mujoco", "pin", "proxsuite", "qpsolvers", "daqp", "quadprog", "numpy", "scipy", "mcap")
CODE = ("planner", "wbc", "sim", "models", "scenarios")
READERS = ("scenarios/paper", "scenarios/report", "scenarios/replay")
"""Folders of the code, and those in it that only read logs: no run depends on them."""

ABSENT = "not installed"
"""Version of a package that is not there, as of a source tree that was never installed."""


def versions() -> dict[str, str]:
    """Versions of all that a result may depend on, by name."""
    return {
        **{name: _version(name) for name in PACKAGES},
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}",
        "git_revision": _git_revision(),
        "source_digest": source_digest(Path(__file__).parents[1]),
    }


def source_digest(root: Path) -> str:
    """Digest of the code that makes runs, as it is on the disk: tells apart what a revision with ``-dirty`` cannot.

    Args:
        root: folder that holds the code's folders.
    """
    digest = hashlib.sha256()
    for path in sorted(path for folder in CODE for path in (root / folder).rglob("*.py")):
        name = path.relative_to(root).as_posix()
        if not name.startswith(READERS):
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ABSENT


def _git_revision() -> str:
    """Commit of the source tree, with ``-dirty`` when it was changed; empty when it is not under git."""
    here = Path(__file__)
    tracked = _git(here.parent, "ls-files", "--error-unmatch", here.name)
    return (_git(here.parent, "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*") or "") if tracked else ""


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() if done.returncode == 0 else None
