"""The compiled kernels of a plan against their plain counterparts, plan by plan, on real walks."""

from collections import Counter
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

from surefoot.native.library import VARIABLE
from surefoot.planner.references.com_height import BentKneeHeight, PaperHeight, SmoothHeight
from surefoot.planner.references.window import ReferencePreview
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

NEAR = 1e-11
"""Largest relative difference of what a plan sees and decides from."""

TRUTH = {"sensing.source": "truth"}
SOON = {**TRUTH, "gait.initial_stand": 0.1}
PUSH = {"step": 3, "phase": "single", "fraction": 0.2, "duration": 0.1}
ASIDE = {**SOON, "pushes": [{**PUSH, "force": [0, -260, 0]}]}
HARD = {**SOON, "pushes": [{**PUSH, "force": [0, -380, 0]}]}
STOOD = {**TRUTH, "pushes": [{"time": 0.2, "duration": 0.1, "force": [0, 320, 0]}]}
FORCED = {**SOON, "pushes": [{"time": 0.6, "duration": 0.5, "force": [60.0, 40.0, 0.0]}]}
WALKS = {
    "walk": ("walk", 2.5, SOON, {"steady"}),
    "aside": ("walk", 2.9, ASIDE, {"steady", "adapted", "bent", "height in transition"}),
    "lowered": ("walk", 3.2, HARD, {"scaled", "adapted", "bent", "lowered", "height in transition"}),
    "stood": ("stand", 1.6, STOOD, {"steady"}),
    "forced": ("walk", 1.6, FORCED, {"steady", "lasting force"}),
    "stairs": ("stairs-up", 3.6, SOON, {"steady"}),
    "fast": ("walk-fast", 2.2, SOON, {"steady"}),
    "g1": ("walk", 1.8, {**SOON, "robot": "g1"}, {"steady"}),
    "talos": ("walk", 1.8, {**SOON, "robot": "talos"}, {"steady"}),
}


def leaves(value: Any, name: str = "") -> dict[str, Any]:
    """Numbers and arrays in nested dataclasses, by name."""
    if not is_dataclass(value):
        return {name: value}
    found = {}
    for field in fields(value):
        found |= leaves(getattr(value, field.name), f"{name}.{field.name}")
    return found


def far(one: Any, other: Any) -> float:
    """Largest difference over the largest size of either, or over 1; infinite where only one is there."""
    if (one is None) is not (other is None):
        return np.inf
    if one is None:
        return 0.0
    a, b = np.asarray(one, dtype=np.float64), np.asarray(other, dtype=np.float64)
    if a.shape != b.shape:
        return np.inf
    apart = np.where(a == b, 0.0, np.abs(a - b))
    return float(np.max(apart / max(1.0, np.abs(a[np.isfinite(a)]).max(initial=0.0)), initial=0.0))


