"""The log: loading one channel of a long one, and its size."""

import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.table import Section
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec

VALUES, CHANNELS, PERIOD_NS = 60, 5, 2_000_000


def reading(quick: bool) -> Section:
    """Time to load one channel of a long log into numpy, among five."""
    messages, tries = (2_000, 1) if quick else (20_000, 9)
    rows = np.random.default_rng(0).normal(size=(500, VALUES))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        with LogWriter(path, {}) as writer:
            specs = [ChannelSpec(f"/c{i}", "Values", (FieldSpec("values", (VALUES,)),)) for i in range(CHANNELS)]
            channels = [writer.channel(spec) for spec in specs]
            start = time.perf_counter()
            for tick in range(messages):
                for channel in channels:
                    channel.append(tick * PERIOD_NS, rows[tick % 500])
            wrote = time.perf_counter() - start
        spent = []
        for _ in range(tries):
            start = time.perf_counter()
            values = read(path)["/c0"].field("values")
            spent.append(time.perf_counter() - start)
            assert values.shape == (messages, VALUES)
        megabytes = path.stat().st_size / 1e6
    table = (
        (f"{messages} x {VALUES} values of one channel, read", 1e3 * float(np.median(spent))),
        (f"the same of {CHANNELS} channels, written ({megabytes:.0f} MB)", 1e3 * wrote),
    )
    return Section("log", ("what", "ms"), table, "", {"read over written": float(np.median(spent)) / wrote})
