"""What recovery costs: a tick of the planner, both axes, with steps adapted and without, from real walks.

    python benchmarks/recovery_tick.py [--tries N] [--set KEY=VALUE ...]

A walk without adaptation, the same with it, and with pushes that make it adapt. Runs of the same scenario are equal to
the bit, so that each tick counts with the least processor time that it took in the tries. Run it with OMP_NUM_THREADS=1
on an idle core.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from typing import Any
from unittest.mock import patch

import numpy as np
from threadpoolctl import threadpool_limits

from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.recovery import Recovery
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.loop.run import closed_loop
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


def timed(method: Callable[..., Any], spent: list[float]) -> Callable[..., Any]:
    def call(*given: Any) -> Any:
        start = time.thread_time()
        result = method(*given)
        spent.append(time.thread_time() - start)
        return result

    return call


def ticks(settings: Sequence[str]) -> np.ndarray:
    """Of each tick its time, that in `Recovery.catch` [s], and whether a step was adapted, shape (n, 3)."""
    planner: list[float] = []
    catch: list[float] = []
    rows: list[tuple[float, float, float]] = []
    adapts: list[bool] = []
    recovery = Recovery.catch

    def noted(self: Recovery, now: Any) -> Any:
        found = recovery(self, now)
        adapts.append(found is not None)
        return found

    with (
        threadpool_limits(1),
        patch.object(WalkingPlanner, "update", timed(WalkingPlanner.update, planner)),
        patch.object(Recovery, "catch", timed(noted, catch)),
    ):
        loop = closed_loop(resolve(load_scenario("walk", list(settings))), NoLog())
        while not loop.done:
            loop.step()
            if len(planner) > len(rows):
                rows.append((planner[-1], sum(catch), float(any(adapts))))
                catch.clear()
                adapts.clear()
        assert not loop.fell, "it fell: what was timed is no walk"
    return np.array(rows)


def row(name: str, values: np.ndarray, median: float) -> str:
    """A line of the table, ratios to the median without adaptation."""
    middle, p99 = np.percentile(values[:, 0], (50, 99)) * 1e6
    caught = np.median(values[:, 1]) * 1e6
    ratios = f"{middle / median:>9.2f} {p99 / middle:>12.2f}"
    return f"{name:<24} {len(values):>6} {middle:>10.0f} {p99:>8.0f} {ratios} {caught:>14.0f}"


def main() -> None:
    options = arguments()
    tries: dict[str, list[np.ndarray]] = {name: [] for name in VARIANTS}
    for _ in range(options.tries):
        for name, settings in VARIANTS.items():
            tries[name].append(ticks([*WALK, *settings, *options.set]))
    best = {name: np.min(runs, axis=0) for name, runs in tries.items()}
    median = float(np.median(best["without"][:, 0])) * 1e6
    print(f"{'planner tick':<24} {'ticks':>6} {'median us':>10} {'p99 us':>8} {'to without':>9} ", end="")
    print(f"{'p99 / median':>12} {'in catch, us':>14}")
    for name, values in best.items():
        print(row(name, values, median))
    adapted = best["with, pushed"][:, 2] > 0.0
    print(row("  of it those adapting", best["with, pushed"][adapted], median))


if __name__ == "__main__":
    main()
