"""A plan: of each profile, and on steps of real walks with steps adapted and without."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np

from benchmarks.table import Section, Value, microseconds
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.model.jerk import cached_response
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState, FeetState, PhaseKind
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

FEET = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])


def profiles(quick: bool) -> Section:
    """`WalkingPlanner.update` with everything in it, both axes, over a diagonal walk that does what is planned."""
    gait = GaitParameters(steps=1 if quick else 5, lateral_step=0.1)
    legs = closed_loop(resolve(load("diagonal-walk")), NoLog()).planning.planner.parameters.leg
    variants = [(name, profile, profile.parameters) for name, profile in PROFILES.items()]
    default = PROFILES["default"]
    variants.insert(1, ("default, legs as links (full physics)", default, replace(default.parameters, leg=legs)))
    rows: list[tuple[Value, ...]] = []
    for name, profile, parameters in variants:
        feet = FeetState(FEET.copy(), np.zeros(2), (True, True))
        planner, spent = WalkingPlanner(gait, feet, 0.075, 0.075, parameters=parameters, profile=profile), []
        with _timed(planner, "update", spent):
            _walk(planner, feet, gait.duration + 1.0)
        rows.append((name, *microseconds(spent, 50, 90, 99)))
    rows += [("prediction matrices, N_c 50", _median(tuple(range(50))), None, None)]
    rows += [("prediction matrices, N_c 2", _median((0, 1)), None, None)]
    return Section("plan of a profile", ("profile", "median us", "p90 us", "p99 us"), tuple(rows))


def _walk(planner: WalkingPlanner, feet: FeetState, duration: float) -> None:
    """Walk exactly as planned."""
    ideal, state = IdealFeet(feet), CentroidalState(0.0, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    t = planner.parameters.sample_time
    for tick in range(1, round(duration / t) + 1):
        plan = planner.update(state, ideal.state)
        state = CentroidalState(tick * t, plan.com[1], plan.com_velocity[1])
        ideal.follow(PlanSampler(plan), tick * t)


def _median(starts: tuple[int, ...], tries: int = 1000) -> float:
    """Median times of S_x, S_u1 and S_u at a stiffness that varies [us]."""
    stiffness, response, spent = np.random.default_rng(0).uniform(7.0, 13.0, 50), cached_response(0.02, starts, 50), []
    for _ in range(tries):
        start = time.perf_counter()
        response.at(stiffness)
        spent.append(time.perf_counter() - start)
    return microseconds(spent, 50)[0]


@contextmanager
def _timed(owner: Any, name: str, spent: list[float]) -> Iterator[None]:
    method: Callable[..., Any] = getattr(owner, name)

    def call(*given: Any) -> Any:
        start = time.perf_counter()
        found = method(*given)
        spent.append(time.perf_counter() - start)
        return found

    with patch.object(owner, name, call):
        yield


STEPS = (
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


class _Walk:
    """A walk; of each plan on steps its processor time and that in `solve` [s], and whether a step was adapted."""

    def __init__(self, settings: Sequence[str]) -> None:
        self.loop = closed_loop(resolve(load("walk-level", ["sensing.source=truth", *settings])), NoLog())
        self.rows: list[tuple[float, float, float]] = []

    def step(self) -> None:
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


def adaptation(quick: bool) -> Section:
    """Plans of natural walks, tick by tick in turns; each counts with the least time of the tries."""
    tries = [_walked(quick) for _ in range(1 if quick else 3)]
    best = {name: np.min([one[name] for one in tries], axis=0) for name in VARIANTS}
    adapted = best["with, pushed"][best["with, pushed"][:, 2] > 0.0]
    if len(adapted):
        best["of it those that adapt"] = adapted
    unit = float(np.median(best["without"][:, 0]))
    rows = tuple(
        (
            name,
            len(one),
            *microseconds(one[:, 0], 50, 99),
            float(np.median(one[:, 0])) / unit,
            float(np.percentile(one[:, 0], 99) / np.median(one[:, 0])),
            1e6 * float(np.mean(one[:, 1])),
        )
        for name, one in best.items()
    )
    columns = ("steps adapted", "plans", "median us", "p99 us", "over without", "p99 / median", "mean us in solve")
    return Section("plan with steps adapted", columns, rows, "", {"plan adapted over not": float(rows[1][4] or 0.0)})


def _walked(quick: bool) -> dict[str, np.ndarray]:
    short = [*STEPS, "gait.steps=7"]
    short += ["fidelity=pendulum", "rates.control=50"] if quick else []
    walks = {name: _Walk([*short, *settings]) for name, settings in VARIANTS.items()}
    with one_thread():
        while not all(walk.loop.done for walk in walks.values()):
            for walk in walks.values():
                if not walk.loop.done:
                    walk.step()
    assert not any(walk.loop.fell for walk in walks.values()), "one fell: what was timed is no walk"
    return {name: np.array(walk.rows) for name, walk in walks.items()}
