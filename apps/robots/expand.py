"""A xacro expanded by the package `xacro`, where it is installed, into a URDF beside it."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from surefoot.models.robot_file.document import UnexpandedError
from surefoot.models.robot_file.paths import is_file
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.output import write_whole

_PATIENCE = 60.0
"""Time that a file may take to expand [s]."""

_RUN = "import sys, xacro; sys.exit(xacro.main())"


def expanded(model: Path, refusal: UnexpandedError) -> Path:
    """The URDF that a xacro expands to, written beside it, so that paths of meshes hold.

    A URDF with that text that is there already stays.

    Args:
        model: the xacro.
        refusal: what was found left in it, which is raised where it cannot be expanded here.

    Raises:
        ScenarioError: `xacro` is not installed or cannot expand it, or something else has the name of the URDF.
    """
    if find_spec("xacro") is None:
        raise ScenarioError([f"{refusal}, or pip install xacro, and `surefoot robot new` does it"])
    text = _text(model, refusal)
    target = model.with_name(f"{_stem(model)}.urdf")
    if is_file(target) and target.read_text(encoding="utf-8", errors="replace") == text:
        return target
    if os.path.lexists(target):
        what = f"{refusal.what}, and {target}, where `surefoot robot new` would expand it to, holds something else"
        raise ScenarioError([f"{what}; remove that, or {refusal.right}"])
    with write_whole(target) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return target


def _text(model: Path, refusal: UnexpandedError) -> str:
    """Text that `xacro` makes of a file, in a process of its own, since expressions in it are evaluated.

    Raises:
        ScenarioError: it makes nothing of it.
    """
    command = [sys.executable, "-c", _RUN, str(model)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_PATIENCE, check=False)
        said = (done.stderr.strip().splitlines() or ["nothing is said"])[-1] if done.returncode else ""
    except subprocess.TimeoutExpired:
        said = f"it takes more than {_PATIENCE:.0f} s"
    if said:
        raise ScenarioError([f"{refusal.what}, and xacro cannot expand it here ({said[:200]}); {refusal.right}"])
    return done.stdout


def _stem(model: Path) -> str:
    """Name of the URDF without its ending: none that the xacro itself has."""
    stem = model.name.removesuffix(".xacro").removesuffix(".urdf")
    return stem if f"{stem}.urdf" != model.name else f"{stem}.expanded"
