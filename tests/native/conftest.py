"""Real walks whose controller has a twin: one walks, the other is given the same, and both are compared."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from needs import KERNELS

import surefoot
from surefoot.native.library import VARIABLE, Library, library
from surefoot.wbc.controller import WholeBodyController
from surefoot.wbc.parameters import BalanceGains
from surefoot.wbc.types import FootSensing, RobotState, WbcReference, WbcReport

NEAR, NEARLY = 1e-11, 1e-9
"""Largest relative difference of terms and QP, and of what its solution gives."""

_TERMS = (
    "com_velocity", "base_angular_velocity", "torso_rotation", "torso_position", "sole_position", "sole_rotation",
    "sole_pose", "contact_position", "contact_rotation", "sole_jacobian", "sole_velocity", "sole_bias",
    "sole_wrench_map", "torso_jacobian", "torso_velocity", "torso_bias",
)  # fmt: skip
_QP = ("H", "g", "A", "bounds_lower", "bounds_upper")
_ANSWERS = ("torque", "acceleration", "wrench", "task_error")


def far(one: Any, other: Any) -> float:
    """Largest difference over the largest size of either, or over 1; infinite where one alone is."""
    if not np.array_equal(np.isinf(one), np.isinf(other)):
        return np.inf
    a, b = (np.where(np.isinf(values), 0.0, values) for values in (one, other))
    return float(np.abs(a - b).max() / max(1.0, np.abs(a).max()))


class Twins:
    """A plain controller that drives, and a compiled one beside it.

    Attributes:
        unlike: quantities that differ by more than they may, and by how much.
        seen: at how many ticks the walk came by what.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **given: Any) -> None:
        monkeypatch.setenv(VARIABLE, "0")
        self._plain = WholeBodyController(**given)
        monkeypatch.delenv(VARIABLE)
        self._compiled = WholeBodyController(**given)
        assert self._plain.terms.compiled is None
        assert self._compiled.terms.compiled is not None
        self.unlike: dict[str, float] = {}
        self.seen: dict[str, int] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._plain, name)

    def observe(self, state: RobotState) -> Any:
        terms = self._plain.observe(state)
        self._hold(_TERMS, NEAR, terms, self._compiled.observe(state))
        return terms

    def update(self, reference: WbcReference, sensing: FootSensing, fail_solvers: bool = False) -> WbcReport:
        plain, compiled = (
            controller.update(reference, sensing, fail_solvers) for controller in (self._plain, self._compiled)
        )
        self._hold(_QP, NEAR, self._plain.qp, self._compiled.qp)
        self._hold(_ANSWERS, NEARLY, plain, compiled)
        self._hold(("force", "moment", "mass_scale"), NEAR, plain.load, compiled.load)
        assert (plain.status, plain.active, plain.felt) == (compiled.status, compiled.active, compiled.felt)
        swing = next(write.__self__ for write, _, _ in self._plain.tasks._tasks if write.__self__.name == "swing foot")
        self._count("held by inequalities", plain.iterations > 0)
        self._count("rolling", reference.rolling_foot >= 0)
        self._count("ankle at its stop", swing._turned >= 0)
        self._count("ankle to rest", swing._turned >= 0 and reference.catching)
        self._count("ZMP beyond the soles", self._beyond(reference))
        self._count("one foot", plain.active[0] != plain.active[1])
        self._count("force", bool(plain.load.force.any()))
        self._count("weight", plain.load.mass_scale != 1.0)
        self._count("limbs near", bool((self._plain._gap_lower > -1e8).any()))
        return plain

    def _hold(self, names: tuple[str, ...], most: float, one: Any, other: Any) -> None:
        for name in names:
            found = far(getattr(one, name), getattr(other, name))
            if not found <= most:
                self.unlike[name] = max(self.unlike.get(name, 0.0), found)

    def _beyond(self, reference: WbcReference) -> bool:
        """Whether the law of the CoM asks for a ZMP beyond the soles, and may have it."""
        terms, region, gains = self._plain.terms, self._plain._region, BalanceGains()
        com, rate = terms.com - reference.com, terms.com_velocity - reference.com_velocity
        aim = reference.zmp + reference.zmp_offset + gains.dcm * (com + rate / reference.omega)[:2]
        return reference.catching and region.project(*aim) != region.project(*aim, gains.beyond_catching)

    def _count(self, name: str, there: bool) -> None:
        self.seen[name] = self.seen.get(name, 0) + there


@pytest.fixture(scope="session")
def kernels() -> Library:
    """The compiled kernels."""
    KERNELS.or_skip()
    found = library()
    assert found is not None
    return found


@pytest.fixture
def twins(kernels: Library, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Twins]:
    """Walk a scenario for a while with twins."""

    def walk(name: str, seconds: float, **overrides: Any) -> Twins:
        made: list[Twins] = []

        def controller(**given: Any) -> Twins:
            made.append(Twins(monkeypatch, **given))
            return made[0]

        with surefoot.Simulation(surefoot.load(name, overrides), controller=controller) as simulation:
            while simulation.time < seconds:
                simulation.advance()
        return made[0]

    return walk
