"""What recovery costs: a tick of the planner, both axes, with steps adapted and without, from real walks.

    python benchmarks/recovery_tick.py [--tries N] [--set KEY=VALUE ...]

A walk without adaptation, the same with it, and with pushes that make it adapt, tick by tick in turns, standing left
out. Runs of the same scenario are equal to the bit, so that each tick counts with the least processor time that it took
in the tries. Run it with OMP_NUM_THREADS=1 on an idle core.
"""

import argparse
import time
from collections.abc import Sequence
from typing import Any
from unittest.mock import patch

import numpy as np
from threadpoolctl import threadpool_limits

from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import resolve

WALK = (
    "gait.steps=7",
    "gait.step_length=0.36",
    "gait.single_support=0.5",
    "gait.double_support=0.12",
    "gait.com_height=0.95",
    "gait.initial_stand=0.4",
)
PUSHES = (
    "pushes=[{step: 2, phase: single, fraction: 0.2, duration: 0.1, impulse: 0.3, direction: 0.0}, "
    "{step: 4, phase: double, fraction: 0.5, duration: 0.1, impulse: 0.4, direction: 3.141593}, "
    "{step: 6, phase: single, fraction: 0.2, duration: 0.1, impulse: 0.15, direction: 1.570796}]"
)
VARIANTS = {
    "without": ("planner.step_adaptation=none",),
    "with": ("planner.step_adaptation=crossing",),
    "with, pushed": ("planner.step_adaptation=crossing", PUSHES),
}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Microseconds of a planner tick, with steps adapted and without.")
    parser.add_argument("--tries", type=int, default=3, help="how often each walk is walked")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="set a key; repeatable")
    return parser.parse_args()


class Walk:
    """A walk whose planner's ticks are timed.

    Attributes:
        loop: the closed loop.
        rows: of each tick of the planner on steps its time, that in `solve` [s], and whether one was adapted.
    """

    def __init__(self, settings: Sequence[str]) -> None:
        self.loop = closed_loop(resolve(load_scenario("walk", list(settings))), NoLog())
        self.rows: list[tuple[float, float, float]] = []

    def step(self) -> None:
        """Go through one control tick."""
        spent, caught, adapts, steps = 0.0, 0.0, False, False
        update, catch = WalkingPlanner.update, StepAdjustment.solve

        def timed_update(self: WalkingPlanner, *given: Any) -> Any:
            nonlocal spent, steps
            start = time.thread_time()
            plan = update(self, *given)
            spent, steps = time.thread_time() - start, plan.phase.kind is not PhaseKind.STAND
            return plan

        def timed_catch(self: StepAdjustment, *given: Any) -> Any:
            nonlocal caught, adapts
            start = time.thread_time()
            found = catch(self, *given)
            caught, adapts = caught + time.thread_time() - start, found is not None
            return found

        with patch.object(WalkingPlanner, "update", timed_update), patch.object(StepAdjustment, "solve", timed_catch):
            self.loop.step()
        if steps:
            self.rows.append((spent, caught, float(adapts)))


def walked(overrides: Sequence[str]) -> dict[str, np.ndarray]:
    """Rows of each variant, shape (n, 3) each; their ticks take turns, so that neighbours slow all of them alike."""
    walks = {name: Walk([*WALK, *settings, *overrides]) for name, settings in VARIANTS.items()}
    with threadpool_limits(1):
        while not all(walk.loop.done for walk in walks.values()):
            for walk in walks.values():
                if not walk.loop.done:
                    walk.step()
    assert not any(walk.loop.fell for walk in walks.values()), "one fell: what was timed is no walk"
    return {name: np.array(walk.rows) for name, walk in walks.items()}


def row(name: str, values: np.ndarray, median: float) -> str:
    """A line of the table, ratios to the median without adaptation."""
    middle, p99 = np.percentile(values[:, 0], (50, 99)) * 1e6
    caught = np.mean(values[:, 1]) * 1e6
    ratios = f"{middle / median:>9.2f} {p99 / middle:>12.2f}"
    return f"{name:<24} {len(values):>6} {middle:>10.0f} {p99:>8.0f} {ratios} {caught:>14.0f}"


def main() -> None:
    options = arguments()
    tries = [walked(options.set) for _ in range(options.tries)]
    best = {name: np.min([one[name] for one in tries], axis=0) for name in VARIANTS}
    median = float(np.median(best["without"][:, 0])) * 1e6
    print(f"{'planner tick':<24} {'ticks':>6} {'median us':>10} {'p99 us':>8} {'to without':>9} ", end="")
    print(f"{'p99 / median':>12} {'mean in solve':>14}")
    for name, values in best.items():
        print(row(name, values, median))
    adapted = best["with, pushed"][:, 2] > 0.0
    print(row("  of it those adapting", best["with, pushed"][adapted], median))


if __name__ == "__main__":
    main()
