"""QP solvers on the whole-body QPs of a real walk; the table decides `WbcParameters.solver`."""

import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import daqp
import numpy as np
from scipy.optimize import nnls

from benchmarks.stopwatch import TimedWalk
from benchmarks.table import Section, Value, microseconds
from benchmarks.tick import WALK
from surefoot.wbc.qp.data import EQUALITY_ROWS, QpData
from surefoot.wbc.qp.solvers import Daqp, EqualityFirst, ProxQp, QpSolution, QpSolver


class DaqpModel:
    """DAQP with a workspace that is set up once; optionally the active set of the last solve is kept."""

    name = "daqp workspace"

    def __init__(self, warm_start: bool) -> None:
        self._model, self._warm = daqp.Model(), warm_start
        self._sense = np.zeros(0, dtype=np.intc)

    def solve(self, qp: QpData) -> QpSolution | None:
        data = (qp.H, qp.g, qp.A, qp.bounds_upper, qp.bounds_lower)
        if not self._sense.size:
            self._sense = np.zeros(qp.bounds_lower.size, dtype=np.intc)
            self._sense[qp.g.size : qp.g.size + EQUALITY_ROWS] = 5
            self._model.setup(*data, self._sense)
            self._model.settings = {**self._model.settings, "primal_tol": 1e-9}
        elif self._warm:
            self._model.update(*data)
        else:
            self._model.update(*data, sense=self._sense)
        x, _, flag, info = self._model.solve()
        return QpSolution(np.array(x), qp.violation(x), int(info["iterations"])) if flag == 1 else None


SOLVERS: dict[str, Callable[[], QpSolver]] = {
    "equality-first": EqualityFirst,
    "daqp": Daqp,
    "daqp workspace": lambda: DaqpModel(warm_start=False),
    "daqp workspace, warm": lambda: DaqpModel(warm_start=True),
    "proxqp": ProxQp,
    "proxqp, warm": lambda: ProxQp(warm_start=True),
}


@dataclass(frozen=True)
class Outcome:
    """Times [s] of all solves and the answers, None where the solver failed."""

    seconds: np.ndarray
    answers: list[np.ndarray | None]


def _recorded(quick: bool, every: int = 10) -> list[QpData]:
    """The QP of every tenth tick."""
    walk, problems = TimedWalk(WALK, ["duration=0.6"] if quick else []), []
    with tempfile.TemporaryDirectory() as folder:
        for i, _ in enumerate(walk.ticks(Path(folder) / "walk.mcap")):
            if i % every == 0:
                problems.append(walk.loop.walker.controller.qp.copy())
    return problems


def solve_all(solver: QpSolver, problems: list[QpData]) -> Outcome:
    seconds, answers = np.zeros(len(problems)), []
    for i, qp in enumerate(problems):
        start = time.perf_counter()
        solution = solver.solve(qp)
        seconds[i] = time.perf_counter() - start
        answers.append(None if solution is None else solution.x)
    return Outcome(seconds, answers)


def kkt_residual(qp: QpData, x: np.ndarray) -> float:
    """Larger of the violation and what no admissible multipliers of the active rows balance, relative to |g|."""
    n = x.size
    values, rows = np.concatenate([x, qp.A @ x]), np.vstack([np.eye(n), qp.A])
    equal = np.zeros(values.size, dtype=bool)
    equal[n : n + EQUALITY_ROWS] = True
    low = ~equal & (values < qp.bounds_lower + 1e-5)
    high = ~equal & (values > qp.bounds_upper - 1e-5)
    columns = np.vstack([rows[equal], -rows[equal], -rows[low], rows[high]]).T
    left = nnls(columns / np.linalg.norm(columns, axis=0), -(qp.H @ x + qp.g))[1]
    return max(float(left / np.linalg.norm(qp.g)), qp.violation(x))


def solvers(quick: bool) -> Section:
    """Each solver on the same problems, beside DAQP started from cold."""
    problems = _recorded(quick)
    outcomes = {name: solve_all(make(), problems) for name, make in SOLVERS.items()}
    best = outcomes["daqp"]
    unit = float(np.median(best.seconds))
    rows = tuple(_row(name, outcome, problems, best, unit) for name, outcome in outcomes.items())
    columns = ("solver", "median us", "p99 us", "over daqp", "failures", "KKT residual", "largest |x - x_daqp|")
    ratio = float(np.median(outcomes["equality-first"].seconds)) / unit
    note = f"{len(problems)} whole-body QPs of {WALK}"
    return Section("solvers of the whole-body QP", columns, rows, note, {"equality-first over daqp": ratio})


def _row(name: str, outcome: Outcome, problems: list[QpData], best: Outcome, unit: float) -> tuple[Value, ...]:
    solved = [i for i, x in enumerate(outcome.answers) if x is not None and best.answers[i] is not None]
    median, p99 = microseconds(outcome.seconds, 50, 99)
    failed = sum(x is None for x in outcome.answers)
    if not solved:
        return (name, median, p99, median / (1e6 * unit), failed, None, None)
    away = max(float(np.abs(outcome.answers[i] - best.answers[i]).max()) for i in solved)
    kkt = max(kkt_residual(problems[i], outcome.answers[i]) for i in solved[:: max(1, len(solved) // 100)])
    return (name, median, p99, median / (1e6 * unit), failed, f"{kkt:.0e}", f"{away:.0e}")
