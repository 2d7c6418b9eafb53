"""All tasks as one weighted least-squares cost of the whole-body QP."""

from collections.abc import Sequence

import numpy as np

from surefoot.maths import linear
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.qp.data import QpData
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.diagonal import DiagonalTerm
from surefoot.wbc.tasks.law import Place
from surefoot.wbc.tasks.registry import TaskLayout
from surefoot.wbc.tasks.task import Task, layout_of
from surefoot.wbc.types import Array


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
        unscale: 1 / √W, zero where that is infinite, shape (rows,).
        catching: whether tasks count as they do where a step catches the body.
    """

    def __init__(self, qp: QpData, tasks: Sequence[Task], terms: Sequence[DiagonalTerm]) -> None:
        """Stack tasks in their order.

        Args:
            qp: whose H and g this writes.
            tasks: those with rows.
            terms: costs of single variables.

        Raises:
            ValueError: two tasks have one name, or a task's size or weight is none.
        """
        self.layout: TaskLayout = layout_of(tasks)
        variables, sizes = qp.g.shape[0], [size for _, size in self.layout]
        # Of walking, and of catching the body.
        self._scales = [np.sqrt(np.concatenate([_weight(task, caught) for task in tasks])) for caught in (False, True)]
        self._unscales = [np.divide(1.0, s, out=np.zeros_like(s), where=s > 0.0) for s in self._scales]
        if len(dict(self.layout)) < len(self.layout):
            raise ValueError(f"tasks {', '.join(name for name, _ in self.layout)}: each needs a name of its own")
        self.rows, self.target = np.zeros((sum(sizes), variables)), np.zeros(sum(sizes))
        self.diagonal, self.linear = np.zeros(variables), np.zeros(variables)
        self.scale, self.unscale = np.zeros(sum(sizes)), np.zeros(sum(sizes))
        self._T, self._t, self._root_W = self.rows, self.target, self.scale
        self._D = self.diagonal
        self._d = self.linear
        self._H = qp.H
        self._g = qp.g
        ends = np.cumsum(sizes)
        slices = [slice(end - size, end) for size, end in zip(sizes, ends, strict=True)]
        self._places = [
            Place(task, self.scale[part], self.rows[part], self.target[part])
            for task, part in zip(tasks, slices, strict=True)
        ]
        self._terms = list(terms)
        for term in self._terms:
            term.weigh(self.diagonal)
        self._weigh(False)

    def _weigh(self, catching: bool) -> None:
        """Let tasks count as they do where a step catches the body, or as they do else."""
        self.catching = catching
        self.scale[:], self.unscale[:] = self._scales[catching], self._unscales[catching]

    def write(self, terms: RobotTerms, reference: WbcReference) -> None:
        """Write H and g of the QP for this state and reference.

        Raises:
            ValueError: a task gives more or less numbers than it has rows.
        """
        if reference.catching != self.catching:
            self._weigh(reference.catching)
        for place in self._places:
            place.put(terms, reference)
        for term in self._terms:
            term.put(terms, reference, self._d)
        self._assemble()

    def _assemble(self) -> None:
        """H = TᵀT + D and g = -(Tᵀt + d), of targets that become the scaled ones."""
        for i in range(self._t.shape[0]):
            self._t[i] *= self._root_W[i]
        linear.gram(self._T, self._H)
        linear.transposed_product(self._T, self._t, self._g)
        for i in range(self._g.shape[0]):
            self._H[i, i] += self._D[i]
            self._g[i] = -(self._g[i] + self._d[i])


def _weight(task: Task, catching: bool) -> Array:
    """Weight of each row of a task, in a walk or where a step catches the body."""
    weight = np.asarray(getattr(task, "catching_weight", task.weight) if catching else task.weight, dtype=np.float64)
    if task.size < 1 or weight.shape not in ((), (task.size,)) or not (np.isfinite(weight) & (weight >= 0.0)).all():
        raise ValueError(
            f"task '{task.name}' has size {task.size} and weight {weight}; the size must be at least 1, the "
            "weight one number or one for each row, finite and not negative"
        )
    return np.broadcast_to(weight, task.size)
