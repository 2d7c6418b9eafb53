"""The tasks of other packages by name, and the rows of those that every controller has; needs no engine."""

from typing import TYPE_CHECKING

from surefoot.parts.plugins import Registry

if TYPE_CHECKING:
    from surefoot.wbc.tasks.task import TaskFactory

TaskLayout = tuple[tuple[str, int], ...]
"""Names and sizes of tasks, in the order of their rows."""

DEFAULT_LAYOUT: TaskLayout = (("CoM", 3), ("angular momentum", 3), ("pelvis", 3), ("torso", 3), ("swing foot", 6))
"""Names and sizes of the default tasks, in the order of their rows."""

TASKS: "Registry[TaskFactory]" = Registry("surefoot.tasks", None, {})
"""Tasks of other packages by name: a ``TaskFactory`` each."""
