"""Real walks whose planner has a twin: one walks, the other is given the same, and both are compared."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from needs import KERNELS

import surefoot
from surefoot.native.library import VARIABLE, Library, library

NEAR, NEARLY = 1e-11, 1e-9
"""Largest relative difference of terms and QP, and of what its solution gives."""

_PLAN = ("zmp_offset", "zmp_reference", "stiffness", "omega", "load_left")
_PLANNED = ("com", "com_velocity", "com_acceleration", "zmp")
_PLAN_QP = ("P", "q", "G", "h", "lower", "upper")


def far(one: Any, other: Any) -> float:
    """Largest difference over the largest size of either, or over 1; infinite where one alone is."""
    if not np.array_equal(np.isinf(one), np.isinf(other)):
        return np.inf
    a, b = (np.where(np.isinf(values), 0.0, values) for values in (one, other))
    return float(np.abs(a - b).max() / max(1.0, np.abs(a).max()))


class PlannerTwins:
    """A planner that drives with its kernels, and a plain one that is told the same.

    Attributes:
        unlike: quantities that differ by more than they may, and by how much.
    """

    def __init__(self, compiled: Any, plain: Any) -> None:
        self._twins, self._update = (compiled, plain), compiled.update
        self.unlike: dict[str, float] = {}
        compiled.update = self.update

    def update(self, *measured: Any) -> Any:
        compiled, plain = self._twins
        plan, other = self._update(*measured), plain.update(*measured)
        self._hold(_PLAN, NEAR, other, plan)
        self._hold(_PLANNED, NEARLY, other, plan)
        self._hold(("jerk", "shifts"), NEARLY, plain.motion, compiled.motion)
        for one, another in zip(plain.motion.qps, compiled.motion.qps, strict=True):
            self._hold(_PLAN_QP, NEAR, one, another)
        assert (plan.phase.kind, plan.status.solver) == (other.phase.kind, other.status.solver)
        return plan

    def _hold(self, names: tuple[str, ...], most: float, one: Any, other: Any) -> None:
        for name in names:
            found = far(getattr(one, name), getattr(other, name))
            if not found <= most:
                self.unlike[name] = max(self.unlike.get(name, 0.0), found)


@pytest.fixture(scope="session")
def kernels() -> Library:
    """The compiled kernels."""
    KERNELS.or_skip()
    found = library()
    assert found is not None
    return found


@pytest.fixture
def planner_twins(kernels: Library, monkeypatch: pytest.MonkeyPatch) -> Callable[..., PlannerTwins]:
    """Walk a scenario for a while with planner twins."""

    def walk(name: str, seconds: float, **overrides: Any) -> PlannerTwins:
        scenario = surefoot.load(name, overrides)
        monkeypatch.setenv(VARIABLE, "0")
        with surefoot.Simulation(scenario) as plain:
            monkeypatch.delenv(VARIABLE)
            with surefoot.Simulation(scenario) as simulation:
                twins = PlannerTwins(simulation.planner, plain.planner)
                while simulation.time < seconds and not simulation.done:
                    simulation.advance()
        return twins

    return walk
