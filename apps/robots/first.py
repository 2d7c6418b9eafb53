"""A first robot file of a model, which names the model from where the file will be."""

import os
from pathlib import Path

from surefoot.apps.robots.draft import Draft, draft
from surefoot.apps.robots.expand import expanded
from surefoot.models.robot_file.document import UnexpandedError
from surefoot.models.robot_file.paths import is_file, resolve
from surefoot.scenarios.output import write_whole


def first_file(model: str, folder: Path) -> tuple[Draft, tuple[str, ...]]:
    """A first robot file.

    Args:
        model: URDF, MJCF or xacro, from here.
        folder: where the file will be.

    Returns:
        the file, and notes on how it came to be, one line each.

    Raises:
        RobotError: the model cannot be read.
        ScenarioError: it is a xacro that cannot be expanded here.
    """
    try:
        return draft(_from(model, folder), folder), ()
    except UnexpandedError as refusal:
        made = expanded(resolve(model, Path()), refusal)
    note = f"expanded by xacro: {model} is {made}, which is the model of this robot file"
    return draft(_from(str(made), folder), folder), (note,)


def _from(model: str, folder: Path) -> str:
    """The model as a file in a folder names it."""
    if "://" in model or Path(model).is_absolute() or folder == Path():
        return model
    return os.path.relpath(model, folder)


def written(out: Path, text: str, replace: bool) -> None:
    """Write a robot file, over an empty one or over any if it shall be replaced.

    Raises:
        LogError: there is one already, or it cannot be written.
    """
    empty = is_file(out) and out.stat().st_size == 0
    with write_whole(out, replace or empty) as temporary:
        temporary.write_text(text, encoding="utf-8")
