"""What a plan costs: prediction matrices, and a tick of both axes for every planner profile.

    python benchmarks/planner_tick.py [--steps N]

Run it with OMP_NUM_THREADS=1 on an idle core.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.model.jerk import cached_response
from surefoot.planner.parameters import LegInertia
from surefoot.planner.plan import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import resolve

T, N = 0.02, 50


def median_time(function: Callable[[], object], tries: int) -> float:
    spent = []
    for _ in range(tries):
        start = time.perf_counter()
        function()
        spent.append(time.perf_counter() - start)
    return float(np.median(spent)) * 1e6


def print_matrices() -> None:
    stiffness = np.random.default_rng(0).uniform(7.0, 13.0, N)
    full, short = cached_response(T, tuple(range(N)), N), cached_response(T, (0, 1), N)
    print(f"{'S_x, S_u1, S_u, N_p 50':<42} {'median us':>10}")
    for name, response in (("cached P_x - diag(1/λ) P_a, N_c 50", full), ("cached P_x - diag(1/λ) P_a, N_c 2", short)):
        print(f"{name:<42} {median_time(lambda response=response: response.at(stiffness), 2000):>10.1f}")


def robot_legs() -> LegInertia:
    return closed_loop(resolve(load_scenario("diagonal-walk")), NoLog()).planning.planner.parameters.leg


def walk(planner: WalkingPlanner, feet: FeetState, duration: float) -> None:
    """Walk exactly as planned."""
    ideal, state = IdealFeet(feet), CentroidalState(0.0, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    for tick in range(1, round(duration / T) + 1):
        plan = planner.update(state, ideal.state)
        state = CentroidalState(tick * T, plan.com[1], plan.com_velocity[1])
        ideal.follow(PlanSampler(plan), tick * T)


def print_margins(steps: int) -> None:
    """What of a tick is the margin, of a walk whose steps may be moved."""
    gait, legs = GaitParameters(steps=steps, step_length=0.2), resolve(load_scenario("walk")).legs
    feet = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
    planner, spent = WalkingPlanner(gait, feet, 0.22, 0.11, legs=legs), []
    balance = planner._recovery.balance

    def timed(*given):
        start = time.perf_counter()
        found = balance(*given)
        spent.append(time.perf_counter() - start)
        return found

    planner._recovery.balance = timed
    walk(planner, feet, gait.duration)
    median, p90, p99 = np.percentile(spent, (50, 90, 99)) * 1e6
    print(f"{'capturability margin, of a tick':<42} {median:>10.0f} {p90:>10.0f} {p99:>10.0f}")


def print_ticks(steps: int) -> None:
    gait = GaitParameters(steps=steps, lateral_step=0.1)
    side = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
    print(f"\n{'WalkingPlanner.update, diagonal walk':<42} {'median us':>10} {'p90 us':>10} {'p99 us':>10}")
    rows = [(name, profile, profile.parameters) for name, profile in PROFILES.items()]
    default = PROFILES["default"]
    rows.insert(1, ("default, legs as links (full physics)", default, replace(default.parameters, leg=robot_legs())))
    for name, profile, parameters in rows:
        feet = FeetState(side.copy(), np.zeros(2), (True, True))
        planner, spent = WalkingPlanner(gait, feet, 0.075, 0.075, parameters=parameters, profile=profile), []
        update = planner.update

        def timed(state, feet, update=update, spent=spent):
            start = time.perf_counter()
            plan = update(state, feet)
            spent.append(time.perf_counter() - start)
            return plan

        planner.update = timed
        walk(planner, feet, gait.duration + 1.0)
        median, p90, p99 = np.percentile(spent, (50, 90, 99)) * 1e6
        print(f"{name:<42} {median:>10.0f} {p90:>10.0f} {p99:>10.0f}")


def main() -> None:
    parser = argparse.ArgumentParser(description="Microseconds of prediction matrices and of planner ticks.")
    parser.add_argument("--steps", type=int, default=5, help="footsteps of the diagonal walk")
    options = parser.parse_args()
    print_matrices()
    print_ticks(options.steps)
    print_margins(options.steps)


if __name__ == "__main__":
    main()