class Plans:
    """A walk that plain Python plans, with kernels that are given the same.

    Attributes:
        unlike: what differs by more than it may, and by how much.
        seen: at how many plans the walk came by what.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, name: str, overrides: dict[str, Any]) -> None:
        walk = resolve(load(name, overrides))
        monkeypatch.setenv(VARIABLE, "0")
        self.loop = closed_loop(walk, NoLog())
        self.planner = self.loop.planning.planner
        monkeypatch.delenv(VARIABLE)
        compiled = closed_loop(walk, NoLog()).planning.planner
        assert self.planner._preview._compiled is None
        assert compiled._preview._compiled is not None
        self.unlike: dict[str, float] = {}
        self.seen: Counter[str] = Counter()
        self._pair(self.planner._preview, compiled._preview, "window")
        self._pair(self.planner._preview, compiled._preview, "support", lambda support: support.table)
        plain, twin = self.planner._recovery, compiled._recovery
        self._pair(plain._planned, twin._planned, "margin")
        if plain.adjustment is not None:
            assert plain.adjustment._compiled is None
            assert twin.adjustment._compiled is not None
            self._pair(plain._movable, twin._movable, "margins")
            self._pair(plain.adjustment, twin.adjustment, "solve")

    def _pair(self, plain: Any, compiled: Any, method: str, part: Callable[[Any], Any] = lambda found: found) -> None:
        """Have a method of one object also asked of another one, and what both say, or a part of it, compared."""
        does, twin = getattr(plain, method), getattr(compiled, method)

        def both(*given: Any) -> Any:
            found = does(*given)
            self._hold(method, part(found), part(twin(*given)))
            return found

        setattr(plain, method, both)

    def _hold(self, method: str, one: Any, other: Any) -> None:
        first, second = leaves(one, method), leaves(other, method)
        for name in first.keys() | second.keys():
            found = far(first.get(name), second.get(name))
            if not found <= NEAR:
                self.unlike[name] = max(self.unlike.get(name, 0.0), found)

    def walk(self, seconds: float) -> None:
        """Walk so long."""
        update = self.planner.update

        def counted(state: Any, feet: Any) -> Any:
            plan, execution = update(state, feet), self.planner._execution
            self.seen["steady" if execution.clock.steady else "scaled"] += 1
            self.seen["adapted"] += execution.adapted
            self.seen["lowered"] += execution.lowering > 0.0
            self.seen["bent"] += execution.swing is not None and execution.swing.bent
            self.seen["height in transition"] += self.planner._preview._transition is not None
            self.seen["lasting force"] += state.lasting is not None and bool(state.lasting.force.any())
            return plan

        self.planner.update = counted
        while self.loop.time < seconds:
            self.loop.step()


@pytest.mark.parametrize("case", WALKS)
def test_kernels_plan_what_their_counterparts_do(kernels, monkeypatch, case):
    name, seconds, overrides, comes_by = WALKS[case]
    plans = Plans(monkeypatch, name, overrides)
    plans.walk(seconds)
    assert {what for what, count in plans.seen.items() if count} >= comes_by, plans.seen
    assert plans.unlike == {}


class Squat(SmoothHeight):
    """A height of one's own."""

    def height(self, gait, samples, support_height):
        found = super().height(gait, samples, support_height)
        found[0] -= 0.05 * np.sin(samples.clock)
        return found


@pytest.mark.parametrize("profile", [SmoothHeight(), BentKneeHeight(), PaperHeight(), Squat()])
def test_each_height_law_is_seen_by_the_kernels_and_one_of_ones_own_is_asked(kernels, monkeypatch, profile):
    planner = closed_loop(resolve(load("stairs-up", SOON)), NoLog()).planning.planner
    execution, half_size = planner._execution, np.array([0.11, 0.05])
    for _ in range(160):
        execution.clock = execution.clock.advanced()
    execution.follow(execution.schedule)
    found = []
    for plain in ("1", "0"):
        monkeypatch.setenv(VARIABLE, plain)
        preview = ReferencePreview(planner.gait, profile, planner.parameters, half_size)
        found.append(preview.window(execution, preview.support(execution), np.zeros(2), 0.0))
    pairs = zip(leaves(found[0]).items(), leaves(found[1]).values(), strict=True)
    assert {name: far(one, other) for (name, one), other in pairs if far(one, other) > NEAR} == {}


def test_a_window_stays_as_it_was_when_the_next_one_is_looked_at(kernels):
    planner = closed_loop(resolve(load("walk", SOON)), NoLog()).planning.planner
    execution, preview = planner._execution, planner._preview
    first = preview.window(execution, preview.support(execution), np.zeros(2), 0.0)
    kept = {name: np.array(value) for name, value in leaves(first).items()}
    execution.clock = execution.clock.advanced()
    second = preview.window(execution, preview.support(execution), np.zeros(2), 0.02)
    assert far(first.height.height, second.height.height) > NEAR
    assert all(np.array_equal(kept[name], value) for name, value in leaves(first).items())
