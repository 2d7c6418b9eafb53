"""Logging as a share of the loop: the same walk with every channel and with none, side by side in short turns.

Usage: python benchmarks/logging_share.py [SIMULATED_SECONDS]
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from surefoot.scenarios.log import LogWriter, NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import resolve

TURN = 450
"""Ticks of a turn: a whole number of chunks, plans and pictures."""


def spent(loop: ClosedLoop) -> float:
    begin = time.perf_counter()
    for _ in range(TURN):
        loop.step()
    return time.perf_counter() - begin


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 12.0
    with (
        tempfile.TemporaryDirectory() as folder,
        threadpool_limits(1),
        LogWriter(Path(folder) / "on.mcap", {}) as on,
    ):
        walk = resolve(load_scenario("diagonal-walk"))
        loops = closed_loop(walk, on), closed_loop(walk, NoLog())
        turns = [[spent(loop) for loop in loops] for _ in range(0, round(500 * seconds), TURN)]
    logged, bare = np.array(turns).T
    print(
        f"median tick with all channels {1e6 * np.median(logged) / TURN:.0f} us, "
        f"with none {1e6 * np.median(bare) / TURN:.0f} us"
    )
    print(f"logging takes {100 * np.median(1 - bare / logged):.1f} % of the loop (median of {len(turns)} turns)")


if __name__ == "__main__":
    main()
