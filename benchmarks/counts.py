"""Work in counts, which no busy machine changes: calls of Python functions and bytes, with a plan and without."""

import sys
import tracemalloc
from types import FrameType
from typing import Any

import numpy as np

from benchmarks.table import Section
from surefoot.native import modules
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

WARM, COUNTED, EVERY = 700, 200, 10
"""Ticks of `diagonal-walk` before those that are counted, on a step; their number; and ticks from plan to plan."""


def counted() -> dict[str, float]:
    """Means over ticks with a plan and over those without."""
    loop = closed_loop(resolve(load("diagonal-walk", ["sensing.source=truth"])), NoLog())
    for _ in range(WARM):
        loop.step()
    calls = np.array([_calls(loop) for _ in range(COUNTED)])
    plans = np.arange(COUNTED) % EVERY == int(np.argmax(calls[:EVERY]))
    tracemalloc.start()
    try:
        loop.step()
        held = np.array([_bytes(loop) for _ in range(COUNTED)])
    finally:
        tracemalloc.stop()
    with_plan = np.roll(plans, -1)
    return {
        "calls of a tick without a plan": float(calls[~plans].mean()),
        "calls of a tick with a plan": float(calls[plans].mean()),
        "kB allocated at once in a tick without a plan": float(held[~with_plan].mean()) / 1e3,
        "kB allocated at once in a tick with a plan": float(held[with_plan].mean()) / 1e3,
    }


def _calls(loop: ClosedLoop) -> int:
    """Calls of Python functions in the next tick."""
    count = 0

    def note(frame: FrameType, event: str, argument: Any) -> None:
        nonlocal count
        count += event == "call"

    sys.setprofile(note)
    try:
        loop.step()
    finally:
        sys.setprofile(None)
    return count


def _bytes(loop: ClosedLoop) -> int:
    """Bytes that the next tick holds at once beside those that were held before."""
    before = tracemalloc.get_traced_memory()[0]
    tracemalloc.reset_peak()
    loop.step()
    return tracemalloc.get_traced_memory()[1] - before


def counts(quick: bool) -> Section:
    """The same as a table."""
    made = "modules interpreted" if modules.missing() else "modules compiled"
    return Section("counts", ("of diagonal-walk", "count"), tuple(counted().items()), f"with {made}, without a log")
