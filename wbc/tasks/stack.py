"""All tasks as one weighted least-squares cost of the whole-body QP."""

from collections.abc import Callable, Sequence
from typing import cast

import numpy as np

from surefoot.native.library import Bound
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.qp import QpData
from surefoot.wbc.tasks.diagonal import DiagonalTerm
from surefoot.wbc.tasks.registry import TaskLayout
from surefoot.wbc.tasks.task import CompiledTask, Task, layout_of
from surefoot.wbc.types import Array, WbcReference


class TaskStack:
    """Rows and targets of all tasks, allocated from their sizes.

    With the rows T = √W J and targets t = √W a of all tasks, a diagonal D and its linear term d:
    H = TᵀT + D and g = -(Tᵀt + d).

    Attributes:
        layout: names and sizes of the tasks, in the order of their rows.
        rows: T, shape (rows, n).
        target: t, shape (rows,).
        diagonal: D, shape (n,).
        linear: d, shape (n,).
        catching: whether tasks count as they do where a step catches the body.
        is_alone: whether kernels do all that ``write`` does while that stays so; else ``write_others`` comes before.
        bound: rows and targets as kernels take them, and ``calls`` what these do in one call; of kernels alone.
    """

    def __init__(
        self, qp: QpData, tasks: Sequence[Task], terms: Sequence[DiagonalTerm], compiled: CompiledTick | None = None
    ) -> None:
        """Stack tasks in their order.

        Args:
            qp: whose H and g this writes.
            tasks: those with rows.
            terms: costs of single variables.
            compiled: on which kernels of tasks work that have one; None for plain Python.

        Raises:
            ValueError: two tasks have one name, or a task's size or weight is none.
        """
        self.layout: TaskLayout = layout_of(tasks)
        variables, sizes = qp.g.shape[0], [size for _, size in self.layout]
        # Of walking, and of catching the body.
        self._scales = [np.sqrt(np.concatenate([_weight(task, caught) for task in tasks])) for caught in (False, True)]
        self._unscales = [np.divide(1.0, s, out=np.zeros_like(s), where=s > 0.0) for s in self._scales]
        scale = self._scales[False].copy()
        if len(dict(self.layout)) < len(self.layout):
            raise ValueError(f"tasks {', '.join(name for name, _ in self.layout)}: each needs a name of its own")
        self.rows, self.target = np.zeros((sum(sizes), variables)), np.zeros(sum(sizes))
        self.diagonal, self.linear = np.zeros(variables), np.zeros(variables)
        self._weighing = [term.weigh for term in terms]
        for weigh in self._weighing:
            weigh(self.diagonal, False)
        # In place, since tasks and kernels have views of it.
        self._scale, self._unscale, self.catching = scale, self._unscales[False].copy(), False
        # A view costs as much to make as to use, so each task's part of the rows gets its name once.
        ends = np.cumsum(sizes)
        places = [slice(end - size, end) for size, end in zip(sizes, ends, strict=True)]
        self._tasks = [
            (task.write, scale[place, None], self.rows[place]) for task, place in zip(tasks, places, strict=True)
        ]
        self._terms = [term.write for term in terms]
        self._H, self._g, self._H_diagonal = qp.H, qp.g, qp.H.reshape(-1)[:: variables + 1]
        if compiled is not None:
            self._compile(compiled, list(zip(tasks, places, strict=True)), terms)

    def _compile(self, tick: CompiledTick, tasks: Sequence[tuple[Task, slice]], terms: Sequence[DiagonalTerm]) -> None:
        """Take kernels where a class has one of its own; a class that inherits one may write something else."""
        self._kernels: list[Callable[[], None]] = []
        self._others = []
        for (task, place), (write, scale, rows) in zip(tasks, self._tasks, strict=True):
            if "compiled" in vars(type(task)):
                bench = tick.bench(self._scale[place], rows, self.target[place])
                self._kernels.append(cast(CompiledTask, task).compiled(tick, bench))
            else:
                self._others.append((write, scale, rows, self.target[place]))
        self._kernels += filter(None, (term.compiled(tick, self.linear) for term in terms))
        self.bound = tick.kernels.fill(
            "Stack",
            variables=len(self.linear),
            rows_count=len(self.target),
            rows=self.rows,
            target=self.target,
            scale=self._scale,
            unscale=self._unscale,
            diagonal=self.diagonal,
            linear=self.linear,
            H=self._H,
            g=self._g,
        )
        self._assemble = tick.kernels.bind("stack_assemble", self.bound)
        calls = None if self._others else tick.kernels.calls([*self._kernels, self._assemble])
        self.is_alone = calls is not None
        self.calls = calls or cast(Bound, tick.kernels.calls([]))

    def _weigh(self, catching: bool) -> None:
        """Let tasks count as they do where a step catches the body, or as they do else."""
        self.catching = catching
        np.copyto(self._scale, self._scales[catching])
        np.copyto(self._unscale, self._unscales[catching])
        self.diagonal[:] = 0.0
        for weigh in self._weighing:
            weigh(self.diagonal, catching)

    def write(self, terms: RobotTerms, reference: WbcReference) -> None:
        """Write H and g of the QP for this state and reference."""
        if reference.catching is not self.catching:
            self._weigh(reference.catching)
        wanted: list[float] = []
        for write, scale, rows in self._tasks:
            wanted.extend(write(terms, reference, scale, rows))
        self.target[:] = wanted
        self.target *= self._scale
        for term in self._terms:
            term(terms, reference, self.linear)
        np.matmul(self.rows.T, self.rows, out=self._H)
        self._H_diagonal += self.diagonal
        np.matmul(self.target, self.rows, out=self._g)
        self._g += self.linear
        np.negative(self._g, out=self._g)

    def write_others(self, terms: RobotTerms, reference: WbcReference) -> None:
        """What of ``write`` the kernels' calls leave to Python, after the reference was given to their tick."""
        if reference.catching is not self.catching:
            self._weigh(reference.catching)
        if self.is_alone:
            return
        for kernel in self._kernels:
            kernel()
        for write, scale, rows, target in self._others:
            target[:] = np.reshape(tuple(write(terms, reference, scale, rows)), target.shape)
        self._assemble()

    def residual(self, x: Array) -> Array:
        """Residuals J x - a of all tasks at the solution x, shape (rows,); those of a task without weight are zero."""
        residual: Array = self.rows @ x
        residual -= self.target
        residual *= self._unscale
        return residual


def _weight(task: Task, catching: bool) -> Array:
    """Weight of each row of a task, in a walk or where a step catches the body."""
    weight = np.asarray(getattr(task, "catching_weight", task.weight) if catching else task.weight, dtype=np.float64)
    if task.size < 1 or weight.shape not in ((), (task.size,)) or not (np.isfinite(weight) & (weight >= 0.0)).all():
        raise ValueError(
            f"task '{task.name}' has size {task.size} and weight {weight}; the size must be at least 1, the "
            "weight one number or one for each row, finite and not negative"
        )
    return np.broadcast_to(weight, task.size)
