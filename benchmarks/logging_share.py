"""Logging as a share of the loop: the same walk with every channel and with none, side by side in short turns.

Usage: python benchmarks/logging_share.py [SIMULATED_SECONDS]
"""

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.loop.full import ClosedLoop
from surefoot.scenarios.setup.load import load_scenario
from surefoot.scenarios.setup.robot import describe

TURN = 450
"""Ticks of a turn: a whole number of chunks, plans and pictures."""


class Nothing:
    """Records nothing."""

    def __getattr__(self, name: str) -> Any:
        return lambda *values: None


def walk(writer: LogWriter, logged: bool) -> ClosedLoop:
    scenario = load_scenario("diagonal-walk", [])
    loop = ClosedLoop(scenario, describe(scenario), writer)
    if not logged:
        loop._recorder = loop._walk_recorder = loop._view = loop._planning._recorder = Nothing()
    return loop


def spent(loop: ClosedLoop, start: int) -> float:
    begin = time.perf_counter()
    for tick in range(start, start + TURN):
        loop.tick(tick)
    return time.perf_counter() - begin


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 12.0
    with (
        tempfile.TemporaryDirectory() as folder,
        threadpool_limits(1),
        LogWriter(Path(folder) / "on.mcap", {}) as on,
        LogWriter(Path(folder) / "off.mcap", {}) as off,
    ):
        loops = walk(on, True), walk(off, False)
        turns = [[spent(loop, start) for loop in loops] for start in range(0, round(500 * seconds), TURN)]
    logged, bare = np.array(turns).T
    print(
        f"median tick with all channels {1e6 * np.median(logged) / TURN:.0f} us, "
        f"with none {1e6 * np.median(bare) / TURN:.0f} us"
    )
    print(f"logging takes {100 * np.median(1 - bare / logged):.1f} % of the loop (median of {len(turns)} turns)")


if __name__ == "__main__":
    main()
