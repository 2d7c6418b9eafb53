"""Where a run comes from: versions of the packages, of the interpreter and of the code."""

import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("surefoot", "mujoco", "pin", "proxsuite", "qpsolvers", "daqp", "quadprog", "numpy", "scipy", "mcap")
ABSENT = "not installed"
"""Version of a package that is not there, as of a source tree that was never installed."""


def versions() -> dict[str, str]:
    """Versions of all that a result may depend on, by name."""
    return {
        **{name: _version(name) for name in PACKAGES},
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}",
        "git_revision": _git_revision(),
    }


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
