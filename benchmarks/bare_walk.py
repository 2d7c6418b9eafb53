"""A walk outside the command line, with a stop watch around the parts of the real closed loop."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest.mock import patch

from threadpoolctl import threadpool_limits

from planner.planner import WalkingPlanner
from planner.sampling import PlanSampler
from scenarios.closed_loop.loop import ClosedLoop
from scenarios.file.load import load_scenario
from scenarios.file.robots import describe
from scenarios.file.timeline import run_duration
from scenarios.log import LogWriter
from scenarios.recording.recorder import Recorder
from scenarios.recording.walk_recorder import WalkRecorder
from scenarios.viewer.body_view import BodyView
from sim.world import World
from wbc.controller import WholeBodyController

PARTS: dict[str, tuple[tuple[type, str], ...]] = {
    "measure": ((World, "measure"),),
    "Pinocchio terms": ((WholeBodyController, "observe"),),
    "planner": ((WalkingPlanner, "update"),),
    "logging of plans": ((WalkRecorder, "plan"),),
    "reference sampling": ((PlanSampler, "sample"),),
    "QP assembly": ((WholeBodyController, "_assemble"),),
    "QP solve": ((WholeBodyController, "_solve"),),
    "logging": ((Recorder, "tick"), (WalkRecorder, "reference")),
    "viewers' channels": ((BodyView, "events"), (BodyView, "picture")),
    "physics steps": ((World, "advance"),),
}


class BareWalk:
    """The closed loop of a scenario.

    Attributes:
        rate: control ticks per second [Hz].
        loop: the closed loop, while it walks.
        laps: wall-clock time of each call of each part [s].
    """

    def __init__(self, name: str, overrides: tuple[str, ...] = ()) -> None:
        self._scenario = load_scenario(name, list(overrides))
        self.rate = self._scenario.rates.control
        self.loop: ClosedLoop
        self.laps: dict[str, list[float]] = defaultdict(list)

    def ticks(self, log: Path) -> Iterator[float]:
        """Walk to the end, logging to the file ``log``; gives the time of each control tick after it [s]."""
        with ExitStack() as stack:
            stack.enter_context(threadpool_limits(1))
            for part, methods in PARTS.items():
                for owner, method in methods:
                    timed = _timed(getattr(owner, method), self.laps[part])
                    stack.enter_context(patch.object(owner, method, timed))
            writer = stack.enter_context(LogWriter(log, {}))
            self.loop = ClosedLoop(self._scenario, describe(self._scenario), writer)
            for tick in range(round(run_duration(self._scenario) * self.rate)):
                self.loop.tick(tick)
                yield tick / self.rate


def _timed(method: Callable[..., Any], spent: list[float]) -> Callable[..., Any]:
    def call(*arguments: Any, **named: Any) -> Any:
        start = time.perf_counter()
        result = method(*arguments, **named)
        spent.append(time.perf_counter() - start)
        return result

    return call
