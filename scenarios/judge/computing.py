"""Metrics of what thinks: the state that was given, the solvers, the time they took, the log."""

from collections.abc import Mapping

import numpy as np

from surefoot.planner.model.dcm import dcm
from surefoot.scenarios.judge.balance import rms
from surefoot.scenarios.judge.digest import Array, Rows, RunView
from surefoot.scenarios.judge.metric import MM, metric

_SPREAD: Mapping[str, float] = {"median": 50.0, "p99": 99.0}
"""Percentiles by the names of their parts."""

_TAIL: Mapping[str, float] = {**_SPREAD, "p999": 99.9}

WARM = 60.0
"""Time by which everything that a run needs once is there [s]."""


@metric(unit="m", shown=MM, reads={"/truth": ("com",), "/planner_state": ("com",)}, least=0.0)
def estimation_error_rms(run: RunView) -> float | None:
    """Distance of the CoM that the planner was given from the true one, RMS [m]."""
    rows, given = _given(run)
    error = run.log["/planner_state"].field("com")[given] - run.log["/truth"].field("com")[rows]
    value = rms(np.linalg.norm(error, axis=1)[:, None])
    return value[0] if value else None


@metric(shown=(1e2, "% of the plans"), reads={"/plan": ("infeasible",)}, least=0.0, most=1.0)
def planner_infeasible_fraction(run: RunView) -> float:
    """Share of plans whose hard constraints had no solution and were softened [-]."""
    return float(np.mean(run.log["/plan"].field("infeasible") != 0))


@metric(
    unit="m",
    shown=MM,
    size=2,
    reads={"/truth": ("com", "com_velocity"), "/planner_state": ("com", "com_velocity"), "/reference": ("omega",)},
    least=0.0,
)
def dcm_estimation_error_rms(run: RunView) -> list[float] | None:
    """DCM that the planner was given minus the true one, both by the planned frequency, RMS, x and y [m]."""
    rows, given = _given(run)
    state, truth = run.log["/planner_state"], run.log["/truth"]
    omega = run.log["/reference"].field("omega")[rows, None]
    position = state.field("com")[given, :2] - truth.field("com")[rows, :2]
    velocity = state.field("com_velocity")[given, :2] - truth.field("com_velocity")[rows, :2]
    return rms(dcm(position, velocity, omega))


@metric(
    unit="s",
    shown=(1e3, "ms"),
    parts=tuple(_SPREAD),
    needs=("/timing", "/plan"),
    reads={"/timing": ("planner",)},
    repeatable=False,
    least=0.0,
)
def planner_time(run: RunView) -> dict[str, float] | None:
    """Wall-clock time of a plan: median and 99th percentile [s]."""
    spent = run.field("/timing", "planner")
    return _spread(spent[spent > 0])


@metric(
    unit="s",
    shown=(1e3, "ms"),
    parts=tuple(_SPREAD),
    needs=("/timing", "/wbc"),
    reads={"/timing": ("wbc_build", "wbc_solve")},
    body=True,
    repeatable=False,
    least=0.0,
)
def wbc_time(run: RunView) -> dict[str, float] | None:
    """Wall-clock time to build and solve the whole-body QP: median and 99th percentile [s]."""
    return _spread(run.field("/timing", "wbc_build") + run.field("/timing", "wbc_solve"))


@metric(
    unit="s",
    shown=(1e3, "ms"),
    parts=tuple(_TAIL),
    reads={"/timing": ("controller",)},
    repeatable=False,
    least=0.0,
)
def controller_time(run: RunView) -> dict[str, float] | None:
    """Processor time of a tick without log and physics: median, 99th and 99.9th percentile [s]."""
    return _spread(run.field("/timing", "controller"), _TAIL)


@metric(reads={"/timing": ("controller",)}, repeatable=False, least=0.0)
def deadlines_missed(run: RunView) -> int:
    """Ticks that take more processor time than their period, without log and physics."""
    return int(np.count_nonzero(run.field("/timing", "controller") * 1e-6 > 1.0 / run.constants.control_rate))


@metric(shown=(1.0, "times real time"), reads={"/timing": ("tick",)}, repeatable=False, least=0.0)
def real_time_factor(run: RunView) -> float | None:
    """Simulated over wall-clock time of the loop [-]."""
    wall = float(run.field("/timing", "tick").sum()) * 1e-6
    return run.ticks / run.constants.control_rate / wall if wall > 0 else None


@metric(shown=(1e2, "%"), reads={"/process": ("memory",)}, repeatable=False)
def memory_growth(run: RunView) -> float | None:
    """Growth of the process's memory after the first simulated minute, over what it was then [-]."""
    later = run.log["/process"].time >= WARM
    memory = run.log["/process"].field("memory")[later]
    if len(memory) < 2 or not np.isfinite(memory).all():
        return None
    return float(memory.max() / memory[0] - 1.0)


@metric(reads={"/wbc": ("status", "solver")}, body=True, least=0.0)
def qp_failures(run: RunView) -> int:
    """Ticks at which the whole-body QP's default solver failed."""
    return int(np.count_nonzero((run.field("/wbc", "status") != 0) | (run.field("/wbc", "solver") != 0)))


@metric(reads={"/wbc": ("fallback",)}, body=True, least=0.0)
def wbc_fallbacks(run: RunView) -> int:
    """Ticks at which nothing held all limits and the fallback torque was used."""
    return int(np.count_nonzero(run.field("/wbc", "fallback")))


@metric(unit="B", shown=(1e-6, "MB"), repeatable=False, least=0.0)
def log_bytes(run: RunView) -> int:
    """Size of the log [bytes]."""
    return run.log.size


def _spread(microseconds: Array, percentiles: Mapping[str, float] = _SPREAD) -> dict[str, float] | None:
    if not len(microseconds):
        return None
    ordered = np.sort(microseconds)  # not numpy's own percentiles, for which it imports its masked arrays
    places = np.array([*percentiles.values()]) / 100.0 * (len(ordered) - 1)
    found = np.interp(places, np.arange(len(ordered)), ordered) * 1e-6
    return dict(zip(percentiles, found.tolist(), strict=True))


def _given(run: RunView) -> tuple[Rows, Rows]:
    """Rows of /truth and of /planner_state at the planner's measurements, of ticks that are whole."""
    rows, near = run.rows_at("/truth", run.log["/planner_state"].time_ns)
    given = np.flatnonzero(near & (rows < run.ticks))
    return rows[given], given
