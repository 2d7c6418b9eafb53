"""Logging as a share of the loop: the same walk with every channel and with none, in processor time.

Usage: python benchmarks/logging_share.py [SIMULATED_SECONDS] [REPETITIONS]
"""

import gc
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from scenarios.load import load_scenario
from scenarios.log import LogWriter
from scenarios.loop import ClosedLoop
from scenarios.robots import describe


class Nothing:
    """Records nothing."""

    def __getattr__(self, name: str) -> Any:
        return lambda *values: None


def spent(path: Path, seconds: float, logged: bool) -> float:
    """Processor time of the loop [s]."""
    scenario = load_scenario("diagonal-walk", [])
    with LogWriter(path, {}) as writer:
        loop = ClosedLoop(scenario, describe(scenario), writer)
        if not logged:
            loop._recorder = loop._walk_recorder = loop._view = loop._planning._recorder = Nothing()
        ticks = range(round(seconds * scenario.rates.control))
        gc.collect()
        start = time.process_time()
        for tick in ticks:
            loop.tick(tick)
        return time.process_time() - start


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0
    repetitions = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    with tempfile.TemporaryDirectory() as folder, threadpool_limits(1):
        path = Path(folder) / "log.mcap"
        spent(path, 0.5, True)
        pairs = [(spent(path, seconds, True), spent(path, seconds, False)) for _ in range(repetitions)]
    on, off = (min(column) for column in zip(*pairs, strict=True))
    print(f"with all channels {on / seconds:.3f} s per simulated second, with none {off / seconds:.3f}")
    print(f"logging takes {100 * (on - off) / on:.1f} % of the loop")


if __name__ == "__main__":
    main()
