"""The tasks of other packages by name, and the rows of those that every controller has; needs no engine."""

from typing import TYPE_CHECKING

from surefoot.parts.plugins import Declared

if TYPE_CHECKING:
    from surefoot.wbc.tasks.task import TaskFactory

TaskLayout = tuple[tuple[str, int], ...]
"""Names and sizes of tasks, in the order of their rows."""

DEFAULT_LAYOUT: TaskLayout = (("CoM", 3), ("angular momentum", 3), ("pelvis", 3), ("torso", 3), ("swing foot", 6))
"""Names and sizes of the default tasks, in the order of their rows."""

TASKS: "Declared[TaskFactory]" = Declared("surefoot.tasks", None, {})
"""Tasks by name that a scenario may add to the default ones, a ``TaskFactory`` each: so far those of other packages."""
