"""What a long walk costs: a planner for it, a tick at its begin and at its end, and the memory meanwhile.

    python benchmarks/long_walk.py [--steps N] [--full]

The CoM and the feet do exactly what is planned; or the whole robot walks in full physics, with its log. Run it with
OMP_NUM_THREADS=1 on an idle core.
"""

import argparse
import time
from collections.abc import Iterator, Sequence
from tempfile import TemporaryDirectory

import numpy as np

import surefoot
from surefoot.planner.plan import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.scenarios.record.walk import resident_memory

STANCE = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
BLOCK = 1000
"""Steps of which the ticks are taken together."""

_FRESH = 60
"""Steps of the fresh planner."""

_START = 200
"""Ticks of both that are left out: there the fresh one stands."""


def planner_of(steps: int) -> WalkingPlanner:
    gait = GaitParameters(steps=steps, step_length=0.3, single_support=0.5, double_support=0.16, com_height=0.99)
    return WalkingPlanner(gait, STANCE, 0.22, 0.11)


def print_construction() -> None:
    print(f"{'steps':>7} {'planner, ms':>12}")
    for steps in (20, 2000, 20_000):
        spent = []
        for _ in range(20):
            start = time.perf_counter()
            planner_of(steps)
            spent.append(time.perf_counter() - start)
        print(f"{steps:>7} {1e3 * np.median(spent):>12.2f}")


def report(done: int, spent: Sequence[float], fresh: Sequence[float] = ()) -> None:
    """Print what the last ticks took."""
    median, beside = 1e6 * np.median(spent), 1e6 * np.median(fresh) if fresh else np.nan
    print(f"{done:>7} {median:>11.1f} {beside:>10.1f} {resident_memory() / 1e6:>11.2f}", flush=True)


HEAD = f"{'done':>7} {'median, us':>11} {'fresh, us':>10} {'memory, MB':>11}"


def ticks(steps: int) -> Iterator[tuple[int, float]]:
    """Walk; the step swung last and the time taken [s] of each tick."""
    planner = planner_of(steps)
    t = planner.parameters.sample_time
    com, velocity, feet = np.array([0.0, 0.0, 0.99]), np.zeros(3), IdealFeet(STANCE)
    for tick in range(round(planner.gait.duration / t)):
        state = CentroidalState(t * tick, com, velocity)
        start = time.perf_counter()
        plan = planner.update(state, feet.state)
        spent = time.perf_counter() - start
        com, velocity = plan.com[1], plan.com_velocity[1]
        feet.follow(PlanSampler(plan), t * (tick + 1))
        yield plan.phase.step, spent


def walk(steps: int) -> None:
    """Walk; prints the median tick at the end of each block of steps beside that of a fresh planner.

    Both tick in turn, so that a machine that is now faster, now slower changes both alike.
    """
    walked = ticks(steps)
    for step, _ in walked:
        if step and step % BLOCK == BLOCK - _FRESH:
            both = [(old, new) for (_, old), (_, new) in zip(walked, ticks(_FRESH), strict=False)]
            old, new = zip(*both[_START:], strict=True)
            report(step + _FRESH, old, new)


def walk_in_full(steps: int) -> None:
    scenario = surefoot.load("walk", {"gait.steps": steps})
    period, rate = scenario.gait.single_support + scenario.gait.double_support, scenario.rates.control
    block = round(min(BLOCK, steps // 2) * period * rate)
    print(HEAD)
    spent: list[float] = []
    with TemporaryDirectory() as folder, surefoot.Simulation(scenario, log=f"{folder}/log.mcap") as sim:
        while not sim.done:
            start = time.perf_counter()
            sim.advance()
            spent.append(time.perf_counter() - start)
            if len(spent) == block:
                report(round(sim.time * rate), spent)
                spent.clear()
        print(sim.end)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=20_000)
    parser.add_argument("--full", action="store_true")
    asked = parser.parse_args()
    print_construction()
    if asked.full:
        walk_in_full(asked.steps)
    else:
        print(HEAD)
        walk(asked.steps)


if __name__ == "__main__":
    main()
