"""A walk with a stop watch around the parts of the real closed loop."""

import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import patch

from surefoot.planner.planner import WalkingPlanner
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.foxglove.views import BodyView
from surefoot.scenarios.record.walk import WalkRecorder
from surefoot.scenarios.run import assembly, controller, full
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.run.sensed import Senses
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim.readings import SensorSuite
from surefoot.sim.world import World
from surefoot.wbc.controller import WholeBodyController

PARTS: dict[str, tuple[tuple[type | ModuleType, str], ...]] = {
    "measure": ((World, "measure"),),
    "sensors": ((SensorSuite, "read"),),
    "estimator": ((Senses, "__call__"),),
    "Pinocchio terms": ((WholeBodyController, "observe"),),
    "planner": ((WalkingPlanner, "update"),),
    "logging of plans": ((WalkRecorder, "plan"),),
    "plan sampled": ((controller, "planned"),),
    "whole-body QP": ((WholeBodyController, "update"),),
    "logging": ((Recorder, "tick"), (WalkRecorder, "reference")),
    "viewers' channels": ((BodyView, "events"), (BodyView, "picture")),
    "physics steps": ((World, "act"),),
}
"""Methods and functions of the loop by what they do; compiled code calls them where a class below has its own."""


class TimedWalk:
    """The closed loop of a scenario.

    Attributes:
        rate: control ticks per second [Hz].
        loop: the closed loop, while it walks.
        laps: processor time of each call of each part [s].
    """

    def __init__(self, name: str, overrides: Sequence[str] = ()) -> None:
        self._scenario = load(name, list(overrides))
        self.rate = self._scenario.rates.control
        self.loop: ClosedLoop
        self.laps: dict[str, list[float]] = defaultdict(list)

    def ticks(self, log: Path) -> Iterator[float]:
        """Walk to the end, logging to a file; gives the processor time that each control tick took [s]."""
        with ExitStack() as stack:
            stack.enter_context(one_thread())
            for owner, methods in self._timed().items():
                _watch(stack, owner, methods)
            writer = stack.enter_context(LogWriter(log, {}))
            # A loop of no parts of others has the controller that its module knew before it was watched.
            parts = assembly.Parts(controller=full.WholeBodyController)
            self.loop = closed_loop(resolve(self._scenario), writer, parts)
            while not self.loop.done:
                start = time.thread_time()
                self.loop.step()
                yield time.thread_time() - start

    def _timed(self) -> dict[type | ModuleType, dict[str, Callable[..., Any]]]:
        """Timed stand-ins of each method, by its owner: a class may be watched in several parts."""
        found: dict[type | ModuleType, dict[str, Callable[..., Any]]] = defaultdict(dict)
        for part, methods in PARTS.items():
            for owner, method in methods:
                found[owner][method] = _timed(getattr(owner, method), self.laps[part])
        return found


def _watch(stack: ExitStack, owner: type | ModuleType, methods: Mapping[str, Callable[..., Any]]) -> None:
    """Put methods in place while the stack is open; of a compiled class, which cannot be changed, in one below it."""
    if not isinstance(owner, type) or owner.__flags__ & _CHANGEABLE:
        for method, timed in methods.items():
            stack.enter_context(patch.object(owner, method, timed))
        return
    below = type(owner.__name__, (owner,), dict(methods))
    assert full.__name__ in sys.modules  # compiled modules look a class up when they are imported
    for module in list(sys.modules.values()):
        for name in [name for name, value in vars(module).items() if value is owner]:
            stack.enter_context(patch.object(module, name, below))


_CHANGEABLE = 1 << 9
"""Flag of types that were made by a statement (``Py_TPFLAGS_HEAPTYPE``)."""


def _timed(method: Callable[..., Any], spent: list[float]) -> Callable[..., Any]:
    def call(*arguments: Any, **named: Any) -> Any:
        start = time.thread_time()
        result = method(*arguments, **named)
        spent.append(time.thread_time() - start)
        return result

    return call
