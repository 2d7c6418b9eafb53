"""Tasks of the whole-body QP: each gives the acceleration it wants and the rows that produce it.

A task of one's own is any object that has what ``Task`` says; it is handed to the controller, which stacks it after the
default ones, or registered by name in ``TASKS``, as what makes it for a robot:

    [project.entry-points."surefoot.tasks"]
    still-hand = "my_package.hand:StillHand"        # StillHand(model, frames) is a Task
"""

from surefoot.plugins import Registry
from surefoot.wbc.tasks.default import DEFAULT_LAYOUT
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.stack import TaskStack
from surefoot.wbc.tasks.task import Task, TaskFactory, TaskLayout, Weighted, angular_acceleration

__all__ = [
    "DEFAULT_LAYOUT",
    "TASKS",
    "Task",
    "TaskFactory",
    "TaskGains",
    "TaskLayout",
    "TaskStack",
    "TaskWeights",
    "Weighted",
    "angular_acceleration",
]

TASKS: Registry[TaskFactory] = Registry("surefoot.tasks", None, {})
"""Tasks of other packages by name: a ``TaskFactory`` each."""
