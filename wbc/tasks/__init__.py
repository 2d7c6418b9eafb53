"""Tasks of the whole-body QP: each gives the acceleration it wants and the rows that produce it.

A task of one's own is any object that has what ``Task`` says; it is handed to the controller, which stacks it after the
default ones, or registered by name in ``TASKS``, as what makes it for a robot:

    [project.entry-points."surefoot.tasks"]
    still-hand = "my_package.hand:StillHand"        # StillHand(model, frames) is a Task
"""

from typing import TYPE_CHECKING

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.wbc.parameters import TaskGains, TaskWeights
    from surefoot.wbc.tasks.registry import DEFAULT_LAYOUT, TASKS, TaskLayout
    from surefoot.wbc.tasks.stack import TaskStack
    from surefoot.wbc.tasks.task import Task, TaskFactory, Weighted, angular_acceleration

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

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            ".parameters": ("TaskGains", "TaskWeights"),
            "registry": ("DEFAULT_LAYOUT", "TASKS", "TaskLayout"),
            "stack": ("TaskStack",),
            "task": ("Task", "TaskFactory", "Weighted", "angular_acceleration"),
        },
    )
